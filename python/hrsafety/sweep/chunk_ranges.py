"""Some of the chunks of a sweep, so that several processes share one folder."""

from __future__ import annotations

import re

from hrsafety.errors import InvalidParameterError

__all__ = ["ChunkShare", "checked_share"]

_RULE = 'be a range, "0:8" or "2/16"'
_SPAN, _PART = re.compile(r"(\d{1,18}):(\d{1,18})"), re.compile(r"(\d{1,18})/(\d{1,18})")
# More parts than a job array can have.
MOST_PARTS = 10**6


class ChunkShare:
    """A share of the chunks: from a first to a last one, or one of equal parts.

    Parameters
    ----------
    span : range or None
        Chunks by their numbers.
    part : (int, int) or None
        Number of the part, from 1, and how many there are.
    """

    def __init__(self, span: range | None, part: tuple[int, int] | None) -> None:
        self._span, self._part = span, part

    @property
    def parts(self) -> int:
        """Number of equal parts; 0 for chunks by their numbers."""
        return 0 if self._part is None else self._part[1]

    def of(self, chunks: int) -> range:
        """Return the numbers of the chunks of a sweep that has so many.

        Raises
        ------
        InvalidParameterError
            If the sweep does not have them.
        """
        if self._part is not None:
            number, parts = self._part
            return range(chunks * (number - 1) // parts, chunks * number // parts)
        assert self._span is not None
        if self._span.stop > chunks:
            shown = f"{self._span.start}:{self._span.stop}"
            remedy = f"the sweep has the chunks 0:{chunks}"
            raise InvalidParameterError("chunks", f"end at {chunks} at most", shown, remedy)
        return self._span


def checked_share(value: object) -> ChunkShare | None:
    """Return the share that ``chunks`` names.

    Parameters
    ----------
    value : object
        A range, ``"0:8"`` for the chunks 0 to 7, ``"2/16"`` for the second of sixteen parts, or ``None``.

    Returns
    -------
    Share or None
        ``None`` for all chunks.

    Raises
    ------
    InvalidParameterError
        If it is neither, or empty.
    """
    if value is None:
        return None
    if isinstance(value, range):
        if value.step != 1 or value.start < 0 or not value:
            raise InvalidParameterError("chunks", "be a range upward in steps of 1, not empty", str(value))
        return ChunkShare(value, None)
    span = _SPAN.fullmatch(value) if isinstance(value, str) else None
    if span is not None:
        first, stop = int(span[1]), int(span[2])
        if not first < stop:
            raise InvalidParameterError("chunks", "end behind its start", value)
        return ChunkShare(range(first, stop), None)
    part = _PART.fullmatch(value) if isinstance(value, str) else None
    if part is None:
        raise InvalidParameterError("chunks", _RULE, value)
    number, parts = int(part[1]), int(part[2])
    if not 1 <= number <= parts <= MOST_PARTS:
        rule = f"count parts from 1 to their number, {MOST_PARTS:,} at most"
        raise InvalidParameterError("chunks", rule, value, "number the tasks of a job array from 1")
    return ChunkShare(None, (number, parts))
