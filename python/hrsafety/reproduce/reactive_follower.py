"""The robot that follows a sound: experiments 1 to 3 of Avi (2019) over many layouts."""

from __future__ import annotations

from collections.abc import Callable

from hrsafety.reproduce import reactive_follower_figures, reactive_follower_tables
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.reactive_follower_study import run_study

__all__ = ["make"]


def make(say: Callable[[str], object]) -> tuple[list[Cell], list[Picture]]:
    """Run the experiments in 1,000 layouts each, and draw them."""
    study = run_study(say)
    return reactive_follower_tables.cells(study), reactive_follower_figures.make(study)
