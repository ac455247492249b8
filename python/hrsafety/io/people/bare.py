"""Bare columns of numbers: ETH, ATC, TrajNet, HERMES and others whose columns are found by what they hold."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import FileError, Shown
from hrsafety.io.cells import TableColumn, read_columns
from hrsafety.io.headers import cells_of, delimiter_of, first_row, header_of, is_number
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows, assumed
from hrsafety.io.people.tables import ROLES, rows_of
from hrsafety.io.reader import Document, Reader
from hrsafety.plausibility import ResultWarning

__all__ = ["READERS"]

Array = npt.NDArray[np.float64]

UNIX_TIME = 1e9
"""Seconds since 1970 are more."""
ONE_STEP = 0.9
"""Frames of a person grow by one step in such a share of rows at least."""
SHORTER = 5.0
"""Ways between rows of a person are so many times shorter than between rows of another order of the columns."""


def _first_numbers(document: Document) -> list[float]:
    """Return the cells of the first row if all are numbers or unknown."""
    _, line = first_row(document)
    cells = cells_of(line, delimiter_of(line))
    if not cells or not all(is_number(each) or each == "?" for each in cells):
        return []
    return [math.nan if each == "?" else float(each.replace(",", ".")) for each in cells]


def _is_atc(document: Document) -> bool:
    cells = _first_numbers(document)
    return len(cells) == 8 and cells[0] > UNIX_TIME


def _is_eth(document: Document) -> bool:
    cells = _first_numbers(document)
    return len(cells) == 8 and cells[3] == cells[6] == 0.0


def _is_bare(document: Document) -> bool:
    return len(_first_numbers(document)) in {4, 5} and header_of(document, ROLES) is None


def _numbers(
    document: Document, columns: int, wanted: list[int], ids: int
) -> tuple[Array, npt.NDArray[Any], npt.NDArray[np.int64]]:
    """Return numbers, ids and lines of a table without a header."""
    skip, line = first_row(document)
    table = read_columns(
        document,
        delimiter=delimiter_of(line),
        skip=max(skip, 0),
        columns=columns,
        numbers=[TableColumn(each, str(each + 1)) for each in wanted],
        ids=TableColumn(ids, str(ids + 1)),
    )
    return table.numbers, table.ids, table.lines


def _read_atc(document: Document, request: Request) -> Rows:
    values, ids, lines = _numbers(document, 8, [0, 2, 3, 5, 6], 1)
    velocity = values[:, 3:4] * np.stack([np.cos(values[:, 4]), np.sin(values[:, 4])], axis=1)
    if request.fps is not None or request.step_s is not None:
        raise document.error(
            "frame_rate_contradicts_file", "be read without fps and step_s", Shown("times in seconds"), "leave them out"
        )
    return Rows(
        clock=values[:, 0],
        person=ids,
        position=values[:, 1:3],
        velocity=velocity,
        lines=lines,
        frames=False,
        unit="mm",
        format="atc",
    )


def _read_eth(document: Document, _request: Request) -> Rows:
    values, ids, lines = _numbers(document, 8, [0, 2, 4, 5, 7], 1)
    return Rows(
        clock=values[:, 0],
        person=ids,
        position=values[:, 1:3],
        velocity=values[:, 3:5],
        lines=lines,
        frames=True,
        rate_from_velocity=True,
        unit="m",
        format="eth",
    )


def _read_trajnet(document: Document, _request: Request) -> Rows:
    cells = len(_first_numbers(document))
    if cells != 4:
        raise document.error("unequal_rows", "have 4 columns, frame id x y", cells)
    values, ids, lines = _numbers(document, 4, [0, 2, 3], 1)
    return _rows(values, ids, lines, "trajnet", "m")


def _rows(
    values: Array,
    ids: npt.NDArray[Any],
    lines: npt.NDArray[np.int64],
    form: str,
    unit: str,
    notes: tuple[ResultWarning, ...] = (),
) -> Rows:
    return Rows(
        clock=values[:, 0],
        person=ids,
        position=values[:, 1:3],
        lines=lines,
        frames=True,
        unit=unit,
        unit_fixed=False,
        format=form,
        notes=notes,
    )


def _read_bare(document: Document, request: Request) -> Rows:
    """Return the rows of columns a b x y, or a b x y z, of which one of the first two counts frames."""
    if request.columns is not None:
        form = " ".join(
            request.columns.replace(",", " ").split() if isinstance(request.columns, str) else request.columns
        )
        if form.lower() == "frame id x y":
            return _read_trajnet(document, request)
        return rows_of(document, request, form=form, guess=False)
    cells = len(_first_numbers(document))
    values, _, lines = _numbers(document, cells, [0, 1, 2, 3], 1)
    by = _frame_column(document, values)
    more = " z" if cells == 5 else ""
    if by == 0 and cells == 4:
        return _read_trajnet(document, request)
    form = ("frame id x y" if by == 0 else "id frame x y") + more
    values, ids, lines = _numbers(document, cells, [by, 2, 3], 1 - by)
    note = assumed("columns", f"{document.name} has no header: its columns were taken as {form} by what they hold")
    return _rows(values, ids, lines, form, "", (note,))


def _frame_column(document: Document, values: Array) -> int:
    """Return which of the first two columns counts frames, the other one names people.

    Raises
    ------
    FileError
        If it cannot be told.
    """
    ways = [_median_way(values[:, by], values[:, 1 - by], values[:, 2:4]) for by in (0, 1)]
    if all(way is None for way in ways):
        broken = (values[:, :2] != np.floor(values[:, :2])).any(axis=0)
        if broken.any():
            names = "time id" if broken[0] else "id time"
            remedy = f'name them, columns="{names} x y" if that column has times in s'
            found = Shown(f"numbers that are not whole in column {1 + int(np.argmax(broken))}")
            rule = "show which column counts frames and which names people"
            raise document.error("ambiguous_columns", rule, found, remedy)
        raise _ambiguous(document, "neither of the first two columns counts frames")
    for by, other in ((0, 1), (1, 0)):
        mine, its = ways[by], ways[other]
        if mine is not None and (its is None or SHORTER * mine <= its):
            return by
    raise _ambiguous(document, "either of the first two columns may count frames")


def _ambiguous(document: Document, why: str) -> FileError:
    remedy = 'name them, columns="frame id x y" or columns="id frame x y"'
    return document.error(
        "ambiguous_columns", "show which column counts frames and which names people", Shown(why), remedy
    )


def _median_way(frame: Array, who: Array, place: Array) -> float | None:
    """Return the median way between rows of a person one step apart; none if frames do not grow by one step."""
    order = np.lexsort((frame, who))
    frame, who, place = frame[order], who[order], place[order]
    same = who[1:] == who[:-1]
    steps = np.diff(frame)[same]
    whole = (frame == np.floor(frame)).all() and (who == np.floor(who)).all()
    if len(steps) == 0 or not np.isfinite(steps).all() or not whole:
        return None
    sizes, counts = np.unique(steps, return_counts=True)
    most = int(np.argmax(counts))
    if sizes[most] <= 0.0 or counts[most] < ONE_STEP * len(steps):
        return None
    ways = np.hypot(*np.diff(place, axis=0)[same][steps == sizes[most]].T)
    ways = ways[np.isfinite(ways)]
    return float(np.median(ways)) if len(ways) else None


READERS = [
    Reader(name="atc", title="ATC: time, id, x, y, z, speed, motion, facing", recognizes=_is_atc, read=_read_atc),
    Reader(name="eth", title="ETH, BIWI: frame id x z y vx vz vy", recognizes=_is_eth, read=_read_eth),
    Reader(name="trajnet", title="TrajNet: frame id x y", recognizes=lambda _: False, read=_read_trajnet),
    Reader(
        name="columns", title="four or five columns of numbers, named by columns=", recognizes=_is_bare, read=_read_bare
    ),
]
