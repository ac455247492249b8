"""``hrsafety contact CELL.toml``: a contact report to hand over, as a page and as JSON."""

from __future__ import annotations

import argparse
import datetime
import os
from importlib import resources
from pathlib import Path

from hrsafety import contact
from hrsafety._words import some
from hrsafety.cli import output, progress, terminal, verdict
from hrsafety.cli.cell import page as cell_page
from hrsafety.cli.cell import pictures as cell_pictures
from hrsafety.cli.cell import report as cell_report
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.verdicts import VERDICT_WORDS

__all__ = ["date_of", "report_cell"]


def report_cell(options: argparse.Namespace) -> None:
    """Judge the contacts of a cell file and write the report, or write a file to start from.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety contact``.
    """
    if options.init:
        _start(options.cell)
        return
    if not Path(options.cell).exists():
        remedy = "hrsafety contact --init writes one to start from"
        raise InvalidParameterError("CELL.toml", "name a file", options.cell, remedy)
    date = date_of(options.date)
    command = f"hrsafety contact {Path(options.cell).name}"
    options.out = output.report_folder(options.out, "report", command)
    output.planned_folder(options.out)
    output.require_page("contact")
    output.check_json(options)
    output.check_pdf(options)
    with output.located(options.cell), progress.live() as shown:
        cell = contact.load_cell(options.cell)
        told = None if shown is None else lambda done, total: shown("map of allowed speeds", done, total, None)
        study = contact.study(cell, progress=told)
    report = cell_report.report_of(options.cell, cell, study, command=command, date=date)
    print(terminal.told(report))
    held = [each["drive"]["holds_for"] for each in study.verdicts if each["drive"] is not None]
    print("\n".join(f"clamped contacts hold for {words}" for words in dict.fromkeys(held)))
    page = cell_page.html(report, cell_pictures.drawings(cell, study), study.annex.tables())
    place = output.folder(options.out)
    files = [output.write_text(place / "report.json", report.json(sort=True))]
    files += output.write_page(place / "report.html", page, options)
    output.say_written([*files, study.plan.to_csv(place / "plan.csv")], report, options)
    output.report_warnings(study.warnings, strict=False)
    verdict.leave(study.verdict, _said(study))
    output.leave_if_strict(study.warnings, options.strict)


def _said(study: contact.ContactStudy) -> str:
    """Return the verdict with its number of contacts and, where they decide it, its doubts."""
    rows = [each for each in study.verdicts if each["verdict"] == study.verdict]
    if not rows:
        doubts = ", ".join(study.fields["speed_over_distance"]["doubts"])
        return f"the separation distance is {VERDICT_WORDS[study.verdict]} ({doubts})"
    doubts = f" ({', '.join(study.fields['doubts'])})" if study.verdict == "not_checked" else ""
    return f"{VERDICT_WORDS[study.verdict]}: {len(rows)} of {some(len(study.verdicts), 'contact')}{doubts}"


def _start(path: str) -> None:
    """Write the commented file, never over another one."""
    place = output.target("CELL.toml", path, (".toml",))
    if place.exists():
        raise InvalidParameterError("CELL.toml", "not exist with --init", path, "nothing is overwritten")
    text = (resources.files("hrsafety.cli") / "data" / "cell.toml").read_text(encoding="utf-8")
    print(f"wrote {output.write_text(place, text)}")


def date_of(given: str | None) -> str | None:
    """Return the date that the page prints: the option, else SOURCE_DATE_EPOCH, else none."""
    if given is not None:
        try:
            return datetime.date.fromisoformat(given).isoformat()
        except ValueError:
            raise InvalidParameterError("--date", "be a date such as 2026-03-31", given) from None
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    if epoch is None:
        return None
    try:
        return datetime.datetime.fromtimestamp(int(epoch), datetime.UTC).date().isoformat()
    except (ValueError, OverflowError, OSError):
        raise InvalidParameterError("SOURCE_DATE_EPOCH", "be seconds since 1970", epoch) from None
