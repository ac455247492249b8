"""The parts of the reproduction: each has a name, a title, cells and pictures, all made in one call."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Any

from hrsafety._records import dataclass
from hrsafety.pages import Picture
from hrsafety.reproduce import data, figures, records, study, tables
from hrsafety.reproduce.built import camera_figures, camera_tables, wheels_figures, wheels_tables
from hrsafety.reproduce.built import figures as built_figures
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain import figures as gain_figures
from hrsafety.reproduce.gain import tables as gain_tables
from hrsafety.reproduce.impact import part as impact_part
from hrsafety.reproduce.laws import claims as laws_claims
from hrsafety.reproduce.laws import demonstrations as laws_demonstrations
from hrsafety.reproduce.laws import figures as laws_figures
from hrsafety.reproduce.laws import study as laws_study
from hrsafety.reproduce.reactive import part as reactive_part

__all__ = ["PARTS", "Made", "ReproducedPart"]

Say = Callable[[str], object]


@dataclass(frozen=True, kw_only=True, slots=True)
class Made:
    """Result of a part.

    Attributes
    ----------
    cells : sequence of Cell
        Printed values beside measured ones.
    pictures : sequence of Picture
        Its pictures.
    study : object
        What its section shows besides.
    files : dict of str to str
        What lies beside the page, by file name.
    """

    cells: Sequence[PrintedValue] = ()
    pictures: Sequence[Picture] = ()
    study: Any = None
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, slots=True)
class ReproducedPart:
    """A part of the reproduction.

    Attributes
    ----------
    name : str
        As on the command line.
    make : callable
        Makes it; takes a function that is called with a line of text when a long step begins.
    progress, nav, heading, note : str
        What is said when it begins, on the link to its section, above the section and below its heading.
    template : str
        Template of the section.
    counted : bool
        Whether its cells count in the table at the top of the page.
    placed : bool
        Whether its pictures may stand beside tables; else all stand in its own section.
    tables : list of str
        Order of its tables; that of its cells if empty.
    """

    name: str
    make: Callable[[Say], Made]
    progress: str
    nav: str
    heading: str
    note: str = ""
    template: str = "tables.html"
    counted: bool = True
    placed: bool = True
    tables: list[str] = field(default_factory=list)


def _laws(say: Say) -> Made:
    found = laws_study.compare(say)
    return Made(
        cells=laws_claims.cells(found),
        pictures=[*laws_demonstrations.make(found), *laws_figures.make(found)],
        study=found,
        files={"laws.csv": records.laws_csv(found), "laws.json": records.laws_json(found)},
    )


def _stabilizing(say: Say) -> Made:
    found = study.compare(say)
    return Made(
        pictures=figures.of_study(found),
        study=found,
        files={"stabilizing.csv": records.study_csv(found), "stabilizing.json": records.study_json(found)},
    )


def _reactive(say: Say) -> Made:
    cells, pictures = reactive_part.make(say)
    return Made(cells=cells, pictures=pictures)


_MAKERS: Mapping[str, Callable[[Say], Made]] = {
    "tables-6": lambda _: Made(cells=tables.chapter_6()),
    "tables-7": lambda _: Made(cells=tables.chapter_7()),
    "table-5.1": lambda _: Made(cells=tables.unpredictable_human()),
    "tables-c": lambda _: Made(cells=gain_tables.appendix_c(), pictures=gain_figures.make()),
    "figures-6": lambda _: Made(pictures=figures.make()),
    "figures-7": lambda _: Made(pictures=built_figures.make()),
    "impact": lambda _: Made(cells=impact_part.cells(), pictures=impact_part.pictures()),
    "laws": _laws,
    "reactive": _reactive,
    "stabilizing": _stabilizing,
    "wheels": lambda _: Made(cells=wheels_tables.cells(), pictures=wheels_figures.make()),
    "camera": lambda _: Made(cells=camera_tables.cells(), pictures=camera_figures.make()),
}
PARTS: Mapping[str, ReproducedPart] = {
    name: ReproducedPart(name=name, make=_MAKERS[name], **words) for name, words in data.table("parts").items()
}
"""All parts by name, in the order in which they are made."""
