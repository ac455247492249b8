"""Live progress of long work on a terminal: bars if rich is there, else lines; nothing elsewhere."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hrsafety.cli.terminal import can_draw, console

__all__ = ["Report", "live"]

Report = Callable[[str, int, int, float | None], object]
"""Progress callback of long work: stage, work done, work in all, best value so far if anything is searched."""

SECONDS_BETWEEN_LINES = 2.0
SECONDS_BETWEEN_FRAMES = 0.1


@contextmanager
def live(*, digits: int = 5) -> Iterator[Report | None]:
    """Yield what to report progress to; ``None`` if stderr is no terminal.

    Parameters
    ----------
    digits : int
        Digits of the best value.

    Yields
    ------
    callable or None
        Takes stage, done, total and the best value so far: NaN without one yet, ``None`` if
        nothing is searched.
    """
    if not sys.stderr.isatty():
        yield None
        return
    shown = _Bars(digits) if can_draw(sys.stderr) else _Lines(digits)
    try:
        yield shown
    finally:
        shown.close()


def _best(value: float | None, digits: int) -> str:
    if value is None:
        return ""
    return f"best {value:.{digits}f}" if math.isfinite(value) else "nothing yet"


class _Bars:
    """One bar of rich for each stage; drawn by the calls alone, without a thread of its own."""

    def __init__(self, digits: int) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskProgressColumn, TextColumn

        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[best]}"),
        )
        self._digits = digits
        self._stage: str | None = None
        self._last = -math.inf
        self._progress = Progress(*columns, console=console(sys.stderr), auto_refresh=False)
        self._progress.start()

    def __call__(self, stage: str, done: int, total: int, best_value: float | None) -> None:
        """Show how far a stage is."""
        if stage != self._stage:
            self._stage, self._last = stage, -math.inf
            self._task = self._progress.add_task(stage, total=total, best="")
        now = time.monotonic()
        refresh = done >= total or now - self._last > SECONDS_BETWEEN_FRAMES
        self._last = now if refresh else self._last
        best = _best(best_value, self._digits)
        self._progress.update(self._task, completed=done, total=total, best=best, refresh=refresh)

    def close(self) -> None:
        """Leave the bars as they are."""
        self._progress.stop()


class _Lines:
    """A line when a stage begins or ends, and every few seconds between."""

    def __init__(self, digits: int) -> None:
        self._digits = digits
        self._stage = ""
        self._last = -math.inf

    def __call__(self, stage: str, done: int, total: int, best_value: float | None) -> None:
        """Show how far a stage is."""
        now = time.monotonic()
        if stage == self._stage and done < total and now - self._last < SECONDS_BETWEEN_LINES:
            return
        self._stage, self._last = stage, now
        words = ", ".join(filter(None, [f"{done} of {total}", _best(best_value, self._digits)]))
        print(f"{stage}: {words}", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Nothing is left open."""
