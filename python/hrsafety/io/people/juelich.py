"""Text of PeTrack, PedPy and JuPedSim: comments with the frame rate, then rows id frame x y z."""

from __future__ import annotations

import math
import re

from hrsafety.errors import Shown
from hrsafety.io.cells import TableColumn, read_columns
from hrsafety.io.headers import LENGTHS, cells_of, delimiter_of, first_row, is_number
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader

__all__ = ["READERS"]

_RATE = re.compile(r"frame\s?rate\s*[:=]?\s*([-+0-9.,eE]+)", re.IGNORECASE)
_JUPEDSIM = re.compile(r"^#\s*ID\s+FR\s+X\s+Y", re.IGNORECASE)
_PETRACK = re.compile(r"^#\s*(?:\w+\s+)?\|?\s*(?:id|ped_?id|pers_?id)\b.*\b(?:frame|fr)\b.*\bx\b", re.IGNORECASE)
_UNITS = (
    (re.compile(r"\bx\s*(?:/|\[|\(|in\s)\s*(km|cm|mm|m)\b", re.IGNORECASE), 1),
    (re.compile(r"\bin\s+(centi|milli)?met(?:er|re)s?\b", re.IGNORECASE), 0),
    (re.compile(r"\bin\s+(cm|mm|m)\b", re.IGNORECASE), 1),
)


def _comments(document: Document) -> list[str]:
    """Return the comments before the first row."""
    number, _ = first_row(document)
    lines = document.first_lines
    return [line.strip() for line in (lines if number < 0 else lines[:number]) if line.strip()]


def _is_jupedsim(document: Document) -> bool:
    return any(_JUPEDSIM.match(line) for line in _comments(document))


def _is_petrack(document: Document) -> bool:
    comments = _comments(document)
    _, line = first_row(document)
    cells = cells_of(line, delimiter_of(line))
    numbers = not line or (len(cells) in {4, 5} and all(map(is_number, cells)))
    return numbers and any(_RATE.search(line) or _PETRACK.match(line) for line in comments)


def _rate(document: Document) -> float | None:
    for place, line in enumerate(document.first_lines):
        found = _RATE.search(line) if line.lstrip().startswith("#") else None
        if found is None:
            continue
        text = found[1]
        try:
            rate = float(text)
        except ValueError:
            rate = math.nan
        if not (math.isfinite(rate) and rate > 0.0):
            rule = "tell a positive number of frames per second"
            raise document.error("unreadable_number", rule, text[:40], line=place + 1)
        return rate
    return None


def _unit(comments: list[str]) -> str:
    for line in comments:
        for pattern, group in _UNITS:
            found = pattern.search(line)
            if found and group:
                return found[1].lower()
            if found:
                return {"centi": "cm", "milli": "mm"}.get((found[1] or "").lower(), "m")
    return ""


def _rows(document: Document, form: str, unit: str, columns: int | None) -> Rows:
    _, line = first_row(document)
    names = ("id", "frame", "x", "y")
    if not line:
        raise document.error("no_rows", "hold at least one row of a person", Shown("comments only"))
    by = delimiter_of(line)
    count = len(cells_of(line, by))
    if count < 4:
        raise document.error("unequal_rows", "have the columns id, frame, x, y", Shown(f"{count} columns"), line=1)
    table = read_columns(
        document,
        delimiter=by,
        columns=columns,
        numbers=[TableColumn(place, names[place]) for place in (1, 2, 3)],
        ids=TableColumn(0, "id"),
    )
    return Rows(
        clock=table.numbers[:, 0],
        person=table.ids,
        position=table.numbers[:, 1:],
        lines=table.lines,
        frames=True,
        rate=_rate(document),
        unit=unit,
        unit_fixed=unit in LENGTHS,
        format=form,
    )


def _read_petrack(document: Document, _request: Request) -> Rows:
    return _rows(document, "petrack", _unit(_comments(document)), None)


def _read_jupedsim(document: Document, _request: Request) -> Rows:
    return _rows(document, "jupedsim-text", "m", None)


READERS = [
    Reader(name="jupedsim-text", title="JuPedSim text: #ID FR X Y Z ...", recognizes=_is_jupedsim, read=_read_jupedsim),
    Reader(
        name="petrack", title="PeTrack, PedPy: # id frame x/cm y/cm z/cm", recognizes=_is_petrack, read=_read_petrack
    ),
]
