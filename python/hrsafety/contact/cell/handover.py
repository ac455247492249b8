"""Documents of a cell beside its verdict: the plan of measurements, the annex, distances for a scanner."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hrsafety.contact.annex import Annex, Assumption, Hazard, annex_of
from hrsafety.contact.cell.cell import Cell, PlannedContact
from hrsafety.contact.cell.judgement import Judged
from hrsafety.contact.covering import Covering
from hrsafety.contact.drive import Drive
from hrsafety.contact.plan import MeasurementPlan, PlannedMeasurement
from hrsafety.contact.simulation import ContactImpact
from hrsafety.plausibility import unsafe_doubts
from hrsafety.standards.contact_limits import CONTACTS, ContactLimit
from hrsafety.standards.fields import FieldDistances
from hrsafety.standards.limit_sets import LimitSet
from hrsafety.standards.verdicts import strictest

__all__ = [
    "HUMAN_SPEED",
    "annex_of_cell",
    "assumed",
    "assumptions_about",
    "distances_fields",
    "hazard_of",
    "left_out",
    "limit_words",
    "payload_assumed",
    "plan_of",
    "regions_of",
]

CLASSES = {"quasi_static": "clamped", "transient": "free"}


def regions_of(judged: Sequence[Judged]) -> list[dict[str, Any]]:
    """Return one row for each region: its slowest allowed speed over all contacts with it, and what governs that.

    Parameters
    ----------
    judged : sequence of Judged
        Contacts in their order.

    Returns
    -------
    list of dict
        ``allowed_speed`` and ``planned_speed`` in m/s, the strictest verdict, the contact that governs with its
        ``row`` among the verdicts. Of a region with a contact that has no allowed speed it is ``None``.
    """
    rows: dict[str, list[tuple[int, dict[str, Any]]]] = {}
    for index, each in enumerate(judged):
        rows.setdefault(each.planned.limit.region, []).append((index, each.verdict))
    found = []
    for region, held in rows.items():
        index, slowest = min(held, key=lambda one: -1.0 if one[1]["allowed_speed"] is None else one[1]["allowed_speed"])
        names = ("area_name", "contact", "covering", "governs", "status", "allowed_speed")
        found.append(
            {
                "region": region,
                "row": index,
                **{name: slowest[name] for name in names},
                "with_drive": (slowest["drive"] or {}).get("status") == slowest["status"],
                "planned_speed": max(row["planned_speed"] for _, row in held),
                "verdict": strictest(row["verdict"] for _, row in held),
            }
        )
    return found


def left_out(contacts: Sequence[PlannedContact]) -> list[dict[str, Any]]:
    """Return the class of contact in which a planned region is not judged, since no contact of the cell names it.

    Parameters
    ----------
    contacts : sequence of PlannedContact
        Of a cell.

    Returns
    -------
    list of dict
        ``region``, ``area_name`` and ``contact``, by class.
    """
    held = {(each.limit.region, each.limit.area, each.limit.contact) for each in contacts}
    places = dict.fromkeys((each.limit.region, each.limit.area) for each in contacts)
    return [
        {"region": region, "area_name": area, "contact": kind}
        for kind in CONTACTS
        for region, area in places
        if (region, area, kind) not in held
    ]


def plan_of(cell: Cell, judged: Sequence[Judged], loads: Sequence[dict[str | None, ContactImpact]]) -> MeasurementPlan:
    """Return what to measure: every contact that is permitted and known, the load that governs it.

    Parameters
    ----------
    cell : Cell
        What was asked.
    judged : sequence of Judged
        Its contacts.
    loads : sequence of dict
        Collisions at the planned speed by covering.

    Returns
    -------
    MeasurementPlan
        With predictions, the drive with them where the cell has one.
    """
    rows = []
    robot = cell.robot
    for each, impacts in zip(judged, loads, strict=True):
        planned, row = each.planned, each.verdict
        limit = planned.limit
        if not limit.permitted:
            continue
        load = "pressure" if row["governs"] == "pressure" else "force"
        found = impacts.get(planned.covering)
        value = None if found is None else getattr(found, f"peak_{load}")
        if found is not None and load == "pressure" and planned.covering is None and planned.area:
            value = None if found.peak_force is None else found.peak_force / planned.area
        driven = (row["drive"] or {}).get(f"peak_{load}")
        region = limit.region if limit.area is None else f"{limit.region} ({limit.area})"
        rows.append(
            PlannedMeasurement(
                place=str(robot.inputs.get("link", robot.kind)),
                region=region,
                contact=limit.contact,
                speed=planned.speed + cell.human_speed,
                spring=limit.spring_constant,
                limit=getattr(limit, load),
                load=load,
                prediction=value if driven is None else driven,
                pose=robot.pose,
                direction=robot.direction,
                payload=robot.payload_mass or 0.0,
                covering=planned.covering,
            )
        )
    return MeasurementPlan(rows=tuple(rows))


def distances_fields(found: FieldDistances) -> dict[str, Any]:
    """Return both distances with their terms as the report holds them."""
    names = ("stop", "slow_down", "robot_speed", "contact_speed", "stop_terms", "slow_down_terms", "said")
    doubts = [each.code for each in unsafe_doubts(found.warnings)]
    return {name: getattr(found, name) for name in names} | {"doubts": doubts}


def annex_of_cell(cell: Cell, judged: Sequence[Judged], distances: FieldDistances | None) -> Annex:
    """Return the annex of a cell: what it says itself, and what its verdict rests on.

    Parameters
    ----------
    cell : Cell
        With its annex.
    judged : sequence of Judged
        Its contacts.
    distances : FieldDistances or None
        For the field of a scanner.

    Returns
    -------
    Annex
        To be filled.
    """
    hazards, limits = [], []
    for each in judged:
        planned, limit = each.planned, each.planned.limit
        covering = "bare" if planned.covering is None else f"covering {planned.covering!r}"
        hazards.append(hazard_of(limit, f"speed at most {planned.speed:g} m/s, {covering}"))
        limits.append(limit_words(limit, cell.limits))
    return annex_of(
        cell.annex,
        hazards=hazards,
        assumptions=list(_assumptions(cell, distances)),
        limits=list(dict.fromkeys(limits)),
        hashes=dict(cell.files),
    )


def hazard_of(limit: ContactLimit, measures: str, where: str = "") -> Hazard:
    """Return the contact with a region as a hazard with what is done against it."""
    return Hazard(
        hazard=f"contact with {_region(limit)}{where}".replace("_", " "),
        contact=CLASSES[limit.contact],
        measures=measures,
    )


def limit_words(limit: ContactLimit, limits: LimitSet) -> str:
    """Return a limit with its edition, to be compared with one's own copy."""
    loads = [
        f"{name} {value:g} {unit}"
        for name, value, unit in (("force", limit.force, "N"), ("pressure", limit.pressure, "Pa"))
        if value is not None
    ]
    words = ", ".join(loads) if limit.permitted else "not permitted"
    edition = f"({limits.title}, edition {limits.edition})"
    return f"{_region(limit)}, {CLASSES[limit.contact]}: {words} {edition}".replace("_", " ")


def _region(limit: ContactLimit) -> str:
    return f"{limit.region} ({limit.area})" if limit.area else limit.region


def assumed(name: str, value: str, broken_by: str) -> Assumption:
    """Return an assumption with what breaks it."""
    return Assumption(name=name, value=value, broken_by=broken_by)


def _assumptions(cell: Cell, distances: FieldDistances | None) -> Iterator[Assumption]:
    speeds = [each.speed for each in cell.contacts]
    robot = cell.robot
    mass = "unbounded" if math.isinf(robot.mass) else f"{robot.mass:.4g} kg"
    yield assumed(
        "speed of the robot in a contact", f"at most {max(speeds):g} m/s", "another program, a changed override"
    )
    yield assumed("mass of the robot", mass, "a heavier payload or tool, other poses")
    yield assumed(HUMAN_SPEED, f"at most {cell.human_speed:g} m/s", "people who walk there")
    if robot.payload_mass is not None:
        yield payload_assumed(robot.payload_mass)
    yield from assumptions_about(cell.coverings, cell.drive, distances, cell.confirmed)


HUMAN_SPEED = "speed of the person towards the robot"


def payload_assumed(mass: float) -> Assumption:
    """Return the assumption about the payload."""
    return assumed("payload", f"at most {mass:g} kg", "another tool or workpiece")


def assumptions_about(
    coverings: Mapping[str, Covering],
    drive: Drive | None,
    distances: FieldDistances | None,
    confirmed: Mapping[str, str],
) -> Iterator[Assumption]:
    """Yield what verdicts assume of coverings, the drive, the field of a scanner, and what somebody has confirmed."""
    for name, pad in coverings.items():
        value = f"{1e3 * pad.thickness:g} mm, {pad.material.law.replace('_', ' ')}"
        yield assumed(f"covering {name!r}", value, "wear, dirt, another material, a place without it")
    if drive is not None and drive.model != "none":
        if drive.reaction_time is not None:
            yield assumed("reaction time of the drive", f"{drive.reaction_time:g} s", "filters, a slower bus")
            yield assumed("detection force", f"{drive.detection_force:g} N", "a coarser setting")
        if drive.deceleration is not None:
            value = f"{drive.deceleration:g} m/s^2"
            yield assumed("deceleration of the drive", value, "worn brakes, more payload")
        if drive.push_limit is not None:
            yield assumed("push limit of the drive", f"{drive.push_limit:g} N", "other settings, another pose")
    if distances is not None:
        slow = "" if distances.slow_down is None else f", {distances.slow_down:.3f} m to slow down"
        value = f"{distances.stop:.3f} m to stop{slow}"
        yield assumed("distance of the scanner field", value, "faster people, objects that hide somebody")
    for code, reason in confirmed.items():
        yield assumed(f"confirmed: {code.replace('_', ' ')}", reason, "a change of the machine")
