"""A sweep as a plan of chunks, and the computation of one of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import count
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Column
from hrsafety.sweep.designs import Design
from hrsafety.sweep.identity import described, digest
from hrsafety.sweep.studies import Study

__all__ = ["SweepPlan", "WorkerTask", "computed", "planned"]

MOST_CHUNK_ROWS = 65536
# Smaller chunks by themselves would cost more than they spread.
LEAST_CHUNK_ROWS = 16
# Size of a chunk by itself, in bytes.
CHUNK_BYTES = 1 << 22


@dataclass(frozen=True, slots=True)
class WorkerTask:
    """Task of a worker, enough to compute any chunk.

    Attributes
    ----------
    design : Design
        With units.
    study : Study
        What is computed.
    columns : tuple of Column
        All columns: axes, cases, what is found.
    threads : int or None
        Threads of one chunk.
    """

    design: Design
    study: Study
    columns: tuple[Column, ...]
    threads: int | None


@dataclass(frozen=True, slots=True)
class SweepPlan:
    """A sweep, divided into chunks.

    Attributes
    ----------
    task : Task
        What a worker needs.
    chunk_rows : int
        Rows of the design in a chunk; the last one may have fewer.
    """

    task: WorkerTask
    chunk_rows: int

    @property
    def rows(self) -> int:
        """Number of rows of the design."""
        return len(self.task.design)

    def __len__(self) -> int:
        """Return the number of chunks."""
        return -(-self.rows // self.chunk_rows)

    def doubts(self) -> tuple[ResultWarning, ...]:
        """Return the doubts of design and study before anything runs."""
        design = self.task.design
        return (*design.warnings, *self.task.study.judged(design))

    def span(self, index: int) -> tuple[int, int]:
        """Return first row and end of a chunk."""
        start = index * self.chunk_rows
        return start, min(start + self.chunk_rows, self.rows)

    def settings(self, version: str) -> dict[str, Any]:
        """Return everything that tells this sweep from others."""
        design = self.task.design
        ends = [design.rows(0, min(8, len(design))), design.rows(max(len(design) - 8, 0), len(design))]
        found: dict[str, Any] = {
            "version": version,
            "design": {**design.settings(), "sample": digest(described([end.ravel() for end in ends]))},
            "study": self.task.study.settings(),
            "cases": described(self.task.study.cases),
            "columns": [column.settings() for column in self.task.columns],
            "chunk_rows": self.chunk_rows,
        }
        return found


def planned(
    design: Design, study: Study, *, chunk_rows: int | None, least_chunks: int, threads: int | None
) -> SweepPlan:
    """Return the plan of a sweep.

    Parameters
    ----------
    design : Design
        Which rows.
    study : Study
        What is computed.
    chunk_rows : int or None
        Rows of the design in a chunk; about 4 MB when ``None``, or less for ``least_chunks``.
    least_chunks : int
        Chunks that are wanted at least, as long as they have some rows.
    threads : int or None
        Threads of one chunk.

    Returns
    -------
    Plan
        Checked: the study knows the axes and gives no column twice.

    Raises
    ------
    InvalidParameterError
        If an axis or a column is unsuitable.
    """
    design = design.with_units(study.units(design.names))
    cases = study.cases
    columns = [Column(name=axis.name, unit=axis.unit or "") for axis in design.axes]
    if cases is not None:
        columns.append(Column(name=cases.name, kind="word", words=cases.words))
    columns += study.columns()
    names = [column.name for column in columns]
    for name in names:
        if names.count(name) > 1:
            raise InvalidParameterError("columns", "have different names from each other and from the axes", name)
    if chunk_rows is None:
        row_bytes = sum(column.stored.itemsize for column in columns) * (1 if cases is None else len(cases.words))
        chunk_rows = max(1, min(MOST_CHUNK_ROWS, CHUNK_BYTES // row_bytes))
        if least_chunks:
            chunk_rows = min(chunk_rows, max(-(-len(design) // least_chunks), LEAST_CHUNK_ROWS))
    return SweepPlan(
        WorkerTask(design, study, tuple(columns), threads), min(count("chunk_rows", chunk_rows), len(design))
    )


def computed(task: WorkerTask, start: int, stop: int) -> dict[str, npt.NDArray[Any]]:
    """Return the columns of some rows of a sweep, as they are stored.

    Parameters
    ----------
    task : Task
        The sweep.
    start, stop : int
        Rows of its design.

    Returns
    -------
    dict of str to ndarray
        By name, of one length.
    """
    rows = np.ascontiguousarray(task.design.rows(start, stop).T)
    axes = dict(zip(task.design.names, rows, strict=True))
    cases = task.study.cases
    each = 1 if cases is None else len(cases.words)
    total = (stop - start) * each
    found: Mapping[str, Any] = task.study.compute(dict(axes), task.threads)
    stored = {}
    for column in task.columns:
        if column.name in axes:
            stored[column.name] = np.repeat(axes[column.name], each)
        elif cases is not None and column.name == cases.name:
            stored[column.name] = np.tile(np.arange(each, dtype=column.stored), stop - start)
        else:
            stored[column.name] = column.encoded(found[column.name], total)
    return stored
