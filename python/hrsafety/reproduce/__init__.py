"""Published tables and figures made again: every printed value beside the measured one.

`run` simulates, compares, draws and writes one summary page that needs no network.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, as_completed
from dataclasses import replace
from pathlib import Path

from hrsafety._words import meant
from hrsafety.errors import InvalidParameterError, Shown, SimulationError
from hrsafety.navigation.sensing.calibration import scipy_least_squares
from hrsafety.pages import require_jinja
from hrsafety.reproduce import page, parts, trends
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.parts import Made
from hrsafety.reproduce.published import published_tables

__all__ = ["PARTS", "PrintedValue", "published_tables", "run"]

PARTS = tuple(parts.PARTS)
"""Parts that `run` can make, in the order in which they are made."""

LONGEST = "reactive"


def run(
    out: str | Path = "reproduction",
    only: str | Iterable[str] | None = None,
    progress: Callable[[str], object] | None = None,
    executor: Executor | None = None,
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
        Called with a line of text when a part begins, where it is made.
    executor : concurrent.futures.Executor or None
        Where parts are made, for example a ``ProcessPoolExecutor``; here, one after the other, when ``None``. For
        other processes ``progress`` is pickled. Changes nothing in what is written.

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
    SimulationError
        If a process of the executor ended.
    MissingExtraError
        If Jinja2 is not installed, or SciPy while the part ``"camera"`` is to be made.

    Examples
    --------
    >>> import tempfile
    >>> from hrsafety import reproduce
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     reproduce.run(folder, only="tables-6").name
    'summary.html'
    """
    chosen = _chosen(only)
    folder = Path(out)
    if folder.exists() and not folder.is_dir():
        raise InvalidParameterError("out", "be a folder or not exist", str(out))
    require_jinja("reproduce")  # before minutes of work, not after them
    if "camera" in chosen:
        scipy_least_squares()
    folder.mkdir(parents=True, exist_ok=True)
    say = progress if progress is not None else _silent
    begin = time.perf_counter()
    report = page.ReproductionReport(command=_command(out, only))
    made = dict(_each(chosen, say, executor))
    report.made.update((name, made[name]) for name in chosen)
    if {"tables-c", "figures-6"} <= set(chosen):
        drawn = report.made["figures-6"]
        report.made["figures-6"] = replace(
            drawn, pictures=[*drawn.pictures, *trends.make(report.made["tables-c"].cells)]
        )
    report.seconds = time.perf_counter() - begin
    say("writing the page")
    return page.write(report, folder)


def _each(names: Iterable[str], say: Callable[[str], object], executor: Executor | None) -> Iterator[tuple[str, Made]]:
    """Yield parts by name as they are made."""
    if executor is None:
        for name in names:
            yield name, _make(name, say)
        return
    # The longest one is begun first, so that nobody waits for it.
    begun = {executor.submit(_make, name, say): name for name in sorted(names, key=lambda name: name != LONGEST)}
    for future in as_completed(begun):
        try:
            yield begun[future], future.result()
        except BrokenExecutor as error:
            raise SimulationError(f"the pool broke ({error}); nothing was written") from error


def _make(name: str, say: Callable[[str], object]) -> Made:
    part = parts.PARTS[name]
    say(f"{name}: {part.progress}")
    return part.make(say)


def _silent(_: str) -> None:
    """Say nothing."""


def _chosen(only: str | Iterable[str] | None) -> tuple[str, ...]:
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
