"""Clamped contacts of a cell with the drive that presses on."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from hrsafety.contact.cell.cell import Cell, PlannedContact, contact_of
from hrsafety.contact.cell.judgement import FASTEST, Judged
from hrsafety.contact.drive import Drive
from hrsafety.contact.driven import DrivenSpeed, driven_loads, driven_speed
from hrsafety.contact.driving import DrivenLoads
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

__all__ = ["WITHOUT", "Driven", "drive_doubts", "driven_of", "driven_row"]

WITHOUT = "a robot without drive"
UNKNOWN = ResultWarning(
    "drive_not_given",
    "drive",
    f"the allowed speed holds for {WITHOUT}: one that is driven on until it has reacted and braked presses harder; "
    "give [drive] with its reaction time and its stop, which are not taken from [separation]",
)


class Driven(NamedTuple):
    """Allowed speed of a clamped contact with the drive of its cell, and the loads at the planned one."""

    drive: Drive
    speed: DrivenSpeed
    loads: DrivenLoads


def driven_of(cell: Cell, planned: PlannedContact, closing: float) -> Driven | None:
    """Return a clamped contact with the drive of its cell.

    Parameters
    ----------
    cell : Cell
        With its drive.
    planned : PlannedContact
        A clamped contact of which spring and limits are known.
    closing : float
        Planned closing speed in m/s.

    Returns
    -------
    Driven or None
        ``None`` where the cell says nothing of the drive, or its robot cannot yield anyway.
    """
    drive = cell.drive
    if drive is None or drive.model == "none" or math.isinf(cell.robot.mass):
        return None
    hit = contact_of(cell, planned, planned.covering)
    try:
        speed = driven_speed(hit, drive, human_speed=cell.human_speed)
        if speed.status == "threshold_above_limit":
            # A path that continues until such a force is noticed has no loads worth a long simulation.
            return Driven(drive, speed, DrivenLoads(force=math.inf, pressure=math.inf, status=speed.status))
        return Driven(drive, speed, driven_loads(hit, closing, drive))
    except InvalidParameterError as error:
        # A covering that is compressed by more than was measured has no loads.
        if "beyond_data" not in error.requirement:
            raise
        lost = DrivenLoads(force=math.inf, pressure=math.inf, strain=math.inf, status="unfinished")
        speed = DrivenSpeed(
            speed=0.0, governs="nothing", status="unfinished", kinetic_speed=None, robot_speed=0.0, warnings=()
        )
        return Driven(drive, speed, lost)


def drive_doubts(cell: Cell, driven: Driven | None) -> tuple[ResultWarning, ...]:
    """Return the doubts about a clamped contact: a drive that nobody gave, an odd stop, loads that are not known."""
    if driven is None:
        # A robot that cannot yield has no allowed speed anyway.
        return () if math.isinf(cell.robot.mass) else (UNKNOWN,)
    unknown = driven.loads.status in {"unfinished", "outside_table"} or driven.speed.status == "unfinished"
    told: tuple[ResultWarning, ...] = ()
    if unknown:
        words = {"outside_table": "the stop was not measured from the planned speed"}
        unsettled = "a motion did not settle; a shorter stop or damping of an elastic drive may help"
        message = f"loads with the drive are not known: {words.get(driven.loads.status, unsettled)}"
        told = (ResultWarning("unfinished", "drive", message),)
    return (*driven.drive.doubts_with(cell.robot.payload_mass), *told)


def driven_row(cell: Cell, judged: Judged, driven: Driven | None) -> Judged:
    """Return a clamped contact with the lower one of both allowed speeds, and what the report says of its drive.

    Parameters
    ----------
    cell : Cell
        What was asked.
    judged : Judged
        By the kinetic energy.
    driven : Driven or None
        With the drive.

    Returns
    -------
    Judged
        Not yet decided.
    """
    row = dict(judged.verdict)
    names = ("path", "peak_force", "peak_pressure", "peak_strain", "static_force", "stiffness", "status")
    told: dict[str, Any] = {
        "holds_for": WITHOUT,
        "model": None if cell.drive is None else cell.drive.model,
        "kinetic_closing_speed": row["allowed_closing_speed"],
        **dict.fromkeys((*names, "allowed_closing_speed", "transient_force_limit")),
    }
    if driven is None:
        return judged._replace(verdict=row | {"drive": told})
    speed, loads = driven.speed, driven.loads
    numbers = (loads.commanded, loads.force, loads.pressure, loads.strain, loads.static_force)
    told |= {name: value if math.isfinite(value) else None for name, value in zip(names, numbers, strict=False)}
    told["stiffness"] = "rigid" if math.isinf(loads.stiffness) else None
    if math.isfinite(loads.stiffness):
        told["stiffness"] = loads.stiffness
    told |= {"holds_for": _words(driven.drive), "status": speed.status}
    limit = judged.planned.limit
    told["transient_force_limit"] = cell.limits.contact(limit.region, "transient", area=limit.area).force
    most = FASTEST if speed.speed is None else speed.speed
    told["allowed_closing_speed"] = most
    kinetic = row["allowed_closing_speed"]
    if kinetic is None or most < kinetic:
        own = max(most - cell.human_speed, 0.0)
        row |= {"allowed_closing_speed": most, "allowed_speed": own, "margin": own - judged.planned.speed}
        row |= {"governs": speed.governs, "status": speed.status}
    return judged._replace(verdict=row | {"drive": told})


def _words(drive: Drive) -> str:
    """Return what a drive is in a line."""
    if drive.model == "push_limit":
        return f"a drive that pushes with at most {drive.push_limit:g} N"
    stop = "stops as measured" if drive.stopping is not None else f"brakes at {drive.deceleration:g} m/s2"
    noticed = f"a force of {drive.detection_force:g} N" if drive.detection_force else "the first touch"
    kind = {
        "any_stiffness": "a drive of any stiffness",
        "rigid": "a drive that keeps its path",
        "elastic": f"a drive of {drive.stiffness or 0.0:g} N/m",
    }[drive.model]
    return f"{kind} that reacts {drive.reaction_time:g} s after {noticed} and {stop}"
