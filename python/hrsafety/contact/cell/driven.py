"""Clamped contacts of a robot that is driven on until it has reacted and braked, for a drive of any stiffness."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from hrsafety.contact.cell.cell import Cell, PlannedContact, contact_of
from hrsafety.contact.cell.stops import stopping_of
from hrsafety.contact.contact import Contact, Support
from hrsafety.contact.covering import Covering, covering_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["Driven", "drive_doubts", "drive_fields", "driven_of"]

STIFFNESSES = np.concatenate([[0.0], np.geomspace(1e-2, 1e2, 25)])
"""Stiffnesses of the drive beside that of the region; a rigid drive is examined, too."""
SETTLING = 1.0
"""Time in s after the robot stands in which loads may still rise."""
HALVINGS = 30
_FASTEST_BRAKE = 1e6
WITHOUT = "a robot without drive"
UNKNOWN = ResultWarning(
    "drive_not_given",
    "separation",
    f"the allowed speed holds for {WITHOUT}: one that is driven on until it has reacted and braked presses harder; "
    "give reaction_time and deceleration in [separation]",
)


class Driven(NamedTuple):
    """Largest loads of a clamped contact over the stiffness of the drive.

    Attributes
    ----------
    path : float
        Way of the robot after the touch until it stands, in m; NaN where it is not known.
    force, pressure, strain : float
        Largest force in N, pressure in Pa and strain of the covering, NaN where there is none; inf where the covering
        is pressed farther than anything is known of.
    stiffness : float
        Stiffness of the drive with the largest force in N/m, inf if it is rigid.
    deceleration : float
        In m/s^2, NaN where it is not known.
    keeps : bool
        Whether every limit is kept.
    """

    path: float
    force: float
    pressure: float
    strain: float
    stiffness: float
    deceleration: float
    keeps: bool


def driven_of(cell: Cell, planned: PlannedContact, speed: float) -> Driven | None:
    """Return the loads of a clamped contact with a drive, by the reaction and the stop of the cell.

    Parameters
    ----------
    cell : Cell
        With its separation.
    planned : PlannedContact
        A clamped contact of which spring and limits are known.
    speed : float
        Closing speed in m/s.

    Returns
    -------
    Driven or None
        ``None`` where the cell says nothing of the stop, or its robot cannot yield anyway.
    """
    if cell.separation is None or math.isinf(cell.robot.mass):
        return None
    reaction = float(cell.separation["reaction_time"])
    try:
        braking = _braking(cell.separation, speed)
    except InvalidParameterError:
        return Driven(math.nan, math.inf, math.inf, math.inf, math.inf, math.nan, keeps=False)
    path = speed * (reaction + 0.5 * speed / braking)
    pad = covering_of(contact_of(cell, planned, planned.covering).covering)
    k = float(planned.limit.spring_constant or math.nan)
    hit = Contact(robot=cell.robot.mass, region=k, covering=pad, drive=Support(stop=(reaction, braking)))
    horizon = min(reaction + speed / braking + SETTLING, 60.0)
    rows = hit.simulate_many(speed, horizon=horizon, robot_stiffness=k * STIFFNESSES)
    forces, strains = rows.peak_force, rows.peak_strain
    pressures = rows.peak_pressure
    if pad is None and planned.area is not None:
        pressures = forces / planned.area
    if rows.rising.any() or not np.isfinite(forces).all():
        return Driven(path, math.inf, math.inf, math.inf, math.inf, braking, keeps=False)
    force, pressure, strain = _rigid(pad, k, path, speed)
    if pad is None and planned.area is not None:
        pressure = force / planned.area
    stiffest = force >= float(forces.max())
    found = {
        "force": max(force, float(forces.max())),
        "pressure": float(np.fmax(pressure, np.fmax.reduce(pressures))),
        "strain": float(np.fmax(strain, np.fmax.reduce(strains))),
    }
    stiffness = math.inf if stiffest else float(k * STIFFNESSES[int(np.argmax(forces))])
    own = None if planned.covering is None else cell.strains.get(planned.covering)
    most = {
        "force": planned.limit.force,
        "pressure": planned.limit.pressure,
        "strain": None if pad is None else (pad.bottom[0] if own is None else own),
    }
    keeps = all(not (limit is not None and found[name] > limit * (1.0 + 1e-9)) for name, limit in most.items())
    return Driven(path, **found, stiffness=stiffness, deceleration=braking, keeps=keeps)


def _braking(separation: Mapping[str, Any], speed: float) -> float:
    """Return the deceleration in m/s^2, of measured stops that with the same way from the speed."""
    if "stopping" not in separation:
        return float(separation["deceleration"])
    curve = stopping_of(separation).curve(separation.get("load"), separation.get("extension"))
    # Without reaction and person the distance is the way of the stop.
    rules = ("human_speed", "reaction_time", "intrusion", "uncertainty", "target_speed")
    way = float(curve.distances(np.array([speed]), {name: np.zeros(1) for name in rules})[0])
    return _FASTEST_BRAKE if way <= 0.0 else min(0.5 * speed**2 / way, _FASTEST_BRAKE)


def _rigid(pad: Covering | None, k: float, path: float, speed: float) -> tuple[float, float, float]:
    """Return force, pressure and strain where the robot keeps to its way whatever the force.

    With a rate or a damper these are bounds: the largest compression at the largest speed of compression.
    """
    if pad is None:
        return k * path, math.nan, math.nan
    least, most = 0.0, path
    for _ in range(100):
        middle = 0.5 * (least + most)
        force = _force(pad, middle)
        least, most = (middle, most) if middle + force / k < path else (least, middle)
    force = _force(pad, most)
    if math.isinf(force):
        return math.inf, math.inf, math.inf
    strain = most / pad.thickness
    base, slope, reference = pad.rate
    factor = (1.0 + speed / (pad.thickness * reference)) ** (base + slope * strain)
    return (
        force * factor + pad.damping * speed,
        pad.column(most).peak_pressure * factor + (pad.damping * speed / pad.area if pad.area else 0.0),
        strain,
    )


def _force(pad: Covering, compression: float) -> float:
    """Return the force of a covering at rest in N, inf beyond its law."""
    try:
        return pad.column(compression).force
    except InvalidParameterError:
        return math.inf


def _words(cell: Cell) -> str:
    rules = cell.separation or {}
    stop = "stops as measured" if "stopping" in rules else f"brakes at {rules['deceleration']:g} m/s2"
    return f"a drive that reacts after {rules['reaction_time']:g} s and {stop}"


def drive_doubts(cell: Cell, planned: PlannedContact, driven: Driven | None) -> tuple[ResultWarning, ...]:
    """Return the doubts about a clamped contact: kept only without the drive, which was not given, or an odd stop."""
    if driven is None:
        # A robot that cannot yield has no allowed speed anyway.
        return () if cell.separation is not None or math.isinf(cell.robot.mass) else (UNKNOWN,)
    stop = {"reaction_time": (cell.separation or {})["reaction_time"], "deceleration": driven.deceleration}
    doubts = implausible(stop, {"deceleration": "robot_deceleration"})
    if driven.keeps:
        return doubts
    if not math.isfinite(driven.force):
        found = "the loads are not known: the stop or the covering is outside what was measured"
    else:
        kind = "a rigid one" if math.isinf(driven.stiffness) else f"one of {driven.stiffness:.3g} N/m"
        limit = "" if planned.limit.force is None else f" (limit {planned.limit.force:g} N)"
        found = f"the force is up to {driven.force:.4g} N{limit}, with {kind}"
    message = f"the allowed speed holds for {WITHOUT}: with {_words(cell)} {found}"
    return (*doubts, ResultWarning("drive_not_given", "separation", message))


def drive_fields(cell: Cell, planned: PlannedContact, closing: float, driven: Driven | None) -> dict[str, Any]:
    """Return what the report says of the drive of a clamped contact."""
    found: dict[str, Any] = {
        "holds_for": WITHOUT,
        **dict.fromkeys(("path", "peak_force", "peak_pressure", "peak_strain", "stiffness", "keeps_limits")),
        "allowed_closing_speed": None,
    }
    if driven is None:
        return found
    if driven.keeps:
        found["holds_for"] = f"any stiffness of {_words(cell)}"
    loads = {"path": driven.path, "peak_force": driven.force, "peak_pressure": driven.pressure}
    loads |= {"peak_strain": driven.strain}
    found |= {name: value if math.isfinite(value) else None for name, value in loads.items()}
    rigid = math.isinf(driven.stiffness) and math.isfinite(driven.force)
    found["stiffness"] = "rigid" if rigid else driven.stiffness if math.isfinite(driven.stiffness) else None
    found["keeps_limits"] = driven.keeps
    found["allowed_closing_speed"] = closing if driven.keeps else _allowed(cell, planned, closing)
    return found


def _allowed(cell: Cell, planned: PlannedContact, closing: float) -> float | None:
    """Return the largest speed below the planned one that keeps all limits with any drive; loads rise with it."""
    least, most = 0.0, closing
    for _ in range(HALVINGS):
        middle = 0.5 * (least + most)
        driven = driven_of(cell, planned, middle)
        least, most = (middle, most) if driven is not None and driven.keeps else (least, middle)
    return least if least > 0.0 else None
