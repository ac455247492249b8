"""Cells and pictures of the impact part, in the order of the page."""

from __future__ import annotations

from hrsafety.reproduce import (
    impact_appendix,
    impact_claims,
    impact_experiments,
    impact_figures,
    impact_influences,
    impact_inputs,
    impact_maneuvers,
    impact_tables,
)
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture

__all__ = ["cells", "pictures"]


def cells() -> list[Cell]:
    """Return every cell of chapters 3 and 4 and appendix A.

    Returns
    -------
    list of Cell
        Tables 3.1 to 3.3, sections 3.6 to 3.9, Tables 4.1 and 4.2, sections 4.3 to 4.5, appendix A.
    """
    chapter_3 = sorted(
        [*impact_claims.cells(), *impact_influences.cells(), *impact_maneuvers.cells()], key=lambda cell: cell.table
    )
    return [
        *impact_inputs.cells(),
        *chapter_3,
        *impact_tables.cells(),
        *impact_experiments.cells(),
        *impact_appendix.cells(),
    ]


def pictures() -> list[Picture]:
    """Return every picture of the part.

    Returns
    -------
    list of Picture
        In the order of the source's figures.
    """
    return impact_figures.make()
