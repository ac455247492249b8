"""The report of a cell: what report.json holds, and what the page says in words."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import resources
from typing import Any

import numpy as np

from hrsafety import __version__
from hrsafety._keys import canonical
from hrsafety.contact import Cell, ContactStudy
from hrsafety.contact.cell.study import numbers_of
from hrsafety.pages import versions
from hrsafety.pages.report import Report, ReportTable, Section
from hrsafety.standards.verdicts import VERDICT_WORDS

__all__ = ["CONFIRM", "NOT_COVERED", "at_path", "left_out_words", "report_of", "sha256_of", "to_thousandths"]

FORMAT = 1
CONFIRM = (
    "Every number here is computed from a model and from limits that were read in public sources. "
    "A measurement on the finished machine must confirm each of them before anybody relies on it."
)
LEFT_OUT = {"quasi_static": "being clamped", "transient": "free contact"}
NOT_COVERED = (
    "Edges, corners and points: a radius below a fifth of the thickness of the covering, or tools that cut or pierce.",
    "Several contacts at once, and contacts that slide, twist or shear.",
    "Children, frail or pregnant people, wounds and implants: the limits are those of adults, and no set has others.",
    "Transient contact of skull, forehead and face: it is not permitted, and no speed makes it so.",
    "Failures of sensors, controllers and brakes: a limit holds only as long as the planned speed does.",
    "Heat, noise, electricity, and what the robot carries and may drop.",
)


def report_of(path: str, cell: Cell, study: ContactStudy, *, command: str, date: str | None) -> Report:
    """Return the report of a study.

    Parameters
    ----------
    path : str
        The cell file, as given.
    cell : Cell
        What was asked.
    study : ContactStudy
        What was found.
    command : str
        How the report was made.
    date : str or None
        Date to print; absent when ``None``.
    """
    values: dict[str, Any] = numbers_of(
        {
            "format": "hrsafety contact report",
            "format_version": FORMAT,
            **({} if date is None else {"date": date}),
            **study.fields,
            "inputs": cell.inputs,
            "materials": cell.materials,
            "equations": _equations(cell, study),
            "not_covered": list(NOT_COVERED),
            "confirmation": CONFIRM,
            "audit": _audit(cell, command),
        }
    )
    return Report(
        title=cell.title,
        facts=list(_facts(path, cell, values)),
        said=VERDICT_WORDS[study.verdict],
        good=study.verdict == "within_limits",
        sections=[Section("Contacts", [_contacts(study)])],
        warnings=study.warnings,
        values=values,
        source=path,
    )


def _facts(path: str, cell: Cell, values: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    robot, limits = values["robot"], values["limits"]
    mass = robot["mass"] if isinstance(robot["mass"], str) else f"{robot['mass']:.3f} kg"
    yield "cell", path
    yield "robot", f"{mass} ({robot['rule']})"
    if robot["iso_mass"] is not None:
        directional = robot["directional_mass"]
        shown = directional if isinstance(directional, str) else f"{directional:.3f} kg"
        heaviest = robot["heaviest_mass"]
        if heaviest is not None:
            most = heaviest if isinstance(heaviest, str) else f"{heaviest:.3f} kg"
            shown += f" in the stated direction (in the heaviest one {most})"
        yield "masses", f"effective {shown}, ISO/TS 15066 {robot['iso_mass']:.3f} kg"
        pose = ", ".join(f"{each['joint']} {each['value']:.4g}" for each in robot["pose"])
        drawn = " drawn between the limits of the joints; poses in [robot] names those that occur"
        sampled = "samples" in cell.robot.inputs
        yield "worst pose", f"{pose} (rad or m), of {robot['poses']:,}{drawn if sampled else ''}"
    yield "limits", f"{limits['title']}, edition {limits['edition']}"
    if values["not_judged"]:
        yield "not judged", left_out_words(values["not_judged"])
    yield "verdict", VERDICT_WORDS[values["verdict"]]
    yield "", CONFIRM


def left_out_words(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return which class of contact is not judged of which regions, in a line.

    Parameters
    ----------
    rows : sequence of mapping
        ``not_judged`` of a study.

    Returns
    -------
    str
        For example ``"being clamped: hand_finger"``.
    """
    regions: dict[str, list[str]] = {}
    for each in rows:
        area = f" ({each['area_name']})" if each["area_name"] else ""
        regions.setdefault(each["contact"], []).append(f"{each['region']}{area}")
    return "; ".join(f"{LEFT_OUT[kind]}: {', '.join(names)}" for kind, names in regions.items())


def _contacts(study: ContactStudy) -> ReportTable:
    rows = []
    for each in study.verdicts:
        numbers = [each[name] for name in ("planned_speed", "allowed_speed", "margin")]
        numbers[1] = None if numbers[1] is None else to_thousandths(numbers[1])
        shown = ["-" if value is None else f"{value:.3f}" for value in numbers]
        place = (each["region"], each["contact"], each["covering"] or "bare")
        area = "-" if each["contact_area"] is None else f"{1e4 * each['contact_area']:.3g}"
        words = (each["governs"] or "-", ", ".join(each["doubts"]) or "-")
        rows.append((*place, area, VERDICT_WORDS[each["verdict"]], *shown, *words))
    names = ("region", "contact", "covering", "area", "verdict", "planned", "allowed", "margin", "governs", "doubts")
    units = ("", "", "", "cm2", "", "m/s", "m/s", "m/s", "", "")
    return ReportTable(headers=(names, units), rows=rows, left=(0, 1, 2, 4, 8, 9), printed=True)


def to_thousandths(value: float, careful: Callable[[float], int] = math.floor) -> float:
    """Return a speed rounded down, or a distance rounded up, to whole thousandths."""
    # Far below a thousandth first, so that 0.3 is not shown as 0.299.
    return careful(round(1e3 * value, 6)) / 1e3


def at_path(report: Any, path: str) -> Any:
    """Return the value at a path such as ``verdicts[0].allowed_speed``."""
    found = report
    for part in path.replace("]", "").replace("[", ".").split("."):
        found = found[int(part)] if isinstance(found, list) else found[part]
    return found


def _audit(cell: Cell, command: str) -> dict[str, Any]:
    rows = canonical(numbers_of({name: np.asarray(each).tolist() for name, each in cell.limits.columns().items()}))
    return {
        "hrsafety": __version__,
        "versions": versions("numpy", "matplotlib", "jinja2"),
        "command": command,
        "inputs_sha256": sha256_of(cell.inputs),
        "limits_sha256": sha256_of(rows),
        "urdf_sha256": cell.robot.sha256,
        "files_sha256": dict(cell.files),
        "canonical_form": "JSON, keys sorted, no blanks, shortest floats that read back, whole numbers as integers",
    }


def sha256_of(value: Any) -> str:
    """Return the SHA-256 of a value in the canonical form."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _equations(cell: Cell, study: ContactStudy) -> list[dict[str, str]]:
    """Return the equations that this report used: name, equation and use."""
    file = resources.files("hrsafety.cli") / "data" / "cell_equations.json"
    known = json.loads(file.read_text(encoding="utf-8"))
    return [row for part in _parts(cell, study) for row in known[part]]


def _parts(cell: Cell, study: ContactStudy) -> Iterator[str]:
    """Yield which equations those are."""
    if cell.robot.kind == "arm":
        yield "arm"
    elif cell.robot.kind == "base":
        yield str(cell.inputs["robot"]["base"])
    yield "limits"
    yield from dict.fromkeys(pad.material.law for pad in cell.coverings.values())
    yield from dict.fromkeys(pad.shape for pad in cell.coverings.values())
    statuses = {row["status"] for each in study.fields["results"] for row in each["rows"]}
    if "closed_form" in statuses:
        yield "closed_form"
    if statuses & {"monotone", "several_crossings", "unlimited_up_to_20"}:
        yield "simulated"
    yield "collision"
    if cell.separation is not None:
        yield "measured_stops" if "stopping" in cell.separation else "separation"
    if study.fields["sensitivity"] is not None:
        yield "sensitivity"
    if any(each["status"] == "computed" for each in study.fields["probability"]):
        yield "chance"
