"""The part of the summary page about robots that avoid from sensors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrsafety.reproduce import markup, placement
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture

__all__ = ["section"]

_INTRO = (
    "<p>A robot that follows a sound and avoids obstacles by virtual impedance: Electronics 8(5):522 (2019, "
    "<code>avi2019</code>) and J. Kim, J. Lee, IJRA 6(2):99&ndash;111 (2017, <code>avi2017</code>). A robot with a "
    "skirt of ultrasonic sensors: T. W. Gussu, C.-Y. Lin, Journal of Sensors 2017:2849537 (<code>gussu2017</code>). "
    "Single printed runs are compared with shares of many random layouts and their 95 % intervals.</p>"
)


def section(cells: Sequence[Cell], pictures: Sequence[Picture]) -> Iterator[str]:
    """Yield the tables and pictures of the reactive part."""
    yield _INTRO
    yield markup.count_table(cells)
    groups = markup.by_table(cells)
    for table, own in groups.items():
        yield from markup.table_with_pictures(table, own, pictures)
    yield from markup.figures(placement.unplaced(pictures, list(groups)))
