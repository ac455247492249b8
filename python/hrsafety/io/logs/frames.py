"""Frames of a robot: trees of transforms, and poses along a chain at given instants."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety.errors import FileError, Shown

__all__ = ["Edge", "Poses", "Tree", "rotations", "unit_quaternions", "yaw_of"]

Instants = npt.NDArray[np.int64]

OLDEST = 10**9
"""A transform that is interpolated is known for so long after its last stamp, in ns."""
UNIT = 0.02
"""Quaternions differ by at most so much from length 1: two decimals of each number."""


class Poses(NamedTuple):
    """Poses at n instants.

    Attributes
    ----------
    rotation : ndarray, shape (n, 3, 3)
        Rotation matrices.
    translation : ndarray, shape (n, 3)
        In m.
    known : ndarray of bool, shape (n,)
        Whether there is a pose.
    """

    rotation: Array
    translation: Array
    known: npt.NDArray[np.bool_]

    def after(self, other: Poses) -> Poses:
        """Return these poses in the parent frame of others: ``other`` times ``self``."""
        rotation = other.rotation @ self.rotation
        translation = np.einsum("nij,nj->ni", other.rotation, self.translation) + other.translation
        return Poses(rotation, translation, self.known & other.known)

    def inverse(self) -> Poses:
        """Return the poses of the parents in the children."""
        turned = np.swapaxes(self.rotation, 1, 2)
        return Poses(turned, -np.einsum("nij,nj->ni", turned, self.translation), self.known)


@dataclass(frozen=True, kw_only=True, slots=True)
class Edge:
    """A child frame in its parent over time.

    Attributes
    ----------
    parent, child : str
        Frames.
    topic : str
        Where the transforms come from.
    stamp : ndarray of int, shape (n,)
        Increasing times in ns.
    translation : ndarray, shape (n, 3)
        In m.
    quaternion : ndarray, shape (n, 4)
        x, y, z, w, of length 1.
    static : bool
        Whether it holds for all times.
    """

    parent: str
    child: str
    topic: str
    stamp: Instants
    translation: Array
    quaternion: Array
    static: bool = False

    def at(self, instants: Instants, *, held: bool) -> Poses:
        """Return poses at instants: the last one at or before (held), else linear between two, shortest arc."""
        count = len(instants)
        if self.static:
            rotation = np.broadcast_to(rotations(self.quaternion[-1:]), (count, 3, 3))
            return Poses(rotation, np.broadcast_to(self.translation[-1:], (count, 3)), np.ones(count, dtype=np.bool_))
        last = np.searchsorted(self.stamp, instants, "right") - 1
        known = last >= 0
        last = np.maximum(last, 0)
        if held:
            return Poses(rotations(self.quaternion[last]), self.translation[last], known)
        following = np.minimum(last + 1, len(self.stamp) - 1)
        since, span = instants - self.stamp[last], self.stamp[following] - self.stamp[last]
        exact = since == 0
        known = known & (exact | ((following > last) & (span <= OLDEST)))
        share = np.divide(since, span, out=np.zeros(count), where=known & ~exact & (span > 0))
        moved = self.translation[last] + share[:, None] * (self.translation[following] - self.translation[last])
        turned = _between(self.quaternion[last], self.quaternion[following], share)
        return Poses(rotations(turned), moved, known)


@dataclass(kw_only=True, slots=True)
class Tree:
    """Frames by their parents.

    Attributes
    ----------
    edges : mapping of str to Edge
        By child.
    held : frozenset of str
        Children whose transforms are corrections that hold until the next one, such as ``odom`` in ``map``.
    """

    edges: Mapping[str, Edge]
    held: frozenset[str] = field(default=frozenset())

    def up(self, frame: str) -> list[str]:
        """Return the frames from one to its root."""
        found = [frame]
        while found[-1] in self.edges:
            parent = self.edges[found[-1]].parent
            if parent in found:
                raise FileError(f"frame {parent}", "be no child of itself", Shown(" <- ".join(found)), code="frames")
            found.append(parent)
        return found

    def words(self) -> str:
        """Return all trees in a line: ``map > odom > base_link; earth``."""
        children: dict[str, list[str]] = {}
        for child, edge in self.edges.items():
            children.setdefault(edge.parent, []).append(child)
        roots = [name for name in children if name not in self.edges]

        def told(name: str, depth: int = 0) -> str:
            below = sorted(children.get(name, ()))
            if not below or depth > 20:
                return name
            inner = [told(each, depth + 1) for each in below]
            return f"{name} > {inner[0]}" if len(inner) == 1 else f"{name} > ({', '.join(inner)})"

        return "; ".join(told(root) for root in sorted(roots))

    def poses(self, frame: str, target: str, instants: Instants) -> Poses | None:
        """Return poses of a frame in another one, ``None`` if no chain leads there."""
        one, other = self.up(frame), self.up(target)
        shared = next((each for each in one if each in other), None)
        if shared is None:
            return None
        found = self._along(one[: one.index(shared)], instants)
        below = other[: other.index(shared)]
        return found.after(self._along(below, instants).inverse()) if below else found

    def _along(self, frames: Iterable[str], instants: Instants) -> Poses:
        count = len(instants)
        found = Poses(np.broadcast_to(np.eye(3), (count, 3, 3)), np.zeros((count, 3)), np.ones(count, dtype=np.bool_))
        for child in frames:
            found = found.after(self.edges[child].at(instants, held=child in self.held))
        return found


def rotations(quaternion: Array) -> Array:
    """Return rotation matrices (n, 3, 3) of unit quaternions x, y, z, w (n, 4)."""
    x, y, z, w = quaternion.T
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def yaw_of(rotation: Array) -> Array:
    """Return the angle of the x axis in the plane, in rad, of rotation matrices (n, 3, 3)."""
    return np.asarray(np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]))


def unit_quaternions(quaternion: Array, name: str, places: Iterable[object]) -> Array:
    """Return quaternions (n, 4) of length 1, or refuse the first that is no rotation.

    Parameters
    ----------
    quaternion : ndarray, shape (n, 4)
        As read; rows that are not finite are passed on.
    name : str
        File, before the place of an error.
    places : iterable of object
        Line or topic of each.

    Raises
    ------
    FileError
        If one is zero or far from length 1 (``quaternion``).
    """
    with np.errstate(over="ignore", invalid="ignore"):
        length = np.linalg.norm(quaternion, axis=1)
    wrong = np.isfinite(quaternion).all(axis=1) & ~(np.abs(length - 1.0) <= UNIT)
    if wrong.any():
        row = int(np.argmax(wrong))
        place = next(each for index, each in enumerate(places) if index == row)
        shown = ", ".join(f"{each:g}" for each in quaternion[row])
        raise FileError(
            f"{name}, {place}, quaternion",
            "have length 1",
            Shown(f"({shown}) of length {length[row]:.3g}"),
            "the order is x, y, z, w; leave out rows without an orientation",
            code="quaternion",
        )
    return np.asarray(quaternion / np.where(length > 0.0, length, 1.0)[:, None])


def _between(one: Array, other: Array, share: Array) -> Array:
    """Return unit quaternions on the shortest arc between two, at a share of it."""
    cosine = np.einsum("ni,ni->n", one, other)
    other = np.where(cosine[:, None] < 0.0, -other, other)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    near = sine < 1e-9
    scale = np.where(near, 1.0, sine)
    first = np.where(near, 1.0 - share, np.sin((1.0 - share) * angle) / scale)
    second = np.where(near, share, np.sin(share * angle) / scale)
    found = first[:, None] * one + second[:, None] * other
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])
