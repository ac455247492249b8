"""Outlines of a map: what people who keep off walls see of it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, pair, sequence
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.parts import PolylineWall
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.standing import Disc, Rectangle

__all__ = ["Shape", "checked_shapes", "native_walls", "outlines", "standing"]

Shape = Disc | Rectangle | tuple[Pair, ...]


def checked_shapes(name: str, given: object) -> tuple[Shape, ...]:
    """Return walls as shapes, points as pairs."""
    walls = sequence(name, "be a StaticMap or a sequence of walls", given)
    return tuple(_shape(f"{name}[{index}]", wall) for index, wall in enumerate(walls))


def _shape(name: str, given: object) -> Shape:
    if isinstance(given, Disc | Rectangle):
        return given
    places = sequence(name, "be a Disc, a Rectangle or a sequence of points (x, y)", given)
    wall = tuple(pair(f"{name}[{index}]", place) for index, place in enumerate(places))
    try:
        _hrsafety.CrowdWall.polyline(list(wall))
    except InvalidParameterError as error:
        raise error.renamed(f"{name}.{error.argument}") from None
    return wall


def native_walls(walls: object) -> list[_hrsafety.CrowdWall]:
    """Return walls of all kinds as the core of worlds knows them."""
    polyline, solid = _hrsafety.CrowdWall.polyline, _hrsafety.CrowdWall.solid
    shapes = checked_shapes("walls", walls)
    return [polyline(list(wall)) if isinstance(wall, tuple) else solid(wall._native) for wall in shapes]


def standing(walls: Sequence[Any] | StaticMap) -> StaticMap:
    """Return walls as a map, which knows distances of segments; a line without length is a disc of a nanometer."""
    if isinstance(walls, StaticMap):
        return walls
    solid = [wall for wall in walls if isinstance(wall, Disc | Rectangle)]
    lines = [np.asarray(wall, dtype=np.float64) for wall in walls if not isinstance(wall, Disc | Rectangle)]
    dots = [(*line[0], 1e-9) for line in lines if not np.ptp(line, axis=0).any()]
    drawn = [line for line in lines if np.ptp(line, axis=0).any()]
    return StaticMap.from_obstacles(solid) + StaticMap.from_polylines(drawn) + StaticMap(discs=dots)


def outlines(place: StaticMap) -> tuple[Shape, ...]:
    """Return the parts of a map as discs, rectangles and polylines.

    Parameters
    ----------
    place : StaticMap
        The map.

    Returns
    -------
    tuple of Disc, Rectangle or tuple of points
        Walls without thickness as they are, a rectangle for every segment of a thick one, its length that of the
        segment and the thickness; polygons and the boundaries of occupied cells as closed polylines; discs.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> from hrsafety.navigation.maps.outlines import outlines
    >>> outlines(nav.StaticMap.from_polygons([[(0, 0), (2, 0), (1, 1)]]))
    (((0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (0.0, 0.0)),)
    """
    found: list[Shape] = []
    for wall in place.walls:
        found += [tuple(wall.points)] if wall.radius == 0.0 else _thick(wall)
    polygons: Any = place.polygons  # checked: tuples of points, and rows of three numbers
    discs: Any = place.discs
    found += [(*corners, corners[0]) for corners in polygons]
    found += [Disc(center=(x, y), radius=radius) for x, y, radius in discs]
    for grid in place.grids:
        found += _boundaries(StaticMap(grids=[grid]))
    return tuple(found)


def _thick(wall: PolylineWall) -> list[Shape]:
    """Return a rectangle for each segment of a thick wall."""
    found: list[Shape] = []
    for (x, y), (u, v) in zip(wall.points[:-1], wall.points[1:], strict=True):
        length, width = math.hypot(u - x, v - y), 2.0 * wall.radius
        if length > 0.0:
            middle, heading = (0.5 * (x + u), 0.5 * (y + v)), math.atan2(v - y, u - x)
            found.append(Rectangle(center=middle, length=length + width, width=width, heading=heading))
    return found


def _boundaries(place: StaticMap) -> Iterator[Shape]:
    """Yield the boundaries of the occupied cells of a map, whose segments follow each other."""
    segments = np.asarray(place._native.segments())[:, :4]
    starts: dict[Pair, list[Pair]] = {}
    for x, y, u, v in segments.tolist():
        starts.setdefault((x, y), []).append((u, v))
    while starts:
        first = next(iter(starts))
        line, here = [first], first
        while here in starts:
            here, rest = starts[here].pop(), starts[here]
            if not rest:
                del starts[line[-1]]
            line.append(here)
        yield tuple(line)
