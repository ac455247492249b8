"""Well-known text: the rings of areas that people walk in."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

__all__ = ["polygon_text", "rings"]

Array = npt.NDArray[np.float64]

_TOKEN = re.compile(r"\s*(?:([A-Za-z]+)|([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)|([(),]))")
_KINDS = ("POLYGON", "MULTIPOLYGON", "GEOMETRYCOLLECTION")
DEEPEST = 20


def rings(text: str) -> list[Array]:
    """Return the rings of polygons, also in collections, without the first point again at the end.

    Raises
    ------
    ValueError
        If the text is no polygon or collection of polygons.
    """
    tokens: list[str] = []
    place = 0
    stripped = text.strip()
    while place < len(stripped):
        found = _TOKEN.match(stripped, place)
        if found is None:
            raise ValueError(f"{stripped[place : place + 20]!r} at letter {place}")
        tokens.append(found[0].strip())
        place = found.end()
    if not tokens or tokens[0].upper() not in _KINDS:
        raise ValueError(f"no polygon but {(tokens or ['nothing'])[0]}")
    found_rings: list[Array] = []
    depth = 0
    points: list[tuple[float, float]] = []
    numbers: list[float] = []
    for token in tokens:
        if token == "(":
            depth += 1
            if depth > DEEPEST:
                raise ValueError("brackets too deep")
        elif token == ",":
            _end_point(points, numbers)
        elif token == ")":
            _end_point(points, numbers)
            if points:
                found_rings.append(_ring(points))
                points = []
            depth -= 1
            if depth < 0:
                raise ValueError("a bracket that was not opened")
        elif token[0].isalpha():
            if token.upper() not in {*_KINDS, "Z", "M", "ZM", "EMPTY"}:
                raise ValueError(f"no polygon but {token[:20]}")
        else:
            numbers.append(float(token))
    if depth or points or numbers:
        raise ValueError("a bracket that is not closed")
    return found_rings


def _end_point(points: list[tuple[float, float]], numbers: list[float]) -> None:
    """Add the coordinates since the last comma as a point."""
    if not numbers:
        return
    if len(numbers) < 2 or not np.isfinite(numbers).all():
        raise ValueError("a point without x and y")
    points.append((numbers[0], numbers[1]))
    numbers.clear()


def _ring(points: list[tuple[float, float]]) -> Array:
    ring = points[:-1] if len(points) > 1 and points[0] == points[-1] else points
    if len(ring) < 3:
        raise ValueError("a ring of fewer than three points")
    return np.array(ring)


def polygon_text(outer: Array, holes: Sequence[Array] = ()) -> str:
    """Return a polygon as well-known text.

    Parameters
    ----------
    outer : ndarray, shape (n, 2)
        Ring in m.
    holes : sequence of ndarray
        Rings within it.
    """
    texts = []
    for ring in (outer, *holes):
        closed = [*ring.tolist(), ring[0].tolist()]
        texts.append("(" + ", ".join(f"{x!r} {y!r}" for x, y in closed) + ")")
    return f"POLYGON ({', '.join(texts)})"
