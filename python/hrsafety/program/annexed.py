"""Annex of a program for the technical file: what its verdict rests on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrsafety.contact import Annex, Assumption, Hazard, annex_of
from hrsafety.contact.cell.handover import (
    HUMAN_SPEED,
    assumed,
    assumptions_about,
    hazard_of,
    limit_words,
    payload_assumed,
)
from hrsafety.program.judged import JudgedExposure
from hrsafety.program.task import ContactTask
from hrsafety.standards.fields import FieldDistances

__all__ = ["annex_of_task"]


def annex_of_task(
    task: ContactTask, rows: Sequence[JudgedExposure], fastest: float, distances: FieldDistances | None = None
) -> Annex:
    """Return the annex of a program: what its file says, and what was computed.

    Parameters
    ----------
    task : ContactTask
        What was asked, with its own texts.
    rows : sequence of JudgedExposure
        Its limits.
    fastest : float
        Largest planned speed of a point in m/s.
    distances : FieldDistances or None
        For the field of a scanner.

    Returns
    -------
    Annex
        To be filled.
    """
    hazards: dict[Hazard, None] = {}
    for each in rows:
        exposure = each.exposure
        covering = "bare" if exposure.covering is None else f"covering {exposure.covering!r}"
        place = f" by {task.points[exposure.point].name} in {task.segment_name(exposure.segment)}"
        allowed = each.allowed_speed
        speed = f"speed at most {min(allowed, each.speed):.3g} m/s, " if exposure.limit.permitted else "none: "
        hazards[hazard_of(exposure.limit, f"{speed}{covering}", place)] = None
    return annex_of(
        task.annex,
        hazards=tuple(_once(hazards)),
        assumptions=list(_assumptions(task, fastest, distances)),
        limits=list(dict.fromkeys(limit_words(each.exposure.limit, task.limits) for each in rows)),
        hashes=dict(task.files),
    )


def _once(hazards: dict[Hazard, None]) -> Iterator[Hazard]:
    """Yield each contact once, with its hardest limit: that of the drive, or that of the kinetic energy."""
    seen = set()
    for each in hazards:
        if (each.hazard, each.contact) not in seen:
            seen.add((each.hazard, each.contact))
            yield each


def _assumptions(task: ContactTask, fastest: float, distances: FieldDistances | None) -> Iterator[Assumption]:
    arm = task.motion.arm
    yield assumed(
        "speed of the points of the robot",
        f"at most {fastest:.3g} m/s as planned",
        "another program, a changed override",
    )
    if task.tcp_speed is not None:
        yield assumed("speed of the tool center point", f"at most {task.tcp_speed:g} m/s", "a changed override")
    value = f"ISO/TS 15066 {arm.iso_mass:.4g} kg, moving links {arm.moving_mass:.4g} kg, {task.robot_mass}"
    yield assumed("mass of the robot", value, "a heavier payload or tool, another arm")
    yield payload_assumed(arm.payload_mass)
    walking = max(each.human_speed for each in task.segments)
    yield assumed(HUMAN_SPEED, f"at most {walking:g} m/s", "people who walk there")
    for place, each in enumerate(task.segments):
        name = task.segment_name(place)
        if each.regions:
            regions = ", ".join(each.regions).replace("_", " ")
            yield assumed(f"within reach in {name}", f"{regions} and nothing else", "another layout, someone who bends")
        else:
            yield assumed(f"nobody within reach in {name}", each.reason, "another layout, an open door")
        if each.regions and not each.clamped:
            yield assumed(f"nobody is clamped in {name}", each.reason, "objects that are put there, another layout")
    yield from assumptions_about(task.coverings, task.drive, distances, task.confirmed)
