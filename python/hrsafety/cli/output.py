"""Output of the commands: aligned tables, CSV, pictures."""

from __future__ import annotations

import argparse
import csv
import importlib.util
import io
import json
import math
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety._atomic import write_file
from hrsafety.cli.exit_codes import WARNED
from hrsafety.cli.progress import live
from hrsafety.cli.terminal import styled
from hrsafety.errors import InvalidParameterError, MissingExtraError, Shown
from hrsafety.pages import Picture, require_jinja
from hrsafety.pages.pdf import pdf_of, require_pdf
from hrsafety.pages.report import Report, Section
from hrsafety.plausibility import ResultWarning

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hrsafety._replay import PlayerPage

__all__ = [
    "animation",
    "check_json",
    "check_pdf",
    "check_targets",
    "decided",
    "decimal",
    "folder",
    "law_words",
    "leave_if_strict",
    "located",
    "mcap",
    "picture",
    "pictures",
    "planned_animation",
    "planned_folder",
    "player",
    "report_folder",
    "report_warnings",
    "require_matplotlib",
    "require_page",
    "say_written",
    "stepping_words",
    "target",
    "warnings_of",
    "with_options",
    "write_csv",
    "write_page",
    "write_report",
    "write_text",
]


def decimal(value: float, digits: int = 2) -> str:
    """Return a number with fixed digits, or a dash where there is none."""
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def with_options(law: nav.Law, options: argparse.Namespace) -> nav.Law:
    """Return the law with what the command line changes."""
    if options.law is not None:
        from hrsafety.scenarios.laws import law_named

        named = law_named("--law", options.law)
        law = law if type(law) is named else named()
    changes: dict[str, object] = {}
    if options.gains is not None:
        names = law.GAIN_NAMES
        if len(options.gains) != len(names):
            rule = f"be {len(names)} numbers: {', '.join(names)}"
            raise InvalidParameterError("--gains", rule, Shown(" ".join(f"{gain:g}" for gain in options.gains)))
        changes |= dict(zip(names, options.gains, strict=True))
    if options.stabilizing is not None:
        if not isinstance(law, nav.VirtualForceField):
            raise InvalidParameterError("--stabilizing", "come with the virtual force field", options.stabilizing)
        changes["stabilizing"] = options.stabilizing
        if options.stabilizing != "capped":
            changes |= {"stabilizing_force_cap": None, "stabilizing_momentum_cap": None}
    try:
        changed = law.replaced(**changes)
    except InvalidParameterError as error:
        option = "--stabilizing" if error.argument == "stabilizing" else f"--gains: {error.argument}"
        raise error.renamed(option) from None
    return safe(changed) if options.safe else changed


def safe(law: nav.Law) -> nav.Law:
    """Return the law with a shield and yielding around it, as ``--safe`` asks for."""
    return nav.laws.SafeNavigation(law, shield=nav.laws.Shield(), yielding=nav.laws.Yielding())


def law_words(law: nav.Law) -> str:
    """Return the law in one line."""
    if isinstance(law, nav.laws.SafeNavigation):
        return f"{law_words(law.law)}; with {law.parts_words}"
    if not isinstance(law, nav.VirtualForceField):
        numbers = (f"{name} {value:g}" for name, value in zip(law.GAIN_NAMES, law.gains, strict=True))
        from hrsafety.scenarios.laws import name_of

        return f"{name_of(law).replace('_', ' ')}, {', '.join(numbers)}"
    attraction, repulsion, detour, ratio = (f"{gain:g}" for gain in law.gains)
    return (
        f"virtual force field, K_1 {attraction} N/m, K_3 {repulsion} N/m, K_5 {detour} N/m^2, b {ratio} s, "
        f"stabilizing force {law.stabilizing}"
    )


def stepping_words(options: argparse.Namespace, control_period: float) -> str:
    """Return the time stepping in one line."""
    force = f"force held for {control_period:g} s" if options.hold else "force at every step"
    return f"{options.integrator}, step {options.step:g} s, {force}"


def report_warnings(found: Iterable[ResultWarning], strict: bool) -> None:
    """Print every different warning on stderr, in yellow on a terminal.

    Parameters
    ----------
    found : iterable of ResultWarning
        Warnings of all results, repeated ones too.
    strict : bool
        Whether warnings end the command with exit code 4. Call this after everything was written.

    Raises
    ------
    SystemExit
        If there are warnings and ``strict`` is true.
    """
    different = tuple(dict.fromkeys(found))
    for each in different:
        print(styled(f"hrsafety: {' '.join(str(each).split())}", "yellow", sys.stderr), file=sys.stderr)
    leave_if_strict(different, strict)


def warnings_of(*results: object) -> tuple[ResultWarning, ...]:
    """Return the warnings that scenarios and results carry, those without any passed over."""
    return tuple(found for result in results for found in getattr(result, "warnings", ()))


def leave_if_strict(found: Iterable[ResultWarning], strict: bool) -> None:
    """Leave with exit code 4 if there are warnings and ``strict`` is true.

    Raises
    ------
    SystemExit
        Then.
    """
    if strict and any(True for _ in found):
        print(f"hrsafety: warnings with --strict: exit code {WARNED}", file=sys.stderr)
        raise SystemExit(WARNED)


@contextmanager
def located(file: str) -> Iterator[None]:
    """Put the name of the file that a command was given before the key that an error names."""
    try:
        yield
    except InvalidParameterError as error:
        if error.argument == "path" or error.argument.startswith("--"):
            raise
        if error.argument == Path(file).name:
            raise error.renamed(file) from None
        # A reader knows the file, too: its name stands once.
        inside = error.argument
        for known in (file, Path(file).name):
            inside = inside.removeprefix(f"{known}: ").removeprefix(f"{known}, ")
        raise error.renamed(f"{file}: {inside}") from None


def planned_folder(path: str) -> Path:
    """Return a folder that exists or can be made, and leave it to `folder` to make it."""
    place = _named("--out", path)
    if _exists("--out", place) and not place.is_dir():
        raise InvalidParameterError("--out", "be a folder or not exist", path, "this is a file")
    _check_parents("--out", place)
    return place


def report_folder(given: str | None, default: str, command: str) -> str:
    """Return the folder of a report that is handed over: without ``--out`` never that of another file.

    Parameters
    ----------
    given : str or None
        Value of ``--out``.
    default : str
        Folder without it.
    command : str
        How the report is made, as ``audit.command`` of its JSON has it.
    """
    held = Path(default) / "report.json"
    if given is not None or not held.exists():
        return default if given is None else given
    before = _command_of(held)
    if before != command:
        rule = f"be given where {default} holds another report"
        remedy = f"--out DIR writes beside it, --out {default} over it"
        raise InvalidParameterError("--out", rule, Shown(f"that of {before or 'another program'}"), remedy)
    return default


def _command_of(path: Path) -> str | None:
    """Return how a report was made, ``None`` of a file that is none."""
    try:
        return str(json.loads(path.read_text(encoding="utf-8"))["audit"]["command"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def folder(path: str) -> Path:
    """Return a folder that exists."""
    place = planned_folder(path)
    place.mkdir(parents=True, exist_ok=True)
    return place


def target(option: str, path: str, suffixes: Sequence[str] = ()) -> Path:
    """Return a file that can be written, checked before anything is computed.

    Parameters
    ----------
    option : str
        The option that names it.
    path : str
        As given.
    suffixes : sequence of str
        Endings of which it must have one; any if there are none.
    """
    place = _named(option, path)
    if suffixes and place.suffix.lower() not in suffixes:
        near = meant(place.suffix, suffixes)
        raise InvalidParameterError(option, f"end in {' or '.join(suffixes)}", path, near)
    if _exists(option, place) and place.is_dir():
        raise InvalidParameterError(option, "name a file", path, "this is a folder")
    _check_parents(option, place)
    return place


def _named(option: str, path: str) -> Path:
    if not path.strip():
        raise InvalidParameterError(option, "name a file or folder", path)
    return Path(path)


def _exists(option: str, place: Path) -> bool:
    try:
        return place.exists()
    except (OSError, ValueError) as error:
        raise InvalidParameterError(option, "be a path", Shown(f"{place} ({error})")) from None


def _check_parents(option: str, place: Path) -> None:
    """Refuse a path below a file, or below a folder where nothing may be written."""
    for parent in place.absolute().parents:
        if parent.is_dir():
            if not place.exists() and not os.access(parent, os.W_OK):
                raise InvalidParameterError(option, "lie where files may be written", str(place))
            return
        if parent.exists():
            raise InvalidParameterError(option, f"not lie below {parent}", str(place), "this is a file")


def check_targets(options: argparse.Namespace) -> None:
    """Refuse before a run the folder and files that could not be written after it."""
    if options.out is not None:
        planned_folder(options.out)
        require_page("--out")
    if getattr(options, "animate", None) is not None:
        planned_animation(options.animate)
    if getattr(options, "mcap", None) is not None:
        target("--mcap", options.mcap, (".mcap",))
        if importlib.util.find_spec("foxglove") is None:
            raise MissingExtraError("--mcap needs foxglove-sdk: pip install foxglove-sdk")
    check_json(options)
    check_pdf(options)


def check_pdf(options: argparse.Namespace) -> None:
    """Refuse before the work a PDF that nothing could print after it, or that has no folder."""
    if getattr(options, "pdf", False):
        if options.out is None:
            raise InvalidParameterError("--pdf", "come with --out", Shown("no --out"))
        require_pdf("--pdf")


def check_json(options: argparse.Namespace) -> None:
    """Refuse before the work a file of ``--json`` that could not be written after it."""
    if options.json is not None:
        target("--json", options.json)


def require_matplotlib(option: str) -> None:
    """Find out before the run that its pictures cannot be made."""
    if importlib.util.find_spec("matplotlib") is None:
        raise MissingExtraError(f"{option} makes pictures and needs matplotlib: pip install matplotlib")


def write_text(path: Path, text: str) -> Path:
    """Write a text file whole or not at all, with its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_file(path, text)


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    """Write a table; what is not a finite number is left empty."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    for row in rows:
        writer.writerow(["" if isinstance(cell, float) and not math.isfinite(cell) else cell for cell in row])
    return write_text(path, buffer.getvalue())


def pictures(place: Path, drawn: Iterable[tuple[str, Figure, str]]) -> list[Picture]:
    """Write pictures as PNG into a folder, and return them for a page.

    Parameters
    ----------
    place : Path
        The folder.
    drawn : iterable of (str, Figure, str)
        File name without ending, picture and caption.
    """
    found = []
    for name, figure, caption in drawn:
        found.append(Picture(name=name, caption=caption, png=picture(figure)))
        write_file(place / f"{name}.png", found[-1].png)
    return found


def write_report(
    report: Report,
    place: Path,
    drawn: Iterable[tuple[str, Figure, str]],
    files: Sequence[Path],
    name: str = "summary",
    plays: Iterable[PlayerPage] = (),
    options: argparse.Namespace | None = None,
) -> list[Path]:
    """Write the pictures of a report and its page, and return all files.

    Parameters
    ----------
    report : Report
        What was found.
    place : Path
        The folder.
    drawn : iterable of (str, Figure, str)
        Pictures that stand at the end of the page, see `pictures`.
    files : sequence of Path
        Files beside the page that are written already.
    name : str
        Name of the page without ending.
    plays : iterable of PlayerPage
        Players of runs, which stand before the pictures, and in files of their own.
    options : argparse.Namespace or None
        Of a command with ``--pdf``.
    """
    made, players = pictures(place, drawn), list(plays)
    names = ["player.html", *(f"player_{index}.html" for index in range(2, len(players) + 1))]
    written = [*files, *(place / f"{each.name}.png" for each in made)]
    written += [write_text(place / file, page) for file, page in zip(names, players, strict=False)]
    sections = [*report.sections, *([Section("Player", players)] if players else [])]
    sections += [Section("Pictures", made)] if made else []
    whole = replace(report, sections=sections, files=[*report.files, *(path.name for path in written)])
    return [*written, *write_page(place / f"{name}.html", whole.page(), options or argparse.Namespace())]


def write_page(place: Path, page: str, options: argparse.Namespace) -> list[Path]:
    """Write a page and, with ``--pdf``, its PDF beside it."""
    written = [write_text(place, page)]
    if getattr(options, "pdf", False):
        written.append(write_file(place.with_suffix(".pdf"), pdf_of(page)))
    return written


def say_written(paths: Sequence[Path], report: Report, options: argparse.Namespace) -> None:
    """Print which files were written, the report as JSON among them if ``--json`` asks for it."""
    if options.json is not None:
        paths = [*paths, write_text(Path(options.json), report.json())]
    if paths:
        print()
        print("\n".join(f"wrote {path}" for path in paths))


def picture(figure: Figure) -> bytes:
    """Return a picture as PNG, drawn once: `savefig` draws it twice, at first for its layout."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    buffer = io.BytesIO()
    canvas: Any = FigureCanvasAgg(figure)  # matplotlib types it in part
    canvas.print_png(buffer)
    return buffer.getvalue()


def require_page(option: str) -> None:
    """Find out before the run that its page and pictures cannot be made."""
    require_matplotlib(option)
    require_jinja(option)


def planned_animation(path: str) -> None:
    """Refuse before the run an animation that could not be written after it."""
    target("--animate", path, (".gif", ".mp4"))
    require_matplotlib("--animate")
    from hrsafety.plotting import movies

    movies.check_writer(Path(path))


def decided(run: nav.Trajectory) -> nav.Trajectory | nav.metrics.SafetyRecord:
    """Return a run with the decisions of a shield, where recording them gives the same run again; else as it is."""
    place = run.scenario
    of_world = isinstance(place, nav.World)
    if place is None or (of_world and len(place.robots) != 1) or not isinstance(run.law, nav.laws.SafeNavigation):
        return run
    body = place.robots[0].body if of_world else place.robot
    if not isinstance(body, nav.HolonomicRobot) or run.built is not None:
        return run
    record = nav.metrics.record_safety(place, run.law)
    return record if np.array_equal(record.trajectory.position, run.position) else run


def player(run: nav.Trajectory) -> PlayerPage:
    """Return the player of a run, with the decisions of a shield where there are any."""
    from hrsafety import plotting

    return plotting.player(decided(run))


def mcap(run: nav.Trajectory | nav.metrics.Judgement, options: argparse.Namespace) -> list[Path]:
    """Write a run as the MCAP file that ``--mcap`` asks for, with its folder."""
    if options.mcap is None:
        return []
    from hrsafety import plotting

    Path(options.mcap).parent.mkdir(parents=True, exist_ok=True)
    return [plotting.mcap(decided(run) if isinstance(run, nav.Trajectory) else run, options.mcap)]


def animation(trajectory: nav.Trajectory, path: str) -> Path:
    """Write an animation of a run, with its folder; a terminal sees how far it is."""
    from hrsafety import plotting

    Path(path).parent.mkdir(parents=True, exist_ok=True)
    with live() as shown:
        report = None if shown is None else lambda done, total: shown("frames", done, total, None)
        return plotting.animate(trajectory, path, progress=report)
