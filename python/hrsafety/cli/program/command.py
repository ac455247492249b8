"""``hrsafety program FILE.toml``: cycle time of a robot program within limits of contacts, as a page and as tables."""

from __future__ import annotations

import argparse
from pathlib import Path

from hrsafety import program
from hrsafety.cli import output, terminal, verdict
from hrsafety.cli.cell.command import date_of
from hrsafety.cli.program import page as program_page
from hrsafety.cli.program import pictures as program_pictures
from hrsafety.cli.program import report as program_report
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.verdicts import VERDICT_WORDS
from hrsafety.tables import Columns

__all__ = ["report_program"]


def report_program(options: argparse.Namespace) -> None:
    """Judge a robot program and write its report.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety program``.
    """
    if not Path(options.file).exists():
        remedy = "hrsafety init program writes one to start from"
        raise InvalidParameterError("FILE.toml", "name a file", options.file, remedy)
    date = date_of(options.date)
    command = f"hrsafety program {Path(options.file).name}"
    options.out = output.report_folder(options.out, "program", command)
    output.check_targets(options)
    with output.located(options.file):
        study = program.load_program(options.file).report()
    if isinstance(study, program.DrawnStudy):
        report = program_report.report_of_draws(options.file, study, command=command, date=date)
        page, tables = report.page(), {}
    else:
        report = program_report.report_of(options.file, study, command=command, date=date)
        page = program_page.html(report, program_pictures.drawings(study), study.annex.tables())
        tables = {"measurement_plan": study.plan.columns(), "waypoints": study.columns()}
        if study.limited.standstill < 0:
            tables["joint_log"] = study.limited.columns()
    print(terminal.told(report))
    place = output.folder(options.out)
    written = [
        output.write_text(place / "report.json", report.json(sort=True)),
        *output.write_page(place / "report.html", page, options),
        *(_table(place / f"{name}.csv", columns) for name, columns in tables.items()),
    ]
    output.say_written(written, report, options)
    output.report_warnings(study.warnings, strict=False)
    verdict.leave(study.verdict, _said(study))
    output.leave_if_strict(study.warnings, options.strict)


def _said(study: program.ProgramStudy | program.DrawnStudy) -> str:
    """Return the verdict with its number of limits and, where they decide it, its doubts."""
    held = [each.verdict for each in study.rows]
    doubts = f" ({', '.join(study.fields['doubts'])})" if study.verdict == "not_checked" else ""
    told = f"{held.count(study.verdict)} of {len(held)} limits"
    where = "over drawn motions" if isinstance(study, program.DrawnStudy) else "along the path"
    return f"{VERDICT_WORDS[study.verdict]}: {told} {where}{doubts}"


def _table(path: Path, columns: Columns) -> Path:
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return output.write_csv(path, list(columns), rows)
