"""A bar for the ``progress`` of long calls, in a terminal or a notebook: share done, rate, time left."""

from __future__ import annotations

import math
import sys
import time
from typing import TextIO

from hrsafety._calls import suggest
from hrsafety.errors import InvalidParameterError

__all__ = ["ProgressBar"]

SECONDS_BETWEEN_FRAMES = 0.1
WIDTH = 24


class ProgressBar:
    """Progress of a long call, for its argument ``progress``: draws one line and redraws it in place.

    Parameters
    ----------
    title : str
        In front of the bar.
    file : text file or None
        Where it is drawn; ``sys.stderr`` when ``None``.

    Raises
    ------
    InvalidParameterError
        If the title is no text in one line.

    Examples
    --------
    >>> import sys
    >>> from hrsafety.progress import ProgressBar
    >>> told = ProgressBar("foams", file=sys.stdout)
    >>> told(4, 4)  # doctest: +ELLIPSIS
    foams ######################## 100 % 4/4 in ...
    """

    def __init__(self, title: str = "", *, file: TextIO | None = None) -> None:
        """Start nothing: the first call draws."""
        if not isinstance(title, str) or "\n" in title:
            raise InvalidParameterError("title", "be a text in one line", title)
        self._title, self._file = title, file
        self._stage: str | None = None
        self._begun = self._drawn = -math.inf
        self._first = self._longest = 0

    def __call__(self, *told: object) -> None:
        """Draw how far a call is.

        Parameters
        ----------
        *told : object
            ``(done, total)``, or of searches ``(stage, done, total, best)``.

        Raises
        ------
        InvalidParameterError
            If it is called with something else.
        """
        stage, done, total, best = told if len(told) == 4 else ("", *told, None) if len(told) == 2 else (None,) * 4
        if not isinstance(stage, str) or not isinstance(done, int) or not isinstance(total, int):
            raise InvalidParameterError("told", "be (done, total) or (stage, done, total, best)", told)
        now = time.monotonic()
        if stage != self._stage or done < self._first:
            self._stage, self._begun, self._drawn, self._first, self._longest = stage, now, -math.inf, done, 0
        if done < total and now - self._drawn < SECONDS_BETWEEN_FRAMES:
            return
        self._drawn = now
        share = done / total if total else 1.0
        full = round(WIDTH * share)
        spent = now - self._begun
        # Of the rows of this call alone: those that a sweep found in its folder took no time.
        left = spent * (total - done) / (done - self._first) if done > self._first else math.nan
        ending = f"in {_duration(spent)}" if done >= total else f"{_duration(left)} left" if left == left else ""
        value = f"best {best:.5g}" if isinstance(best, float) and math.isfinite(best) else ""
        bar = "#" * full + "-" * (WIDTH - full)
        words = [self._title, stage, bar, f"{100.0 * share:3.0f} %", f"{done}/{total}", value, ending]
        line = " ".join(filter(None, words))
        file = sys.stderr if self._file is None else self._file
        start = "\r" if self._longest else ""
        file.write(start + line.ljust(self._longest) + ("\n" if done >= total else ""))
        file.flush()
        self._longest = len(line) if done < total else 0


def _duration(seconds: float) -> str:
    """Return a time in the unit that a person would say."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.1f} s"


suggest(__all__, globals())
