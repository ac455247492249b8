"""Verdicts of a planned program: each limit held against the waypoint that uses it most."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety.arms import Arm
from hrsafety.arms.doubts import doubts_of_base, doubts_of_point, for_rule
from hrsafety.arms.link_doubts import several
from hrsafety.arms.masses import mass_by_rule
from hrsafety.arms.rolling import RollingBase, links_of_base
from hrsafety.arms.tool_doubts import doubts_of_tool
from hrsafety.plausibility import ResultWarning, unsafe_doubts
from hrsafety.program.contacts import BLOCK, MASSES, TaskContacts, Waypoints
from hrsafety.program.exposures import NOT_PERMITTED, Exposure
from hrsafety.program.runs import Runs
from hrsafety.program.task import ContactTask
from hrsafety.standards.verdicts import speed_verdict

__all__ = ["EVEN", "JudgedExposure", "judged", "named_doubts", "path_doubts", "robot_fields", "shares_of"]

DISAGREES = 0.05
"""Share of the fastest recorded speed of the tool center point by which that of the joints may differ."""
EVEN = 1e-9
"""Share by which a speed may be above its limit by rounding."""


@dataclass(frozen=True, kw_only=True, slots=True)
class JudgedExposure:
    """A limit of a program with the waypoint that uses it most.

    Attributes
    ----------
    exposure : Exposure
        The limit.
    waypoint : int
        Index of the waypoint, -1 where the point never moves.
    time, place : float
        Instant in s and path parameter.
    joints, velocity : tuple of float
        The pose in rad or m, and the velocity of the point in m/s.
    speed, allowed_speed : float
        Planned and allowed speed of the point in m/s; inf where nothing limits it.
    masses : dict of str to float
        Masses in kg along the motion, of the worst normal and of all kinetic energy.
    share : float
        Planned over allowed speed.
    verdict : {"not_permitted", "exceeds", "not_checked", "within_limits"}
        Of the planned speed.
    doubts : tuple of ResultWarning
        Those that may lie on the unsafe side and are not confirmed.
    confirmed : tuple of str
        Codes that somebody has confirmed.
    warnings : tuple of ResultWarning
        All doubts about it.
    """

    exposure: Exposure
    waypoint: int
    time: float
    place: float
    joints: tuple[float, ...]
    velocity: tuple[float, ...]
    speed: float
    allowed_speed: float
    masses: dict[str, float]
    share: float
    verdict: str
    doubts: tuple[ResultWarning, ...]
    confirmed: tuple[str, ...]
    warnings: tuple[ResultWarning, ...]

    @property
    def scale(self) -> float:
        """Share of the planned speed that is allowed, at most 1."""
        return 1.0 if self.share <= 1.0 else 1.0 / self.share


def path_doubts(runs: Runs) -> Iterator[ResultWarning]:
    """Yield the doubts about the path: parts that no segment speaks of, poses near singular ones."""
    missing = runs.program.uncovered
    if missing > 0.0:
        message = f"{100.0 * missing:.3g} % of the path belong to no segment: nothing is checked there"
        yield ResultWarning("path_without_segment", "segments", message)
    yield from runs.motion.warnings
    yield from _against_tool(runs)
    arm = runs.motion.arm
    own = set(links_of_base(arm.urdf))
    if runs.motion.drives and not any(each.link in own for each in runs.program.points):
        message = (
            "the base drives, and none of the points lies on it: contacts of the base itself are not checked: name a "
            f"point on {several(sorted(own))}"
        )
        yield ResultWarning("base_without_point", "points", message)


def _against_tool(runs: Runs) -> Iterator[ResultWarning]:
    """Yield the doubt about a log whose joints do not move the tool center point as it was recorded."""
    log = runs.program.motion.log
    if log is None or log.tool_speed is None or runs.motion.drives:
        return
    masses = runs.contact(None).masses(log.joints, log.rates, body_masses=np.zeros(0), threads=runs.threads)
    own = np.linalg.norm(masses["velocity"][:, -1], axis=1)
    off = float(np.sqrt(np.mean((own - log.tool_speed) ** 2)))
    fastest = max(float(own.max()), float(log.tool_speed.max()))
    if off > DISAGREES * fastest:
        message = (
            f"the joints of the log move the tool center point by {off:.3g} m/s (root of the mean square) otherwise "
            "than it was recorded: are columns of joints swapped, or is link or point of the tool another one?"
        )
        yield ResultWarning("log_disagrees_with_tool", "motion.log", message)


def judged(
    runs: TaskContacts,
    waypoints: Waypoints,
    contact: _hrsafety.ProgramContact,
    rows: tuple[Exposure, ...],
    general: tuple[ResultWarning, ...],
) -> list[JudgedExposure]:
    """Return the limits of a program held against its waypoints.

    Parameters
    ----------
    runs : TaskContacts
        Of the program.
    waypoints : Waypoints
        Planned places and rates.
    contact : native contact
        Of the rows.
    rows : tuple of Exposure
        The limits.
    general : tuple of ResultWarning
        Doubts about the motion, those of every limit.
    """
    worst, share = _worst(runs, waypoints, contact, rows)
    used = np.unique(worst[worst >= 0])
    numbers = contact.masses(
        waypoints.joints[used], waypoints.rates[used], body_masses=np.zeros(0), threads=runs.threads
    )
    everywhere = contact.masses(waypoints.joints, waypoints.rates, body_masses=np.zeros(0), threads=runs.threads)
    about = [
        (*_about_point(runs, everywhere[runs.own][:, place], place), *_of_base(runs, waypoints, everywhere, place))
        for place in range(len(runs.task.points))
    ]
    found = []
    for number, row in enumerate(rows):
        at, doubts = int(worst[number]), (*row.warnings, *about[row.point], *general)
        line = int(np.searchsorted(used, at)) if at >= 0 else -1
        found.append(_row(runs, waypoints, numbers, row, at, line, float(share[number]), doubts))
    return found


def shares_of(
    runs: TaskContacts, waypoints: Waypoints, contact: _hrsafety.ProgramContact, rows: tuple[Exposure, ...]
) -> Iterator[tuple[int, Array]]:
    """Yield planned over allowed speeds (waypoints, rows) by blocks, each with the index of its first waypoint."""
    points = np.array([each.point for each in rows], dtype=np.int64)
    step = max(BLOCK // max(len(rows), 1), 1)
    for first in range(0, len(waypoints.time), step):
        block = slice(first, first + step)
        found = contact.allowed(
            waypoints.joints[block], waypoints.rates[block], waypoints.place[block], every=True, threads=runs.threads
        )
        speed = found["speed"][:, points]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(speed > 0.0, speed / found["allowed"][:, : len(rows)], 0.0)
        yield first, np.where(np.isnan(share), np.inf, share)  # a limit that is no number is not kept


def _worst(
    runs: TaskContacts, waypoints: Waypoints, contact: _hrsafety.ProgramContact, rows: tuple[Exposure, ...]
) -> tuple[Array, Array]:
    """Return the waypoint that uses each limit most, -1 for none, and the share."""
    worst, most = np.full(len(rows), -1), np.zeros(len(rows))
    for first, share in shares_of(runs, waypoints, contact, rows):
        at = share.argmax(axis=0)
        here = share[at, np.arange(len(rows))]
        better = here > most
        worst[better], most[better] = first + at[better], here[better]
    return worst, most


def _about_point(runs: TaskContacts, masses: Array, place: int) -> tuple[ResultWarning, ...]:
    """Return the doubts about the masses of a point."""
    program, arm = runs.task, runs.task.motion.arm
    moving = masses[np.isfinite(masses)]
    point = np.array(program.points[place].point)
    own = for_rule(arm.warnings, program.robot_mass, moving, arm.iso_mass, arm.mass_source)
    return (*own, *doubts_of_point(point, arm.reach), *doubts_of_tool(arm, program.points[place].link, point))


def _of_base(
    runs: TaskContacts, waypoints: Waypoints, numbers: dict[str, Array], place: int
) -> tuple[ResultWarning, ...]:
    """Return the doubt about a base that may be held, where that makes a point heavier along its motion."""
    arm, point = runs.task.motion.arm, runs.task.points[place]
    moving = numbers["speed"][:, place] > 0.0
    if not arm.base_joints or not moving.any() or point.link in links_of_base(arm.urdf):
        return ()
    joints, rule = waypoints.joints[moving], runs.task.robot_mass
    place_of: dict[str, Any] = {
        "link": point.link,
        "point": point.point,
        "check_limits": False,
        "threads": runs.threads,
    }
    if runs.own == MASSES[0]:
        held = standing(arm).effective_mass(joints, direction=numbers["velocity"][moving, place], **place_of).mass
    else:
        held = standing(arm).extremes(joints, **place_of).worst_mass
    return doubts_of_base(rule, mass_by_rule(rule, numbers[runs.own][moving, place], arm.iso_mass), held)


def standing(arm: Arm) -> Arm:
    """Return an arm whose base stands still."""
    return replace(arm, locked=tuple(dict.fromkeys((*arm.locked, *arm.base_joints))))


def _row(
    runs: TaskContacts,
    waypoints: Waypoints,
    numbers: dict[str, Array],
    row: Exposure,
    at: int,
    line: int,
    share: float,
    doubts: tuple[ResultWarning, ...],
) -> JudgedExposure:
    unsafe = tuple(dict.fromkeys(unsafe_doubts(doubts)))
    confirmed = runs.task.confirmed
    left = tuple(each for each in unsafe if each.code not in confirmed)
    speed = float(numbers["speed"][line, row.point]) if at >= 0 else 0.0
    verdict = speed_verdict(share, 1.0 + EVEN, permitted=row.limit.permitted, checked=not left)
    masses = {name: float(numbers[name][line, row.point]) for name in MASSES} if at >= 0 else {}
    velocity = numbers["velocity"][line, row.point] if at >= 0 else np.zeros(3)
    return JudgedExposure(
        exposure=row,
        waypoint=at,
        time=float(waypoints.time[at]) if at >= 0 else float("nan"),
        place=float(waypoints.place[at]) if at >= 0 else float("nan"),
        joints=tuple(waypoints.joints[at].tolist()) if at >= 0 else (),
        velocity=tuple(velocity.tolist()),
        speed=speed,
        allowed_speed=speed / share if share > 0.0 else float("inf"),
        masses=masses,
        share=share,
        verdict=verdict,
        doubts=tuple(each for each in left if each is not NOT_PERMITTED),
        confirmed=tuple(dict.fromkeys(each.code for each in unsafe if each.code in confirmed)),
        warnings=tuple(dict.fromkeys(each for each in doubts if each is not NOT_PERMITTED)),
    )


def named_doubts(task: ContactTask, rows: Sequence[JudgedExposure]) -> Iterator[ResultWarning]:
    """Yield each doubt of some rows once, one about a limit with its first point and region and how many others."""
    places: dict[ResultWarning, list[str]] = {}
    for row in rows:
        limit, own = row.exposure.limit, set(row.exposure.warnings)
        name = f"{task.points[row.exposure.point].name}, {limit.region}, {limit.contact}"
        for found in row.warnings:
            places.setdefault(found, []).extend([name] if found in own else [])
    for found, where in places.items():
        more = "" if len(where) < 2 else f" and {len(where) - 1} more"
        yield replace(found, message=f"{where[0]}{more}: {found.message}") if where else found


def held_mass(row: JudgedExposure, task: ContactTask) -> float | None:
    """Return the mass of a row along its motion if a base that rolls stood still, in kg."""
    arm = task.motion.arm
    if not arm.base_joints or not row.joints or row.speed == 0.0:
        return None
    point = task.points[row.exposure.point]
    found = standing(arm).effective_mass(
        row.joints, link=point.link, point=point.point, direction=row.velocity, check_limits=False, threads=1
    )
    return float(found.mass)


def fields_of(row: JudgedExposure, runs: TaskContacts) -> dict[str, Any]:
    """Return a row as JSON holds it."""
    limit, program = row.exposure.limit, runs.task
    names = program.motion.arm.joint_names
    rolling = {"mass_if_base_stands": held_mass(row, program)} if program.motion.arm.base_joints else {}
    return {
        "point": program.points[row.exposure.point].name,
        "segment": program.segment_name(row.exposure.segment),
        "region": limit.region,
        "area_name": limit.area,
        "contact": limit.contact,
        "covering": row.exposure.covering,
        "with_drive": row.exposure.how == "drive",
        "contact_area": row.exposure.area,
        "verdict": row.verdict,
        "time": row.time,
        "pose": dict(zip(names, row.joints, strict=True)) if row.joints else None,
        "velocity": list(row.velocity),
        "speed": row.speed,
        "allowed_speed": row.allowed_speed,
        "scale": row.scale,
        "governs": row.exposure.governs,
        **{name: row.masses.get(name) for name in MASSES},
        **rolling,
        "human_speed": row.exposure.human_speed,
        "doubts": list(dict.fromkeys(each.code for each in row.doubts)),
        "reasons": list(dict.fromkeys(each.message for each in row.doubts)),
        "confirmed": list(row.confirmed),
    }


def robot_fields(task: ContactTask, velocity: Array) -> dict[str, Any]:
    """Return what is known of the robot as JSON holds it, with the largest rates of its joints."""
    arm = task.motion.arm
    names = list(arm.joint_names)
    return {
        "name": arm.name,
        "sha256": arm.sha256,
        "base": None if not isinstance(arm.base, RollingBase) else {"kind": arm.base.kind, "mass": arm.base.mass},
        "iso_mass": arm.iso_mass,
        "total_mass": arm.total_mass,
        "moving_mass": arm.moving_mass,
        "payload_mass": arm.payload_mass,
        "mass_rule": task.robot_mass,
        "direction": task.direction,
        "joints": names,
        "velocity": dict(zip(names, velocity.tolist(), strict=True)),
        "tool": {"link": task.link, "point": list(task.point), "speed": task.tcp_speed},
    }
