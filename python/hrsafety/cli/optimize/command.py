"""``hrsafety optimize STUDY.toml``: search gains, print the best, write page and files."""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hrsafety import navigation as nav
from hrsafety._atomic import only_writer
from hrsafety.cli import exit_codes, output, progress, terminal
from hrsafety.cli.optimize import pictures as optimize_pictures
from hrsafety.cli.optimize import record as optimize_record
from hrsafety.cli.optimize import report as optimize_report
from hrsafety.cli.optimize.file import GAIN_NAMES, Gains, GainStudy, load
from hrsafety.cli.optimize.found import MOST_PATHS, FoundGains, Scored, gain_words
from hrsafety.errors import FolderInUseError, InvalidParameterError, Shown
from hrsafety.navigation.gains.metrics import is_maximized

__all__ = ["optimize_file"]

LOCK = ".lock"
CHECKPOINT = "search.checkpoint"
FRONT_CHECKPOINT = "front.checkpoint"
SO_FAR = "best_so_far.json"
_STEPPING = ("integrator", "step", "hold")
# Argument of a search to the table of the file that it comes from.
_TABLES = {
    "objective": "objective",
    "method": "search",
    "grid": "search",
    "refinements": "search",
    "survivors": "search",
    "local_starts": "search",
    "evaluations": "search",
    "seed": "search",
    "weights": "objective",
    "require_arrival": "objective",
    "cap_ratios": "objective",
    "seeds": "noise",
    "robustness": "noise",
    "integrator": "run",
    "step": "run",
    "hold": "run",
    "time_limit": "run",
}


def optimize_file(options: argparse.Namespace) -> None:
    """Search the gains of a study, print the best and write page, pictures and values.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety optimize``.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C, when checkpoint and best gains so far have been written.
    SystemExit
        With code 3, when everything has been written, if no gain set keeps the constraints.
    """
    output.planned_folder(options.out)
    output.require_page("optimize")
    output.check_json(options)
    study = _loaded(options.study)
    new = not Path(options.out).exists()
    place = output.folder(options.out)
    with only_writer(place / LOCK, FolderInUseError):
        try:
            found = _searched(options, study, place)
        except InvalidParameterError as error:
            if new and [path.name for path in place.iterdir()] == [LOCK]:
                (place / LOCK).unlink()
                place.rmdir()
            raise _located(options.study, error) from None
        _show(options, found, place)
        for path in (*_checkpoints(study, place), place / SO_FAR):
            path.unlink(missing_ok=True)
    search, doubts = found.search, output.warnings_of(found.search)
    output.report_warnings(doubts, strict=False)
    if not search.valid:
        print(f"hrsafety: nothing feasible: {search.shortcoming}; {search.remedy}", file=sys.stderr, flush=True)
        raise SystemExit(exit_codes.FAILED_RUN)
    output.leave_if_strict(doubts, options.strict)


def _checkpoints(study: GainStudy, place: Path) -> tuple[Path, Path]:
    """Return where unfinished work of the search and of the front is kept."""
    return study.checkpoint or place / CHECKPOINT, place / FRONT_CHECKPOINT


def _loaded(path: str) -> GainStudy:
    with output.located(path):
        return load(path)


def _located(path: str, error: InvalidParameterError) -> InvalidParameterError:
    """Return an error of the search under the key or option that the value came from."""
    argument = error.argument
    name = re.split(r"[.\[]", argument, maxsplit=1)[0]
    if name.startswith("--"):
        return error
    if name == "threads":
        return error.renamed("--threads")
    if name in _TABLES:
        argument = "objective.metric" if name == "objective" else f"{_TABLES[name]}.{argument}"
    return error.renamed(f"{path}: {argument}")


# ---- searching --------------------------------------------------------------------------------------


def _searched(options: argparse.Namespace, study: GainStudy, place: Path) -> FoundGains:
    """Search, resumed or from the start, and score what was found."""
    checkpoint, front_checkpoint = _checkpoints(study, place)
    for path in (checkpoint, front_checkpoint):
        if path.exists() and not options.resume:
            raise InvalidParameterError(
                "--out",
                "hold no unfinished search without --resume",
                Shown(path),
                f"add --resume to continue it, or remove {path} to start over",
            )
    if study.front is not None:
        _check_front(study)
    resumed, begin = checkpoint.exists(), time.perf_counter()
    with progress.live() as shown:
        search = _search(options, study, checkpoint, shown)
        seconds = time.perf_counter() - begin
        front, stopped = None, search.interrupted
        if not stopped and study.front is not None:
            front = _front(options, study, front_checkpoint, shown)
            stopped = front is None
    if stopped:
        _leave(options, study, search, place)
    return FoundGains(
        path=options.study,
        study=study,
        search=search,
        sets=tuple(_sets(study, search)),
        flatness=search.flatness(threads=options.threads),
        sensitivity=_sensitivity(study, search.nearest, options.threads),
        front=front,
        seconds=seconds,
        resumed=resumed,
    )


def _search(
    options: argparse.Namespace, study: GainStudy, checkpoint: Path, shown: progress.Report | None
) -> nav.GainSearch:
    try:
        return nav.optimize_gains(
            study.scenarios,
            study.law,
            **study.search,
            checkpoint=checkpoint,
            threads=options.threads,
            progress=shown,
        )
    except KeyboardInterrupt:
        print("hrsafety: interrupted before any gain set was evaluated", file=sys.stderr, flush=True)
        raise


def _front(
    options: argparse.Namespace, study: GainStudy, checkpoint: Path, shown: progress.Report | None
) -> nav.gains.ParetoFront | None:
    """Return the front, or ``None`` if Ctrl-C came first."""
    # There is no best gain set of several objectives.
    unranked = None if shown is None else lambda stage, done, total, _: shown(stage, done, total, None)
    try:
        found = nav.gains.pareto_front(
            study.scenarios,
            study.law,
            **_front_arguments(study),
            checkpoint=checkpoint,
            threads=options.threads,
            progress=unranked,
        )
    except KeyboardInterrupt:
        return None
    return None if found.interrupted else found


def _front_arguments(study: GainStudy) -> dict[str, Any]:
    """Return the arguments of the front: its own and those that it shares with the search."""
    names: tuple[str, ...] = (
        "bounds",
        "weights",
        "constraints",
        "require_arrival",
        "cap_ratios",
        "seeds",
        "seed",
        "robustness",
    )
    names += (*_STEPPING, "time_limit")
    return {name: study.search[name] for name in names if name in study.search} | (study.front or {})


def _check_front(study: GainStudy) -> None:
    """Find mistakes in what is asked of the front before the search, by a front of one gain set."""
    single = {"bounds": {name: (1.0, 1.0) for name in GAIN_NAMES}, "grid": (1, 1, 1, 1)}
    try:
        nav.gains.pareto_front(study.scenarios, study.law, **(_front_arguments(study) | single))
    except InvalidParameterError as error:
        own = re.split(r"[.\[]", error.argument, maxsplit=1)[0] in {"objectives", *(study.front or {})}
        argument = f"front.{error.argument}" if own else error.argument
        raise error.renamed(argument) from None


def _leave(options: argparse.Namespace, study: GainStudy, search: nav.GainSearch, place: Path) -> None:
    """Write the best so far, say how to resume, and end as Ctrl-C does."""
    path = output.write_text(place / SO_FAR, optimize_record.best_so_far(options.study, study, search))
    found = f"; {search.shortcoming}"
    if search.valid:
        found = f"; best of {search.evaluations:,} gain sets so far: {gain_words(search.best.gains)}"
    print(f"hrsafety: interrupted{found}", file=sys.stderr)
    print(f"hrsafety: wrote {path}", file=sys.stderr)
    words = ["hrsafety", "optimize", options.study, "--out", options.out, "--resume"]
    command = " ".join(f'"{word}"' if " " in word else word for word in words)
    print(f"hrsafety: resume with: {command}", file=sys.stderr, flush=True)
    raise KeyboardInterrupt


def _scoring(study: GainStudy) -> dict[str, Any]:
    """Return the arguments that say how a run is stepped and scored."""
    return {name: study.search[name] for name in ("weights", *_STEPPING) if name in study.search}


def _sets(study: GainStudy, search: nav.GainSearch) -> Iterator[Scored]:
    """Yield the best gain set and those of the file, scored in every scenario."""
    sign = 1.0 if is_maximized(study.objective) else -1.0
    first = "best" if search.valid else "nearest"
    values = {first: (search.nearest, sign * search.best_value)}
    for name, gains in study.compare.items():
        found = _alone(study, gains)
        values[name] = (found.nearest, sign * found.best_value)
    stepping = {name: value for name, value in _scoring(study).items() if name != "weights"}
    for name, (law, value) in values.items():
        yield Scored(
            name=name,
            law=law,
            value=value,
            scores=nav.simulate_batch(study.scenarios, law, **_scoring(study)),
            runs=tuple(nav.simulate(scenario, law, **stepping) for scenario in study.scenarios[:MOST_PATHS]),
        )


def _alone(study: GainStudy, gains: Gains) -> nav.GainSearch:
    """Return a search that has this one gain set to choose from, so that its objective is the same."""
    arguments = {name: value for name, value in study.search.items() if name != "evaluations"}
    arguments |= {
        "bounds": {name: (gain, gain) for name, gain in zip(GAIN_NAMES, gains, strict=True)},
        "method": "grid",
        "grid": (1, 1, 1, 1),
        "refinements": 0,
        "survivors": 1,
        "local_starts": 0,
    }
    return nav.optimize_gains(study.scenarios, study.law, **arguments)


def _sensitivity(study: GainStudy, law: nav.Law, threads: int | None) -> nav.gains.GainSensitivity:
    return nav.gain_sensitivity(study.scenarios, law, threads=threads, **_scoring(study))


# ---- files ------------------------------------------------------------------------------------------


def _show(options: argparse.Namespace, found: FoundGains, place: Path) -> None:
    """Print what was found, and write values, pictures and page."""
    pictures = output.pictures(place, optimize_pictures.make(found))
    report = optimize_report.report_of(found, {each.name: each for each in pictures})
    print(terminal.told(report))
    files = [place / f"{each.name}.png" for each in pictures]
    if found.front is not None:
        files.append(found.front.to_csv(place / "front.csv"))
    files.append(output.write_text(place / "results.json", report.json()))
    output.say_written(output.write_report(report, place, (), files), report, options)
