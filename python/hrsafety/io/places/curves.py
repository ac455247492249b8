"""Chords of arcs and curves, each at most 5 mm away from it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from hrsafety._arguments import Pair

__all__ = ["arc_points", "bezier_points", "bulge_points"]

DEVIATION = 0.005
"""Farthest that a curve is from its chord, in m."""
MOST_CHORDS = 100_000
"""Chords of one curve: a circle of 10,000 km has as many."""
STRAIGHT = 1e-9
"""Arcs of a smaller bulge are lines."""


def arc_points(center: Pair, radius: float, start: float, sweep: float) -> Iterator[Pair]:
    """Yield the points of an arc from its angle ``start``, in m and rad; both ends are among them.

    Raises
    ------
    OverflowError
        If it needs more than `MOST_CHORDS`.
    """
    widest = 2.0 * math.acos(1.0 - DEVIATION / radius) if radius > DEVIATION else math.pi
    count = _count(abs(sweep) / min(max(widest, 1e-9), 0.5 * math.pi) - 1e-9)
    for index in range(count + 1):
        angle = start + sweep * index / count
        yield center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)


def bulge_points(first: Pair, last: Pair, bulge: float) -> Iterator[Pair]:
    """Yield the points after ``first`` of an arc; its bulge is the tangent of a quarter of its angle."""
    (x, y), (u, v) = first, last
    chord = math.hypot(u - x, v - y)
    if abs(bulge) > STRAIGHT and chord:
        away = (1.0 - bulge * bulge) / (4.0 * bulge)
        center = 0.5 * (x + u) - away * (v - y), 0.5 * (y + v) + away * (u - x)
        radius = chord * (1.0 + bulge * bulge) / (4.0 * abs(bulge))
        start = math.atan2(y - center[1], x - center[0])
        yield from list(arc_points(center, radius, start, 4.0 * math.atan(bulge)))[1:-1]
    yield last


def bezier_points(points: list[Pair]) -> Iterator[Pair]:
    """Yield the points after the first of a Bezier curve of two to four control points, in m.

    Raises
    ------
    OverflowError
        If it needs more than `MOST_CHORDS`.
    """
    order = len(points) - 1
    bends = [
        math.hypot(a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1])
        for a, b, c in zip(points, points[1:], points[2:], strict=False)
    ]
    # Largest second derivative over eight times the deviation is the square of the number of pieces.
    square = order * (order - 1) * max(bends, default=0.0) / (8.0 * DEVIATION)
    count = _count(math.sqrt(square))
    for index in range(1, count + 1):
        share = index / count
        weights = [math.comb(order, k) * share**k * (1.0 - share) ** (order - k) for k in range(order + 1)]
        yield (
            sum(weight * x for weight, (x, _) in zip(weights, points, strict=True)),
            sum(weight * y for weight, (_, y) in zip(weights, points, strict=True)),
        )


def _count(least: float) -> int:
    """Return a whole number of chords, at least one."""
    if not least <= MOST_CHORDS:
        raise OverflowError(f"more than {MOST_CHORDS} chords in one curve")
    return max(math.ceil(least), 1)
