"""``hrsafety sweep STUDY.toml``: run a sweep or resume it, and show what came out."""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hrsafety import sweep
from hrsafety.cli import output, progress, terminal, workers
from hrsafety.cli.sweep import report as sweep_report
from hrsafety.cli.sweep.file import SweepFile, load
from hrsafety.cli.sweep.pictures import make
from hrsafety.errors import InvalidParameterError, MissingExtraError
from hrsafety.sweep.estimates import ADVICE, size_words, time_words
from hrsafety.sweep.exports import require_polars
from hrsafety.sweep.room import free_space

__all__ = ["sweep_file"]

_FORMATS = (".parquet", ".npz", ".csv")
# Arguments of a run that options give, and no key of the file.
_OPTIONS = ("threads", "store", "chunks", "out")


def sweep_file(options: argparse.Namespace) -> None:
    """Run the sweep of a file, or what is left of it, and write the page.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety sweep``.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C, when it was said what is finished.
    """
    if not options.dry_run:
        output.planned_folder(options.out)
        output.require_page("sweep")
    output.check_json(options)
    if options.table is not None and output.target("--table", options.table, _FORMATS).suffix.lower() == ".parquet":
        require_polars()  # before the work begins
    if options.workers is not None and options.workers < 1:
        raise InvalidParameterError("--workers", "be at least 1", options.workers)
    if options.workers is not None and options.scheduler is not None:
        raise InvalidParameterError("--workers", "not be given with --scheduler", options.workers)
    with output.located(options.study):
        described = _described(options)
        if options.dry_run:
            found = _estimated(options, described)
            print("\n".join(_expected(options, described, found)))
            output.report_warnings(output.warnings_of(found), options.strict)
            return
        begin = time.perf_counter()
        result = _run(options, described)
    if options.chunks is not None and not result.complete:
        print(_share_words(options, result))
        return
    report = sweep_report.report_of(options.study, described, result, time.perf_counter() - begin)
    print(terminal.told(report))
    place = output.folder(options.out)
    tables = []
    if options.table is not None:
        target = Path(options.table)
        target.parent.mkdir(parents=True, exist_ok=True)
        write = {".parquet": result.to_parquet, ".npz": result.to_npz, ".csv": result.to_csv}
        tables = [write[target.suffix.lower()](target)]
    written = output.write_report(report, place, make(result, described.show), tables)
    output.say_written(written, report, options)
    output.report_warnings(output.warnings_of(report), options.strict)


def _described(options: argparse.Namespace) -> SweepFile:
    """Return what the file describes, with the columns that are asked for."""
    if options.outputs is None:
        return load(options.study)
    try:
        return load(options.study, tuple(name.strip() for name in options.outputs.split(",")))
    except InvalidParameterError as error:
        raise error.renamed("--outputs") if error.argument == "outputs" else error from None


def _estimated(options: argparse.Namespace, described: SweepFile) -> sweep.SweepEstimate:
    """Return what the sweep will take."""
    try:
        return sweep.estimate(
            described.design,
            described.study,
            store=options.store or "npz",
            chunk_rows=described.chunk_rows,
            chunks=options.chunks,
            threads=options.threads,
        )
    except InvalidParameterError as error:
        raise error.renamed(f"--{error.argument}") if error.argument in _OPTIONS else error from None


def _expected(options: argparse.Namespace, described: SweepFile, found: sweep.SweepEstimate) -> Iterator[str]:
    """Yield what the sweep will take, in lines."""
    cases = described.study.cases
    each = 1 if cases is None else len(cases.words)
    columns = described.study.columns()
    yield f"study    {options.study}"
    yield f"rows     {found.rows * each:,} of {len(columns)} columns besides the axes"
    yield f"chunks   {found.chunk_count:,} of at most {found.chunk_rows * each:,} rows"
    yield f"size     about {size_words(found.bytes)} in {found.store} files"
    measured = f"{found.measured_rows * each:,} measured rows"
    yield f"time     about {time_words(found.seconds)} of computing in one process, from {measured}"
    free = free_space(Path(options.out))
    if found.bytes > free:
        yield f"room     {size_words(free)} are free at {options.out}: the sweep would be refused"
    if found.is_long:
        yield f"stop     loses up to {time_words(found.chunk_seconds)}, {ADVICE}"


def _share_words(options: argparse.Namespace, result: sweep.SweepResult) -> str:
    """Return what is there when other processes are to compute the rest."""
    there = f"{len(result.finished):,} of {result.chunk_count:,} chunks are in {options.out}"
    page = "the same command without --chunks writes the page when all are there"
    return f"chunks   {options.chunks} finished; {there}\n{page}"


def _run(options: argparse.Namespace, described: SweepFile) -> sweep.SweepResult:
    """Run with live progress; damage that was repaired and a stop are told in a line each."""
    with progress.live() as shown, _workers(options) as where, warnings.catch_warnings():
        warnings.simplefilter("always", sweep.SweepWarning)
        warnings.showwarning = _tell
        try:
            return sweep.run(
                described.design,
                described.study,
                out=options.out,
                store=options.store,
                chunks=options.chunks,
                chunk_rows=described.chunk_rows,
                threads=options.threads,
                progress=None if shown is None else lambda done, total: shown("rows", done, total, None),
                **where,
            )
        except InvalidParameterError as error:
            raise error.renamed(f"--{error.argument}") if error.argument in _OPTIONS else error from None
        except sweep.SweepInterrupted as stop:
            print(f"hrsafety: {stop}", file=sys.stderr, flush=True)
            raise


def _tell(message: Warning | str, *_where: Any, **_more: Any) -> None:
    print(f"hrsafety: {message}", file=sys.stderr, flush=True)


@contextlib.contextmanager
def _workers(options: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Yield where chunks are computed, as arguments of a run."""
    if options.workers is not None:
        with workers.pool(options.workers) as pool:
            yield {"executor": pool}
    elif options.scheduler is not None:
        try:
            from distributed import Client
        except ModuleNotFoundError:
            raise MissingExtraError('--scheduler needs dask.distributed: pip install "dask[distributed]"') from None
        connect: Any = Client
        try:
            client = connect(options.scheduler, set_as_default=False)
        except (OSError, ValueError) as error:
            requirement = f"be the address of a Dask scheduler that answers ({error})"
            raise InvalidParameterError("--scheduler", requirement, options.scheduler) from None
        with client:
            yield {"client": client}
    else:
        yield {}
