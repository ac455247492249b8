"""The report of a cell: what report.json holds, and what the page says in words."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from importlib import resources
from typing import Any

import numpy as np

from hrsafety import __version__
from hrsafety._keys import canonical
from hrsafety.contact import Cell, ContactStudy
from hrsafety.contact.cell.study import numbers_of
from hrsafety.pages import versions

__all__ = ["CONFIRM", "NOT_COVERED", "at_path", "json_text", "report_of"]

FORMAT = 1
CONFIRM = (
    "Every number here is computed from a model and from limits that were read in public sources. "
    "A measurement on the finished machine must confirm each of them before anybody relies on it."
)
NOT_COVERED = (
    "Edges, corners and points: a radius below a fifth of the thickness of the covering, or tools that cut or pierce.",
    "Several contacts at once, and contacts that slide, twist or shear.",
    "Children, frail or pregnant people, wounds and implants: the limits are those of adults, and no set has others.",
    "Transient contact of skull, forehead and face: it is not permitted, and no speed makes it so.",
    "Failures of sensors, controllers and brakes: a limit holds only as long as the planned speed does.",
    "Heat, noise, electricity, and what the robot carries and may drop.",
)


def report_of(cell: Cell, study: ContactStudy, *, command: str, date: str | None) -> dict[str, Any]:
    """Return what report.json holds.

    Parameters
    ----------
    cell : Cell
        What was asked.
    study : ContactStudy
        What was found.
    command : str
        How the report was made.
    date : str or None
        Date to print; absent when ``None``.

    Returns
    -------
    dict
        Values of JSON only.
    """
    head: dict[str, Any] = {"format": "hrsafety contact report", "format_version": FORMAT, "title": cell.title}
    if date is not None:
        head["date"] = date
    found: dict[str, Any] = numbers_of(
        {
            **head,
            **study.fields,
            "inputs": cell.inputs,
            "materials": cell.materials,
            "equations": _equations(cell, study),
            "not_covered": list(NOT_COVERED),
            "confirmation": CONFIRM,
            "warnings": list(dict.fromkeys(each.message for each in study.warnings)),
            "audit": _audit(cell, command),
        }
    )
    return found


def json_text(report: Mapping[str, Any]) -> str:
    """Return a report as text: sorted keys, shortest floats that read back the same."""
    return json.dumps(report, indent=1, sort_keys=True, ensure_ascii=False, allow_nan=False) + "\n"


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
        "inputs_sha256": _sha256(cell.inputs),
        "limits_sha256": _sha256(rows),
        "urdf_sha256": cell.robot.sha256,
        "files_sha256": dict(cell.files),
        "canonical_form": "JSON, keys sorted, no blanks, shortest floats that read back, whole numbers as integers",
    }


def _sha256(value: Any) -> str:
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
