"""``hrsafety benchmark SUITE``: run laws through a fixed protocol and show the shares."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from hrsafety import navigation as nav
from hrsafety._replay import PlayerPage
from hrsafety.benchmarks import SUITES, Result, benchmark, entry
from hrsafety.benchmarks.results import HEAD, NAMES
from hrsafety.benchmarks.runs import case_of
from hrsafety.cli import output, progress, terminal
from hrsafety.errors import InvalidParameterError
from hrsafety.pages import Picture
from hrsafety.pages.report import Report, ReportTable, Section

__all__ = ["run_suite"]

OPTIONS = {
    name: f"--{name.replace('_', '-')}" for name in ("laws", "cases", "data", "out", "person_speed", "noise", "latency")
}


def run_suite(options: argparse.Namespace) -> None:
    """Run a suite, print its table, and write rows, table and page into a folder.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety benchmark``.
    """
    output.check_targets(options)
    place = None if options.out is None else Path(options.out)
    try:
        with progress.live() as shown:
            result = benchmark(
                options.suite,
                options.laws,
                cases=options.cases,
                person_speed=options.person_speed,
                seed=options.seed,
                data=options.data,
                out=place,
                threads=options.threads,
                noise=options.noise,
                latency=options.latency,
                progress=None if shown is None else lambda done, total: shown("episodes", done, total, None),
            )
    except InvalidParameterError as error:
        name = OPTIONS.get(error.argument)
        raise error if name is None else error.renamed(name) from None
    table = ReportTable(headers=[HEAD], rows=result.cells(), printed=True)
    note = (
        "Shares in percent with 95 % Wilson intervals. A contact is at fault where the robot moves toward whom it "
        "touches."
    )
    report = Report(
        title=f"Benchmark {result.suite}",
        facts=[("suite", result.suite), ("conditions", result.conditions)],
        sections=[Section("Shares", [table, note])],
        warnings=result.warnings,
        warned="What a shield does not cover here",
    )
    print(terminal.told(report))
    written = [] if place is None else _write(options, result, report, place)
    output.say_written(written, report, options)
    output.report_warnings(result.warnings, options.strict)


def _write(options: argparse.Namespace, result: Result, report: Report, place: Path) -> list[Path]:
    """Write table, picture and page beside the rows."""
    from hrsafety import plotting

    stem = f"{result.suite}-{'+'.join(str(len(rows)) for rows in list(result.rows.values())[:1])}"
    every = [(name, *(getattr(row, each) for each in NAMES)) for name, rows in result.rows.items() for row in rows]
    tables = [
        output.write_csv(place / f"{stem}.csv", HEAD, result.cells()),
        output.write_csv(place / f"{stem}-episodes.csv", ("law", *NAMES), every),
    ]
    failed = list(_failures(options, result))
    sections = [*report.sections, *([Section("Episodes that did not succeed", failed)] if failed else [])]
    drawn = [("standings", plotting.comparison_standings(result), "Shares with 95 % intervals, and ranks by success.")]
    return output.write_report(replace(report, sections=sections), place, drawn, tables, stem)


def _failures(options: argparse.Namespace, result: Result) -> Iterator[Picture | PlayerPage]:
    """Draw the first episodes of every entry that did not succeed, the first one of each entry as a player, too."""
    from hrsafety import plotting

    suite = SUITES[result.suite]
    if suite.scene is None:
        return
    settings = {
        "person_speed": options.person_speed,
        "seed": suite.seed if options.seed is None else options.seed,
        "data": None if options.data is None else Path(options.data),
        "threads": options.threads,
        "noise": options.noise,
        "latency": options.latency,
    }
    for name in result.rows:
        for case in result.failures(name):
            place, law = suite.scene(case_of(settings, entry(name), [case]), case)
            run = nav.simulate(place, law, stop_on_contact=result.suite != "recordings", step=suite.step)
            yield Picture(
                name=f"{name}-{case}".replace("+", "_"),
                caption=f"{name}, episode {case}: {run.outcome}",
                png=output.picture(plotting.time_sequence(run)),
            )
            if case == result.failures(name)[0]:
                yield plotting.player(run, title=f"{name}, episode {case}: {run.outcome}")
