"""Room for the results of a sweep, in memory or on the disk: what does not fit is refused before it begins."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sized
from pathlib import Path

from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.sweep.chunks import SweepPlan
from hrsafety.sweep.estimates import estimate, size_words

__all__ = ["check_disk", "check_memory", "free_space"]

# Of a system that does not tell its memory.
USUAL_MEMORY = 16 * 2**30
_FEWER = "keep fewer columns with outputs= of the study"


def check_memory(plan: SweepPlan) -> None:
    """Raise if the columns of a sweep do not fit into the memory of this machine.

    Parameters
    ----------
    plan : SweepPlan
        The sweep.

    Raises
    ------
    InvalidParameterError
        With the size and the remedy.
    """
    size, there = _stored_bytes(plan, len(plan)), _memory()
    if size > there:
        rule = f"be a folder for results of about {size_words(size)}: this machine has {size_words(there)} of memory"
        remedy = f"give out=, of which chunks= computes parts, or {_FEWER}"
        raise InvalidParameterError("out", rule, Shown("nothing"), remedy)


def check_disk(plan: SweepPlan, chunks: Sized, path: Path, store: str) -> None:
    """Raise if the files of chunks do not fit into the free space of the file system of a folder.

    Parameters
    ----------
    plan : SweepPlan
        The sweep.
    chunks : sized
        Those that are to be written.
    path : Path
        The folder; it need not exist.
    store : str
        Kind of the files: what Parquet saves is measured where it matters.

    Raises
    ------
    InvalidParameterError
        With both numbers and the remedy.
    """
    size, free = _stored_bytes(plan, len(chunks)), free_space(path)
    if size > free and store != "npz":
        task = plan.task
        whole = estimate(task.design, task.study, store="parquet", chunk_rows=plan.chunk_rows, threads=task.threads)
        size = round(whole.bytes * len(chunks) / len(plan))
    if size > free:
        rule = f"have room for about {size_words(size)} of results"
        remedy = f"choose a folder on a larger disk, {_FEWER}, or take parts with chunks="
        raise InvalidParameterError("out", rule, Shown(f"{size_words(free)} free at {path}"), remedy)


def free_space(path: Path) -> int:
    """Return the free bytes of the file system on which a folder lies or would lie."""
    place = path.absolute()
    while not place.exists():
        place = place.parent
    return shutil.disk_usage(place).free


def _stored_bytes(plan: SweepPlan, chunks: int) -> int:
    """Return the size of the columns of so many chunks, which NPZ files hold as they are."""
    cases = plan.task.study.cases
    each = sum(column.stored.itemsize for column in plan.task.columns) * (1 if cases is None else len(cases.words))
    return each * min(chunks * plan.chunk_rows, plan.rows)


def _memory() -> int:
    """Return the memory of this machine in bytes."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):  # not on Windows
        return USUAL_MEMORY
