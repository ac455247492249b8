"""The score of a run over ROS 2 as a report."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hrsafety.navigation.metrics.declared import METRICS
from hrsafety.pages import DASH
from hrsafety.pages.report import Report, ReportTable, Section
from hrsafety.ros.base import limits_of
from hrsafety.ros.bridge import Settings
from hrsafety.ros.record import BusRecord, Leg

__all__ = ["report_of"]

_COUNTED = {
    "commands": "velocity commands executed",
    "command_timeout": "times without a command for 0.5 s: the robot braked",
    "command_out_of_order": "commands older than one before: ignored",
    "command_late": "commands more than 0.2 s old: executed",
    "command_not_finite": "commands that were not finite: ignored",
    "command_clipped": "commands beyond the limits of the robot: cut to them",
    "command_from_future": "commands with a stamp later than the clock",
    "lockstep_timeout": "steps without a command within 1 s of the wall",
    "overrun": "times that the world fell behind the clock of the wall",
    "goal_pose": "goals taken",
    "goal_pose_refused": "goals refused",
    "initialpose": "places taken",
    "initialpose_refused": "places refused",
}
"""Meaning of each count."""


def report_of(record: BusRecord, settings: Settings, source: str) -> Report:
    """Return what came of a run.

    Parameters
    ----------
    record : BusRecord
        What happened.
    settings : Settings
        How the bridge ran.
    source : str
        The file of the world.

    Returns
    -------
    Report
        Verdict, legs with their metrics, what was counted on the bus, doubts.
    """
    contacts = record.contacts
    walls = sum(int(leg.metrics.wall_contacts) for leg in record.legs)
    touched = contacts.moving + contacts.standing + contacts.apart + walls
    return Report(
        title=f"{Path(source).name} over ROS 2",
        facts=list(_facts(record, settings, source)),
        said=_said(record, walls),
        good=not touched and record.legs[-1].outcome == "arrived",
        sections=[
            Section("Legs", [_legs(record)]),
            Section("On the bus", [_counts(record)]),
            Section("Social metrics", [_metrics(record)]),
        ],
        warnings=record.warnings,
        source=source,
        values={
            "source": source,
            "settings": _settings(settings),
            "verdict": _said(record, walls),
            "contacts": {**contacts._asdict(), "walls": walls},
            "legs": [_leg(leg) for leg in record.legs],
            "counts": {name: record.counts[name] for name in _COUNTED},
            "late_s": record.late,
        },
    )


def _said(record: BusRecord, walls: int) -> str:
    """Return the verdict in a sentence."""
    last, contacts = record.legs[-1], record.contacts
    parts = [
        f"{count} {words}"
        for count, words in (
            (contacts.toward, "with the robot moving toward somebody"),
            (contacts.away, "with the robot moving away"),
            (contacts.standing, "with the robot standing"),
            (contacts.apart, "with somebody who appeared on it"),
            (walls, "with a wall"),
        )
        if count
    ]
    arrival = float(last.trajectory.robot_arrival_time[0])
    if math.isfinite(arrival):
        end = f"arrived after {arrival:.2f} s"
    else:
        left = math.dist(last.trajectory.robot_position[-1, 0], last.world.robots[0].goal)
        end = f"ended {left:.2f} m from the goal"
    if record.counts["initialpose"]:
        count = record.counts["initialpose"]
        end += f", carried {'once' if count == 1 else f'{count} times'}"
    if not parts:
        return f"{end} without a contact"
    fault = f" ({contacts.at_fault} at fault)" if contacts.at_fault else ""
    return f"contacts: {', '.join(parts)}{fault}; {end}"


def _settings(settings: Settings) -> dict[str, Any]:
    names = ("lockstep", "period", "delay", "speed", "commands", "topic", "wait")
    lidar = {name: getattr(settings.lidar, name) for name in ("beams", "field_of_view", "range_min", "range_max")}
    return {**{name: getattr(settings, name) for name in names}, "lidar": lidar}


def _facts(record: BusRecord, settings: Settings, source: str) -> Iterator[tuple[str, str]]:
    world, lidar = record.world, settings.lidar
    time = sum(float(leg.trajectory.time[-1]) for leg in record.legs)
    delay = f", commands executed {settings.delay:g} s later" if settings.delay else ""
    stepped = f"lock-step of {settings.period:g} s, computing takes no time{delay}"
    paced = f"{settings.speed:g} times real time{delay}"
    yield "world", source
    more = f", more from {len(world.sources)} {'door' if len(world.sources) == 1 else 'doors'}" if world.sources else ""
    yield "people", f"{len(world.people)} in the file{more}; seed {world.seed}"
    yield "clock", stepped if settings.lockstep else paced
    yield "lidar", f"{lidar.beams} beams up to {lidar.range_max:g} m"
    (robot,) = world.robots
    limits = limits_of(robot.body)
    kind = "in any direction" if limits.sideways else "on two wheels"
    brakes = f"brakes at {limits.deceleration:g} m/s^2"
    yield "robot", f"radius {robot.body.radius:.3g} m, up to {limits.speed:g} m/s {kind}, {brakes}"
    yield "simulated", f"{time:.2f} s"
    yield "clearance", f"{record.clearance:.3f} m at least" if math.isfinite(record.clearance) else "nobody was near"


def _leg(leg: Leg) -> dict[str, Any]:
    """Return the values of a leg."""
    return {
        "reason": leg.reason,
        "begin_s": leg.begin,
        "duration_s": float(leg.trajectory.time[-1]),
        "goal_m": leg.world.robots[0].goal,
        "outcome": leg.outcome,
        "arrival_time_s": float(leg.trajectory.robot_arrival_time[0]),
        "without_command_s": leg.standing_by,
        "contacts": leg.contacts._asdict(),
        "metrics": leg.metrics.to_dict(),
    }


def _legs(record: BusRecord) -> ReportTable:
    names = (
        "leg",
        "begins with",
        "goal",
        "outcome",
        "duration",
        "arrival",
        "path",
        "toward",
        "away",
        "standing",
        "wall",
    )
    units = ("", "", "m", "", "s", "s", "m", "contacts", "contacts", "contacts", "contacts")
    rows = [
        (
            index,
            leg.reason,
            "({:.2f}, {:.2f})".format(*leg.world.robots[0].goal),
            leg.outcome,
            f"{leg.trajectory.time[-1]:.2f}",
            _number(float(leg.trajectory.robot_arrival_time[0])),
            f"{leg.metrics.path_length:.2f}",
            leg.contacts.toward,
            leg.contacts.away,
            leg.contacts.standing,
            int(leg.metrics.wall_contacts),
        )
        for index, leg in enumerate(record.legs)
    ]
    return ReportTable(headers=(names, units), rows=rows, left=(1, 2, 3), printed=True)


def _metrics(record: BusRecord) -> ReportTable:
    legs = [f"leg {index}" for index in range(len(record.legs))]
    values = [leg.metrics.to_dict() for leg in record.legs]
    rows = [(metric.name, *(_number(each[metric.name]) for each in values), metric.unit) for metric in METRICS.values()]
    return ReportTable(headers=(("metric", *legs, "unit"),), rows=rows, left=(0,), summary="all of them")


def _counts(record: BusRecord) -> ReportTable:
    rows = [(record.counts[name], words) for name, words in _COUNTED.items() if record.counts[name]]
    return ReportTable(headers=(("count", "what"),), rows=rows, left=(1,), printed=bool(rows))


def _number(value: float) -> str:
    """Return a number, a truth value as a word, and a dash where there is none."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return DASH if not math.isfinite(value) else str(value) if isinstance(value, int) else f"{value:.3f}"
