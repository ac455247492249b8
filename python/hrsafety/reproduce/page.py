"""The summary page and the files beside it."""

from __future__ import annotations

import datetime
import importlib.metadata
import platform
from collections.abc import Iterator
from dataclasses import dataclass, field
from html import escape
from importlib import resources
from pathlib import Path

from hrsafety._atomic import write_file
from hrsafety.reproduce import evidence, gain_page, impact_page, laws_page, markup, placement, reactive_page, records
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.laws_study import LawsStudy
from hrsafety.reproduce.study import Study

__all__ = ["Report", "write"]


@dataclass(kw_only=True, slots=True)
class Report:
    """What goes on the page.

    Attributes
    ----------
    command : str
        Command line that makes the same page.
    parts : tuple of str
        Names of the parts that were made.
    cells : list of Cell
        Every printed value of the tables.
    pictures : list of Picture
        Pictures in their order.
    gain_pictures : list of Picture
        Pictures of the search for the best gains.
    study : Study or None
        Comparison of the stabilizing modes.
    study_pictures : list of Picture
        Pictures of that comparison.
    laws : LawsStudy or None
        Every law with the unpredictable person.
    laws_pictures : list of Picture
        Pictures of that part.
    impact_cells : list of Cell
        Every printed value and claim of the impact part.
    impact_pictures : list of Picture
        Pictures of that part.
    reactive_cells : list of Cell
        Every printed value and claim of the reactive part.
    reactive_pictures : list of Picture
        Pictures of that part.
    wheel_pictures : list of Picture
        Pictures of the wheels.
    camera_pictures : list of Picture
        Pictures of the camera.
    seconds : float
        How long simulations and pictures took, in s.
    """

    command: str
    parts: tuple[str, ...]
    cells: list[Cell] = field(default_factory=list)
    pictures: list[Picture] = field(default_factory=list)
    gain_pictures: list[Picture] = field(default_factory=list)
    study: Study | None = None
    study_pictures: list[Picture] = field(default_factory=list)
    laws: LawsStudy | None = None
    laws_pictures: list[Picture] = field(default_factory=list)
    impact_cells: list[Cell] = field(default_factory=list)
    impact_pictures: list[Picture] = field(default_factory=list)
    reactive_cells: list[Cell] = field(default_factory=list)
    reactive_pictures: list[Picture] = field(default_factory=list)
    wheel_pictures: list[Picture] = field(default_factory=list)
    camera_pictures: list[Picture] = field(default_factory=list)
    seconds: float = 0.0

    @property
    def all_cells(self) -> list[Cell]:
        """Cells of all parts."""
        return [*self.impact_cells, *self.cells, *self.reactive_cells]

    @property
    def all_pictures(self) -> list[Picture]:
        """Pictures of all parts."""
        return [
            *self.impact_pictures,
            *self.laws_pictures,
            *self.gain_pictures,
            *self.pictures,
            *self.reactive_pictures,
            *self.study_pictures,
            *self.wheel_pictures,
            *self.camera_pictures,
        ]


def write(report: Report, folder: Path) -> Path:
    """Write the page, the values and the pictures, each file whole or not at all."""
    if report.all_pictures:
        (folder / "figures").mkdir(exist_ok=True)
    for picture in report.all_pictures:
        write_file(folder / "figures" / f"{picture.name}.png", picture.png)
    if report.all_cells:
        write_file(folder / "tables.csv", records.cells_csv(report.all_cells))
        write_file(folder / "tables.json", records.cells_json(report.all_cells))
    if report.laws is not None:
        write_file(folder / "laws.csv", records.laws_csv(report.laws))
        write_file(folder / "laws.json", records.laws_json(report.laws))
    if report.study is not None:
        write_file(folder / "stabilizing.csv", records.study_csv(report.study))
        write_file(folder / "stabilizing.json", records.study_json(report.study))
    return write_file(folder / "summary.html", html(report))


def html(report: Report) -> str:
    """Return the page: style and pictures inside, nothing loaded from elsewhere."""
    style = resources.files("hrsafety.reproduce").joinpath("page.css").read_text(encoding="utf-8")
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            "<title>Published tables and figures, measured again</title>",
            f"<style>{style}</style></head><body><main>",
            *_head(report),
            *_sections(report),
            *_foot(report),
            "</main></body></html>\n",
        ]
    )


WHEEL_TABLES = ("D.1", "Section D.2", "D.2", "Section D.3", "E.1", "Section E.2", "E.2", "Section E.3")
_PARTS = {
    "impact": "Impact",
    "tables-6": "Chapter 6",
    "tables-7": "Chapter 7",
    "table-5.1": "Table 5.1",
    "laws": "Compared laws",
    "tables-c": "Appendix C",
    "reactive": "Avoidance from sensors",
    "stabilizing": "Stabilizing force",
    "wheels": "Wheels",
    "camera": "Camera",
    "figures-6": "Pictures",
}


def _head(report: Report) -> Iterator[str]:
    yield "<h1>Published tables and figures, measured again</h1>"
    yield (
        "<p>Every printed value of the impact model, of the new virtual force field and of the laws that it is "
        "compared with, in L. Zeng, <cite>Design and "
        "control of human-friendly robots</cite> (PhD thesis, McMaster University, 2011), and of three papers about "
        "avoidance from sensors, beside the value measured here with the corrected equations. Nothing is tuned to the "
        "printed values; where a value differs, the reason stands beside it.</p>"
    )
    parts = [part for part in _PARTS if part in report.parts and (part != "figures-6" or _others(report))]
    links = " ".join(f'<a href="#{part}">{escape(_PARTS[part])}</a>' for part in parts)
    yield f'<nav>{links} <a href="#made">How it was made</a></nav>'
    if report.cells:
        yield markup.counts(report.cells)
    if report.study is not None:
        yield (
            '<p class="banner">Recommended mode of the stabilizing force, from all runs with noise or crowds: '
            f"<strong>{escape(report.study.recommended)}</strong>{_with_other_sides(report.study)} "
            '(<a href="#stabilizing">evidence</a>).</p>'
        )


def _with_other_sides(study: Study) -> str:
    """Return what is recommended under the other rules for the side of a detour."""
    default = study.rankings[0]
    others = [ranking for ranking in study.rankings if ranking.gains == default.gains and ranking is not default]
    return "".join(f"; with the side {escape(other.side)}: {escape(other.recommended)}" for other in others)


def _sections(report: Report) -> Iterator[str]:
    if "impact" in report.parts:
        yield '<section id="impact"><h2>Impact: manipulator, foam, head</h2>'
        yield from impact_page.section(report.impact_cells, report.impact_pictures)
        yield "</section>"
    tables = markup.by_table(report.cells)
    for part, words, prefix in (
        ("tables-6", "Chapter 6: holonomic robot, configurations c1 to c4", "6."),
        ("tables-7", "Chapter 7: both robots, configurations n1 to n4", ("7.", "Section 7.")),
        ("table-5.1", "Table 5.1: a person who stops and turns", "5."),
    ):
        if part in report.parts:
            yield f'<section id="{part}"><h2>{escape(words)}</h2>'
            for table, cells in tables.items():
                if table.startswith(prefix):
                    yield from markup.table_with_pictures(table, cells, report.pictures)
            yield "</section>"
    if report.laws is not None:
        yield '<section id="laws"><h2>Compared laws: nine laws in the same situations</h2>'
        yield from laws_page.section(report.laws, report.cells, report.laws_pictures)
        yield "</section>"
    if "tables-c" in report.parts:
        yield '<section id="tables-c"><h2>Appendix C: the best gains, and one gain at a time changed</h2>'
        yield from gain_page.section(report.cells, [*report.gain_pictures, *report.pictures])
        yield "</section>"
    if "reactive" in report.parts:
        yield '<section id="reactive"><h2>Avoidance from sensors: sound, virtual impedance, ultrasonic skirt</h2>'
        yield from reactive_page.section(report.reactive_cells, report.reactive_pictures)
        yield "</section>"
    if report.study is not None:
        yield '<section id="stabilizing"><h2>Stabilizing force: off, capped, full</h2>'
        yield from evidence.section(report.study)
        yield from markup.figures(report.study_pictures)
        yield "</section>"
    if "wheels" in report.parts:
        yield '<section id="wheels"><h2>Appendices D and E: wheels</h2>'
        yield "<p>Tolerances: identified parameters 2 %; means and feed-forward half a unit of the last digit.</p>"
        for table in WHEEL_TABLES:
            yield markup.table_of_cells(table, tables[table])
        yield from markup.figures(report.wheel_pictures)
        yield "</section>"
    if "camera" in report.parts:
        yield '<section id="camera"><h2>Section D.4: the camera</h2>'
        yield markup.table_of_cells("Section D.4", tables["Section D.4"])
        yield from markup.figures(report.camera_pictures)
        yield "</section>"
    others = _others(report)
    if others:
        yield '<section id="figures-6"><h2>Pictures</h2>'
        yield from markup.figures(others)
        yield "</section>"


def _others(report: Report) -> list[Picture]:
    """Return the pictures whose tables are not on the page."""
    return placement.unplaced(report.pictures, list(markup.by_table(report.cells)))


def _foot(report: Report) -> Iterator[str]:
    made = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    versions = [f"Python {platform.python_version()}", *(f"{name} {_version(name)}" for name in _LIBRARIES)]
    yield '<section id="made"><h2>How this page was made</h2>'
    yield f"<p><code>{escape(report.command)}</code></p>"
    yield f"<p>{escape(', '.join(versions))}; {escape(platform.system())} {escape(platform.machine())}.</p>"
    yield f"<p>Made {made}; simulations and pictures took {report.seconds:.1f} s.</p>"
    beside = ["<code>figures</code> (pictures)"] if report.all_pictures else []
    beside += ["<code>tables.csv</code>, <code>tables.json</code> (every value)"] if report.all_cells else []
    beside += ["<code>laws.csv</code>, <code>laws.json</code>"] if report.laws is not None else []
    beside += ["<code>stabilizing.csv</code>, <code>stabilizing.json</code>"] if report.study is not None else []
    yield f"<p>Beside this page: {', '.join(beside)}.</p></section>"


_LIBRARIES = ("hrsafety", "numpy", "matplotlib")


def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "(not installed)"
