"""Cells and pictures of the impact part, in the order of the page."""

from __future__ import annotations

from hrsafety.pages import Picture
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact import appendix as impact_appendix
from hrsafety.reproduce.impact import claims as impact_claims
from hrsafety.reproduce.impact import experiments as impact_experiments
from hrsafety.reproduce.impact import figures as impact_figures
from hrsafety.reproduce.impact import influences as impact_influences
from hrsafety.reproduce.impact import inputs as impact_inputs
from hrsafety.reproduce.impact import maneuvers as impact_maneuvers
from hrsafety.reproduce.impact import tables as impact_tables

__all__ = ["cells", "pictures"]


def cells() -> list[PrintedValue]:
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
