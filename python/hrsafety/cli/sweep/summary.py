"""Summary of a sweep in few numbers: read once, chunk by chunk."""

from __future__ import annotations

import math
from dataclasses import field

import numpy as np

from hrsafety._records import dataclass
from hrsafety.sweep import Column, SweepResult

__all__ = ["ColumnSummary", "Summary", "Words", "summarized"]


@dataclass(slots=True, kw_only=True)
class ColumnSummary:
    """Range and mean of a column of numbers.

    Attributes
    ----------
    column : Column
        Which.
    least, largest : float
        Of the finite values.
    least_row, largest_row : dict of str to object
        Axes and case of the rows where they are.
    total : float
        Sum of the finite values.
    finite, missing : int
        How many are finite, and how many are not.
    """

    column: Column
    least: float = math.inf
    largest: float = -math.inf
    least_row: dict[str, object] = field(default_factory=dict)
    largest_row: dict[str, object] = field(default_factory=dict)
    total: float = 0.0
    finite: int = 0
    missing: int = 0

    @property
    def label(self) -> str:
        """Name and unit."""
        return self.column.label

    def numbers(self) -> tuple[str, str, str, str]:
        """Return least, mean and largest value, and how many have none, as text."""
        if not self.finite:
            return ("-", "-", "-", f"{self.missing:,}")
        return (f"{self.least:.5g}", f"{self.total / self.finite:.5g}", f"{self.largest:.5g}", f"{self.missing:,}")


@dataclass(slots=True, kw_only=True)
class Words:
    """How often each word of a column occurs.

    Attributes
    ----------
    column : Column
        Which; truth values count as words.
    counts : list of (str, int)
        In the order of the declaration, without those that do not occur.
    """

    column: Column
    counts: list[tuple[str, int]] = field(default_factory=list)

    @property
    def label(self) -> str:
        """Name."""
        return self.column.label

    def shares(self) -> str:
        """Return how often each word occurs, as text."""
        return ", ".join(f"{word} {number:,}" for word, number in self.counts)


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """Summary of a sweep.

    Attributes
    ----------
    result : SweepResult
        The sweep.
    numbers : tuple of Numbers
        Columns of numbers.
    words : tuple of Words
        Columns of words and truth values.
    """

    result: SweepResult
    numbers: tuple[ColumnSummary, ...]
    words: tuple[Words, ...]


def summarized(result: SweepResult) -> Summary:
    """Return the summary of a sweep.

    Parameters
    ----------
    result : SweepResult
        The sweep.

    Returns
    -------
    Summary
        Of the chunks that are there.
    """
    numbers = [ColumnSummary(column=column) for column in result.found if column.kind in {"number", "integer"}]
    words = [Words(column=column) for column in result.found if column.kind in {"flag", "word"}]
    kinds = {each.column.name: each.column.words or ("no", "yes") for each in words}
    counts = {name: np.zeros(len(known), dtype=np.int64) for name, known in kinds.items()}
    leading = result.columns[: len(result.columns) - len(result.found)]
    for stored in result.stored_chunks(result.columns):
        for each in numbers:
            _count(each, stored, leading)
        for name, count in counts.items():
            count += np.bincount(stored[name].astype(np.int64), minlength=len(count))
    for entry in words:
        name = entry.column.name
        entry.counts = [(word, int(n)) for word, n in zip(kinds[name], counts[name], strict=True) if n]
    return Summary(result=result, numbers=tuple(numbers), words=tuple(words))


def _count(each: ColumnSummary, stored: dict[str, np.ndarray], leading: tuple[Column, ...]) -> None:
    """Take a chunk into account."""
    values = stored[each.column.name].astype(np.float64)
    finite = np.isfinite(values)
    each.missing += int(len(values) - finite.sum())
    if not finite.any():
        return
    each.finite += int(finite.sum())
    each.total += float(values[finite].sum())
    low, high = int(np.argmin(np.where(finite, values, np.inf))), int(np.argmax(np.where(finite, values, -np.inf)))
    if values[low] < each.least:
        each.least = float(values[low])
        each.least_row = {column.name: column.decoded(stored[column.name][low]).item() for column in leading}
    if values[high] > each.largest:
        each.largest = float(values[high])
        each.largest_row = {column.name: column.decoded(stored[column.name][high]).item() for column in leading}
