"""Cells and pictures of the impact part, in the order of the page."""

from __future__ import annotations

from hrsafety.pages import Picture
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

__all__ = ["cells", "pictures"]


def cells() -> list[Cell]:
    """Return every cell of chapters 3 and 4 and appendix A."""
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
    """Return every picture of the part."""
    return impact_figures.make()
