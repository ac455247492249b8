"""How often each word of a column occurs in groups of the rows of a sweep, with intervals."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import field
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, sequence, word
from hrsafety._bounds import MOST_TABLE_ROWS
from hrsafety._records import dataclass
from hrsafety._statistics import wilson
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Axis, Column
from hrsafety.sweep.designs import Design, Grid
from hrsafety.sweep.exports import Stored
from hrsafety.sweep.sampled_designs import Saltelli
from hrsafety.tables import Columns, Table

__all__ = ["SEED", "SweepShares", "counted", "levels_of"]

SEED = "seed"
"""Axis whose levels are draws."""
_OWN = ("count", "rows", "share", "low", "high")
_COUNTS = ("none", "some")
_TELLING = ("end_time", "path_length", "min_clearance")
"""Columns that are equal, all of them, in rows that are the same run."""
MOST_COMPARED = 1_000_000
"""Rows that are looked at for runs that stand there more than once: the first ones."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class SweepShares(Table):
    """Shares of the words of a column in groups of rows, with 95 % Wilson intervals: one group and word a row.

    An interval takes the rows of its group as drawn independently of each other: it is that of the draws of a ``seed``
    or of a sampled design. Levels of a grid are no draws.

    Attributes
    ----------
    name : str
        The column that was counted.
    by : tuple of str
        The columns that make the groups; all rows are one group without any.
    group : mapping of str to ndarray, shape (n,)
        Values of these columns.
    word : ndarray of str, shape (n,)
        What was counted: every word of the column, whether it occurs or not; ``"no"`` and ``"yes"`` of flags,
        ``"none"`` and ``"some"`` (at least one) of counts.
    count, rows : ndarray of int, shape (n,)
        In how many of how many rows of the group.
    share, low, high : ndarray, shape (n,)
        The share and its interval, from 0 to 1. Of a group without rows, of which nothing is known, NaN, 0 and 1.
    warnings : tuple of ResultWarning
        Those of the sweep, and ``same_runs`` and ``repeated_seeds`` where the intervals count one draw as many, as is
        seen in the first million rows.
    """

    name: str
    by: tuple[str, ...]
    group: Mapping[str, npt.NDArray[Any]]
    word: npt.NDArray[np.str_]
    count: npt.NDArray[np.int64]
    rows: npt.NDArray[np.int64]
    share: Array
    low: Array
    high: Array
    warnings: tuple[ResultWarning, ...] = field(default=())

    def _telling(self) -> tuple[str, ...]:
        return (*self.by[:4], self.name, "share", "low", "high")  # as many as are printed

    def columns(self) -> Columns:
        """Return the columns by name: those of the groups, the word, count, rows, share, low and high."""
        return {**self.group, self.name: self.word, **{name: getattr(self, name) for name in _OWN}}


def levels_of(axis: Axis, design: Design, most: int) -> npt.NDArray[np.float64] | None:
    """Return the values that an axis has in a design; ``None`` where they are no levels, or more than ``most``."""
    sampled = not isinstance(design, Grid)
    if sampled and axis.values is None and axis.scale != "integer":
        return None
    # A sample of whole numbers has all of them, whatever points a grid would have.
    whole = Axis(name=axis.name, low=axis.low, high=axis.high, scale="integer") if sampled and not axis.values else axis
    size = whole.size or 0
    return np.unique(whole.levels()) if size <= most else None


def counted(result: Stored, name: object, by: object) -> SweepShares:
    """Return the shares of a column in groups of rows, see `SweepResult.shares`."""
    column = _counted_column(result, name)
    names = tuple(sequence("by", "be names of axes or the column of the cases", by))
    kinds = [_kind_of_group(result, each, column.name) for each in names]
    if len(set(names)) != len(names):
        raise InvalidParameterError("by", "be different names", names)
    words = column.words or (("no", "yes") if column.kind == "flag" else _COUNTS)
    shape = tuple(len(each) for each in kinds)
    groups = int(np.prod(shape, dtype=np.float64))
    if groups * len(words) > MOST_TABLE_ROWS:
        rule = f"make at most {MOST_TABLE_ROWS} rows of groups and words"
        raise InvalidParameterError("by", rule, Shown(f"{groups * len(words)} of {', '.join(names)}"))
    counts = np.zeros((groups, len(words)), dtype=np.int64)
    repeats = _Repeats(result)
    leading = result.selected((column.name, *names))
    for stored in result.stored_chunks((*leading, *repeats.columns(leading))):
        place = _places(stored, names, kinds, shape)
        counts += np.bincount(place * len(words) + _codes(column, stored[column.name]), minlength=counts.size).reshape(
            counts.shape
        )
        repeats.add(place, stored)
    index = np.unravel_index(np.repeat(np.arange(groups), len(words)), shape) if names else ()
    rows = np.repeat(counts.sum(axis=1), len(words))
    found = [_interval(*each) for each in zip(counts.ravel().tolist(), rows.tolist(), strict=True)]
    share, low, high = np.array(found, dtype=np.float64).reshape(-1, 3).T
    return SweepShares(
        name=column.name,
        by=names,
        group={each: kind[at] for each, kind, at in zip(names, kinds, index, strict=True)},
        word=np.tile(np.array(words), groups),
        count=counts.ravel(),
        rows=rows,
        share=share,
        low=low,
        high=high,
        warnings=(*result.warnings, *repeats.doubts(names)),
    )


def _interval(count: int, rows: int) -> tuple[float, float, float]:
    if not rows:
        return (np.nan, 0.0, 1.0)
    found = wilson(count, rows)
    return (found.value, found.low, found.high)


def _counted_column(result: Stored, name: object) -> Column:
    """Return the column that is counted, which has words, flags or counts."""
    known = [each.name for each in result.found if each.kind != "number"]
    if isinstance(name, str) and any(each.name == name for each in result.found if each.kind == "number"):
        rule = f"be a column of words, flags or counts ({', '.join(known) or 'there is none'})"
        remedy = f"compare its numbers with a bound: (result[{name!r}] > bound).mean()"
        raise InvalidParameterError("name", rule, name, remedy)
    (column,) = result.selected([word("name", name, known)])
    if column.name in _OWN:
        raise InvalidParameterError("name", f"not be that of a column of the table ({', '.join(_OWN)})", name)
    return column


def _codes(column: Column, values: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
    """Return the numbers of the words of some rows."""
    if column.kind != "integer":
        return values.astype(np.int64)
    if values.min(initial=0) < 0:
        rule = "be a column of counts, none of them below 0"
        raise InvalidParameterError("name", rule, Shown(f"{column.name} with {values.min()}"))
    return (values > 0).astype(np.int64)


def _kind_of_group(result: Stored, name: object, counted: str) -> npt.NDArray[Any]:
    """Return the values that tell the groups of a column apart."""
    leading = result.columns[: len(result.columns) - len(result.found)]
    chosen = word("by", name, [each.name for each in leading])
    if chosen in (*_OWN, counted):
        rule = f"not have the name of another column of the table ({', '.join((counted, *_OWN))})"
        raise InvalidParameterError("by", rule, chosen)
    axis = next((each for each in result.axes if each.name == chosen), None)
    if axis is None:
        return np.array(result.cases)
    levels = levels_of(axis, result.design, MOST_TABLE_ROWS)
    if levels is None:
        rule = "name axes with levels: of a grid, or with values or whole numbers in a sample"
        remedy = "give the axis values, or put its rows into bands yourself, for example with numpy.digitize"
        raise InvalidParameterError("by", rule, chosen, remedy)
    return levels


def _places(
    stored: Mapping[str, npt.NDArray[Any]],
    names: tuple[str, ...],
    kinds: list[npt.NDArray[Any]],
    shape: tuple[int, ...],
) -> npt.NDArray[np.int64]:
    """Return the group of each row of a chunk."""
    if not names:
        return np.zeros(len(next(iter(stored.values()))), dtype=np.int64)
    # Words are stored as their numbers, and a value of an axis is one of its levels, bit for bit.
    at = [
        stored[name].astype(np.int64) if kind.dtype.kind == "U" else np.searchsorted(kind, stored[name])
        for name, kind in zip(names, kinds, strict=True)
    ]
    return np.asarray(np.ravel_multi_index(at, shape), dtype=np.int64)


class _Repeats:
    """Looks for rows of a group that are one run, or hang on one draw, among the first rows."""

    def __init__(self, result: Stored) -> None:
        self._result = result
        found = [each.name for each in result.found]
        self._telling = _TELLING if set(_TELLING) <= set(found) else ()
        self._seeded = SEED in result.design.names
        # Rows of one draw follow each other: the cases, and of a Saltelli design those with numbers from one base row.
        self._based = isinstance(result.design, Saltelli) and not self._seeded
        self._together = max(len(result.cases), 1) * (len(result.axes) + 2 if self._based else 1)
        self._groups: list[npt.NDArray[np.int64]] = []
        self._draws: list[Array] = []
        self._runs: list[Array] = []
        self._looked_at = 0

    def columns(self, given: Collection[Column]) -> tuple[Column, ...]:
        """Return the columns that are needed beside those that are read anyway."""
        wanted = (*self._telling, *([SEED] if self._seeded else []))
        return tuple(each for each in self._result.selected(wanted) if each not in given)

    def add(self, place: npt.NDArray[np.int64], stored: Mapping[str, npt.NDArray[Any]]) -> None:
        """Remember the rows of a chunk."""
        left = MOST_COMPARED - self._looked_at
        if left <= 0:
            return
        self._groups.append(place[:left])
        draws = stored[SEED] if self._seeded else (self._looked_at + np.arange(len(place))) // self._together
        self._draws.append(draws[:left].astype(np.float64))
        if self._telling:
            self._runs.append(np.stack([stored[name][:left] for name in self._telling], axis=1))
        self._looked_at += len(self._groups[-1])

    def doubts(self, by: tuple[str, ...]) -> Iterator[ResultWarning]:
        """Yield what makes the intervals too narrow."""
        if not self._looked_at:
            return
        group = np.concatenate(self._groups)
        of = f"of {'the first ' if len(self._result) > len(group) else ''}{len(group)} rows"
        known = {each.code for each in self._result.warnings}
        if self._runs and "same_runs" not in known:
            runs = np.concatenate(self._runs).view(np.int64)
            again = len(group) - _different(group, *runs.T)
            if again:
                message = (
                    f"{again} {of} are the same run as another one of their group, to the last bit of "
                    f"{', '.join(self._telling)}: what varies there changes nothing in them, and shares and intervals "
                    "count one run as many"
                )
                yield ResultWarning("same_runs", "by", message)
        draws = np.concatenate(self._draws)
        again = len(group) - _different(group, draws.view(np.int64))
        if again:
            yield ResultWarning("repeated_seeds", "by", self._repeated(by, f"{again} {of}"))

    def _repeated(self, by: tuple[str, ...], rows: str) -> str:
        levels = {
            each.name: levels_of(each, self._result.design, MOST_TABLE_ROWS)
            for each in self._result.axes
            if each.name != SEED
        }
        pooled = [name for name, values in levels.items() if values is not None and len(values) > 1]
        if len(self._result.cases) > 1:
            pooled.append(self._result.columns[len(levels) + self._seeded].name)
        pooled = [name for name in pooled if name not in by]
        what = "seed" if self._seeded else "base row" if self._based else "row of the design"
        remedy = f"group by {' and '.join(pooled)}, too" if pooled else f"give each row a {SEED} of its own"
        remedy = "take a Sobol design or a Latin hypercube for shares" if self._based else remedy
        return (
            f"{rows} have the {what} of another one of their group: runs of one {what} are alike, and "
            f"intervals that count each of them may be too narrow; {remedy}"
        )


def _different(*keys: npt.NDArray[np.int64]) -> int:
    """Return how many rows of some columns differ from each other."""
    order = np.lexsort(keys)
    changed = np.zeros(len(order) - 1, dtype=np.bool_)
    for key in keys:
        changed |= np.diff(key[order]) != 0
    return 1 + int(changed.sum())
