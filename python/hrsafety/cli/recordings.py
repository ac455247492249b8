"""``hrsafety people info|convert``: what a file of recorded people holds, and the same people for another program."""

from __future__ import annotations

import argparse
import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety import io
from hrsafety._words import some
from hrsafety.cli import output, terminal
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError
from hrsafety.pages.report import Report
from hrsafety.plausibility import HrsafetyWarning, ResultWarning

__all__ = ["convert", "in_words", "is_given", "loaded", "show", "told_in_options"]

ARGUMENTS = ("format", "fps", "step_s", "unit", "scale", "homography", "columns", "classes")
_OPTIONS = {each: f"--{each.replace('_', '-')}" for each in (*ARGUMENTS, "people", "frame")} | {
    "robot": "--robot-frame"
}
_ARGUMENT = re.compile(rf"(?<![\w-])({'|'.join(_OPTIONS)})=([\x22\x27]?\w?)")
_REMEDIES = {
    "recording.smoothed(0.6) takes": "--smooth 0.6 takes",
    'unknown="occupied"': "--unknown occupied",
    "recording.relabeled() and load_people(..., relabel=True) do": "--relabel does",
    "load_people(..., fps=) or --fps": "--fps F",
}
_TOPICS = {"people": "people", "topic": "TOPIC"}


def loaded(path: str, options: argparse.Namespace) -> Recording:
    """Return the people of a file, read as the options say; the recording carries its doubts."""
    given: dict[str, Any] = {name: getattr(options, name) for name in ARGUMENTS if getattr(options, name) is not None}
    if "columns" in given and "=" in given["columns"]:
        given["columns"] = dict(_pair(each) for each in given["columns"].split(","))
    if "classes" in given:
        given["classes"] = tuple(given["classes"].split(","))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HrsafetyWarning)  # all of them are printed
        try:
            with told_in_options():
                found = io.load_people(path, relabel=options.relabel, **given)
        except InvalidParameterError as error:
            if error.argument in ARGUMENTS:
                raise error.renamed(f"--{error.argument.replace('_', '-')}") from None
            raise
    return found if getattr(options, "smooth", None) is None else found.smoothed(options.smooth)


def in_words(found: Iterable[ResultWarning]) -> tuple[ResultWarning, ...]:
    """Return warnings with the options of the command line in their remedies."""
    return tuple(replace(each, message=in_options(each.message)) for each in found)


def is_given(options: argparse.Namespace) -> bool:
    """Return whether an option says what a file of people does not say itself."""
    return options.relabel or any(getattr(options, name) is not None for name in ARGUMENTS)


def in_options(text: str) -> str:
    """Return a message with the options of the command line in place of the arguments of Python."""
    for python, option in _REMEDIES.items():
        text = text.replace(python, option)
    text = re.sub(r'columns=\{"([^"]*)": "([^"]*)"\}', r"--columns '\1=\2'", text)
    text = _ARGUMENT.sub(lambda found: f"{_OPTIONS[found[1]]} {found[2]}".rstrip(), text)
    return re.sub(r"offset=\{\"?(\w+)\"?: seconds\}", lambda found: f"--offset {_TOPICS[found[1]]}=S", text)


@contextmanager
def told_in_options() -> Iterator[None]:
    """Name options in the remedies of errors where they name arguments of Python."""
    try:
        yield
    except InvalidParameterError as error:
        if error.remedy is not None:
            error.remedy = in_options(error.remedy)
        raise


def _pair(text: str) -> tuple[str, str]:
    name, sign, meaning = text.partition("=")
    if not sign or not name.strip() or not meaning.strip():
        raise InvalidParameterError("--columns", "be NAME=MEANING,... or all names", text)
    return name.strip(), meaning.strip()


def show(options: argparse.Namespace) -> None:
    """Print what a file of recorded people holds.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety people info``.
    """
    output.check_json(options)
    recording = loaded(options.file, options)
    report = _report(recording, options.file)
    print(terminal.told(report))
    output.say_written([], report, options)
    output.report_warnings(in_words(recording.warnings), options.strict)


def convert(options: argparse.Namespace) -> None:
    """Write the people of a file for another program.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety people convert``.
    """
    output.check_json(options)
    recording = loaded(options.file, options)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", HrsafetyWarning)
        try:
            place = io.write_people(
                recording, options.out, format=options.to, fps=options.out_fps, renumber=options.renumber
            )
        except InvalidParameterError as error:
            names = {"format": "--to", "path": "OUT", "fps": "--out-fps"}
            raise error.renamed(names.get(error.argument, error.argument)) from None
    lost = [ResultWarning("not_written", "format", str(each.message)) for each in caught]
    report = _report(recording, options.file)
    print(terminal.told(report))
    output.say_written([place], report, options)
    output.report_warnings((*in_words(recording.warnings), *lost), options.strict)


def _report(recording: Recording, path: str) -> Report:
    return Report(
        title=f"Recorded people of {path}",
        facts=list(_facts(recording)),
        warnings=in_words(recording.warnings),
        values=_values(recording),
        source=path,
    )


def _facts(recording: Recording) -> Iterator[tuple[str, str]]:
    source = recording.source
    if source is not None:
        yield "format", source.format
        yield "SHA-256", source.sha256
    rate = recording.frame_rate
    told = (
        f"{rate:.8g} a second, by the {recording.frame_rate_from}" if rate is not None else "none: the file has times"
    )
    yield "frames", told
    yield "people", f"{len(recording.people())}, {some(len(recording), 'row')}"
    yield "time", f"{recording.duration:.10g} s, one row of a person every {recording.sampling_period:.4g} s"
    low, high = recording.position.min(axis=0), recording.position.max(axis=0)
    yield "area", f"x {low[0]:.2f} to {high[0]:.2f} m, y {low[1]:.2f} to {high[1]:.2f} m"
    motion = recording.motion()
    how = {"stored": "as stored", "differences": "differences", "fit": "local quadratic fits"}[motion.velocity_from]
    passed = f", motions below {motion.bandwidth:.2g} Hz stay" if np.isfinite(motion.bandwidth) else ""
    yield "speed", f"median {recording.median_speed():.2f} m/s of those who walk; {how}{passed}"
    if recording.walls:
        yield "walls", f"{len(recording.walls)} rings and lines"
    if recording.robot is not None:
        yield "robot", some(len(recording.robot.time_s), "instant")
    for name, value in recording.details.items():
        if isinstance(value, str | int | float) and not isinstance(value, bool):
            yield name.replace("_", " "), str(value)
        elif name in {"other_classes", "markers"}:
            yield name.replace("_", " "), ", ".join(f"{key}: {each}" for key, each in value.items())
        elif name in {"scenes", "absent", "relabeled"}:
            yield name, str(len(value))


def _values(recording: Recording) -> dict[str, Any]:
    source = recording.source
    return {
        "format": source and source.format,
        "sha256": source and source.sha256,
        "arguments": dict(source.arguments) if source else {},
        "rows": len(recording),
        "people": recording.people().tolist(),
        "duration_s": recording.duration,
        "time_origin_s": recording.time_origin,
        "frame_rate_Hz": recording.frame_rate,
        "frame_rate_from": recording.frame_rate_from,
        "sampling_period_s": recording.sampling_period,
        "median_speed_m_per_s": recording.median_speed(),
        "switches": recording.switches,
        "teleports": recording.teleports,
        "gaps": recording.gaps,
        "details": {key: value for key, value in recording.details.items() if key not in {"grid", "objects"}},
    }
