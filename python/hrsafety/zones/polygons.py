"""Polygons of zones: checks, points inside as the collision monitor counts them, supports and distances."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, own, points
from hrsafety.errors import InvalidParameterError, Shown

__all__ = [
    *("ANGLES", "area", "checked", "convex", "distance_outside", "from_supports", "inside", "simplified", "supports"),
    "trimmed",
]

ANGLES = np.arange(72.0) * (2.0 * math.pi / 72.0)
"""Directions in rad in which the reach of shapes is taken."""


def checked(name: str, value: object) -> Array:
    """Return the corners of a simple polygon, (n, 2), or say what they should have been."""
    corners = points(name, value)
    if not np.isfinite(corners).all():
        raise InvalidParameterError(name, "have finite numbers", Shown("one that is not"))
    if len(corners) < 3:
        raise InvalidParameterError(name, "have at least 3 corners", Shown(f"{len(corners)}"))
    crossing = _crossing(corners)
    if crossing is not None:
        first, second = crossing
        shown = Shown(f"edges {first} and {second} that meet")
        raise InvalidParameterError(
            name, "be a polygon that does not cross itself", shown, "order its corners around it"
        )
    if abs(area(corners)) <= 1e-12:
        raise InvalidParameterError(name, "enclose an area", Shown("corners on one line"))
    return own(corners)


def _crossing(corners: Array) -> tuple[int, int] | None:
    """Return two edges that have a point in common and are no neighbors, by the index of their first corners."""
    count = len(corners)
    start, end = corners, np.roll(corners, -1, axis=0)
    for first in range(count):
        others = np.arange(first + 1, count)
        near = (others == first + 1) | ((first == 0) & (others == count - 1))
        # A neighbor that turns back lies on this edge.
        for other in others[near]:
            back = end[other] if other == first + 1 else start[other]
            if count > 2 and _on_edge(start[first], end[first], back) and not np.array_equal(back, start[first]):
                return first, int(other)
        apart = others[~near]
        if not len(apart):
            continue
        a, b, c, d = start[first], end[first], start[apart], end[apart]
        sides = [np.sign(_turn(a, b, c)), np.sign(_turn(a, b, d)), np.sign(_turn(c, d, a)), np.sign(_turn(c, d, b))]
        meet = (sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)
        for index in np.flatnonzero(~meet & ((sides[0] * sides[1] == 0) | (sides[2] * sides[3] == 0))):
            meet[index] = any(
                (
                    _on_edge(a, b, c[index]),
                    _on_edge(a, b, d[index]),
                    _on_edge(c[index], d[index], a),
                    _on_edge(c[index], d[index], b),
                )
            )
        if meet.any():
            return first, int(apart[np.argmax(meet)])
    return None


def _turn(a: Array, b: Array, c: Array) -> Array:
    """Return twice the signed area of the triangle."""
    return np.asarray(
        (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])
    )


def _on_edge(a: Array, b: Array, point: Array) -> bool:
    low, high = np.minimum(a, b), np.maximum(a, b)
    return bool(_turn(a, b, point) == 0.0 and (low <= point).all() and (point <= high).all())


def area(corners: Array) -> float:
    """Return the area of a polygon, negative if its corners go clockwise."""
    x, y = corners[:, 0], corners[:, 1]
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def inside(corners: Array, x: Array, y: Array, among: npt.NDArray[np.bool_] | None = None) -> npt.NDArray[np.bool_]:
    """Return which points a polygon holds: those from which a ray along x crosses its edges an odd number of times.

    Only points among those that are wanted are examined, and of them those in the box around the polygon.
    """
    low, high = corners.min(axis=0), corners.max(axis=0)
    near = (x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1])
    if among is not None:
        near &= among
    found = np.zeros(np.shape(x), dtype=np.bool_)
    if not near.any():
        return found
    at_x, at_y = x[near], y[near]
    odd = np.zeros(at_x.shape, dtype=np.bool_)
    before = corners[-1]
    for corner in corners:
        if before[1] != corner[1]:
            crossed = (at_y <= before[1]) == (at_y > corner[1])
            at = before[0] + (at_y - before[1]) * (corner[0] - before[0]) / (corner[1] - before[1])
            odd ^= crossed & (at > at_x)
        before = corner
    found[near] = odd
    return found


def distance_outside(corners: Array, place: Array) -> Array:
    """Return how far points (n, 2) lie outside a polygon in m; 0 for those inside."""
    start, along = corners, np.roll(corners, -1, axis=0) - corners
    away = place[:, np.newaxis] - start
    length = np.maximum((along * along).sum(axis=1), 1e-300)
    share = np.clip((away * along).sum(axis=2) / length, 0.0, 1.0)
    gap = np.linalg.norm(away - share[..., np.newaxis] * along, axis=2).min(axis=1)
    return np.where(inside(corners, place[:, 0], place[:, 1]), 0.0, gap)


def convex(corners: Array) -> Array:
    """Return the convex hull of points, counter-clockwise."""
    ordered = np.unique(corners, axis=0)
    hull: list[Array] = []
    for run in (ordered, ordered[::-1]):
        first = len(hull)
        for point in run:
            while len(hull) - first >= 2 and _turn(hull[-2], hull[-1], point) <= 0.0:
                hull.pop()
            hull.append(point)
        hull.pop()
    return np.array(hull) if len(hull) > 2 else ordered


def from_supports(angles: Array, supports: Array) -> Array:
    """Return the corners of the convex polygon whose edges have these outward normals and distances from the origin.

    Edges that the others cut off are left out.
    """
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    kept = list(range(len(angles)))
    changed = True
    while changed and len(kept) > 3:
        changed = False
        for place in range(len(kept)):
            before, this, after = kept[place - 1], kept[place], kept[(place + 1) % len(kept)]
            if _angle_between(angles[before], angles[after]) >= math.pi - 1e-9:
                continue
            corner = _meeting(normals[before], supports[before], normals[after], supports[after])
            if corner @ normals[this] <= supports[this] + 1e-12:
                del kept[place]
                changed = True
                break
    pairs = zip(kept, [*kept[1:], kept[0]], strict=True)
    return np.array([_meeting(normals[a], supports[a], normals[b], supports[b]) for a, b in pairs])


def simplified(angles: Array, supports: Array, corners: int) -> npt.NDArray[np.int64]:
    """Return which edges to keep so that so many are left and the polygon grows least, an index into the angles."""
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    kept = list(range(len(angles)))

    def added(place: int) -> float:
        """Return the area that goes to the polygon without this edge."""
        before, this, after = kept[place - 1], kept[place], kept[(place + 1) % len(kept)]
        if _angle_between(angles[before], angles[after]) >= 0.75 * math.pi:
            return math.inf
        tip = _meeting(normals[before], supports[before], normals[after], supports[after])
        first = _meeting(normals[before], supports[before], normals[this], supports[this])
        last = _meeting(normals[this], supports[this], normals[after], supports[after])
        return abs(float(_turn(first, last, tip))) / 2.0

    costs = [added(place) for place in range(len(kept))]
    while len(kept) > max(corners, 4):
        place = int(np.argmin(costs))
        if not math.isfinite(costs[place]):
            break
        del kept[place], costs[place]
        for near in (place - 1, place % len(kept)):
            costs[near] = added(near % len(kept))
    return np.array(kept)


def trimmed(place: Array, corners: int) -> Array:
    """Return a convex polygon around points with at most so many corners, rounded outward to 1 mm."""
    reach = supports(place) + 1e-3
    kept = simplified(ANGLES, reach, corners)
    return np.round(from_supports(ANGLES[kept], reach[kept]), 3)


def supports(place: Array | float) -> Array:
    """Return how far points, or a circle about the origin by its radius, reach along each of `ANGLES` in m."""
    if isinstance(place, float):
        return np.full(len(ANGLES), place)
    found: Array = np.max(np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1) @ place.T, axis=1)
    return found


def _angle_between(first: float, second: float) -> float:
    return float((second - first) % (2.0 * math.pi))


def _meeting(first: Array, at: float, second: Array, other: float) -> Array:
    """Return the corner where two edges meet, each given by its normal and its distance from the origin."""
    cross = first[0] * second[1] - first[1] * second[0]
    found: Array = np.array([at * second[1] - other * first[1], first[0] * other - second[0] * at]) / cross
    return found
