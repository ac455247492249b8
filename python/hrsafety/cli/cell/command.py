"""``hrsafety contact CELL.toml``: a contact report to hand over, as a page and as JSON."""

from __future__ import annotations

import argparse
import datetime
import os
import sys
from importlib import resources
from pathlib import Path
from types import MappingProxyType

from hrsafety import contact
from hrsafety.cli import exit_codes, output, progress, terminal, verdict
from hrsafety.cli.cell import page as cell_page
from hrsafety.cli.cell import pictures as cell_pictures
from hrsafety.cli.cell import report as cell_report
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.verdicts import VERDICT_WORDS

__all__ = ["ENDS", "report_cell"]

ENDS = MappingProxyType(
    {
        "not_permitted": exit_codes.FAILED_RUN,
        "exceeds": exit_codes.FAILED_RUN,
        "not_checked": exit_codes.NOT_CHECKED,
        "within_limits": exit_codes.DONE,
    }
)
"""Exit codes of the verdicts."""
LAST_WORDS = {exit_codes.FAILED_RUN: "FAILED", exit_codes.NOT_CHECKED: "NOT CHECKED", exit_codes.DONE: "passed"}


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
    date = _date(options.date)
    output.planned_folder(options.out)
    output.require_page("contact")
    output.check_json(options)
    with output.located(options.cell), progress.live() as shown:
        cell = contact.load_cell(options.cell)
        told = None if shown is None else lambda done, total: shown("map of allowed speeds", done, total, None)
        study = contact.study(cell, progress=told)
    command = f"hrsafety contact {Path(options.cell).name}"
    report = cell_report.report_of(options.cell, cell, study, command=command, date=date)
    print(terminal.told(report))
    held = [each["drive"]["holds_for"] for each in study.verdicts if each["drive"] is not None]
    print("\n".join(f"clamped contacts hold for {words}" for words in dict.fromkeys(held)))
    page = cell_page.html(report, cell_pictures.drawings(cell, study))
    place = output.folder(options.out)
    texts = {"report.json": report.json(sort=True), "report.html": page}
    output.say_written([output.write_text(place / name, text) for name, text in texts.items()], report, options)
    output.report_warnings(study.warnings, strict=False)
    _end(study)
    output.leave_if_strict(study.warnings, options.strict)


def _end(study: contact.ContactStudy) -> None:
    """Print the verdict once more as the last line, and leave with its code unless it is within limits.

    Raises
    ------
    SystemExit
        With code 3 if a contact exceeds its limits or is not permitted, with code 5 if one is not checked.
    """
    word, code = study.verdict, ENDS[study.verdict]
    rows = [each for each in study.verdicts if each["verdict"] == word]
    said = f"{VERDICT_WORDS[word]}: {len(rows)} of {len(study.verdicts)} contacts"
    if code == exit_codes.NOT_CHECKED:
        said += f" ({', '.join(study.fields['doubts'])})"
    last = f"{LAST_WORDS[code]}  {said}" + ("" if code == exit_codes.DONE else f"; exit code {code}")
    print()
    print(terminal.styled(last, verdict.LOOKS[LAST_WORDS[code].strip()], sys.stdout), flush=True)
    if code != exit_codes.DONE:
        raise SystemExit(code)


def _start(path: str) -> None:
    """Write the commented file, never over another one."""
    place = output.target("CELL.toml", path, (".toml",))
    if place.exists():
        raise InvalidParameterError("CELL.toml", "not exist with --init", path, "nothing is overwritten")
    text = (resources.files("hrsafety.cli") / "data" / "cell.toml").read_text(encoding="utf-8")
    print(f"wrote {output.write_text(place, text)}")


def _date(given: str | None) -> str | None:
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
