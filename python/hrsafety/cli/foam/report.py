"""The report of ``hrsafety foam``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.cli.foam.found import KILO, LOADS
from hrsafety.pages import DASH, sentence
from hrsafety.pages.report import Report, ReportCell, ReportTable, Section

if TYPE_CHECKING:
    from hrsafety import impact
    from hrsafety.cli.foam.found import FoundFoams, StiffnessRange

__all__ = ["CAPTION", "report_of"]

CAPTION = "Boundaries of the foam stiffness over the foam damping, and the foams of the file."
HEADS = (
    "Acceleration and HIC are those with the lightest head on the softest neck, force and compression those with the "
    "heaviest on the stiffest."
)
NO_BOUNDARY = (
    "Where the compression has no boundary or jumps, the impact period ends so early that even soft foam keeps the "
    "limit: the damper does the work. Do not choose a foam there without a test."
)
STATUS_WORDS = {
    "jump": "jump: the impact period jumps, and the compression with it",
    "end_of_impact_period": "met at the end of the impact period",
    "local_maximum": "met at a maximum inside the impact period",
    "initial_step": "met at first contact",
}


def limits_words(limits: impact.FoamLimits) -> str:
    """Return the limits in one line."""
    given = limits.given()
    parts = ((given[name], *load) for name, load in LOADS.items() if name in given)
    return ", ".join(f"{words} {scale * value:g} {unit}".rstrip() for value, words, unit, scale, _ in parts)


def range_words(found: StiffnessRange) -> str:
    """Return a range of stiffness in words; it may have no upper end."""
    if np.isinf(found.high):
        return f"{found.low / KILO:.2f} kN/m and more"
    return f"{found.low / KILO:.2f} to {found.high / KILO:.2f} kN/m"


def report_of(source: str, found: FoundFoams) -> Report:
    """Return the report of a design.

    Parameters
    ----------
    source : str
        Its file, as given.
    found : FoundFoams
        What was found.
    """
    file, arm, best = found.file, found.file.manipulator, found.feasibility
    said, advice = _verdict(found)
    linear = (
        f"Foam is linear up to {KILO * file.sought.linear_range:g} mm of {KILO * file.sought.thickness:g} mm; no limit "
        "counts as kept beyond that."
    )
    boundaries = ReportTable(
        headers=[["boundary", "damping", "stiffness", "meaning"], ["", "N s/m", "kN/m", ""]],
        rows=list(_statuses(found)),
        left=(0, 3),
    )
    return Report(
        title=file.title,
        facts=[
            ("design", source),
            ("manipulator", f"{arm.mass:g} kg, {arm.damping:g} N s/m, {arm.stiffness / KILO:g} kN/m"),
            ("closing speed", f"{file.closing_speed:g} m/s"),
            ("limits", limits_words(file.limits)),
            ("margin", f"{100.0 * file.margin:g} % of every limit and of the linear range"),
            ("foams", said),
            *(
                [("slow down by", f"{best.slow_down:.3f} m/s")]
                if best.max_closing_speed > 0.0 > -best.slow_down
                else []
            ),
            *([("fastest", advice)] if advice else []),
        ],
        said=said,
        good=best.feasible,
        advice=f"{sentence(advice)}." if advice else "",
        sections=[
            *([Section("Foams", [_foams(found)])] if found.foams else []),
            Section("Meaning of the boundaries", [HEADS, linear, boundaries, NO_BOUNDARY]),
        ],
        warnings=found.warnings,
        source=source,
    )


def _verdict(found: FoundFoams) -> tuple[str, str]:
    """Return whether some foam fits, and up to which closing speed."""
    file, best = found.file, found.feasibility
    span = f"a damping of {file.damping[0]:g} to {file.damping[-1]:g} N s/m"
    if not best.max_closing_speed > 0.0:
        return f"none fits with {span}, at any speed", ""
    fastest = (
        f"some foam fits up to {best.max_closing_speed:.3f} m/s: {best.stiffness / KILO:.2f} kN/m with "
        f"{best.damping:g} N s/m"
    )
    if not best.feasible:
        return f"none fits with {span} at {file.closing_speed:g} m/s", fastest
    if found.widest is None:
        return f"there are foams that fit, with {span}", fastest
    words = range_words(found.widest)
    return f"there are foams that fit; widest range at {found.widest.damping:g} N s/m: {words}", fastest


def _foams(found: FoundFoams) -> ReportTable:
    """Return the foams with what they make of each limit."""
    rows = []
    for judged in found.foams:
        # Loads of a foam outside its linear range are too low: none of them is a kept limit.
        known = judged.status in ("kept", "exceeded")
        checks = [
            ReportCell(
                f"{check.value:.3f}{'' if check.kept else ' !'}",
                "good" if check.kept and known else "bad",
                f"{100.0 * check.margin:+.1f} % of {check.limit:g}",
            )
            for check in judged.checks
        ]
        verdict = ReportCell(judged.verdict, "good" if judged.accepted else "bad")
        numbers = (f"{judged.foam.stiffness / KILO:.2f}", f"{judged.foam.damping:.1f}")
        rows.append((judged.name, verdict, *numbers, *checks, f"{judged.max_closing_speed:.3f}"))
    checked = found.foams[0].checks
    names = ("foam", "verdict", "stiffness", "damping", *(check.name for check in checked), "fits up to")
    units = ("", "", "kN/m", "N s/m", *(check.unit for check in checked), "m/s")
    return ReportTable(headers=(names, units), rows=rows, left=(0, 1), printed=True)


def _statuses(found: FoundFoams) -> Iterator[tuple[str, str, str, str]]:
    """Yield where the boundaries change their meaning."""
    for name, boundary in (("upper", found.upper), ("lower", found.lower)):
        if boundary is None:
            continue
        for start, end in _pieces(boundary):
            first, last = boundary.stiffness[start] / KILO, boundary.stiffness[end] / KILO
            values = f"{first:.2f} to {last:.2f}" if np.isfinite(first) and np.isfinite(last) else DASH
            span = f"{found.file.damping[start]:g} to {found.file.damping[end]:g}"
            yield name, span, values, _meaning(boundary, start)


def _pieces(boundary: impact.FoamBoundary) -> Iterator[tuple[int, int]]:
    """Yield first and last index of each run of equal status words."""
    words = [str(word) for word in boundary.status]
    start = 0
    for index in range(1, len(words) + 1):
        if index == len(words) or words[index] != words[start]:
            yield start, index - 1
            start = index


def _meaning(boundary: impact.FoamBoundary, index: int) -> str:
    """Return what a point of a boundary is, in words."""
    word = str(boundary.status[index])
    if word == "none":
        always = bool(boundary.holds_below[index] and boundary.holds_above[index])
        return f"no boundary: {'every' if always else 'no'} foam keeps the limits"
    return STATUS_WORDS.get(word, word.replace("_", " "))
