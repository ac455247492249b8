"""Parts of a static map, and checks of what is given for them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, number, numbers, pair, points, sequence
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.obstacles.standing import Rectangle

__all__ = ["Cells", "PolylineWall"]

_PART = 16_384  # rows of which the answers take milliseconds

Outline = tuple[tuple[float, float], ...]


class PolylineWall(NamedTuple):
    """A wall along a polyline.

    Attributes
    ----------
    points : tuple of (float, float)
        Corners in m.
    radius : float
        Everything within this distance of the polyline belongs to the wall, in m.
    """

    points: Outline
    radius: float


@displayed
class Cells(NamedTuple):
    """An occupancy grid.

    Attributes
    ----------
    bits : bytes
        Occupied cells, row after row from the lowest y, as by ``numpy.packbits``.
    shape : (int, int)
        Rows and columns.
    resolution : float
        Side of a cell in m.
    origin : (float, float)
        Lower left corner of the first cell, in m.
    yaw : float
        Angle by which the grid is turned around it, in rad.
    limits : bool
        Whether nothing is known of what lies outside of it, and of other such grids.
    unseen_bits : bytes
        Cells that count as free though they were not observed, like ``bits``; empty without any.
    """

    bits: bytes
    shape: tuple[int, int]
    resolution: Annotated[float, "m"]
    origin: Annotated[tuple[float, float], "m"]
    yaw: Annotated[float, "rad"]
    limits: bool = False
    unseen_bits: bytes = b""

    @property
    def occupied(self) -> npt.NDArray[np.bool_]:
        """Which cells are occupied, (rows, columns)."""
        return _unpacked(self.bits, self.shape)

    @property
    def unseen(self) -> npt.NDArray[np.bool_]:
        """Which cells count as free though they were not observed, (rows, columns)."""
        return _unpacked(self.unseen_bits, self.shape) if self.unseen_bits else np.zeros(self.shape, dtype=np.bool_)

    def unseen_at(self, point: Array) -> npt.NDArray[np.bool_]:
        """Return whether points (n, 2) lie in cells that count as free though they were not observed."""
        rows, columns = self.shape
        found = np.zeros(len(point), dtype=np.bool_)
        if not self.unseen_bits:
            return found
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        away = (point - self.origin) / self.resolution
        cell = np.floor(np.stack([away @ (cosine, sine), away @ (-sine, cosine)], axis=1))
        inside = ((cell >= 0.0) & (cell < (columns, rows))).all(axis=1)
        column, row = cell[inside].astype(np.int64).T
        at = row * columns + column
        bits = np.frombuffer(self.unseen_bits, dtype=np.uint8)
        found[inside] = bits[at // 8] >> (7 - at % 8) & 1 == 1
        return found


def _unpacked(bits: bytes, shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
    rows, columns = shape
    found = np.unpackbits(np.frombuffer(bits, dtype=np.uint8), count=rows * columns)
    return found.astype(np.bool_).reshape(rows, columns)


def counted(word: str, many: int) -> str:
    return f"1 {word}" if many == 1 else f"{many} {word}s"


def items(name: str, given: object) -> list[Any]:
    return sequence(name, "be a sequence", given)


def checked_wall(name: str, given: object) -> tuple[Array, float]:
    parts = sequence(name, "be a pair (points, radius)", given)
    if len(parts) != 2:
        raise InvalidParameterError(name, "be a pair (points, radius)", given)
    return points(name, parts[0]), number(f"radius of {name}", parts[1])


def outline(corners: Array) -> Outline:
    return tuple((float(x), float(y)) for x, y in corners)


def corners_of(box: Rectangle) -> Outline:
    """Return the corners of a rectangle, counter-clockwise."""
    cosine, sine = math.cos(box.heading), math.sin(box.heading)
    (x, y), along, across = box.center, 0.5 * box.length, 0.5 * box.width
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    places = [(a * along, b * across) for a, b in signs]
    return tuple((x + cosine * u - sine * v, y + sine * u + cosine * v) for u, v in places)


def checked_finite(name: str, given: Array) -> Array:
    if not np.isfinite(given).all():
        first = given.ravel()[~np.isfinite(given.ravel())][0]
        raise InvalidParameterError(name, "be finite", float(first))
    return given


def checked_place(name: str, given: object) -> tuple[float, float]:
    x, y = pair(name, given)
    checked_finite(name, np.array([x, y]))
    return x, y


def checked_points(given: npt.ArrayLike) -> Array:
    array = numbers("point", given)
    return checked_finite("point", points("point", array.reshape(1, -1) if array.ndim == 1 else array))


def in_parts(ask: Callable[[Array], object], rows: Array) -> Array:
    """Return the answers for many rows, asked part by part: between them Ctrl-C is answered."""
    starts = range(0, max(len(rows), 1), _PART)
    return np.concatenate([np.asarray(ask(rows[start : start + _PART])) for start in starts])
