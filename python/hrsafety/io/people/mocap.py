"""Motion capture: THOR and THOR-Magni, a column for each coordinate of each marker."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.errors import Shown
from hrsafety.io.cells import Columns, TableColumn, read_columns, short
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows, assumed
from hrsafety.io.reader import Document, Reader
from hrsafety.plausibility import ResultWarning

__all__ = ["READERS"]

Array = npt.NDArray[np.float64]

_HELMET = re.compile(r"^(Helmet_\w+?)\s*-\s*(\d+)\s+([XYZ])$")
_CENTROID = re.compile(r"^(Helmet_\w+?)[ _]Centroid[ _]([XYZ])$")
MAGNI_RATE = 100.0


class _Table(NamedTuple):
    """Columns of a motion-capture file and the lines above them."""

    names: list[str]
    skip: int
    head: dict[str, list[str]]
    delimiter: str


def _is_thor(document: Document) -> bool:
    return document.first_lines[0].startswith("NO_OF_FRAMES")


def _is_magni(document: Document) -> bool:
    return document.first_lines[0].startswith("FILE_ID")


def _table(document: Document, delimiter: str) -> _Table:
    """Return the header: lines of keys and values, then the names of the columns, Frame first."""
    head: dict[str, list[str]] = {}
    for place, line in enumerate(document.first_lines[:100]):
        cells = [each.strip() for each in line.split(delimiter)]
        if cells[0] == "Frame" and "Time" in cells[:3]:
            return _Table(cells, place + 1, head, delimiter)
        head[cells[0]] = cells[1:]
    rule = "have a line of columns that begins with Frame and Time"
    raise document.error("ambiguous_columns", rule, Shown("none in the first 100 lines"))


def _values(document: Document, table: _Table, names: Sequence[str]) -> Columns:
    cells = []
    for name in names:
        if table.names.count(name) != 1:
            raise document.error(
                "ambiguous_columns", f"have one column {name}", Shown(str(table.names.count(name))), line=table.skip
            )
        cells.append(TableColumn(table.names.index(name), name))
    return read_columns(document, delimiter=table.delimiter, skip=table.skip, columns=len(table.names), numbers=cells)


def _read_thor(document: Document, _request: Request) -> Rows:
    table = _table(document, "\t")
    told = table.head.get("FREQUENCY", [""])[0]
    try:
        rate = float(told)
    except ValueError:
        rate = math.nan
    if not (math.isfinite(rate) and rate > 0.0):
        raise document.error("unreadable_number", "tell a positive FREQUENCY", short(told), key="FREQUENCY")
    markers: dict[str, list[int]] = {}
    for name in table.names:
        found = _HELMET.match(name)
        if found and found[3] == "X":
            markers.setdefault(found[1], []).append(int(found[2]))
    _check_people(document, table, list(markers))
    wanted = [f"{who} - {number} {axis}" for who, numbers in markers.items() for number in numbers for axis in "XYZ"]
    columns = _values(document, table, ["Frame", *wanted])
    places = columns.numbers[:, 1:].reshape(len(columns.lines), len(wanted) // 3, 3)
    lost = (places == 0.0).all(axis=2) | np.isnan(places).any(axis=2)
    chosen: dict[str, str] = {}
    ways: dict[str, Array] = {}
    begin = 0
    for who, numbers in markers.items():
        losses = lost[:, begin : begin + len(numbers)].sum(axis=0)
        best = min(range(len(numbers)), key=lambda place: (int(losses[place]), numbers[place]))
        chosen[who] = f"{who} - {numbers[best]}"
        way = places[:, begin + best, :2].copy()
        way[lost[:, begin + best]] = np.nan
        ways[who] = way
        begin += len(numbers)
    notes = []
    if any(len(numbers) > 1 for numbers in markers.values()):
        names = ", ".join(chosen.values())
        notes.append(assumed("markers", f"each person of {document.name} is the marker that is lost least: {names}"))
    return _rows("thor", columns, ways, rate, chosen, notes)


def _read_magni(document: Document, _request: Request) -> Rows:
    table = _table(document, ",")
    people = [found[1] for name in table.names if (found := _CENTROID.match(name)) and found[2] == "X"]
    _check_people(document, table, people)
    named = {found.groups(): name for name in table.names if (found := _CENTROID.match(name))}
    for who in people:
        if (who, "Y") not in named:
            raise document.error("ambiguous_columns", f"have a centroid Y of {who}", Shown("none"), line=table.skip)
    wanted = [named[who, axis] for who in people for axis in "XY"]
    columns = _values(document, table, ["Frame", "Time", *wanted])
    frame, time = columns.numbers[:, 0], columns.numbers[:, 1]
    notes: list[ResultWarning] = []
    if len(frame) and np.isfinite(frame).all():
        first = np.unique(frame, return_index=True)[1]
        repeated = len(frame) - len(first)
        _check_repeated(document, columns)
        if repeated:
            message = f"{repeated} frames of {document.name} are there twice and counted once"
            notes.append(ResultWarning("repeated_rows", "frame", message, safe_side=True))
            columns = Columns(columns.numbers[first], columns.ids, columns.words, columns.lines[first], columns.decimal)
            frame, time = frame[first], time[first]
    ways = {who: columns.numbers[:, 2 + 2 * place : 4 + 2 * place] for place, who in enumerate(people)}
    rows = _rows("thor-magni", columns, ways, _rate(frame, time), None, notes)
    if notes:
        return replace(rows, details={"repeated_rows": repeated})
    return rows


def _check_repeated(document: Document, columns: Columns) -> None:
    """Refuse a frame that is there twice with different positions."""
    order = np.argsort(columns.numbers[:, 0], kind="stable")
    values = columns.numbers[order]
    same = values[1:, 0] == values[:-1, 0]
    differ = ((values[1:, 2:] != values[:-1, 2:]) & ~(np.isnan(values[1:, 2:]) & np.isnan(values[:-1, 2:]))).any(axis=1)
    bad = np.flatnonzero(same & differ)
    if len(bad):
        row = int(order[bad[0] + 1])
        rule = "have one position of a person at one instant"
        found = Shown(f"two in frame {columns.numbers[row, 0]:g}")
        raise document.error("two_positions_at_one_instant", rule, found, line=int(columns.lines[row]))


def _rate(frame: Array, time: Array) -> float:
    """Return the frames per second by the columns Frame and Time."""
    steps, spans = np.diff(frame), np.diff(time)
    some = (steps > 0) & (spans > 0)
    if not some.any():
        return MAGNI_RATE
    rate = float(np.median(steps[some] / spans[some]))
    return float(round(rate)) if round(rate) > 0 and abs(round(rate) / rate - 1.0) < 0.002 else rate


def _check_people(document: Document, table: _Table, people: list[str]) -> None:
    if not people:
        raise document.error("no_rows", "have columns of Helmet_*, who are the people", Shown("none"), line=table.skip)


def _rows(
    form: str,
    columns: Columns,
    ways: dict[str, Array],
    rate: float,
    markers: dict[str, str] | None,
    notes: list[ResultWarning],
) -> Rows:
    count, people = len(columns.lines), len(ways)
    details = {} if markers is None else {"markers": markers}
    return Rows(
        clock=np.repeat(columns.numbers[:, 0], people),
        person=np.tile(np.array(list(ways), dtype=np.str_), count),
        position=np.stack(list(ways.values()), axis=1).reshape(-1, 2),
        lines=np.repeat(columns.lines, people),
        frames=True,
        rate=rate,
        unit="mm",
        format=form,
        notes=tuple(notes),
        details=details,
    )


READERS = [
    Reader(name="thor", title="THOR .tsv: markers of helmets", recognizes=_is_thor, read=_read_thor),
    Reader(name="thor-magni", title="THOR-Magni: centroids of helmets", recognizes=_is_magni, read=_read_magni),
]
