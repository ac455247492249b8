"""UCY: splines of people with control points in pixels from the center of the picture."""

from __future__ import annotations

import math
import re

import numpy as np

from hrsafety.errors import FileError, Shown
from hrsafety.io.cells import short
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader

__all__ = ["READERS"]

UCY_RATE = 25.0
_WORDS = "Num of control points"
_COUNT = re.compile(r"\s*(\d{1,9})\s*-")
MOST_POINTS = 10_000_000


def _is_ucy(document: Document) -> bool:
    return any(_WORDS.lower() in line.lower() for line in document.first_lines)


def _read_ucy(document: Document, _request: Request) -> Rows:
    lines = document.lines
    filled = [place for place, line in enumerate(lines) if line.strip()]
    splines = _count(document, filled[0] if filled else 0, "the number of splines")
    clock, person, position, where = [], [], [], []
    place = 1
    for who in range(splines):
        if place >= len(filled):
            raise document.error("unequal_rows", f"hold {splines} splines as its first line says", Shown(f"{who}"))
        points = _count(document, filled[place], f"the number of control points of spline {who}")
        rows = filled[place + 1 : place + 1 + points]
        if len(rows) < points:
            rule = f"hold {points} control points of spline {who}"
            raise document.error("unequal_rows", rule, Shown(f"{len(rows)}"), line=filled[place] + 1)
        for row in rows:
            x, y, frame = _numbers(document, row)
            clock.append(frame)
            position.append((x, y))
            where.append(row + 1)
        person += [who] * points
        place += 1 + points
    if place < len(filled):
        rule = f"end after {splines} splines as its first line says"
        raise document.error("unequal_rows", rule, short(lines[filled[place]].strip()), line=filled[place] + 1)
    return Rows(
        clock=np.array(clock, dtype=np.float64),
        person=np.array(person, dtype=np.int64),
        position=np.array(position, dtype=np.float64).reshape(-1, 2),
        lines=np.array(where, dtype=np.int64),
        frames=True,
        rate_of_format=UCY_RATE,
        unit="px",
        unit_fixed=False,
        format="ucy",
    )


def _count(document: Document, place: int, what: str) -> int:
    line = document.lines[place]
    found = _COUNT.match(line)
    if found is None or int(found[1]) > MOST_POINTS:
        raise document.error("unreadable_number", f"tell {what}, as in '12 - '", short(line.strip()), line=place + 1)
    return int(found[1])


def _numbers(document: Document, place: int) -> tuple[float, float, float]:
    line = document.lines[place]
    cells = line.split("-  (")[0].split(" - ")[0].split()
    try:
        x, y, frame, _ = (float(each) for each in cells)
    except ValueError:
        raise _bad(document, place) from None
    if "_" in line.split("(")[0] or not all(map(math.isfinite, (x, y, frame))):
        raise _bad(document, place)
    return x, y, frame


def _bad(document: Document, place: int) -> FileError:
    line = document.lines[place].strip()
    return document.error("unreadable_number", "be a control point, x y frame gaze", short(line), line=place + 1)


READERS = [Reader(name="ucy", title="UCY .vsp: splines in pixels", recognizes=_is_ucy, read=_read_ucy)]
