"""Cells as the page shows them: words for numbers, lines that share a name or a reason, counts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import field
from itertools import groupby
from typing import NamedTuple

from hrsafety._records import dataclass
from hrsafety.pages import DASH, Picture
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.names import TABLE_TITLES, beside, column_label, row_label

__all__ = ["Count", "Line", "Matrix", "TableView", "by_table", "counted", "matrix", "view"]

_UNITS_OF_RESULTS = frozenset({"s", "J", "m"})


class Count(NamedTuple):
    """How many values there are, how many of them are judged, and how many agree."""

    printed: int
    judged: int
    within: int


class Line(NamedTuple):
    """One cell as a line of a table; name and reason stand in the first of the lines that share them."""

    name: str
    name_span: int
    column: str
    values: tuple[tuple[str, bool], ...]
    within: bool | None
    reason: str
    reason_span: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Matrix:
    """Cells as rows by columns: measured above, printed and deviation below.

    Attributes
    ----------
    titles : list of str
        Columns, in HTML.
    rows : list of dict
        Name and entries of each row, or the cells that the source has in words.
    reasons : list of (str, int, str)
        Each reason with the number of its values and their columns.
    """

    titles: list[str]
    rows: list[dict[str, object]]
    reasons: list[tuple[str, int, str]]


@dataclass(frozen=True, kw_only=True, slots=True)
class TableView:
    """One published table.

    Attributes
    ----------
    key, name, title, anchor : str
        Number, how it is called, what it is about in HTML, where links lead.
    count : Count
        Of its cells.
    lines : list of Line
        Its cells one by one.
    matrix : Matrix or None
        The same as a matrix, for the tables of changes of a gain.
    pictures : list of Picture
        What stands below it.
    """

    key: str
    name: str
    title: str
    anchor: str
    count: Count
    lines: list[Line]
    matrix: Matrix | None = None
    pictures: list[Picture] = field(default_factory=list)

    @property
    def verdict(self) -> str:
        """How many values agree, in words."""
        return f"{self.count.within} of {self.count.judged} within tolerance" if self.count.judged else "inputs"

    @property
    def chapter(self) -> int:
        """Chapter of the source; 0 for appendices and papers."""
        digits = self.key.removeprefix("Section ").split(".")[0]
        return int(digits) if digits.isdigit() else 0


def by_table(cells: Iterable[PrintedValue]) -> dict[str, list[PrintedValue]]:
    """Return cells grouped by the table they belong to, in the order of first appearance."""
    groups: dict[str, list[PrintedValue]] = {}
    for cell in cells:
        groups.setdefault(cell.table, []).append(cell)
    return groups


def counted(cells: Sequence[PrintedValue]) -> Count:
    """Count cells."""
    judged = [cell for cell in cells if cell.within is not None]
    return Count(len(cells), len(judged), sum(bool(cell.within) for cell in judged))


def view(table: str, cells: Sequence[PrintedValue], pictures: Iterable[Picture] = ()) -> TableView:
    """Return one published table as the page shows it."""
    plain = table.startswith("Section") or _of_papers(table)
    return TableView(
        key=table,
        name=table if plain else f"Table {table}",
        title=TABLE_TITLES.get(table, ""),
        anchor=f"table-{table.replace(' ', '-')}",
        count=counted(cells),
        lines=_lines(cells),
        matrix=matrix(cells) if any(cell.row.endswith("%") for cell in cells) else None,
        pictures=beside(table, pictures),
    )


def _lines(cells: Sequence[PrintedValue]) -> list[Line]:
    lines = []
    for row, group in groupby(cells, key=lambda cell: cell.row):
        own = list(group)
        spans = [size for _, same in groupby(own, key=lambda cell: cell.reason) for size in _spans(len(list(same)))]
        for cell, name_span, reason_span in zip(own, _spans(len(own)), spans, strict=True):
            label = column_label(cell.column, cell.unit)
            lines.append(Line(row_label(row), name_span, label, _values(cell), cell.within, cell.reason, reason_span))
    return lines


def _spans(size: int) -> list[int]:
    """Return the heights of entries that are given once for several lines."""
    return [size, *[0] * (size - 1)]


def _values(cell: PrintedValue) -> tuple[tuple[str, bool], ...]:
    """Return printed and measured value, deviation and tolerance, each with whether it is words."""
    tolerance = DASH if cell.tolerance is None else f"±{_signed(cell.tolerance, cell, sign=False)}"
    return (
        (_printed(cell), isinstance(cell.printed, str)),
        (_measured(cell), isinstance(cell.measured, str)),
        (_deviation(cell), False),
        (tolerance, False),
    )


def matrix(cells: Sequence[PrintedValue]) -> Matrix:
    """Return cells as rows by columns."""
    columns = list(dict.fromkeys((cell.column, cell.unit) for cell in cells if not cell.column.startswith("outcome")))
    rows: list[dict[str, object]] = []
    for row in dict.fromkeys(cell.row for cell in cells):
        own = {cell.column: cell for cell in cells if cell.row == row}
        words = [cell for cell in own.values() if cell.column.startswith("outcome")]
        entries = [_entry(own.get(column)) for column, _ in columns]
        rows.append({"name": row_label(row), "words": words, "entries": entries})
    return Matrix(titles=[column_label(*column) for column in columns], rows=rows, reasons=_reasons(cells))


def _entry(cell: PrintedValue | None) -> dict[str, object] | None:
    if cell is None:
        return None
    values = {"measured": _measured(cell), "printed": _printed(cell), "deviation": _deviation(cell)}
    return {"within": cell.within, **values}


def _reasons(cells: Sequence[PrintedValue]) -> list[tuple[str, int, str]]:
    """Return the reasons, each with the cells that it is given for."""
    groups: dict[str, list[PrintedValue]] = {}
    for cell in cells:
        if cell.reason:
            groups.setdefault(cell.reason.split(" The printed T, L and d give")[0], []).append(cell)
    return [
        (reason, len(group), "; ".join(dict.fromkeys(column_label(cell.column) for cell in group)))
        for reason, group in groups.items()
    ]


def _of_papers(table: str) -> bool:
    """Return whether a table is of a paper: its name begins with the key of the paper."""
    return table[0].islower()


def _of_many_sizes(cell: PrintedValue) -> bool:
    """Return whether a cell is of the impact part or of a paper, whose quantities differ in size by decades."""
    return cell.table[0] in "34AS" or _of_papers(cell.table)


def _digits(cell: PrintedValue) -> int:
    if cell.table.startswith("C.") and cell.unit == "1":
        return 4
    return 2 if cell.unit in {"s", "J", "%"} else 3


def _printed(cell: PrintedValue) -> str:
    if isinstance(cell.printed, str):
        return cell.printed
    whole = cell.unit in _UNITS_OF_RESULTS and cell.printed.is_integer()
    return f"{cell.printed:.1f}" if whole else f"{cell.printed:g}"


def _measured(cell: PrintedValue) -> str:
    if cell.measured is None:
        return DASH
    if isinstance(cell.measured, str):
        return cell.measured
    return f"{cell.measured:.4g}" if _of_many_sizes(cell) else f"{cell.measured:.{_digits(cell)}f}"


def _deviation(cell: PrintedValue) -> str:
    return DASH if cell.deviation is None else _signed(cell.deviation, cell)


def _signed(value: float, cell: PrintedValue, *, sign: bool = True) -> str:
    plus = "+" if sign else ""
    if cell.relative:
        return f"{100.0 * value:{plus}.1f} %" if sign else f"{100.0 * value:g} %"
    return f"{value:{plus}.2g}" if _of_many_sizes(cell) else f"{value:{plus}.3f}"
