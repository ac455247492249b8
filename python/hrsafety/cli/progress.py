"""Live progress of long work on a terminal: a bar if tqdm is there, else lines, else nothing."""

from __future__ import annotations

import importlib.util
import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["Report", "live"]

Report = Callable[[str, int, int, float | None], object]
"""What long work calls: stage, work done, work in all, best value so far if anything is searched."""

SECONDS_BETWEEN_LINES = 2.0


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
    shown = _Bars(digits) if importlib.util.find_spec("tqdm") is not None else _Lines(digits)
    try:
        yield shown
    finally:
        shown.close()


def _best(value: float | None, digits: int) -> str:
    if value is None:
        return ""
    return f"best {value:.{digits}f}" if math.isfinite(value) else "nothing yet"


class _Bars:
    """One bar of tqdm for each stage."""

    def __init__(self, digits: int) -> None:
        self._digits = digits
        self._stage = ""
        self._bar: Any = None

    def __call__(self, stage: str, done: int, total: int, best_value: float | None) -> None:
        """Show how far a stage is."""
        if stage != self._stage or self._bar is None:
            from tqdm import tqdm

            self.close()
            self._stage = stage
            self._bar = tqdm(total=total, desc=stage, unit="", unit_scale=True, file=sys.stderr, leave=True)
        self._bar.total = total
        self._bar.set_postfix_str(_best(best_value, self._digits), refresh=False)
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        """Leave the bar as it is."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None


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
