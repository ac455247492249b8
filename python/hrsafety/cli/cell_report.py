"""The report of a cell: what report.json holds, and what the page says in words."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from hrsafety import __version__
from hrsafety.cli.cell_file import Cell, canonical
from hrsafety.cli.cell_study import Study, numbers_of
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

_LIMIT_EQUATIONS = (
    ("transient limit", "F_tr = 2 F_qs, p_tr = 2 p_qs", "limits of free contact; none for head and face"),
    ("reduced mass", "μ = m_R m_H / (m_R + m_H)", "free contact; clamped: μ = m_R"),
)
_ARM_EQUATIONS = (
    ("effective mass", "m_u = 1 / (uᵀ J M⁻¹ Jᵀ u)", "mass of the point along the direction u"),
    ("mass of ISO/TS 15066", "m_R = M/2 + m_L", "half of the moving mass, and the payload"),
)
_BASE_EQUATIONS = {
    "holonomic": ("effective mass", "1/m_u = 1/M + (x u_y − y u_x)²/I", "free base, point about the center of mass"),
    "differential": ("effective mass", "m_u = 1 / (J diag(M + 2 I_w/r², I + M d² + 2 I_w b²/r²)⁻¹ Jᵀ)", "two wheels"),
}
_LAWS = {
    "linear": "σ = E e",
    "gibson_ashby": "σ = E e to e_y = s_p/E; s_p to e_p = e_D (1 − D^(−1/m)); s_p/D (e_D/(e_D − e))^m",
    "rusch": "σ = a e^p + b e^q",
    "avalle": "σ = A (1 − exp(−(E/A) e (1−e)^m)) + B (e/(1−e))^n",
    "table": "σ: measured points, linear between them",
}
_SHAPES = {
    "flat": "F = A σ(e), pressure F/A",
    "curved": "F = 2π √(R₁ R₂) T w(e), w = ∫ σ de; pressure σ(e) at the apex",
    "sphere": "F = 2π R T w(e), w = ∫ σ de; pressure σ(e) at the apex",
    "cylinder": "F = 2 l √(2R) ∫ σ((d − s²)/T) ds from 0 to √d; pressure σ(e) at the apex",
}


def report_of(cell: Cell, study: Study, *, command: str, date: str | None) -> dict[str, Any]:
    """Return what report.json holds.

    Parameters
    ----------
    cell : Cell
        What was asked.
    study : Study
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
    return numbers_of(
        {
            **head,
            **study.fields,
            "inputs": cell.inputs,
            "materials": cell.materials,
            "equations": [
                dict(zip(("name", "equation", "use"), each, strict=True)) for each in _equations(cell, study)
            ],
            "not_covered": list(NOT_COVERED),
            "confirmation": CONFIRM,
            "warnings": list(dict.fromkeys(each.message for each in study.warnings)),
            "audit": _audit(cell, command),
        }
    )


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
        "canonical_form": "JSON, keys sorted, no blanks, shortest floats that read back the same, whole numbers as integers",
    }


def _sha256(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _equations(cell: Cell, study: Study) -> Iterator[tuple[str, str, str]]:
    """Yield the equations that this report used."""
    if cell.robot.kind == "arm":
        yield from _ARM_EQUATIONS
    elif cell.robot.kind == "base":
        yield _BASE_EQUATIONS[str(cell.inputs["robot"]["base"])]
    yield from _LIMIT_EQUATIONS
    pads = cell.coverings.values()
    for law in dict.fromkeys(pad.material.law for pad in pads):
        yield (f"covering, {law.replace('_', ' ')}", _LAWS[law], "stress over e = compression / T")
    for shape in dict.fromkeys(pad.shape for pad in pads):
        yield (f"contact, {shape}", _SHAPES[shape], "force of the covering")
    statuses = {row.get("status") for each in study.fields["results"] for row in each["rows"]}
    if "closed_form" in statuses:
        yield ("allowed speed", "v = √(2 (W_c(F*) + W_b(F*)) / μ), W_b = F²/2k", "nothing is lost in the contact")
    if statuses & {"monotone", "several_crossings", "unlimited_up_to_20"}:
        yield ("allowed speed", "root of load(v) = limit over simulations", "coverings with a damper or a rate")
    yield ("collision", "M_r x_r″ = −f, M_h x_h″ = f; f = k δ = F(d) R U, d + δ = x_r − x_h", "loads at a speed")
    if study.speeds is not None:
        formula = "S = v_h (T_r + v/a) + v T_r + v²/2a + C + Z"
        yield ("separation", formula, "stop before contact; v(d) is its inverse, or the allowed contact speed")
    if study.fields["sensitivity"] is not None:
        yield ("sensitivity", "d ln v / d ln x, central differences", "what the governing speed hangs on")
    if any(each["status"] == "computed" for each in study.fields["probability"]):
        yield ("chance", "share of draws with an allowed speed below the planned one", "95 % interval, Clopper-Pearson")
