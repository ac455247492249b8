"""Bases on wheels below an arm: what moves with it when nobody holds the base."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from hrsafety._arguments import Array, finite, not_negative, numbers, pair, positive, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["BASE_JOINTS", "RollingBase"]

BASE_JOINTS = ("base_x", "base_y", "base_turn")
"""Joints of a base that rolls: ways that it drives ahead and to its left, and its turn."""
SIDEWAYS = 0.05
"""Share of its way by which a differential base may slip to the side, beside 10 mm or mrad."""
LARGEST_TURN = 0.5 * np.pi
"""Largest turn in rad between two poses."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RollingBase:
    """A base on wheels below the root of a URDF.

    Masses of an arm on one that rolls are never larger than on one that stands still. Values of its joints are ways
    driven, and places of the arm are told from the base, wherever that is on the floor.

    Parameters
    ----------
    kind : {"differential", "omni"}
        Whether it moves along its heading and turns about its axle, or moves any way.
    mass : float
        Beside that of the root of the URDF, in kg.
    inertia : float or None
        About the vertical through the origin of the root, in kg m^2. ``None``: it is taken not to turn, which makes
        no mass smaller.
    axle : tuple of two floats
        Middle of the axle in the frame of the root in m, of a differential base.
    heading : float
        Direction ahead about the vertical, in rad from x.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range or the word is unknown.

    Examples
    --------
    >>> from hrsafety import arms
    >>> base = arms.RollingBase(kind="omni", mass=40.0)
    >>> arm = arms.Arm.example(base=base, armature=0.3)
    >>> f"{arm.iso_mass - arms.Arm.example().iso_mass:g} kg"
    '20 kg'
    """

    kind: str
    mass: float
    inertia: float | None = None
    axle: tuple[float, float] = (0.0, 0.0)
    heading: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        word("kind", self.kind, ("differential", "omni"))
        object.__setattr__(self, "mass", not_negative("mass", self.mass))
        if self.inertia is not None:
            object.__setattr__(self, "inertia", positive("inertia", self.inertia))
        object.__setattr__(self, "axle", pair("axle", self.axle))
        object.__setattr__(self, "heading", finite("heading", self.heading))

    @property
    def native(self) -> tuple[bool, float, float | None, list[float], float]:
        """Values that the core reads."""
        return self.kind == "omni", self.mass, self.inertia, list(self.axle), self.heading

    def ways(self, poses: object) -> Array:
        """Return the ways that a base drives along poses on the floor.

        Parameters
        ----------
        poses : array_like (n, 3)
            Place of the root on the floor in m, and its turn in rad, as odometry tells them.

        Returns
        -------
        ndarray (n, 3)
            Ways ahead and to the left in m, and the turn in rad, from 0: values of the joints ``base_x``, ``base_y``
            and ``base_turn``.

        Raises
        ------
        InvalidParameterError, ShapeError
            If poses are no finite numbers, turn by more than a quarter turn at once, or are those of another base:
            one that drives sideways, or turns although it has no inertia.

        Examples
        --------
        >>> import numpy as np
        >>> from hrsafety import arms
        >>> angle = np.linspace(0.0, 3.0, 40)
        >>> circle = np.column_stack([np.sin(angle), 1.0 - np.cos(angle), angle])
        >>> arms.RollingBase(kind="differential", mass=40.0, inertia=2.0).ways(circle)[-1].round(6).tolist()
        [3.0, 0.0, 3.0]
        """
        given = numbers("poses", poses)
        if given.ndim != 2 or given.shape[1] != 3 or not len(given):
            raise ShapeError("poses", "(n, 3)", given.shape)
        if not np.isfinite(given).all():
            raise InvalidParameterError("poses", "be finite", float(given[~np.isfinite(given)][0]))
        turn = given[:, 2]
        steps = np.remainder(np.diff(turn) + np.pi, 2.0 * np.pi) - np.pi
        if len(steps) and np.abs(steps).max() > LARGEST_TURN:
            rule = "turn by a quarter turn at most from one to the next"
            raise InvalidParameterError("poses", rule, float(steps[np.argmax(np.abs(steps))]), "record it oftener")
        places = given[:, :2] + _turned(turn, np.array(self._axle))
        along = _turned(-(turn[:-1] + self.heading), np.diff(places, axis=0))
        half = 0.5 * steps
        # Both ends lie on an arc, along which speeds are even.
        straight = np.abs(half) < 1e-8
        stretch = np.where(straight, 1.0, half / np.tan(np.where(straight, 1.0, half)))
        ahead = stretch * along[:, 0] + half * along[:, 1]
        left = stretch * along[:, 1] - half * along[:, 0]
        moves = np.column_stack([ahead, left, steps])
        self._check(moves)
        moves[:, [False, self.kind == "differential", self.inertia is None]] = 0.0
        return np.concatenate([np.zeros((1, 3)), np.cumsum(moves, axis=0)])

    def on_floor(self, ways: object) -> Array:
        """Return the poses on the floor (n, 3) along ways that a base drives, from 0 as `ways` takes them.

        Parameters
        ----------
        ways : array_like (n, 3)
            As `ways` returns them.

        Returns
        -------
        ndarray (n, 3)
            Place of the root in m and its turn in rad.
        """
        given = numbers("ways", ways)
        if given.ndim != 2 or given.shape[1] != 3 or not len(given):
            raise ShapeError("ways", "(n, 3)", given.shape)
        steps = np.diff(given, axis=0)
        turn = given[:, 2]
        half = 0.5 * steps[:, 2]
        straight = np.abs(half) < 1e-8
        chord = np.where(straight, 1.0, np.sin(half) / np.where(straight, 1.0, half))
        moved = _turned(turn[:-1] + half + self.heading, chord[:, np.newaxis] * steps[:, :2])
        start = _turned(turn[:1], np.array(self._axle))
        places = np.concatenate([start, start + np.cumsum(moved, axis=0)])
        return np.column_stack([places - _turned(turn, np.array(self._axle)), turn])

    @property
    def _axle(self) -> tuple[float, float]:
        """Place that ways are driven by, in the frame of the root."""
        return self.axle if self.kind == "differential" else (0.0, 0.0)

    def _check(self, moves: Array) -> None:
        """Refuse moves that a base of this kind does not make."""
        ahead, left, turned = np.abs(moves).sum(axis=0).tolist()
        if self.kind == "differential" and left > 0.01 + SIDEWAYS * ahead:
            remedy = "give the place of its axle and its heading, or kind 'omni'"
            rule = f"drive along the heading of a differential base, beside {100.0 * SIDEWAYS:g} %"
            raise InvalidParameterError("poses", rule, f"{left:.3g} m to the side", remedy)
        if self.inertia is None and turned > 0.01:
            remedy = "give the inertia of the base about the vertical"
            raise InvalidParameterError(
                "poses", "not turn: a base without inertia does not", f"{turned:.3g} rad", remedy
            )


def links_of_base(urdf: str) -> tuple[str, ...]:
    """Return the root of a URDF and the links that are fixed to it."""
    joints: list[tuple[str, str, str]] = []
    for joint in ElementTree.fromstring(urdf).iter("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            joints.append((joint.get("type", ""), parent.get("link", ""), child.get("link", "")))
    children = {child for _, _, child in joints}
    found = [parent for _, parent, _ in joints if parent not in children][:1]
    for link in found:
        found += [child for kind, parent, child in joints if kind == "fixed" and parent == link]
    return tuple(found)


def _turned(angle: Array, way: Array) -> Array:
    """Return ways (..., 2) turned by angles about the vertical."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = way[..., 0], way[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)
