"""Run a sweep: here, in a pool, or on a cluster; resume after a stop."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy.typing as npt

from hrsafety import __version__
from hrsafety._arguments import count, flag, instance, thread_count, word
from hrsafety._bounds import MOST_TASKS
from hrsafety.errors import InvalidParameterError, MissingExtraError
from hrsafety.plausibility import telling
from hrsafety.sweep import room
from hrsafety.sweep.chunk_files import STORES
from hrsafety.sweep.chunk_ranges import checked_share
from hrsafety.sweep.chunks import SweepPlan, WorkerTask, computed, planned
from hrsafety.sweep.designs import Design, checked_design
from hrsafety.sweep.result import SweepResult
from hrsafety.sweep.storage import MANIFEST, Folder, Memory, SweepError, locked, new_manifest
from hrsafety.sweep.studies import Study, checked_study

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["SweepInterrupted", "SweepWarning", "run"]

Stored = dict[str, npt.NDArray[Any]]
Results = Iterator[tuple[int, Stored]]
Progress = Callable[[int, int], object]

# Each place in flight gets so many chunks by itself, so that workers end at about the same time.
ROUNDS = 2


class SweepInterrupted(KeyboardInterrupt):
    """Ctrl-C stopped a sweep; the message says what is finished and how to resume."""


class SweepWarning(UserWarning):
    """A chunk of a sweep was damaged and is computed again."""


@telling()
def run(
    design: Design,
    study: Study,
    *,
    out: str | os.PathLike[str] | None = None,
    store: Literal["npz", "parquet"] | None = None,
    chunk_rows: int | None = None,
    chunks: range | str | None = None,
    executor: Executor | None = None,
    client: Client | None = None,
    in_flight: int | None = None,
    retries: int = 3,
    threads: int | None = None,
    resume: bool = True,
    progress: Progress | None = None,
) -> SweepResult:
    """Compute a study for every row of a design, chunk by chunk.

    With ``out``, each chunk is written as it finishes, whole or not at all, and the same call
    resumes where the last one stopped, whatever stopped it: finished chunks are neither lost
    nor computed again, and the result is the same bit for bit as without a stop. Chunks whose
    checksum does not fit are computed again with a warning. A folder of another sweep is
    refused. Memory does not grow with the number of rows. Without ``out`` the chunks stay in
    memory.

    Parameters
    ----------
    design : Grid, LatinHypercube or Sobol
        Which rows.
    study : ImpactStudy, NavigationStudy, FunctionStudy
        What is computed for each.
    out : path-like or None
        Folder of the results; made if it does not exist.
    store : {"npz", "parquet"} or None
        Files of the chunks in the folder. Parquet is smaller and other programs read it; it needs
        pyarrow (extra ``sweep``). ``None``: that of the folder, if there is a sweep; else NPZ.
    chunk_rows : int or None
        Rows of the design in a chunk. ``None``: those of the folder, if there is a sweep; else
        about 4 MB of results and at most 65536, fewer where that leaves workers idle. Make it
        small when rows take long.
    chunks : range, str or None
        Which chunks are computed, so that several processes write into one folder:
        ``range(0, 8)`` or ``"0:8"`` by their numbers, ``"2/16"`` the second of sixteen equal
        parts; all when ``None``. Chunks that another process writes are refused.
    executor : concurrent.futures.Executor or None
        Where chunks are computed, for example a ``ProcessPoolExecutor``; here when ``None``.
        Design and study are pickled for other processes.
    client : distributed.Client or None
        A client of a Dask cluster, instead of an executor. A chunk whose worker dies is
        computed by another one.
    in_flight : int or None
        Most chunks that an executor or a cluster has at the same time; twice the number of
        cores, or of the threads of the cluster, when ``None``.
    retries : int
        How often a cluster tries a chunk again that failed.
    threads : int or None
        Threads of each chunk. ``None``: all cores here; one with an executor or a client, whose
        workers share the cores. Never changes a bit of the result.
    resume : bool
        Whether a sweep that is in the folder may be resumed.
    progress : callable or None
        Called with (rows of the design done, rows in all) at the start and after each chunk.

    Returns
    -------
    SweepResult
        All columns, lazily read from the folder.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind, the study does not know an axis, or the results do not fit into the
        memory, or with ``out`` on the disk.
    SweepError
        If the folder holds another sweep, another process writes into it, a pool broke, or a function of the study
        raised an error, which is the cause.
    SweepInterrupted
        After Ctrl-C; a `KeyboardInterrupt` whose message says how to resume.
    MissingExtraError
        If a library is missing that the design or the client needs.

    Examples
    --------
    >>> from hrsafety import impact, sweep
    >>> design = sweep.Grid([
    ...     sweep.Axis(name="foam_stiffness", low=5e3, high=60e3, points=12),
    ...     sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=4),
    ... ])
    >>> study = sweep.ImpactStudy(
    ...     manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25}
    ... )
    >>> result = sweep.run(design, study, out="foams")
    >>> len(result), result.units["peak_contact_force"]
    (48, 'N')
    """
    checked_design(design)
    checked_study(study)
    share = checked_share(chunks)
    if store is not None:
        word("store", store, tuple(STORES))
    if executor is not None and client is not None:
        raise InvalidParameterError("client", "be None when there is an executor", client)
    if executor is not None:
        instance("executor", executor, Executor)
    if client is not None:
        _check_client(client)
    if in_flight is not None:
        count("in_flight", in_flight, most=MOST_TASKS)
    count("retries", retries, least=0, most=MOST_TASKS)
    thread_count(threads)
    if progress is not None and not callable(progress):
        raise InvalidParameterError("progress", "be callable or None", progress)
    flag("resume", resume)
    path = _folder_path(out)
    for name, given in (("store", store), ("chunks", chunks)):
        if path is None and given is not None:
            raise InvalidParameterError(name, "be None without a folder (out)", given)
    if chunk_rows is None and path is not None and resume and (path / MANIFEST).is_file():
        chunk_rows = Folder(path).manifest["settings"].get("chunk_rows")
    own = threads if threads is not None or (executor is None and client is None) else 1
    most = in_flight or _most_in_flight(executor, client)
    # Processes that share a folder cut the sweep alike, whatever each of them has of workers.
    least = ROUNDS * most if share is None else share.parts
    plan = planned(design, study, chunk_rows=chunk_rows, least_chunks=least, threads=own)
    wanted = range(len(plan)) if share is None else share.of(len(plan))
    if path is None:
        room.check_memory(plan)
    elif not (path / MANIFEST).is_file():
        room.check_disk(plan, wanted, path, store or "npz")
    manifest = new_manifest(plan.settings(__version__), study.judged(design), store)
    with contextlib.nullcontext() if path is None else locked(path, None if share is None else wanted):
        kept = Memory(manifest) if path is None else Folder.prepared(path, manifest, resume=resume, store=store)
        missing = _missing(wanted, kept)
        if isinstance(kept, Folder):
            room.check_disk(plan, missing, kept.path, kept.files.name)
        report = _Report(plan, wanted, missing, progress)
        if executor is not None:
            results = _pooled(plan, missing, executor, most)
        elif client is not None:
            results = _distributed(plan, missing, client, most, retries)
        else:
            results = _here(plan, missing)
        with _kept(report, path):
            report.show()
            for index, columns in results:
                kept.write(index, columns)
                report.finished(index)
    return SweepResult(kept)


def _most_in_flight(executor: Executor | None, client: Any) -> int:
    """Return how many chunks keep all workers busy while results are written; 0 without workers."""
    if executor is not None:
        return 2 * (os.cpu_count() or 1)
    return 0 if client is None else 2 * max(sum(client.nthreads().values()), 1)


def _folder_path(out: object) -> Path | None:
    if out is None:
        return None
    if not isinstance(out, (str, os.PathLike)) or not isinstance(os.fspath(out), str) or not os.fspath(out):
        raise InvalidParameterError("out", "be the path of a folder or None", out)
    return Path(os.fspath(out))


def _missing(wanted: range, store: Folder | Memory) -> list[int]:
    """Return the chunks that are to be computed, after a look at those that are there."""
    if isinstance(store, Memory):
        return list(wanted)
    store.clear_leftovers(wanted)
    whole = set()
    for index in store.finished():
        if index not in wanted:
            continue
        if store.damaged(index):
            text = f"{store.file(index)} is damaged and is computed again"
            warnings.warn(text, SweepWarning, stacklevel=3)
        else:
            whole.add(index)
    return [index for index in wanted if index not in whole]


class _Report:
    """Progress of a sweep: finished rows, and the callback that is notified."""

    def __init__(self, plan: SweepPlan, wanted: range, missing: Iterable[int], progress: Progress | None) -> None:
        self._plan, self._progress = plan, progress
        self._all = sum(stop - start for start, stop in map(plan.span, wanted))
        self._left = sum(stop - start for start, stop in map(plan.span, missing))

    @property
    def done(self) -> int:
        """Rows that are finished."""
        return self._all - self._left

    @property
    def total(self) -> int:
        """Rows of the chunks that are wanted."""
        return self._all

    def show(self) -> None:
        """Tell whoever listens."""
        if self._progress is not None:
            self._progress(self.done, self.total)

    def finished(self, index: int) -> None:
        """Count a chunk and tell."""
        start, stop = self._plan.span(index)
        self._left -= stop - start
        self.show()


@contextlib.contextmanager
def _kept(report: _Report, path: Path | None) -> Iterator[None]:
    """Turn what can stop a sweep into words that say what is left of it."""
    rows = f"{report.total} rows"
    try:
        yield
    except KeyboardInterrupt:
        left = f"they are in {path}, the same call resumes" if path else "they are lost without a folder (out)"
        raise SweepInterrupted(f"sweep stopped with {report.done} of {rows} finished; {left}") from None
    except BrokenExecutor as error:
        left = f"{report.done} of {rows} are in {path}, the same call resumes" if path else "nothing was kept"
        raise SweepError(f"the pool broke ({error}); {left}") from error


def _here(plan: SweepPlan, missing: Iterable[int]) -> Results:
    """Yield the chunks, computed one after the other."""
    for index in missing:
        yield index, _chunk(plan.task, *plan.span(index))


def _pooled(plan: SweepPlan, missing: Iterable[int], executor: Executor, most: int) -> Results:
    """Yield chunks as a pool finishes them, never more than ``most`` in flight."""
    waiting = iter(missing)
    pending: dict[Future[Stored], int] = {}
    try:
        while True:
            for index in _some(waiting, most - len(pending)):
                pending[executor.submit(_chunk, plan.task, *plan.span(index))] = index
            if not pending:
                return
            done, _ = wait(pending, return_when=FIRST_COMPLETED)
            for future in done:
                yield pending.pop(future), future.result()
    finally:
        for future in pending:
            future.cancel()


def _distributed(plan: SweepPlan, missing: Iterable[int], client: Any, most: int, retries: int) -> Results:
    """Yield chunks as a Dask cluster finishes them."""
    from distributed import as_completed as untyped

    as_completed: Any = untyped
    waiting = iter(missing)
    pending: dict[Any, int] = {}

    def submit(index: int) -> Any:
        start, stop = plan.span(index)
        future = client.submit(_chunk, plan.task, start, stop, retries=retries, pure=False)
        pending[future] = index
        return future

    try:
        first = [submit(index) for index in _some(waiting, most)]
        # The loop is named, because the client need not be the default one of the process.
        completed: Any = as_completed(first, loop=client.loop) if first else ()
        for future in completed:
            # Taken out at once: what a future holds lives on the cluster as long as the future.
            columns, index = future.result(), pending.pop(future)
            future.release()
            for following in _some(waiting, 1):
                completed.add(submit(following))
            yield index, columns
    finally:
        if pending:
            client.cancel(list(pending))


def _some(waiting: Iterator[int], most: int) -> Iterator[int]:
    """Yield at most so many of the chunks that wait."""
    for _ in range(most):
        try:
            yield next(waiting)
        except StopIteration:
            return


def _chunk(task: WorkerTask, start: int, stop: int) -> Stored:
    """Compute a chunk; an error says in which rows it happened."""
    try:
        return computed(task, start, stop)
    except Exception as error:
        error.add_note(f"in rows {start} to {stop - 1} of the sweep")
        raise


def _check_client(client: object) -> None:
    """Raise unless the value is a client of a cluster that answers when it is asked."""
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise MissingExtraError('a cluster needs dask.distributed: pip install "dask[distributed]"') from None
    if not isinstance(client, Client):
        raise InvalidParameterError("client", "be a distributed.Client or None", client)
    if client.asynchronous:
        raise InvalidParameterError("client", "not be an asynchronous one", client)
