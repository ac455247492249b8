"""Measurement plan of a program: what has to be measured so that its limits are confirmed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety.arms.masses import mass_by_rule
from hrsafety.contact import Contact, MeasurementPlan, PlannedMeasurement, driven_loads
from hrsafety.errors import InvalidParameterError
from hrsafety.program.contacts import Choice
from hrsafety.program.exposures import Exposure
from hrsafety.program.motion import Retimed
from hrsafety.program.runs import Runs

__all__ = ["plan_of"]

CONTACT = 2
"""Code of the core for a place that contacts limit."""
SLOWEST = 1e-6
"""Speed in m/s below which nothing is to be measured."""


def plan_of(runs: Runs, run: Retimed, choice: Choice) -> MeasurementPlan:
    """Return the plan of a run within the limits of contacts.

    Parameters
    ----------
    runs : Runs
        Of the program.
    run : Retimed
        The run.
    choice : tuple of str or None
        Its coverings.

    Returns
    -------
    MeasurementPlan
        One row for each point, region and class that governs in a segment; where none does the hardest one.
    """
    if not np.isfinite(run.time):
        return MeasurementPlan(rows=())
    nodes, rows, contact = run.motion.curve.nodes, runs.rows(choice), runs.contact(choice)
    found: list[PlannedMeasurement] = []
    for place, (first, last) in enumerate(runs.spans):
        inside = np.flatnonzero((nodes[1:] > first) & (nodes[:-1] < last))
        of_contact = (run.reason[inside] == CONTACT) & (run.reason_index[inside] < len(rows))
        governing = {
            int(row): inside[of_contact & (run.reason_index[inside] == row)]
            for row in np.unique(run.reason_index[inside][of_contact])
        }
        if not governing:
            hardest = inside[int(np.argmax(run.contact_share[inside]))]
            if run.contact_row[hardest] >= 0 and run.contact_row[hardest] < len(rows):
                governing = {int(run.contact_row[hardest]): np.array([hardest])}
        for row, intervals in governing.items():
            if rows[row].segment == place:
                found += _measured(runs, run, contact, rows[row], intervals)
    return MeasurementPlan(rows=tuple(found))


def _measured(
    runs: Runs, run: Retimed, contact: _hrsafety.ProgramContact, row: Exposure, intervals: np.ndarray[Any, Any]
) -> list[PlannedMeasurement]:
    """Return the row of a limit where it lets the robot be fastest; none where its point hardly moves."""
    x = 0.5 * (run.squared_speed[intervals] + run.squared_speed[intervals + 1])
    middles = 0.5 * (run.motion.curve.nodes[intervals] + run.motion.curve.nodes[intervals + 1])
    joints, tangents, _ = run.motion.curve.at(middles, intervals)
    found = contact.masses(joints, tangents * np.sqrt(x)[:, np.newaxis], body_masses=np.zeros(0), threads=runs.threads)
    speeds = found["speed"][:, row.point]
    at = int(np.argmax(speeds))
    speed = float(speeds[at])
    if speed <= SLOWEST:
        return []
    program, arm = runs.program, runs.program.motion.arm
    mass = float(mass_by_rule(program.robot_mass, found[runs.own][at, row.point], arm.iso_mass))
    velocity = found["velocity"][at, row.point]
    load = "pressure" if row.governs == "pressure" else "force"
    return [
        PlannedMeasurement(
            place=f"{program.segment_name(row.segment)}, {program.points[row.point].name}",
            region=row.limit.region,
            contact=row.limit.contact,
            pose=dict(zip(arm.joint_names, joints[at].tolist(), strict=True)),
            direction=tuple((velocity / speed).tolist()),
            speed=speed,
            payload=arm.payload_mass,
            spring=row.limit.spring_constant,
            covering=row.covering,
            load=load,
            prediction=_predicted(runs, row, mass, speed + row.human_speed, load),
            limit=getattr(row.limit, load),
        )
    ]


def _predicted(runs: Runs, row: Exposure, mass: float, speed: float, load: str) -> float | None:
    """Return the peak force in N or pressure in Pa of a contact at a closing speed."""
    program, drive = runs.program, runs.drive(row.point)
    pad = None if row.covering is None else program.coverings[row.covering]
    strain = None if row.covering is None else program.strains.get(row.covering)
    hit = Contact(robot=mass, body=row.limit, covering=pad, area=row.area, max_strain=strain)
    try:
        if row.how == "drive" and drive is not None:
            found: float | None = getattr(driven_loads(hit, speed, drive), load)
        else:
            impact = hit.simulate(speed, head=False)
            found = getattr(impact, f"peak_{load}")
            if load == "pressure" and pad is None and row.area is not None:
                found = None if impact.peak_force is None else impact.peak_force / row.area
    except InvalidParameterError as error:
        # A covering that is compressed by more than was measured has no loads; its rows say so.
        if "beyond_data" not in error.requirement:
            raise
        return None
    return found if found is not None and math.isfinite(found) else None
