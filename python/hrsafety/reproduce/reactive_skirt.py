"""The ultrasonic skirt of Gussu and Lin (2017): sensors, tables and the avoidance test."""

from __future__ import annotations

from collections.abc import Callable

from hrsafety.reproduce import reactive_skirt_figures, reactive_skirt_tables
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.reactive_skirt_study import run_study

__all__ = ["make"]


def make(say: Callable[[str], object]) -> tuple[list[Cell], list[Picture]]:
    """Measure the section's numbers and Tables 1 to 4, and draw them."""
    say("skirt: 8 x 5 tests in 100 layouts under nine conditions")
    study = run_study()
    cells = [*reactive_skirt_tables.cells(), *reactive_skirt_tables.cells_of_tests(study)]
    say("skirt: number of sensors")
    return cells, reactive_skirt_figures.make(study)
