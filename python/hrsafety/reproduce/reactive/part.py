"""Cells and pictures of the reactive part: sound, follower, ultrasonic skirt."""

from __future__ import annotations

from collections.abc import Callable

from hrsafety.pages import Picture
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.reactive import follower_figures as reactive_follower_figures
from hrsafety.reproduce.reactive import follower_study as reactive_follower_study
from hrsafety.reproduce.reactive import follower_tables as reactive_follower_tables
from hrsafety.reproduce.reactive import skirt_figures as reactive_skirt_figures
from hrsafety.reproduce.reactive import skirt_study as reactive_skirt_study
from hrsafety.reproduce.reactive import skirt_tables as reactive_skirt_tables
from hrsafety.reproduce.reactive import sound_figures as reactive_sound_figures
from hrsafety.reproduce.reactive import sound_study as reactive_sound_study
from hrsafety.reproduce.reactive import sound_tables as reactive_sound_tables

__all__ = ["make"]


def make(say: Callable[[str], object]) -> tuple[list[PrintedValue], list[Picture]]:
    """Measure and draw what three papers print; call ``say`` with a line when a long step begins."""
    say("sound: 100 bursts from each place of Tables 1 and 2, at four levels of noise")
    cells = reactive_sound_tables.cells(reactive_sound_study.measure())
    pictures = reactive_sound_figures.make()
    follower = reactive_follower_study.run_study(say)
    cells += reactive_follower_tables.cells(follower)
    pictures += reactive_follower_figures.make(follower)
    say("skirt: 8 x 5 tests in 100 layouts under nine conditions")
    skirt = reactive_skirt_study.run_study()
    cells += [*reactive_skirt_tables.cells(), *reactive_skirt_tables.cells_of_tests(skirt)]
    say("skirt: number of sensors")
    return cells, pictures + reactive_skirt_figures.make(skirt)
