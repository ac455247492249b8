"""Processes that a command works in."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

__all__ = ["on_all_cores", "pool"]

MOST = 4
"""More would wait for the longest piece of work."""


@contextlib.contextmanager
def pool(count: int) -> Iterator[ProcessPoolExecutor]:
    """Yield processes that leave Ctrl-C to this one."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(count, mp_context=context, initializer=_ignore_interrupts) as executor:
        yield executor


@contextlib.contextmanager
def on_all_cores() -> Iterator[ProcessPoolExecutor | None]:
    """Yield a process for each core, or ``None`` where there is one core; none outlives an error or Ctrl-C."""
    count = min(os.cpu_count() or 1, MOST)
    if count == 1:
        yield None
        return
    with pool(count) as executor:
        try:
            yield executor
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            for process in multiprocessing.active_children():
                process.terminate()
            raise


def _ignore_interrupts() -> None:
    """Leave Ctrl-C to the process that writes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
