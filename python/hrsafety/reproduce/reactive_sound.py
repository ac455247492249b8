"""Cells and pictures of the sound part: Tables 1 and 2 of the source of 2019, its formulas, pictures."""

from __future__ import annotations

from collections.abc import Callable

from hrsafety.reproduce import reactive_sound_figures, reactive_sound_study, reactive_sound_tables
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture

__all__ = ["make"]


def make(say: Callable[[str], object]) -> tuple[list[Cell], list[Picture]]:
    """Make the part."""
    say("sound: 100 bursts from each place of Tables 1 and 2, at four levels of noise")
    measured = reactive_sound_study.measure()
    return reactive_sound_tables.cells(measured), reactive_sound_figures.make()
