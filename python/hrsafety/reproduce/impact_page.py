"""The part of the summary page about impacts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

from hrsafety.reproduce import markup, placement
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.impact_cases import parameter_sets
from hrsafety.reproduce.impact_tables import COLUMNS, Experiment, experiments

__all__ = ["section"]

_INTRO = (
    "<p>Chapters 3 and 4 and appendix A: a manipulator with a foam covering meets a head on a neck. Everything is "
    "computed from the exact linear response with the right coefficient q<sub>2</sub>; where the printed coefficient "
    "explains a printed percentage, its value stands in the reason. Simulated values count as agreeing within 2 % "
    "(acceleration), 4 % (impact period) and 3 % (compression), percentages of the text within one point, results of "
    "appendix A within 0.5 or 1 %. Claims in words are judged by what was measured.</p>"
)
_TABLES = (
    "<p>Runs are the printed experiments, three for each row. Set A: {}. Set B: {}. The deviation of set A is given "
    "from the printed simulation and from the mean of the runs. Each printed simulation is judged twice, with "
    "either set. The heads of Table 4.2 are exchanged in the source.</p>"
)
_TITLES = {"4.1": "direct-drive manipulator", "4.2": "Puma 560"}
_DIGITS = {"a_h_max": 3, "impact_period": 4, "compression_max": 5}


def section(cells: Sequence[Cell], pictures: Sequence[Picture]) -> Iterator[str]:
    """Yield the tables, claims and pictures of the impact part."""
    yield _INTRO
    yield markup.count_table(cells)
    groups = markup.by_table(cells)
    for table, own in groups.items():
        if table.startswith(("3.", "Section 3")):
            yield from markup.table_with_pictures(table, own, pictures)
    yield _TABLES.format(*(escape(choice.words) for choice in parameter_sets()))
    for table in _TITLES:
        yield from _experiments(table, groups[table])
        yield from markup.figures(placement.of_table(table, pictures))
    for table, own in groups.items():
        if table not in _TITLES and not table.startswith(("3.", "Section 3")):
            yield from markup.table_with_pictures(table, own, pictures)
    yield from markup.figures(placement.unplaced(pictures, list(groups)))


_HEAD = ("Row", "Quantity", "Runs", "Printed", "Set A", "Set B", "A from printed", "A from runs", "Reason")


def _experiments(table: str, cells: Sequence[Cell]) -> Iterator[str]:
    """Yield one published table with its runs, printed simulations and own values."""
    places = {(cell.row, cell.column): cell for cell in cells}
    lines = [line for row in experiments() if row.table == table for line in _lines(row, places)]
    judged = [cell for cell in cells if cell.within is not None]
    within = sum(bool(cell.within) for cell in judged)
    yield (
        f'<h3 id="{markup.anchor(table)}">Table {table}: {_TITLES[table]} '
        f"({within} of {len(judged)} within tolerance)</h3>"
    )
    yield markup.scroll(f'<table class="impacts">{markup.head(_HEAD)}<tbody>{"".join(lines)}</tbody></table>')


def _lines(row: Experiment, places: dict[tuple[str, str], Cell]) -> Iterator[str]:
    own = {
        column: [places[row.name, f"{name}, set {choice.name}"] for choice in parameter_sets()]
        for column, (name, _) in COLUMNS.items()
    }
    reasons = dict.fromkeys(cell.reason for pair in own.values() for cell in pair if cell.reason)
    size = len(COLUMNS)
    before = f'<th scope="rowgroup" rowspan="{size}">{escape(row.name)}</th>'
    after = f'<td class="reason" rowspan="{size}">{escape(" ".join(reasons))}</td>'
    for column, (name, unit) in COLUMNS.items():
        runs = " / ".join(f"{value:g}" for value in row.measured[column])
        values = "".join(_value(cell, _DIGITS[column]) for cell in own[column])
        from_printed = 100.0 * (row.simulated["A"][column] / row.printed[column] - 1.0)
        from_runs = 100.0 * (row.simulated["A"][column] / row.mean(column) - 1.0)
        yield (
            f"<tr{' class=group' if before else ''}>{before}"
            f'<td class="text">{markup.column_label(name, unit)}</td><td>{runs}</td><td>{row.printed[column]:g}</td>'
            f"{values}<td>{from_printed:+.1f} %</td><td>{from_runs:+.1f} %</td>{after}</tr>"
        )
        before = after = ""


def _value(cell: Cell, digits: int) -> str:
    shown = f"{cell.measured:.{digits}f}" if isinstance(cell.measured, float) else "&ndash;"
    return f'<td class="{"good" if cell.within else "bad"}">{shown}</td>'
