"""``hrsafety contact CELL.toml``: a contact report to hand over, as a page and as JSON."""

from __future__ import annotations

import argparse
import datetime
import os
import sys
from collections.abc import Iterator, Mapping
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety import contact
from hrsafety.cli import exit_codes, output, progress, terminal, verdict
from hrsafety.cli.cell import page as cell_page
from hrsafety.cli.cell import pictures as cell_pictures
from hrsafety.cli.cell import report as cell_report
from hrsafety.errors import InvalidParameterError
from hrsafety.pages import require_jinja
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
    output.require_matplotlib("contact")
    require_jinja("contact")
    with output.located(options.cell), progress.live() as shown:
        cell = contact.load_cell(options.cell)
        told = None if shown is None else lambda done, total: shown("map of allowed speeds", done, total, None)
        study = contact.study(cell, progress=told)
    command = f"hrsafety contact {Path(options.cell).name}"
    report = cell_report.report_of(cell, study, command=command, date=date)
    page = cell_page.html(report, cell_pictures.drawings(cell, study))
    print("\n".join(_summary(options.cell, report)))
    print()
    print(_table(report))
    print()
    place = output.folder(options.out)
    for name, text in (("report.json", cell_report.json_text(report)), ("report.html", page)):
        print(f"wrote {output.write_text(place / name, text)}")
    output.report_warnings(study.warnings, strict=False)
    _end(report)
    output.leave_if_strict(study.warnings, options.strict)


def _end(report: Mapping[str, Any]) -> None:
    """Print the verdict once more as the last line, and leave with its code unless it is within limits.

    Raises
    ------
    SystemExit
        With code 3 if a contact exceeds its limits or is not permitted, with code 5 if one is not checked.
    """
    word, code = report["verdict"], ENDS[report["verdict"]]
    rows = [each for each in report["verdicts"] if each["verdict"] == word]
    said = f"{VERDICT_WORDS[word]}: {len(rows)} of {len(report['verdicts'])} contacts"
    if code == exit_codes.NOT_CHECKED:
        said += f" ({', '.join(report['doubts'])})"
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


def _summary(path: str, report: Mapping[str, Any]) -> Iterator[str]:
    robot, limits = report["robot"], report["limits"]
    mass = robot["mass"] if isinstance(robot["mass"], str) else f"{robot['mass']:.3f} kg"
    yield f"cell           {path}"
    yield f"robot          {mass} ({robot['rule']})"
    if robot["iso_mass"] is not None:
        directional = robot["directional_mass"]
        shown = directional if isinstance(directional, str) else f"{directional:.3f} kg"
        yield f"masses         effective {shown}, ISO/TS 15066 {robot['iso_mass']:.3f} kg"
        pose = ", ".join(f"{each['joint']} {each['value']:.4g}" for each in robot["pose"])
        yield f"worst pose     {pose} (rad or m), of {robot['poses']:,}{_drawn(report)}"
    yield f"limits         {limits['title']}, edition {limits['edition']}"
    yield f"verdict        {VERDICT_WORDS[report['verdict']]}"
    yield f"               {cell_report.CONFIRM}"


def _drawn(report: Mapping[str, Any]) -> str:
    """Return what poses are that the file does not name: among them are some that hardly yield."""
    if "samples" not in report["inputs"]["robot"]:
        return ""
    return " drawn between the limits of the joints; poses in [robot] names those that occur"


def _table(report: Mapping[str, Any]) -> str:
    rows = []
    for each in report["verdicts"]:
        numbers = [each[name] for name in ("planned_speed", "allowed_speed", "margin")]
        shown = ["-" if value is None else f"{value:.3f}" for value in numbers]
        place = (each["region"], each["contact"], each["covering"] or "bare")
        area = "-" if each["contact_area"] is None else f"{1e4 * each['contact_area']:.3g}"
        words = (each["governs"] or "-", ", ".join(each["doubts"]) or "-")
        rows.append((*place, area, VERDICT_WORDS[each["verdict"]], *shown, *words))
    names = ("region", "contact", "covering", "area", "verdict", "planned", "allowed", "margin", "governs", "doubts")
    units = ("", "", "", "cm2", "", "m/s", "m/s", "m/s", "", "")
    drawn = terminal.table((names, units), rows, left=(0, 1, 2, 4, 8, 9))
    clamped = [each["drive"]["holds_for"] for each in report["verdicts"] if each["drive"] is not None]
    held = [f"clamped contacts hold for {words}" for words in dict.fromkeys(clamped)]
    return "\n".join([drawn, *held])
