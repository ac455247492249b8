"""Command line ``hrsafety``: reproduce, simulate, read people, design foam, search gains, sweep, judge contacts."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext

from hrsafety.cli import exit_codes, font_cache
from hrsafety.cli.parsers import LAW_NAMES, UsageError, parser
from hrsafety.cli.terminal import styled
from hrsafety.errors import HrsafetyError, InvalidParameterError

__all__ = ["LAW_NAMES", "main"]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    argv : sequence of str or None
        Arguments without the name of the program; those of the process when ``None``.

    Returns
    -------
    int
        0 when done, 2 after an error (one line on stderr says which), 3 when a run ended as ``--fail-on``
        says, ``optimize`` found no gain set that keeps the constraints or a contact exceeds its limits or is not
        permitted, 4 after warnings with ``--strict``, 5 when a contact is not checked or runs with ``--fail-on`` are
        in doubt, 130 after Ctrl-C, 1 when the output was closed early.

    Examples
    --------
    >>> from hrsafety.cli import main
    >>> main(["--version"])
    hrsafety 0.1.0
    0
    """
    try:
        return _run(argv)
    except KeyboardInterrupt:
        return exit_codes.INTERRUPTED
    except BrokenPipeError:
        _forget_output()
        return exit_codes.CLOSED_PIPE
    except HrsafetyError as error:
        return _fail(str(error))
    except OSError as error:
        if error.filename is None:
            _forget_output()  # nothing else is written without a name
        return _fail(f"{error.filename or 'standard output'}: {error.strerror or error}")
    except ModuleNotFoundError as error:
        return _fail(str(error))


def _run(argv: Sequence[str] | None) -> int:
    """Run one command; it may leave with a code of its own, after all that it prints and writes."""
    code: object = exit_codes.DONE
    try:
        options = parser().parse_args(argv)
        font_cache.keep_apart()
        work = _COMMANDS[options.command]
        if isinstance(work, str):
            module, _, name = work.partition(":")
            work = getattr(importlib.import_module(f"hrsafety.cli.{module}"), name)
        work(options)
    except SystemExit as request:
        code = request.code
    sys.stdout.flush()
    return code if isinstance(code, int) else exit_codes.DONE


def _fail(message: str) -> int:
    print(styled(f"hrsafety: error: {' '.join(message.split())}", "red", sys.stderr), file=sys.stderr)
    return exit_codes.ERROR


def _forget_output() -> None:
    """Keep the interpreter from flushing into a closed pipe on its way out."""
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError):
        sys.stdout = None


@contextmanager
def _as_options(*names: str, **others: str) -> Iterator[None]:
    """Give an argument that comes from the command line the name that it has there."""
    options = {name: f"--{name}" for name in names} | others
    try:
        yield
    except InvalidParameterError as error:
        if error.argument not in options:
            raise
        raise error.renamed(options[error.argument]) from None


def _reproduce(options: argparse.Namespace) -> None:
    from hrsafety import reproduce
    from hrsafety.cli import output, workers

    output.planned_folder(options.out)
    output.require_matplotlib("reproduce")
    several = options.only is None or len(options.only) > 1
    with _as_options("only", "out"), workers.on_all_cores() if several else nullcontext() as pool:
        page = reproduce.run(options.out, only=options.only, progress=_progress, executor=pool)
    print(f"summary page  {page}")


def _progress(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _simulate(options: argparse.Namespace) -> None:
    if (options.scenario is None) == (options.people is None):
        raise UsageError("simulate needs either a scenario file or --people FILE.csv (see hrsafety simulate --help)")
    if options.people is not None:
        from hrsafety.cli.people import simulate_people

        with _as_options("step", "runs", "selection"):
            simulate_people(options)
        return
    of_people = ("format", "fps", "step_s", "unit", "scale", "homography", "columns", "classes", "relabel")
    for name in (*of_people, "runs", "selection", "animate_run"):
        if getattr(options, name) not in (None, False):
            raise UsageError(f"--{name.replace('_', '-')} goes with --people only (see hrsafety simulate --help)")
    from hrsafety.cli.one_run import simulate_file

    with _as_options("step"):
        simulate_file(options)


def _judge(options: argparse.Namespace) -> None:
    from hrsafety.cli.judge import judge_log

    names = ("people", "frame", "map", "goal", "moments", "offset", "view", "step")
    with _as_options(
        *names, robot_radius="--radius", person_radius="--person-radius", robot="--robot-frame", end="--time"
    ):
        judge_log(options)


def _people(options: argparse.Namespace) -> None:
    from hrsafety.cli import recordings

    {"info": recordings.show, "convert": recordings.convert}[options.task](options)


def _arm(options: argparse.Namespace) -> None:
    from hrsafety.cli.arm import show_arm

    with _as_options("link", "point", "direction", "samples", "seed"):
        show_arm(options)


_COMMANDS: dict[str, str | Callable[[argparse.Namespace], None]] = {
    "reproduce": _reproduce,
    "simulate": _simulate,
    "people": _people,
    "foam": "foam.command:design_file",
    "optimize": "optimize.command:optimize_file",
    "sweep": "sweep.command:sweep_file",
    "arm": _arm,
    "contact": "cell.command:report_cell",
    "program": "program.command:report_program",
    "judge": _judge,
    "record": "record:judge_records",
    "benchmark": "benchmark:run_suite",
    "arena": "arena:run_arena",
    "ros": "ros:serve_world",
    "play": "play:play_world",
    "init": "init:write_starter",
    "validate": "validate:validate_files",
    "zones": "zones:run_zones",
    "info": "info:print_info",
}
"""Function of each command, or its place where it is loaded only then."""
