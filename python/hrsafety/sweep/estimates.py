"""Cost of a sweep, from some of its rows: size of its files and time."""

from __future__ import annotations

import io
import time
from typing import Literal, NamedTuple

from hrsafety._arguments import thread_count, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.plausibility import ResultWarning, telling
from hrsafety.sweep.chunk_files import STORES, chunk_files
from hrsafety.sweep.chunk_ranges import checked_share
from hrsafety.sweep.chunks import SweepPlan, computed, planned
from hrsafety.sweep.designs import Design, checked_design
from hrsafety.sweep.studies import Study, checked_study

__all__ = ["ADVICE", "SweepEstimate", "estimate", "size_words", "time_words"]

ADVICE = "less with a smaller chunk_rows"
"""Remedy for chunks that take too long."""
# Measured rows are taken in ever larger blocks until that took so long, in s.
_ENOUGH = 0.5
# And until so many were measured, unless that takes too long, in s.
_ENOUGH_ROWS = 1000
_TOO_LONG = 1.0
_GROWTH = 4
# Successive multiples of the golden section spread over the design whatever their number.
_GOLDEN = 0.6180339887498949
# Chunks that take longer than this, in s, are worth a word.
_LONG = 120.0
# Of what tells a chunk from others: a fingerprint and a number.
_MARK_LENGTH = 36


@displayed
@dataclass(frozen=True, slots=True, kw_only=True)
class SweepEstimate:
    """Cost of a sweep.

    Attributes
    ----------
    rows : int
        Rows of the design that are computed.
    chunk_count, chunk_rows : int
        Chunks that are computed, and rows of the design in each.
    store : str
        Files of the chunks.
    bytes : int
        Size of their files.
    seconds : float
        Time in one process.
    measured_rows : int
        Rows that were computed for the estimate.
    warnings : tuple of ResultWarning
        Doubts about design and study, which the result of the sweep will carry.
    """

    rows: int
    chunk_count: int
    chunk_rows: int
    store: str
    bytes: int
    seconds: float
    measured_rows: int
    warnings: tuple[ResultWarning, ...] = ()

    @property
    def chunk_seconds(self) -> float:
        """Time of a chunk in s, which a stop loses at most."""
        return self.seconds / self.chunk_count

    @property
    def is_long(self) -> bool:
        """Whether a chunk takes minutes."""
        return self.chunk_seconds > _LONG

    def __str__(self) -> str:
        """Return the estimate in a line."""
        chunks = "1 chunk" if self.chunk_count == 1 else f"{self.chunk_count:,} chunks"
        more = "" if not self.is_long else f"; a stop loses up to {time_words(self.chunk_seconds)}, {ADVICE}"
        return (
            f"{self.rows:,} rows in {chunks}, about {size_words(self.bytes)} in {self.store} files, about "
            f"{time_words(self.seconds)} of computing in one process ({self.measured_rows:,} rows were measured){more}"
        )


def size_words(size: float) -> str:
    """Return a number of bytes in words."""
    for unit in ("B", "kB", "MB", "GB"):
        if size < 1000.0:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:,.3g} TB"


def time_words(seconds: float) -> str:
    """Return a time in words."""
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:,.1f} {unit}"
    return f"{seconds:.2g} s"


@telling()
def estimate(
    design: Design,
    study: Study,
    *,
    store: Literal["npz", "parquet"] = "npz",
    chunk_rows: int | None = None,
    chunks: range | str | None = None,
    threads: int | None = None,
) -> SweepEstimate:
    """Return what a sweep will take, from a few rows that are computed for it; nothing is written.

    Rows are taken from all over the design, in ever larger blocks, until there are 1,000 and half a second has passed,
    or a second where rows take long; the largest block counts. The first row is computed twice, and only the
    second time counts: the first one in a process loads libraries. Time does not include the disk.

    Parameters
    ----------
    design : Grid, LatinHypercube or Sobol
        Which rows.
    study : ImpactStudy, NavigationStudy, FunctionStudy
        What is computed for each.
    store : {"npz", "parquet"}
        Files of the chunks.
    chunk_rows : int or None
        As of `run`.
    chunks : range, str or None
        As of `run`: what a process of several computes.
    threads : int or None
        Number of threads; all cores when ``None``.

    Returns
    -------
    SweepEstimate
        Rows, chunks, bytes and seconds.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind, or the study does not know an axis.
    MissingExtraError
        If a library is missing that the design or the files need.

    Examples
    --------
    >>> from hrsafety import impact, sweep
    >>> study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    >>> speeds = sweep.Grid([sweep.Axis(name="closing_speed", low=0.2, high=2.0, points=200_000)])
    >>> found = sweep.estimate(speeds, study)
    >>> found.rows, found.chunk_count, found.seconds < 60.0
    (200000, 6, True)
    """
    share = checked_share(chunks)
    word("store", store, tuple(STORES))
    least = 0 if share is None else share.parts
    plan = planned(
        checked_design(design),
        checked_study(study),
        chunk_rows=chunk_rows,
        least_chunks=least,
        threads=thread_count(threads),
    )
    wanted = range(len(plan)) if share is None else share.of(len(plan))
    doubts = plan.doubts()
    # Only the last chunk may have fewer rows.
    rows = len(wanted) * plan.chunk_rows
    if len(plan) - 1 in wanted:
        rows -= len(plan) * plan.chunk_rows - plan.rows
    blocks = _measured(plan, store)
    one, most = blocks[0], blocks[-1]
    each = (most.size - one.size) / max(most.rows - one.rows, 1)
    return SweepEstimate(
        rows=rows,
        chunk_count=len(wanted),
        chunk_rows=plan.chunk_rows,
        store=store,
        bytes=round(rows * each + len(wanted) * (one.size - one.rows * each)),
        seconds=rows * most.seconds / most.rows,
        measured_rows=min(sum(block.rows for block in blocks), plan.rows),
        warnings=doubts,
    )


class _Block(NamedTuple):
    """Rows that were computed, how long it took in s, and the bytes of their file."""

    rows: int
    seconds: float
    size: int


def _measured(plan: SweepPlan, store: str) -> list[_Block]:
    """Return blocks of 1, 4, 16, ... rows, at most a chunk, from all over the design."""
    files = chunk_files(store, plan.task.columns)

    def block(start: int, rows: int) -> _Block:
        before, kept = time.perf_counter(), io.BytesIO()
        files.write(kept, "0" * _MARK_LENGTH, computed(plan.task, start, start + rows))
        return _Block(rows, time.perf_counter() - before, kept.tell())

    block(0, 1)  # loads what the first row of a process loads
    blocks: list[_Block] = []
    rows, begin = 1, time.perf_counter()
    while rows <= plan.chunk_rows:
        blocks.append(block(int((len(blocks) + 1) * _GOLDEN % 1.0 * (plan.rows - rows)), rows))
        passed, measured = time.perf_counter() - begin, sum(each.rows for each in blocks)
        if passed > (_ENOUGH if measured >= _ENOUGH_ROWS else _TOO_LONG):
            break
        rows = min(rows * _GROWTH, plan.chunk_rows) if rows < plan.chunk_rows else plan.chunk_rows + 1
    return blocks
