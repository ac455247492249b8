"""The summary page and the files beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from hrsafety import pages
from hrsafety._atomic import write_file
from hrsafety.pages import Picture
from hrsafety.reproduce import records
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.parts import PARTS, Made
from hrsafety.reproduce.sections import section_of, shown_parts
from hrsafety.reproduce.views import by_table, counted, view

__all__ = ["ReproductionReport", "write"]

LIBRARIES = ("hrsafety", "numpy", "matplotlib")
# Parts whose cells stand first and last in the files of values.
FIRST, LAST = "impact", "reactive"


@dataclass(kw_only=True, slots=True)
class ReproductionReport:
    """Content of the page.

    Attributes
    ----------
    command : str
        Command line that makes the same page.
    made : dict of str to Made
        What was made, by name of the part.
    seconds : float
        How long simulations and pictures took, in s.
    """

    command: str
    made: dict[str, Made] = field(default_factory=dict)
    seconds: float = 0.0

    @property
    def cells(self) -> list[PrintedValue]:
        """Cells of all parts."""
        order = sorted(self.made, key=lambda name: (name == LAST) - (name == FIRST))
        return [cell for name in order for cell in self.made[name].cells]

    @property
    def pictures(self) -> list[Picture]:
        """Pictures of all parts."""
        return [picture for made in self.made.values() for picture in made.pictures]

    @property
    def files(self) -> Mapping[str, str]:
        """Text files beside the page, by name."""
        files = {}
        if self.cells:
            files = {"tables.csv": records.cells_csv(self.cells), "tables.json": records.cells_json(self.cells)}
        for made in self.made.values():
            files |= made.files
        return files


def write(report: ReproductionReport, folder: Path) -> Path:
    """Write values, pictures and, last, the page, each file whole or not at all; return the page."""
    if report.pictures:
        (folder / "figures").mkdir(exist_ok=True)
    for picture in report.pictures:
        write_file(folder / "figures" / f"{picture.name}.png", picture.png)
    for name, text in report.files.items():
        write_file(folder / name, text)
    return write_file(folder / "summary.html", html(report))


def html(report: ReproductionReport) -> str:
    """Return the page: style and pictures inside, nothing loaded from elsewhere."""
    parts = shown_parts(report.made, report.cells)
    own = [cell for name, made in report.made.items() if PARTS[name].counted for cell in made.cells]
    return pages.written(
        "reproduce/page.html",
        title="Published tables and figures, measured again",
        command=report.command,
        sections=[section_of(part, report.made, report.cells) for part in parts],
        counted={"tables": [view(*group) for group in by_table(own).items()], "total": counted(own)},
        study=report.made["stabilizing"].study if "stabilizing" in report.made else None,
        versions=pages.versions(*LIBRARIES),
        seconds=report.seconds,
        beside=_beside(report),
    )


def _beside(report: ReproductionReport) -> list[tuple[list[str], str]]:
    """Return what lies beside the page: names, and what they hold."""
    groups = [(["figures"], "pictures")] if report.pictures else []
    groups += [(["tables.csv", "tables.json"], "every value")] if report.cells else []
    return groups + [(list(made.files), "") for made in report.made.values() if made.files]
