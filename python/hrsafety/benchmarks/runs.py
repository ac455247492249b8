"""Runs of a benchmark: chunk by chunk, each kept when it is done, resumed where they stopped."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

from hrsafety import __version__
from hrsafety._arguments import callback, checked_seed, count, number, positive, readable, sequence, thread_count, word
from hrsafety._atomic import only_writer, write_file
from hrsafety.benchmarks.entries import MARGIN, Entry
from hrsafety.benchmarks.protocol import Case, Suite
from hrsafety.benchmarks.results import Result, Row, read_rows, row_text
from hrsafety.benchmarks.suites import CHUNK, SUITES
from hrsafety.errors import FolderInUseError, InvalidParameterError, Shown, StorageError
from hrsafety.navigation.metrics.between import CONTACT_BETWEEN
from hrsafety.navigation.warnings.shields import ASSUMES_LESS
from hrsafety.plausibility import ResultWarning

__all__ = ["benchmark", "case_of"]

Progress = Callable[[int, int], object]

NOTHING_LOST = "all rows that were there"
WRITABLE = "choose a folder that can be written, then start again: it resumes there"


def benchmark(
    suite: str,
    laws: Sequence[str] | None = None,
    *,
    cases: int | None = None,
    person_speed: float = 1.6,
    seed: int | None = None,
    data: str | Path | None = None,
    out: str | Path | None = None,
    threads: int | None = None,
    noise: float = 0.0,
    latency: float = 0.0,
    progress: Progress | None = None,
) -> Result:
    """Run laws through a suite.

    Parameters
    ----------
    suite : str
        The protocol, one of `SUITES`.
    laws : sequence of str or None
        Entries such as ``"field+shield+yielding"``; those of the suite when ``None``.
    cases : int or None
        Number of episodes; those of the protocol when ``None``.
    person_speed : float
        What shields assume of people, in m/s.
    seed : int or None
        Seed of the draw; that of the protocol when ``None``.
    data : path or None
        Folder with the files of suites that read some: recordings (``*.csv``), BARN worlds (``barn_*.json``), or
        trajectories and worlds of DynaBARN (``dynabarn*.json``).
    out : path or None
        Folder in which rows are kept as they come; the same call resumes there.
    threads : int or None
        Number of threads.
    noise : float
        Half width of the uniform error of each coordinate of measured people, in m; shields assume it, too.
    latency : float
        Age of their measurements in s; shields assume it, too.
    progress : callable or None
        Called with (episodes done, episodes in all).

    Returns
    -------
    Result
        Episodes of every entry.

    Raises
    ------
    InvalidParameterError
        If a word is unknown, a number out of range, or the folder holds something else.
    FolderInUseError
        If another process is writing the same rows.
    StorageError
        If the folder cannot be written.

    Examples
    --------
    >>> from hrsafety.benchmarks import benchmark
    >>> result = benchmark("s4", ["orca+shield+yielding"], cases=4)
    >>> result.at_fault("orca+shield+yielding").value
    0.0
    """
    kind = SUITES[word("suite", suite, tuple(SUITES))]
    entries = [
        kind.entry(each)
        for each in (kind.laws if laws is None else sequence("laws", "be a list of words such as field+shield", laws))
    ]
    if not entries:
        raise InvalidParameterError("laws", "name at least one law", laws)
    first = kind.seed if seed is None else checked_seed("seed", seed)
    if kind.files is not None and data is None:
        raise InvalidParameterError("data", f"name the folder with the files of {kind.name}", None)
    folder = None if data is None or kind.files is None else Path(data)
    most = kind.most if kind.available is None else kind.available(folder)
    usual = min(kind.cases, most) if kind.available else kind.cases
    runs = count("cases", usual if cases is None else cases, most=most)
    settings: dict[str, Any] = {
        "person_speed": positive("person_speed", person_speed),
        "seed": first,
        "data": folder,
        "threads": thread_count(threads),
    }
    for name, value in (("noise", noise), ("latency", latency)):
        settings[name] = number(name, value)
        if settings[name] < 0.0:
            raise InvalidParameterError(name, "be 0 or above", value)
        if settings[name] > 0.0 and not kind.sensed:
            rule = f"be 0 in {kind.name}, whose protocol has its own sensing"
            raise InvalidParameterError(name, rule, value)
    told = callback("progress", progress)
    place = None if out is None else _folder(out)
    done = 0
    rows: dict[str, Sequence[Row]] = {}
    for each in entries:

        def heard(own: int, before: int = done) -> None:
            if told is not None:
                told(before + own, len(entries) * runs)

        rows[each.name] = _run(kind, each, runs, settings, place, heard)
        done += runs
    asked = {
        name: kind.accepted[name, speed]
        for name in rows
        for speed in (None, person_speed)
        if (name, speed) in kind.accepted and not noise and not latency
    }
    shielded = any("shield" in each.parts for each in entries)
    of_data = () if kind.doubts is None else kind.doubts(folder, runs)
    doubts = (*of_data, *(_doubts(kind, person_speed) if shielded else ()), *_between(kind, rows), *_lost(rows))
    return Result(suite=kind.name, rows=rows, accepted=asked, warnings=doubts, conditions=_conditions(kind, settings))


def _conditions(kind: Suite, settings: Mapping[str, Any]) -> str:
    """Return the conditions under which the shares hold, in words."""
    noise, latency = settings["noise"], settings["latency"]
    sensing = (
        f"people measured to +-{noise:g} m in x and y and {latency:g} s late" if noise or latency else "exact sensing"
    )
    if not kind.sensed:
        sensing = "sensing of the protocol"
    return f"{kind.summary}; {sensing}; shields assume people of up to {settings['person_speed']:g} m/s"


def _folder(out: object) -> Path:
    """Return the folder for rows, made if it is not there."""
    if not isinstance(out, (str, PathLike)):
        raise InvalidParameterError("out", "be the path of a folder", out)
    try:
        place = Path(out)
        if place.exists() and not place.is_dir():
            raise InvalidParameterError("out", "be a folder or not exist", str(place), "this is a file or a device")
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StorageError(place, error, kept=NOTHING_LOST, remedy=WRITABLE) from None
    except ValueError as error:  # a null character
        raise InvalidParameterError("out", "be the path of a folder", Shown(f"{out!r} ({error})")) from None
    return place


def _doubts(kind: Suite, person_speed: float) -> Iterator[ResultWarning]:
    """Warn where people of a suite are, or may be, faster than shields assume."""
    if kind.execution_error > 0.0:
        yield ResultWarning(
            ASSUMES_LESS,
            "margin",
            f"robots of {kind.name} are up to {kind.execution_error:g} m off the motion that shields plan, more than "
            f"their margin of {MARGIN:g} m: what a shield proves does not hold here, faults are only counted",
        )
    if kind.fastest is not None and person_speed >= kind.fastest:
        return
    fastest = "may be faster in the data" if kind.fastest is None else f"move at up to {kind.fastest:g} m/s"
    yield ResultWarning(
        ASSUMES_LESS,
        "person_speed",
        f"shields assume people of up to {person_speed:g} m/s, but people of {kind.name} {fastest}: what a shield "
        "proves does not hold for those who are faster",
    )


def _between(kind: Suite, rows: Mapping[str, Sequence[Row]]) -> Iterator[ResultWarning]:
    """Tell where people touched robots between instants only."""
    counts = {name: sum(row.between > 0 for row in found) for name, found in rows.items()}
    told = ", ".join(f"{name} {count} of {len(rows[name])}" for name, count in counts.items() if count)
    if told:
        yield ResultWarning(
            CONTACT_BETWEEN,
            "contacts",
            f"in some episodes of {kind.name} somebody touches the robot on straight lines between two instants and at "
            f"none of them, which counts as a contact ({told})",
            safe_side=True,
        )


def _lost(rows: Mapping[str, Sequence[Row]]) -> Iterator[ResultWarning]:
    """Tell where a person may have been touched who was not seen."""
    counts = {name: sum(row.lost > 0 for row in found) for name, found in rows.items()}
    told = ", ".join(f"{name} {count} of {len(rows[name])}" for name, count in counts.items() if count)
    if told:
        yield ResultWarning(
            "lost_nearby",
            "contacts",
            f"in some episodes ({told}) somebody may have been touched out of sight, before the first or after the "
            "last row of the person, or the robot arrived after the end of the recording: whom nobody sees is taken "
            "to be away",
        )


def case_of(settings: Mapping[str, object], each: Entry, cases: Sequence[int]) -> Case:
    """Return some episodes of an entry."""
    return Case(cases=cases, entry=each, **settings)  # type: ignore[arg-type]  # checked by the caller


def _file(place: Path, suite: Suite, each: Entry, settings: Mapping[str, object]) -> Path:
    """Return where rows are kept; other settings, and another version of the package, have another file."""
    plain = re.sub(r"[^a-z0-9+_]", "_", each.name.lower())
    data = f"-data{_content(suite, settings['data'])}" if isinstance(settings["data"], Path) else ""
    sensing = "".join(f"-{name}{settings[name]!r}" for name in ("noise", "latency") if settings.get(name))
    draws = f"v{settings['person_speed']!r}-seed{settings['seed']}{sensing}{data}"
    return place / f"{suite.name}-{plain}-{draws}-hrsafety{__version__}.csv"


def _content(suite: Suite, folder: Path) -> str:
    """Return a word for what the files of a suite hold: others have other rows."""
    content = hashlib.sha256()
    for file in [] if suite.files is None else suite.files(folder):
        content.update(readable("data", file).read_bytes())
    return content.hexdigest()[:12]


def _run(
    suite: Suite,
    each: Entry,
    runs: int,
    settings: Mapping[str, object],
    place: Path | None,
    heard: Callable[[int], None],
) -> list[Row]:
    if place is None:
        return _missing(suite, each, runs, settings, None, heard)
    path = _file(place, suite, each, settings)
    # Another process that writes the same rows would write them twice.
    with only_writer(path.with_name(f".{path.name}.lock"), FolderInUseError):
        return _missing(suite, each, runs, settings, path, heard)


@contextmanager
def _stored(path: Path) -> Iterator[None]:
    """Name the file that cannot be written."""
    try:
        yield
    except OSError as error:
        raise StorageError(path, error, kept=NOTHING_LOST, remedy=WRITABLE) from None


def _missing(
    suite: Suite,
    each: Entry,
    runs: int,
    settings: Mapping[str, object],
    path: Path | None,
    heard: Callable[[int], None],
) -> list[Row]:
    """Return the rows of a file and those that it lacks, which are computed and added to it."""
    rows = [] if path is None else read_rows(path)
    known = {row.case for row in rows}
    if path is not None:
        # Without a line that was cut off, and in one step: what is kept is never lost.
        with _stored(path):
            write_file(path, row_text(rows, head=True))
    missing = [case for case in range(runs) if case not in known]
    heard(runs - len(missing))
    for begin in range(0, len(missing), CHUNK):
        chunk = missing[begin : begin + CHUNK]
        found = list(suite.run(case_of(settings, each, chunk)))
        if path is not None:
            with _stored(path), path.open("a", encoding="utf-8") as file:
                file.write(row_text(found, head=False))
        rows += found
        heard(runs - len(missing) + begin + len(chunk))
    return sorted((row for row in rows if row.case < runs), key=lambda row: row.case)
