"""Zones of constant speed, as they are typed into the pendant of a robot."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety.program.contacts import Choice
from hrsafety.program.curves import Indices
from hrsafety.program.exposures import Exposure
from hrsafety.program.motion import ArmMotion, Retimed
from hrsafety.program.runs import Runs

__all__ = [
    "PathPlace",
    "PathSpeeds",
    "SpeedZone",
    "SpeedZones",
    "place_of",
    "speeds_of",
    "told_limit",
    "way_of",
    "zones_of",
]

CELLS = 400
PLACES = np.linspace(0.0, 1.0, 5)
"""Where each interval of the path is looked at."""


class PathPlace(NamedTuple):
    """A place of the path as a programmer finds it: the move, and mm of the tool center point from its start."""

    move: str
    distance: float


class SpeedZone(NamedTuple):
    """A part of the path with one speed.

    Attributes
    ----------
    first, last : float
        Path parameter where it begins and ends.
    start, end : PathPlace
        The same by move and mm; the start where the speed is to be typed, with room to slow down before it.
    speed : float
        In m/s of the tool center point, or in percent of the full speed of the joints.
    change : {"start", "slow_down", "speed_up"}
        Against the zone before.
    reason : str
        What limits it: point, region, class and limit, or the robot itself.
    """

    first: float
    last: float
    start: PathPlace
    end: PathPlace
    speed: float
    change: str
    reason: str


class SpeedZones(NamedTuple):
    """Zones of a program.

    Attributes
    ----------
    status : {"found", "not_permitted", "tool_stands"}
        Whether there are any: a place with less than one step of speed, or a tool center point that never moves, has
        none.
    percent : bool
        Whether speeds are in percent of the full speed of the joints.
    zones : tuple of SpeedZone
        In the order of the path.
    blocked : tuple of PathPlace
        Where less than a step is allowed.
    run : Retimed or None
        The program with these zones typed in.
    """

    status: str
    percent: bool
    zones: tuple[SpeedZone, ...]
    blocked: tuple[PathPlace, ...]
    run: Retimed | None


class PathSpeeds(NamedTuple):
    """Of each interval at five places: TCP speed per ds/dt, ds/dt allowed by contacts, full ds/dt, what governs."""

    tool: Array
    allowed: Array
    full: Array
    governs: Array

    @property
    def tool_allowed(self) -> Array:
        """Speed of the tool center point that contacts allow in m/s, inf where none limits it."""
        with np.errstate(invalid="ignore"):
            return np.where(np.isinf(self.allowed), np.inf, self.allowed * self.tool)


def zones_of(runs: Runs, choice: Choice) -> SpeedZones | None:
    """Return the zones of a program with a choice of coverings, ``None`` where none are asked for."""
    rules = runs.program.zone_rules
    if rules is None:
        return None
    nodes = runs.motion.curve.nodes
    found = speeds_of(runs, choice)
    way = way_of(runs.motion, found)
    length, edges = _cells(way)
    percent = rules.percent is not None
    if not len(length):
        return SpeedZones("tool_stands", percent, (), (), None)
    starts = edges[:-1]
    if rules.percent is not None:
        share = np.minimum(found.allowed / found.full, 1.0).min(axis=1)
        caps = 100.0 * np.minimum.reduceat(share, starts)
        lengths = np.add.reduceat(np.diff(nodes) / found.full.min(axis=1), starts)
    else:
        most = float((found.full * found.tool).max())
        wanted = runs.program.tcp_speed
        speed = np.minimum(found.tool_allowed, most if wanted is None else min(most, wanted)).min(axis=1)
        caps, lengths = np.minimum.reduceat(speed, starts), length
    step = rules.step if rules.percent is None else rules.percent
    made = _hrsafety.program_zones(lengths, caps, count=rules.count, step=step)
    if made["status"] != "found":
        blocked = tuple(place_of(runs.motion, way, float(nodes[edges[each]])) for each in made["cells"])
        return SpeedZones("not_permitted", percent, (), blocked, None)
    bounds = edges[[*made["first"], made["last"][-1]]]
    return _typed(runs, choice, found, made["speed"], bounds, way, percent)


def speeds_of(runs: Runs, choice: Choice) -> PathSpeeds:
    """Return what holds at five places of each interval."""
    curve = runs.motion.curve
    places = curve.nodes[:-1, np.newaxis] + np.diff(curve.nodes)[:, np.newaxis] * PLACES
    rows = np.broadcast_to(np.arange(len(curve.coefficients))[:, np.newaxis], places.shape)
    joints, rates, _ = curve.at(places, rows)
    # A place on a node belongs to the interval that is looked at, also for limits that begin or end there.
    inside = np.clip(places, places[:, 1:2], places[:, -2:-1])
    flat = (joints.reshape(-1, joints.shape[-1]), rates.reshape(-1, rates.shape[-1]), inside.reshape(-1))
    allowed = runs.contact(choice).allowed(*flat, threads=runs.threads)
    speed, lowest = allowed["speed"], allowed["lowest"]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(speed > 0.0, lowest / speed, np.inf)
        full = np.where(rates != 0.0, runs.motion.velocity / np.abs(rates), np.inf).min(axis=-1)
    hardest = ratio.argmin(axis=1)
    governs = np.take_along_axis(allowed["governs"], hardest[:, np.newaxis], axis=1)[:, 0]
    return PathSpeeds(
        speed[:, -1].reshape(places.shape), ratio.min(axis=1).reshape(places.shape), full, governs.reshape(places.shape)
    )


def way_of(motion: ArmMotion, found: PathSpeeds) -> Array:
    """Return the way of the tool center point up to each node in m, by the rule of Boole in each interval."""
    lengths = found.tool @ (np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0) * np.diff(motion.curve.nodes)
    return np.concatenate([[0.0], np.cumsum(lengths)])


def _cells(way: Array) -> tuple[Array, Indices]:
    """Return the lengths of at most 400 cells of the path, and the nodes that they begin and end at."""
    if not way[-1] > 1e-9:
        return np.zeros(0), np.zeros(1, dtype=np.intp)
    even = np.linspace(0.0, way[-1], CELLS + 1)
    edges = np.unique(np.searchsorted(way, even - 1e-9 * way[-1]))
    edges[0], edges[-1] = 0, len(way) - 1
    return np.diff(way[edges]), edges


def _typed(
    runs: Runs, choice: Choice, found: PathSpeeds, speeds: Array, bounds: Indices, way: Array, percent: bool
) -> SpeedZones:
    """Return the zones with their places and reasons, and the run with them."""
    nodes, rules = runs.motion.curve.nodes, runs.program.zone_rules
    assert rules is not None
    tool = speeds
    if percent:
        full = (found.full * found.tool)[:, 2]
        tool = 0.01 * speeds * full[np.minimum(bounds[:-1], len(full) - 1)]
    begun = _hrsafety.program_zone_starts(way[bounds], np.ascontiguousarray(tool), rules.deceleration)
    starts: Array = np.asarray(np.interp(begun, way, nodes))
    rows = runs.rows(choice)
    zones = []
    for place, speed in enumerate(speeds.tolist()):
        part = slice(bounds[place], bounds[place + 1])
        held = (found.allowed / found.full if percent else found.tool_allowed)[part]
        row = int(np.ravel(found.governs[part])[int(np.argmin(held))])
        reason = "the robot itself" if row < 0 else told_limit(runs, rows, row)
        before = speeds[place - 1] if place else None
        change = "start" if before is None else "slow_down" if speed < before else "speed_up"
        first, last = float(nodes[bounds[place]]), float(nodes[bounds[place + 1]])
        start, end = place_of(runs.motion, way, float(starts[place])), place_of(runs.motion, way, last)
        zones.append(SpeedZone(first, last, start, end, speed, change, reason))
    if percent:
        share = np.empty(len(nodes) - 1)
        for each, first, last in zip(speeds.tolist(), bounds[:-1], bounds[1:], strict=True):
            share[first:last] = 0.01 * each
        run = runs.retimed(choice, path_speed=share * found.full.min(axis=1))
    else:
        run = runs.retimed(choice, speeds=tuple((each.speed, each.first, each.last) for each in zones))
    return SpeedZones("found", percent, tuple(zones), (), run)


def told_limit(runs: Runs, rows: tuple[Exposure, ...], row: int) -> str:
    """Return what a limit of the contacts is called: point and limit, or the speed that was asked for."""
    if row >= len(rows):
        return "speed of the tool center point"
    return f"{runs.program.points[rows[row].point].name}: {rows[row].label}"


def place_of(motion: ArmMotion, way: Array, s: float) -> PathPlace:
    """Return the place of a path parameter: the move, or the time of a log, and mm of the tool center point.

    Parameters
    ----------
    motion : ArmMotion
        The path.
    way : ndarray (n + 1,)
        Way of the tool center point up to each node in m.
    s : float
        Path parameter.
    """
    name, begun = "", 0.0
    if motion.marks:
        names = (each for each, (first, last) in motion.marks.items() if first <= s <= last and last > first)
        name = next(names, "")
        begun = motion.marks[name][0] if name else 0.0
    elif motion.log is not None and motion.place is not None:
        # Of the samples at which the robot stands the last one counts.
        sample = int(np.searchsorted(motion.place, s, side="right")) - 1
        name = f"{float(motion.log.time[max(sample, 0)]):.2f} s"
    here, there = np.interp([begun, s], motion.curve.nodes, way)
    return PathPlace(name, 1e3 * float(there - here))
