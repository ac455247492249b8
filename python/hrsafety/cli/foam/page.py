"""The summary page of ``hrsafety foam``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.pages import DASH, Picture, written

if TYPE_CHECKING:
    from hrsafety import impact
    from hrsafety.cli.foam.report import FoamReport, Range

__all__ = ["html", "limits_words", "range_words"]

KILO = 1000.0
CAPTION = "Boundaries of the foam stiffness over the foam damping, and the foams of the file."
STATUS_WORDS = {
    "jump": "jump: the impact period jumps, and the compression with it",
    "end_of_impact_period": "met at the end of the impact period",
    "local_maximum": "met at a maximum inside the impact period",
    "initial_step": "met at first contact",
}


def limits_words(limits: impact.FoamLimits) -> str:
    """Return the limits in one line."""
    parts = (
        ("head acceleration", limits.peak_head_acceleration_g, 1.0, "g"),
        ("HIC15", limits.hic15, 1.0, ""),
        ("HIC36", limits.hic36, 1.0, ""),
        ("contact force", limits.peak_contact_force, 1.0, "N"),
        ("compression", limits.max_compression, KILO, "mm"),
    )
    return ", ".join(
        f"{name} {scale * value:g} {unit}".rstrip() for name, value, scale, unit in parts if value is not None
    )


def range_words(found: Range) -> str:
    """Return a range of stiffness in words; it may have no upper end."""
    if np.isinf(found.high):
        return f"{found.low / KILO:.2f} kN/m and more"
    return f"{found.low / KILO:.2f} to {found.high / KILO:.2f} kN/m"


def html(report: FoamReport, picture: bytes) -> str:
    """Return the page.

    Parameters
    ----------
    report : FoamReport
        What was found.
    picture : bytes
        Picture of the boundaries as PNG.

    Returns
    -------
    str
        A complete HTML document.
    """
    file = report.file
    return written(
        "foam.html",
        title=file.title,
        warned=list(dict.fromkeys(map(str, report.warnings))),
        file=file,
        arm=file.manipulator,
        limits=limits_words(file.limits),
        span=f"{file.damping[0]:g} to {file.damping[-1]:g} N s/m",
        found=report.feasibility,
        widest=report.widest,
        widest_words=None if report.widest is None else range_words(report.widest),
        picture=Picture(name="boundaries", caption=CAPTION, png=picture),
        foams=report.foams,
        titles=_titles(report),
        boundaries=list(_statuses(report)),
    )


def _titles(report: FoamReport) -> list[str]:
    checks = report.foams[0].checks if report.foams else ()
    names = [f"{check.name}{f' ({check.unit})' if check.unit else ''}, at most {check.limit:g}" for check in checks]
    return ["Foam", "Verdict", "Stiffness (kN/m)", "Damping (N s/m)", *names, "Fits up to (m/s)"]


def _statuses(report: FoamReport) -> Iterator[tuple[str, str, str, str]]:
    """Yield where the boundaries change their meaning."""
    for name, boundary in (("upper", report.upper), ("lower", report.lower)):
        if boundary is None:
            continue
        for start, end in _pieces(boundary):
            first, last = boundary.stiffness[start] / KILO, boundary.stiffness[end] / KILO
            values = f"{first:.2f} to {last:.2f}" if np.isfinite(first) and np.isfinite(last) else DASH
            span = f"{report.file.damping[start]:g} to {report.file.damping[end]:g}"
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
