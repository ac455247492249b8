"""The summary page of ``hrsafety foam``."""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from html import escape
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np

from hrsafety import __version__
from hrsafety.reproduce.markup import figure

if TYPE_CHECKING:
    from hrsafety import impact
    from hrsafety.cli.foam_report import FoamReport, Judged, Range

__all__ = ["html", "limits_words", "range_words"]

KILO = 1000.0
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
    """Return the page: style and picture inside, nothing loaded from elsewhere.

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
    style = resources.files("hrsafety.reproduce").joinpath("page.css").read_text(encoding="utf-8")
    title = escape(report.file.title)
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{title}</title>",
            f"<style>{style}</style></head><body><main>",
            f"<h1>{title}</h1>",
            *_warnings(report),
            *_answer(report),
            figure("Boundaries of the foam stiffness over the foam damping, and the foams of the file.", picture),
            *_foams(report),
            *_statuses(report),
            *_foot(report),
            "</main></body></html>\n",
        ]
    )


def _warnings(report: FoamReport) -> Iterator[str]:
    if report.warnings:
        items = "".join(f"<li>{escape(message)}</li>" for message in dict.fromkeys(map(str, report.warnings)))
        yield f'<div class="banner no"><strong>Is this what was meant?</strong><ul>{items}</ul></div>'


def _answer(report: FoamReport) -> Iterator[str]:
    """Yield what was asked and whether there is a foam for it."""
    file = report.file
    arm = file.manipulator
    yield (
        f"<p>Manipulator at the impact point: {arm.mass:g} kg, {arm.damping:g} N s/m, {arm.stiffness / KILO:g} kN/m. "
        f"Closing speed {file.closing_speed:g} m/s. Limits: {escape(limits_words(file.limits))}; acceleration and HIC "
        "with the lightest head on the softest neck, force and compression with the heaviest on the stiffest. Foam is "
        f"linear up to {KILO * file.sought.linear_range:g} mm of {KILO * file.sought.thickness:g} mm; no limit "
        "counts as kept beyond that.</p>"
    )
    found = report.feasibility
    fastest = f"{found.max_closing_speed:.3f} m/s, with {found.stiffness / KILO:.2f} kN/m and {found.damping:g} N s/m"
    margin = f"with {100.0 * file.margin:g} % of every limit and of the linear range to spare"
    span = f"{file.damping[0]:g} to {file.damping[-1]:g} N s/m"
    if not found.max_closing_speed > 0.0:
        yield (
            f'<p class="banner no"><strong>No foam with a damping of {span} fits at any speed.</strong> None gives '
            f"back within its linear range {margin}.</p>"
        )
        return
    if not found.feasible:
        yield (
            f'<p class="banner no"><strong>No foam with a damping of {span} '
            f"fits at {file.closing_speed:g} m/s</strong> {margin}. The largest closing speed at which one would: "
            f"{fastest}. The impact must be slower by {found.slow_down:.3f} m/s.</p>"
        )
        return
    widest = ""
    if report.widest is not None:
        widest = f"The range of stiffness is widest at {report.widest.damping:g} N s/m: {range_words(report.widest)}. "
    yield (
        f'<p class="banner"><strong>There are foams that fit</strong> {margin}. {widest}'
        f"Some foam fits up to a closing speed of {fastest}.</p>"
    )


def _foams(report: FoamReport) -> Iterator[str]:
    if not report.foams:
        return
    yield "<h2>Foams</h2>"
    names = [
        f"{check.name}{f' ({check.unit})' if check.unit else ''}, at most {check.limit:g}"
        for check in report.foams[0].checks
    ]
    titles = ["Foam", "Verdict", "Stiffness (kN/m)", "Damping (N s/m)", *names, "Fits up to (m/s)"]
    head = "".join(f'<th scope="col">{escape(title)}</th>' for title in titles)
    lines = "".join(f"<tr>{_line(judged)}</tr>" for judged in report.foams)
    yield f'<div class="scroll"><table class="wide"><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>'


def _line(judged: Judged) -> str:
    verdict = ("good", "&#10003; fits") if judged.accepted else ("bad", f"&#10007; {judged.verdict}")
    # Loads of a foam outside its linear range are too low: none of them is a kept limit.
    linear = judged.status in ("kept", "exceeded")
    cells = "".join(
        f'<td class="{"good" if check.kept and linear else "bad"}">{check.value:.3f} '
        f"<small>({100.0 * check.margin:+.1f} %)</small></td>"
        for check in judged.checks
    )
    return (
        f'<th scope="row">{escape(judged.name)}</th><td class="text {verdict[0]}">{verdict[1]}</td>'
        f"<td>{judged.foam.stiffness / KILO:.2f}</td><td>{judged.foam.damping:.1f}</td>{cells}"
        f"<td>{judged.max_closing_speed:.3f}</td>"
    )


def _statuses(report: FoamReport) -> Iterator[str]:
    """Yield where the boundaries change their meaning."""
    yield "<h2>Meaning of the boundaries</h2>"
    yield '<div class="scroll"><table><thead><tr><th scope="col" class="text">Boundary</th>'
    yield '<th scope="col">Damping (N s/m)</th><th scope="col">Stiffness (kN/m)</th>'
    yield '<th scope="col" class="text">Meaning</th></tr></thead><tbody>'
    for name, boundary in (("upper", report.upper), ("lower", report.lower)):
        if boundary is None:
            continue
        for start, end in _pieces(boundary):
            first, last = boundary.stiffness[start] / KILO, boundary.stiffness[end] / KILO
            values = f"{first:.2f} to {last:.2f}" if np.isfinite(first) and np.isfinite(last) else "&ndash;"
            span = f"{report.file.damping[start]:g} to {report.file.damping[end]:g}"
            yield (
                f'<tr><td class="text">{name}</td><td>{span}</td>'
                f'<td>{values}</td><td class="text">{escape(_meaning(boundary, start))}</td></tr>'
            )
    yield "</tbody></table></div>"
    yield (
        "<p>Where the compression has no boundary or jumps, the impact period ends so early that even soft foam keeps "
        "the limit: the damper does the work. Do not choose a foam there without a test.</p>"
    )


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


def _foot(report: FoamReport) -> Iterator[str]:
    made = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    yield f"<p><small>hrsafety {escape(__version__)}, made {made}. Beside this page: boundaries.csv with "
    yield f"{len(report.file.damping)} points of both curves, boundaries.png.</small></p>"
