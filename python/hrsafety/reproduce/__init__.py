"""Published tables and figures made again: every printed value beside the measured one.

`run` simulates, compares, draws and writes one summary page that needs no network.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from pathlib import Path

from hrsafety._words import meant
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.sensing.calibration import scipy_least_squares
from hrsafety.reproduce import (
    built_figures,
    camera_figures,
    camera_tables,
    figures,
    gain_figures,
    gain_tables,
    impact_part,
    laws_claims,
    laws_demonstrations,
    laws_figures,
    laws_study,
    page,
    reactive_part,
    study,
    tables,
    trends,
    wheels_figures,
    wheels_tables,
)
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.published import published_tables

__all__ = ["PARTS", "Cell", "published_tables", "run"]

PARTS = (
    "tables-6",
    "tables-7",
    "table-5.1",
    "tables-c",
    "figures-6",
    "figures-7",
    "impact",
    "laws",
    "reactive",
    "stabilizing",
    "wheels",
    "camera",
)
"""What `run` can make, in the order in which it is made."""


def run(
    out: str | Path = "reproduction",
    only: str | Iterable[str] | None = None,
    progress: Callable[[str], object] | None = None,
) -> Path:
    """Make the published tables and figures again and write a page about them.

    Parameters
    ----------
    out : str or Path
        Folder to write into; made if needed. Files of an earlier run are replaced, others are
        left alone.
    only : str, iterable of str, or None
        Parts to make, among `PARTS`; ``None`` makes all.
    progress : callable or None
        Called with a line of text when a part begins.

    Returns
    -------
    Path
        The summary page, ``summary.html``. Beside it lie ``tables.csv`` and ``tables.json``
        with every value, ``laws.csv`` and ``laws.json`` with the laws and the unpredictable
        person, ``stabilizing.csv`` and ``stabilizing.json`` with the comparison of the
        stabilizing modes, and the pictures in ``figures``.

    Raises
    ------
    InvalidParameterError
        If a part is unknown, none is named, or ``out`` is an existing file.
    MissingExtraError
        If the part ``"camera"`` is to be made and SciPy is not installed.

    Examples
    --------
    >>> import tempfile
    >>> from hrsafety import reproduce
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     reproduce.run(folder, only="tables-6").name
    'summary.html'
    """
    parts = _parts(only)
    folder = Path(out)
    if folder.exists() and not folder.is_dir():
        raise InvalidParameterError("out", "be a folder or not exist", str(out))
    if "camera" in parts:
        scipy_least_squares()  # before minutes of work, not after them
    folder.mkdir(parents=True, exist_ok=True)
    say = progress if progress is not None else _silent
    begin = time.perf_counter()
    report = page.Report(command=_command(out, only), parts=parts)
    for part in parts:
        say(f"{part}: {_TITLES[part]}")
        if part == "impact":
            report.impact_cells.extend(impact_part.cells())
            report.impact_pictures.extend(impact_part.pictures())
        elif part == "figures-6":
            report.pictures.extend(figures.make())
        elif part == "figures-7":
            report.pictures.extend(built_figures.make())
        elif part == "laws":
            report.laws = laws_study.compare(say)
            report.cells.extend(laws_claims.cells(report.laws))
            report.laws_pictures.extend([*laws_demonstrations.make(report.laws), *laws_figures.make(report.laws)])
        elif part == "reactive":
            report.reactive_cells, report.reactive_pictures = reactive_part.make(say)
        elif part == "stabilizing":
            report.study = study.compare(say)
            report.study_pictures.extend(figures.of_study(report.study))
        else:
            report.cells.extend(_TABLES[part]())
        if part == "tables-c":
            report.gain_pictures.extend(gain_figures.make())
        if part == "wheels":
            report.wheel_pictures.extend(wheels_figures.make())
        if part == "camera":
            report.camera_pictures.extend(camera_figures.make())
    if {"tables-c", "figures-6"} <= set(parts):
        report.pictures.extend(trends.make(report.cells))
    report.seconds = time.perf_counter() - begin
    say("writing the page")
    return page.write(report, folder)


_TABLES: dict[str, Callable[[], list[Cell]]] = {
    "tables-6": tables.chapter_6,
    "tables-7": tables.chapter_7,
    "table-5.1": tables.unpredictable_human,
    "tables-c": gain_tables.appendix_c,
    "wheels": wheels_tables.cells,
    "camera": camera_tables.cells,
}
_TITLES = {
    "impact": "chapters 3 and 4, appendix A: tables, claims and pictures of impacts",
    "tables-6": "Tables 6.1 to 6.5",
    "tables-7": "Tables 7.1 to 7.4 and section 7.5.5",
    "table-5.1": "Table 5.1",
    "tables-c": "Tables C.1 to C.9 and the search for the best gains",
    "figures-6": "Figures 6.3 to 6.18",
    "figures-7": "Figures 7.3 to 7.14 and F.1 to F.4",
    "laws": "nine laws: sections 2.2.5 and 5.7, Figures 2.5, 2.6, 5.11, 5.12, 6.19, 6.20",
    "reactive": "sound-following robot and ultrasonic skirt: tables and experiments of three papers",
    "stabilizing": "stabilizing force off, capped and full",
    "wheels": "Tables D.1, D.2, E.1 and E.2: wheels identified and controlled",
    "camera": "section D.4: the camera recovered from points, errors of positions",
}


def _silent(_: str) -> None:
    """Say nothing."""


def _parts(only: str | Iterable[str] | None) -> tuple[str, ...]:
    """Return the parts to make, in the order of `PARTS`."""
    if only is None:
        return PARTS
    named = [only] if isinstance(only, str) else list(only)
    choice = f"be among {', '.join(PARTS)}"
    for name in named:
        if name not in PARTS:
            raise InvalidParameterError("only", choice, name, meant(name, PARTS))
    if not named:
        raise InvalidParameterError("only", choice, Shown("nothing"))
    return tuple(part for part in PARTS if part in named)


def _command(out: str | Path, only: str | Iterable[str] | None) -> str:
    """Return the command line that makes the same page."""
    named = () if only is None else (only,) if isinstance(only, str) else tuple(only)
    words = ["hrsafety", "reproduce", *(word for name in named for word in ("--only", name)), "--out", str(out)]
    return " ".join(f'"{word}"' if " " in word else word for word in words)
