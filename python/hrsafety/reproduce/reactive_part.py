"""Cells and pictures of the reactive part: sound, follower, ultrasonic skirt."""

from __future__ import annotations

from collections.abc import Callable

from hrsafety.reproduce import reactive_follower, reactive_skirt, reactive_sound
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture

__all__ = ["make"]


def make(say: Callable[[str], object]) -> tuple[list[Cell], list[Picture]]:
    """Make the part, in the order of the page."""
    cells: list[Cell] = []
    pictures: list[Picture] = []
    for each in (reactive_sound.make, reactive_follower.make, reactive_skirt.make):
        own_cells, own_pictures = each(say)
        cells.extend(own_cells)
        pictures.extend(own_pictures)
    return cells, pictures
