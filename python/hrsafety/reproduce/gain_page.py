"""The part of the summary page about appendix C: best gains, sensitivities, trends."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrsafety.reproduce import markup
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.gain_deviations import deviations

__all__ = ["section"]

_INTRO = (
    "<p>The search of section C.2 is run with its own settings: four grids of 77,616 gain sets in configurations 1 to "
    "3, each drawn around the 500 best of the one before, and local searches from the 20 best; the force is held and "
    "motion steps are 0.01 s. Table C.1 shows what it finds beside the printed optimum. Tables C.2 to C.9 are the "
    "printed optimum with one gain changed at a time. What the text says about trends is judged claim by claim, "
    "with what is <strong>not</strong> reproduced; the tables themselves are folded below their summary.</p>"
)
_DEVIATIONS = (
    "<p>Deviation of measured from printed over all rows of Tables C.2 to C.9: 12 changes of each of 4 gains; "
    "configuration 3 has two distances.</p>"
)
_HEAD = ("Where", "Quantity", "Values", "Mean (%)", "Largest (%)", "Second largest (%)")
_SUMMARY = ("C.1", "Section C.2", "Section C.3")
_FOLDED = tuple(f"C.{number}" for number in range(2, 10))


def section(cells: Sequence[Cell], pictures: Sequence[Picture]) -> Iterator[str]:
    """Yield tables, claims and pictures of appendix C."""
    yield _INTRO
    tables = markup.by_table(cells)
    for table in _SUMMARY:
        yield from markup.table_with_pictures(table, tables[table], pictures)
    yield "<h3>All rows of Tables C.2 to C.9</h3>" + _DEVIATIONS
    lines = "".join(
        f'<tr><th scope="row">{row.configuration}</th><td class="text">{row.quantity}</td><td>{row.values}</td>'
        f"<td>{row.mean:+.1f}</td><td>{row.worst:.1f}</td><td>{row.second_worst:.1f}</td></tr>"
        for row in deviations(cells)
    )
    yield markup.scroll(f"<table>{markup.head(_HEAD)}<tbody>{lines}</tbody></table>")
    yield "<details><summary>Tables C.2 to C.9, every change of every gain</summary>"
    for table in _FOLDED:
        yield markup.table_of_cells(table, tables[table])
    yield "</details>"
