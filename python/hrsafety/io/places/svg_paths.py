"""Path data and transforms of SVG."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from hrsafety._arguments import Pair
from hrsafety._bounds import MOST_WALL_POINTS
from hrsafety.io.places.curves import arc_points, bezier_points

__all__ = ["AffineMap", "path_points", "transform_of"]

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PART = re.compile(rf"[\s,]*(?:([MmLlHhVvCcSsQqTtAaZz])|({_NUMBER}))")
_COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_FLAG = re.compile(r"[\s,]*([01])")
_FUNCTION = re.compile(r"[\s,]*(matrix|translate|scale|rotate|skewX|skewY)\s*\(([^()]*)\)")


class AffineMap(NamedTuple):
    """Affine map (x, y) to (a x + c y + e, b x + d y + f)."""

    a: float
    b: float
    c: float
    d: float
    e: float
    f: float

    def at(self, point: Pair) -> Pair:
        """Return where a point comes to lie."""
        x, y = point
        return self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f

    def after(self, other: AffineMap) -> AffineMap:
        """Return the map that does the other one first."""
        a, b = self.a * other.a + self.c * other.b, self.b * other.a + self.d * other.b
        c, d = self.a * other.c + self.c * other.d, self.b * other.c + self.d * other.d
        e, f = self.at((other.e, other.f))
        return AffineMap(a, b, c, d, e, f)

    @property
    def stretch(self) -> float:
        """Largest factor by which lengths grow."""
        total = self.a * self.a + self.b * self.b + self.c * self.c + self.d * self.d
        area = self.a * self.d - self.b * self.c
        return math.sqrt(0.5 * (total + math.sqrt(max(total * total - 4.0 * area * area, 0.0))))


def transform_of(words: str) -> AffineMap | None:
    """Return the map of a transform attribute, ``None`` if it is none."""
    found, at = AffineMap(1.0, 0.0, 0.0, 1.0, 0.0, 0.0), 0
    while match := _FUNCTION.match(words, at):
        at = match.end()
        numbers = [float(each) for each in re.findall(_NUMBER, match[2])]
        if re.sub(_NUMBER, "", match[2]).strip(" \t\r\n,") or not all(map(math.isfinite, numbers)):
            return None
        one = _function(match[1], numbers)
        if one is None:
            return None
        found = found.after(one)
    return None if words[at:].strip(" \t\r\n,") or not all(map(math.isfinite, found)) else found


def _function(name: str, given: list[float]) -> AffineMap | None:
    count = len(given)
    if name == "matrix" and count == 6:
        return AffineMap(*given)
    if name == "translate" and count in (1, 2):
        return AffineMap(1.0, 0.0, 0.0, 1.0, given[0], given[1] if count == 2 else 0.0)
    if name == "scale" and count in (1, 2):
        return AffineMap(given[0], 0.0, 0.0, given[-1], 0.0, 0.0)
    if name in ("skewX", "skewY") and count == 1:
        slope = math.tan(math.radians(given[0]))
        return AffineMap(1.0, slope if name == "skewY" else 0.0, slope if name == "skewX" else 0.0, 1.0, 0.0, 0.0)
    if name == "rotate" and count in (1, 3):
        cosine, sine = math.cos(math.radians(given[0])), math.sin(math.radians(given[0]))
        x, y = given[1:] if count == 3 else (0.0, 0.0)
        return AffineMap(cosine, sine, -sine, cosine, x - cosine * x + sine * y, y - sine * x - cosine * y)
    return None


def path_points(data: str, transform: AffineMap) -> Iterator[list[Pair]]:
    """Yield the polyline of each part of a path, transformed; a part that is closed ends with its first point.

    Raises
    ------
    ValueError
        If the data break the grammar of paths.
    OverflowError
        If it has too many points.
    """
    points: list[Pair] = []
    first: Pair = (0.0, 0.0)
    here: Pair = (0.0, 0.0)
    control: Pair = here
    last = ""
    for command, values in _commands(data):
        kind, relative = command.upper(), command.islower()
        if not last and kind != "M":
            raise ValueError(data[:20])
        if len(points) > MOST_WALL_POINTS:
            raise OverflowError(f"more than {MOST_WALL_POINTS} points in one path")
        base = here if relative else (0.0, 0.0)
        if kind == "M":
            if len(points) > 1:
                yield points
            here = first = (base[0] + values[0], base[1] + values[1])
            points = [transform.at(here)]
        elif kind == "Z":
            if len(points) > 1:
                yield [*points, points[0]] if points[-1] != points[0] else points
            here = first
            points = [transform.at(here)]
        elif kind == "A":
            end = (base[0] + values[5], base[1] + values[6])
            points += _arc(here, end, values, transform)
            here = end
        else:
            ends = _ends(kind, values, here, base)
            if kind in "ST":
                smooth = last in ("CS" if kind == "S" else "QT")
                ends.insert(0, (2.0 * here[0] - control[0], 2.0 * here[1] - control[1]) if smooth else here)
            points += bezier_points([transform.at(each) for each in (here, *ends)])
            here, control = ends[-1], ends[-2] if len(ends) > 1 else ends[-1]
        last = kind
    if len(points) > 1:
        yield points


def _ends(kind: str, values: list[float], here: Pair, base: Pair) -> list[Pair]:
    """Return the control points of a command and where it ends."""
    if kind == "H":
        return [(base[0] + values[0], here[1])]
    if kind == "V":
        return [(here[0], base[1] + values[0])]
    return [(base[0] + x, base[1] + y) for x, y in zip(values[::2], values[1::2], strict=True)]


def _commands(data: str) -> Iterator[tuple[str, list[float]]]:
    """Yield the commands of a path; one that is repeated may leave out its letter."""
    data = data.strip(" \t\r\n,")
    at, command = 0, ""
    while at < len(data):
        match = _PART.match(data, at)
        if match is None or (not match[1] and command in ("", "Z", "z")):
            raise ValueError(data[at : at + 20])
        if match[1]:
            at, command = match.end(), match[1]
        else:
            command = {"M": "L", "m": "l"}.get(command, command)
        values: list[float] = []
        while len(values) < _COUNTS[command.upper()]:
            flag = command in "Aa" and len(values) in (3, 4)
            match = (_FLAG if flag else _PART).match(data, at)
            number = match and (match[1] if flag else match[2])
            if match is None or not number or not abs(float(number)) < 1e15:
                raise ValueError(data[at : at + 20] or "the end of the data")
            values.append(float(number))
            at = match.end()
        yield command, values


def _arc(start: Pair, end: Pair, values: list[float], transform: AffineMap) -> Iterator[Pair]:
    """Yield the points after the first of an elliptic arc, appendix F.6 of SVG 1.1."""
    rx, ry, turn, large, sweep = abs(values[0]), abs(values[1]), math.radians(values[2]), values[3], values[4]
    if start == end:
        return
    if not (rx and ry):
        yield transform.at(end)
        return
    cosine, sine = math.cos(turn), math.sin(turn)
    half = (0.5 * (start[0] - end[0]), 0.5 * (start[1] - end[1]))
    x, y = (cosine * half[0] + sine * half[1]) / rx, (-sine * half[0] + cosine * half[1]) / ry
    square = x * x + y * y
    if square > 1.0:  # radii that are too short grow
        rx, ry, x, y = rx * math.sqrt(square), ry * math.sqrt(square), x / math.sqrt(square), y / math.sqrt(square)
        square = 1.0
    factor = math.sqrt(max(1.0 / square - 1.0, 0.0)) * (-1.0 if large == sweep else 1.0)
    center = (factor * y, -factor * x)
    begin = math.atan2(y - center[1], x - center[0])
    angle = (math.atan2(-y - center[1], -x - center[0]) - begin) % (2.0 * math.pi)
    angle -= 2.0 * math.pi if not sweep else 0.0
    unit = transform.after(
        AffineMap(
            cosine * rx,
            sine * rx,
            -sine * ry,
            cosine * ry,
            0.5 * (start[0] + end[0]),
            0.5 * (start[1] + end[1]),
        )
    )
    scale = min(unit.stretch, 1e12)
    round_points = list(arc_points((0.0, 0.0), scale, begin, angle))[1:-1] if scale else []
    for u, v in round_points:
        yield unit.at((center[0] + u / scale, center[1] + v / scale))
    yield transform.at(end)
