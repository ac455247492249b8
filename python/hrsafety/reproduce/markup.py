"""Fragments of the summary page: tables of cells, figures, the comparison of modes."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from itertools import groupby

from hrsafety.reproduce import placement
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.names import TABLE_TITLES, column_label, row_label

__all__ = [
    "anchor",
    "by_table",
    "column_label",
    "count_table",
    "counts",
    "figure",
    "figures",
    "head",
    "scroll",
    "table_of_cells",
    "table_with_pictures",
]

# Columns of words, aligned left.
_LEFT = frozenset(
    {
        "Table",
        "Row",
        "Quantity",
        "Reason",
        "Change",
        "Where",
        "Gains",
        "Mode",
        "Least d (m)",
        "Side of a detour",
        "Without rule 1",
        "Law",
        "Printed walk",
        "Standing disc",
        "Person",
    }
)
_UNITS_OF_RESULTS = frozenset({"s", "J", "m"})
# Class and words of a verdict; the mark says the same as the color.
_VERDICTS = {None: ("none", "&ndash;"), True: ("good", "&#10003; yes"), False: ("bad", "&#10007; no")}


def by_table(cells: Iterable[Cell]) -> dict[str, list[Cell]]:
    """Return cells grouped by the table they belong to."""
    groups: dict[str, list[Cell]] = {}
    for cell in cells:
        groups.setdefault(cell.table, []).append(cell)
    return groups


def counts(cells: Sequence[Cell]) -> str:
    """Return the table that counts agreements by published table."""
    return (
        f"<p><strong>{_agreement(cells)}</strong> {_WHY}</p><p>Tolerances: arrival time "
        "5 %, distance 6 %, energy 25 %, score H 0.03; a sensitivity must agree within the rounding of the printed "
        "scores that it comes from; outcomes in words must agree. Gains, experiments, what is not simulated, "
        "and the times, energies and scores of Ge &amp; Cui, on which no claim is made, are listed without a "
        "verdict.</p>" + _count_lines(cells)
    )


_WHY = (
    "A right evaluation differs from its source where the source prints an equation with an error, simulates with "
    "positions measured in an experiment, rounds, exchanges columns, or leaves out what a value depends on: motor "
    "resistance, time step, start of a person. Then the corrected equations are kept and the reason stands beside the "
    "value; <code>tests</code> compare the package itself with independent implementations, not with these tables."
)


def count_table(cells: Sequence[Cell]) -> str:
    """Return how many values agree, by published table, without the tolerances."""
    return f"<p><strong>{_agreement(cells)}</strong></p>" + _count_lines(cells)


def _agreement(cells: Sequence[Cell]) -> str:
    judged = [cell for cell in cells if cell.within is not None]
    within = sum(bool(cell.within) for cell in judged)
    return f"{within} of {len(judged)} judged values are within tolerance."


def _count_lines(cells: Sequence[Cell]) -> str:
    rows = [_count_row(_link(table), group) for table, group in by_table(cells).items()]
    header = head(["Table", "Printed", "Judged", "Within", "Listed only"])
    return scroll(f'<table class="counts">{header}<tbody>{"".join(rows)}{_count_row("All", cells)}</tbody></table>')


def anchor(table: str) -> str:
    """Return the name that a link to a table leads to."""
    return f"table-{table.replace(' ', '-')}"


def _link(table: str) -> str:
    return f'<a href="#{anchor(table)}">{table}</a> {TABLE_TITLES.get(table, "")}'.rstrip()


def _count_row(name: str, cells: Sequence[Cell]) -> str:
    judged = [cell for cell in cells if cell.within is not None]
    numbers = (len(cells), len(judged), sum(bool(cell.within) for cell in judged), len(cells) - len(judged))
    return f'<tr><th scope="row">{name}</th>' + "".join(f"<td>{number}</td>" for number in numbers) + "</tr>"


def table_of_cells(table: str, cells: Sequence[Cell]) -> str:
    """Return one published table: printed, measured, deviation, verdict and reason."""
    judged = [cell for cell in cells if cell.within is not None]
    within = sum(bool(cell.within) for cell in judged)
    verdict = f"{within} of {len(judged)} within tolerance" if judged else "inputs"
    name = table if table.startswith("Section") or _of_papers(table) else f"Table {table}"
    title = f": {TABLE_TITLES[table]}" if table in TABLE_TITLES else ""
    heading = f'<h3 id="{anchor(table)}">{name}{title} ({verdict})</h3>'
    if not any(cell.row.endswith("%") for cell in cells):
        return heading + _list(cells)
    folded = f"<details><summary>All {len(cells)} values one by one</summary>{_list(cells)}</details>"
    return heading + _matrix(cells) + _reasons(cells) + folded


def table_with_pictures(table: str, cells: Sequence[Cell], pictures: Sequence[Picture]) -> Iterator[str]:
    """Yield one published table and, below it, the pictures that belong to it."""
    yield table_of_cells(table, cells)
    yield from figures(placement.of_table(table, pictures))


def _list(cells: Sequence[Cell]) -> str:
    """Return cells line by line; a reason that several lines of a row share is given once."""
    header = head(["Row", "Quantity", "Printed", "Measured", "Deviation", "Tolerance", "Within", "Reason"])
    lines = []
    for row, group in groupby(cells, key=lambda cell: cell.row):
        own = list(group)
        names = [f'<th scope="rowgroup" rowspan="{len(own)}">{escape(row_label(row))}</th>', *[""] * (len(own) - 1)]
        for cell, name, reason in zip(own, names, _merged(own), strict=True):
            lines.append(f"<tr{' class=group' if name else ''}>{name}{_values(cell)}{reason}</tr>")
    return scroll(f"<table>{header}<tbody>{''.join(lines)}</tbody></table>")


def _merged(cells: Sequence[Cell]) -> list[str]:
    """Return the entries of the column of reasons, equal neighbors as one entry."""
    entries: list[str] = []
    for reason, group in groupby(cells, key=lambda cell: cell.reason):
        size = len(list(group))
        entries += [f'<td class="reason" rowspan="{size}">{escape(reason)}</td>', *[""] * (size - 1)]
    return entries


def _values(cell: Cell) -> str:
    """Return the entries of a line between its name and its reason."""
    look, verdict = _VERDICTS[cell.within]
    tolerance = "&ndash;" if cell.tolerance is None else f"&plusmn;{_signed(cell.tolerance, cell, sign=False)}"
    entries = "".join(
        f"<td{' class=words' if isinstance(value, str) else ''}>{text}</td>"
        for value, text in (
            (cell.printed, _printed(cell)),
            (cell.measured, _measured(cell)),
            (None, _deviation(cell)),
            (None, tolerance),
        )
    )
    return f'<td class="text">{column_label(cell.column, cell.unit)}</td>{entries}<td class="{look}">{verdict}</td>'


def _matrix(cells: Sequence[Cell]) -> str:
    """Return cells as rows by columns: measured above, printed and deviation below."""
    columns = list(dict.fromkeys((cell.column, cell.unit) for cell in cells if not cell.column.startswith("outcome")))
    lines = []
    for row in dict.fromkeys(cell.row for cell in cells):
        own = {cell.column: cell for cell in cells if cell.row == row}
        words = [cell for cell in own.values() if cell.column.startswith("outcome")]
        entries = [_words(words, len(columns))] if words else [_entry(own.get(column)) for column, _ in columns]
        lines.append(f'<tr><th scope="row">{escape(row_label(row))}</th>{"".join(entries)}</tr>')
    header = head(["Change", *(column_label(column, unit) for column, unit in columns)], escaped=True)
    key = "<p>Measured value; below it the printed one and the deviation. Green is within tolerance.</p>"
    return key + scroll(f'<table class="matrix">{header}<tbody>{"".join(lines)}</tbody></table>')


def _entry(cell: Cell | None) -> str:
    if cell is None:
        return '<td class="none">&ndash;</td>'
    look, _ = _VERDICTS[cell.within]
    return f'<td class="{look}">{_measured(cell)}<small>{_printed(cell)}</small><small>{_deviation(cell)}</small></td>'


def _words(cells: Sequence[Cell], width: int) -> str:
    """Return the row that the source has in words, over the full width."""
    parts = []
    for cell in cells:
        look = "good" if cell.within else "bad"
        parts.append(
            f'<span class="{look}">c{cell.column[-1]}: {escape(str(cell.measured))}</span> '
            f"<small>printed: {escape(str(cell.printed))}</small>"
        )
    return f'<td class="text" colspan="{width}">{"".join(parts)}</td>'


def _reasons(cells: Sequence[Cell]) -> str:
    """Return the reasons, each with the cells that it is given for."""
    groups: dict[str, list[Cell]] = {}
    for cell in cells:
        if cell.reason:
            groups.setdefault(cell.reason.split(" The printed T, L and d give")[0], []).append(cell)
    items = []
    for reason, group in groups.items():
        columns = dict.fromkeys(column_label(cell.column) for cell in group)
        items.append(f"<li>{escape(reason)} <small>({len(group)} values: {'; '.join(columns)})</small></li>")
    return f'<ul class="reasons">{"".join(items)}</ul>' if items else ""


def _of_papers(table: str) -> bool:
    """Return whether a table is of a paper: its name begins with the key of the paper."""
    return table[0].islower()


def _of_many_sizes(cell: Cell) -> bool:
    """Return whether a cell is of the impact part or of a paper, whose quantities differ in size by decades."""
    return cell.table[0] in "34AS" or _of_papers(cell.table)


def _digits(cell: Cell) -> int:
    if cell.table.startswith("C.") and cell.unit == "1":
        return 4
    return 2 if cell.unit in {"s", "J", "%"} else 3


def _printed(cell: Cell) -> str:
    if isinstance(cell.printed, str):
        return escape(cell.printed)
    whole = cell.unit in _UNITS_OF_RESULTS and cell.printed.is_integer()
    return f"{cell.printed:.1f}" if whole else f"{cell.printed:g}"


def _measured(cell: Cell) -> str:
    if cell.measured is None:
        return "&ndash;"
    if isinstance(cell.measured, str):
        return escape(cell.measured)
    return f"{cell.measured:.4g}" if _of_many_sizes(cell) else f"{cell.measured:.{_digits(cell)}f}"


def _deviation(cell: Cell) -> str:
    return "&ndash;" if cell.deviation is None else _signed(cell.deviation, cell)


def _signed(value: float, cell: Cell, *, sign: bool = True) -> str:
    plus = "+" if sign else ""
    if cell.relative:
        return f"{100.0 * value:{plus}.1f} %" if sign else f"{100.0 * value:g} %"
    return f"{value:{plus}.2g}" if _of_many_sizes(cell) else f"{value:{plus}.3f}"


def head(names: Sequence[str], *, escaped: bool = False) -> str:
    """Return the head of a table."""
    looks = (' class="text"' if name in _LEFT else "" for name in names)
    titles = (name if escaped else escape(name) for name in names)
    cells = "".join(f'<th scope="col"{look}>{title}</th>' for look, title in zip(looks, titles, strict=True))
    return f"<thead><tr>{cells}</tr></thead>"


def scroll(content: str) -> str:
    """Return wide content in a box that scrolls sideways on a small screen."""
    return f'<div class="scroll">{content}</div>'


def figures(pictures: Iterable[Picture], *beginnings: str) -> Iterator[str]:
    """Yield pictures with their captions, embedded."""
    for each in pictures:
        if each.name.startswith(beginnings or ""):
            yield figure(each.caption, each.png, name=each.name)


def figure(caption: str, png: bytes, *, name: str = "") -> str:
    """Return a picture with its caption, embedded."""
    data = base64.b64encode(png).decode("ascii")
    words = escape(caption)
    link = f' id="{escape(name)}"' if name else ""
    return (
        f'<figure{link}><img loading="lazy" alt="{words}" src="data:image/png;base64,{data}">'
        f"<figcaption>{words}</figcaption></figure>"
    )
