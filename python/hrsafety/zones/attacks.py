"""Attacks on zones: persons and commands that try to make the robot touch a person while it moves toward the person."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, numbers
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import RANGES
from hrsafety.zones.conditions import Conditions
from hrsafety.zones.monitor import CollisionMonitor, MonitorPolygon, MonitorState
from hrsafety.zones.reach import TOWARD

__all__ = ["GENES", "AttackRun", "Attacked", "attack", "replay"]

Flags = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]

STEP = 0.0075
"""Largest time step in s; the reaction is cut into whole ones."""
BEAMS = 48
NEAR = 0.3
"""Gap in m from the disc about the robot within which the gap to its footprint is computed, but in a replay."""
MOST_TIME = 20.0
"""Of an attack in s."""
LEAST_REACTION = RANGES["reaction_time"].least
"""Of an attack in s: steps are a twelfth of the reaction at most, and a shorter one is hardly meant."""

GENES = (
    *("speed", "turn_rate", "direction", "kind", "change", "second_speed", "second_turn_rate", "second_direction"),
    *("bearing", "start", "pace", "aim", "aim_side", "turn_time", "turn", "stop"),
    *("scan_phase", "command_phase", "beam_phase", "leg", "range_error"),
)
"""Numbers from 0 to 1 that an attack is made of."""


class _Attack(NamedTuple):
    """Attacks as physical numbers, each (n,) or (n, k)."""

    first: Array
    second: Array
    change: Array
    start: Array
    walk: Array
    turned: Array
    turn_time: Array
    stop_time: Array
    scan_phase: Array
    command_phase: Array
    beam_phase: Array
    leg: Array
    range_error: Array


@displayed
class Attacked(NamedTuple):
    """Outcome of attacks.

    Attributes
    ----------
    severity : ndarray (n,)
        Speed in m/s toward the person at a contact at fault; else minus the least gap in m while the robot moved toward
        the person.
    time : ndarray (n,)
        Of the contact, in s; NaN without.
    """

    severity: Array
    time: Annotated[Array, "s"]

    @property
    def broken(self) -> Flags:
        """Attacks that ended in a contact while the robot moved toward the person."""
        return np.isfinite(self.time)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AttackRun:
    """One attack, step by step.

    Attributes
    ----------
    genes : tuple of float
        Numbers that the attack is made of, by the names of `GENES`.
    time : ndarray (n,)
        In s.
    pose : ndarray (n, 3)
        x, y in m and heading in rad of the robot.
    velocity : ndarray (n, 3)
        Of the base, in m/s and rad/s.
    command : ndarray (n, 3)
        That reaches the monitor, in m/s and rad/s.
    person : ndarray (n, 2)
        Center of the leg in m.
    gap : ndarray (n,)
        Between leg and footprint in m.
    zone : ndarray (n,) of int
        Zone that acted on the last command; -1 for none.
    leg_radius : float
        In m.
    contact_time : float
        Of the contact at fault in s; NaN without.
    contact_speed : float
        Toward the person in m/s; 0 without.
    """

    genes: tuple[float, ...]
    time: Annotated[Array, "s"]
    pose: Array
    velocity: Array
    command: Array
    person: Annotated[Array, "m"]
    gap: Annotated[Array, "m"]
    zone: Indices
    leg_radius: Annotated[float, "m"]
    contact_time: Annotated[float, "s"] = math.nan
    contact_speed: Annotated[float, "m/s"] = 0.0


def attack(monitor: CollisionMonitor, conditions: Conditions, genes: object) -> Attacked:
    """Run attacks against a monitor, side by side.

    Parameters
    ----------
    monitor : CollisionMonitor
        Zones under attack.
    conditions : Conditions
        Robot, delays, scanner and people.
    genes : array_like (n, 21)
        Numbers from 0 to 1 of each attack, see `GENES`.

    Returns
    -------
    Attacked
        Severity and time of contact of each.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import zones
    >>> circle = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=0.3)
    >>> monitor = zones.CollisionMonitor(polygons=(circle,))
    >>> robot = zones.Conditions(
    ...     footprint=0.22, max_speed=0.5, max_turn_rate=1.0, deceleration=2.5, reaction_time=0.15, error=0.02,
    ...     beam_step=0.0087,
    ... )
    >>> genes = np.random.default_rng(0).random((50, len(zones.GENES)))
    >>> zones.attack(monitor, robot, genes).broken.any()
    np.True_
    """
    return _Plant(monitor, conditions, _genes(genes)).run()


def replay(monitor: CollisionMonitor, conditions: Conditions, genes: object) -> AttackRun:
    """Run one attack and keep every step.

    Parameters
    ----------
    monitor, conditions
        As for `attack`.
    genes : array_like (21,)
        Numbers of the attack.

    Returns
    -------
    AttackRun
        The run until a contact at fault, or until its time is over.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import zones
    >>> circle = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=0.3)
    >>> monitor = zones.CollisionMonitor(polygons=(circle,))
    >>> robot = zones.Conditions(
    ...     footprint=0.22, max_speed=0.5, max_turn_rate=1.0, deceleration=2.5, reaction_time=0.15, error=0.02,
    ...     beam_step=0.0087,
    ... )
    >>> genes = np.random.default_rng(0).random((50, len(zones.GENES)))
    >>> worst = genes[zones.attack(monitor, robot, genes).severity.argmax()]
    >>> zones.replay(monitor, robot, worst).contact_speed > 0.1
    True
    """
    given = _genes(np.atleast_2d(numbers("genes", genes)))
    kept: list[tuple[object, ...]] = []
    plant = _Plant(monitor, conditions, given)
    plant.near = math.inf
    found = plant.run(kept)
    columns = [np.array(each) for each in zip(*kept, strict=True)]
    time, pose, velocity, command, person, gap, zone = columns
    broken = bool(found.broken[0])
    return AttackRun(
        genes=tuple(given[0].tolist()),
        time=time,
        pose=pose,
        velocity=velocity,
        command=command,
        person=person,
        gap=gap,
        zone=zone,
        leg_radius=float(plant.attack.leg[0]),
        contact_time=float(found.time[0]),
        contact_speed=float(found.severity[0]) if broken else 0.0,
    )


def refuse_reaction(conditions: Conditions) -> None:
    """Refuse a reaction whose steps are too many for an attack, or that lasts longer than one.

    Parameters
    ----------
    conditions : Conditions
        Under which zones are attacked.

    Raises
    ------
    InvalidParameterError
        If it is too short or too long.
    """
    if not LEAST_REACTION <= conditions.reaction_time <= MOST_TIME:
        rule = f"be {LEAST_REACTION:g} to {MOST_TIME:g} s where zones are attacked"
        remedy = "it is in s: a slip of ms?"
        raise InvalidParameterError("reaction_time", rule, conditions.reaction_time, remedy)


def _genes(value: object) -> Array:
    given = numbers("genes", value)
    if given.ndim != 2 or given.shape[1] != len(GENES):
        raise ShapeError("genes", f"(n, {len(GENES)})", given.shape)
    return np.clip(given, 0.0, 1.0)


class _Plant:
    """Robots under attack: state arrays with a row for each attack."""

    def __init__(self, monitor: CollisionMonitor, conditions: Conditions, genes: Array) -> None:
        self.monitor, self.conditions, self.body = monitor, conditions, conditions.body
        self.near = NEAR
        refuse_reaction(conditions)
        steps = 12 * max(1, math.ceil(conditions.reaction_time / (12.0 * STEP)))
        self.step = conditions.reaction_time / steps
        self.scan = max(1, round(conditions.scan_time / self.step - 1e-6))
        self.period = max(1, round(conditions.command_time / self.step - 1e-6))
        self.delay = max(0, round(conditions.drive_delay / self.step - 1e-6))
        # The sum is the reaction to the step: never more, so that a zone is not broken by rounding.
        self.age = max(0, steps - self.scan - self.period - self.delay)
        self.reach = max(_zone_reach(each, conditions) for each in monitor.polygons)
        walk = max(conditions.person_speed, 0.5 * conditions.max_speed)
        stop = conditions.reaction_time + conditions.build_up + conditions.max_speed / conditions.deceleration
        self.horizon = min(MOST_TIME, 1.5 * (self.reach + 0.8) / walk + 2.0 * stop + 0.5)
        self.attack = _made(self, genes)

    def run(self, kept: list[tuple[object, ...]] | None = None) -> Attacked:
        """Run all attacks to the end of their time; of one, keep every step."""
        made, h = self.attack, self.step
        count = len(made.leg)
        pose, velocity, person = np.zeros((count, 3)), made.first.copy(), made.start.copy()
        command, out = made.first.copy(), made.first.copy()
        by, brake = np.full(count, -1, dtype=np.intp), np.zeros(count)
        memory = MonitorState.fresh(count, len(self.monitor.polygons))
        span = self.scan + self.age + 1
        past = np.repeat(np.concatenate([pose, person], axis=1)[np.newaxis], span, axis=0)
        sent = np.repeat(out[np.newaxis], self.delay + 1, axis=0)
        scan_phase = np.floor(made.scan_phase * self.scan).astype(np.intp)
        command_phase = np.floor(made.command_phase * self.period).astype(np.intp)
        severity, time = np.full(count, -math.inf), np.full(count, np.nan)
        held, alive = np.zeros(count, dtype=np.bool_), np.ones(count, dtype=np.bool_)
        gap, toward = self._gap(pose, velocity, person)
        for index in range(math.ceil(self.horizon / h)):
            past[index % span, :, :3], past[index % span, :, 3:] = pose, person
            due = np.flatnonzero(alive & ((index - command_phase) % self.period == 0))
            if len(due):
                wanted = np.where((index * h >= made.change[due])[:, np.newaxis], made.second[due], made.first[due])
                command[due] = self._smoothed(command[due], wanted)
                ago = (index - self.age - scan_phase[due]) % self.scan + self.age
                seen_from = past[(index - ago) % span, due]
                state = memory.of(due)
                out[due], by[due] = self._decided(command[due], seen_from, due, state)
                memory.put(due, state)
            sent[index % (self.delay + 1)] = out
            if kept is not None:
                kept.append(
                    (
                        index * h,
                        pose[0].copy(),
                        velocity[0].copy(),
                        command[0].copy(),
                        person[0].copy(),
                        float(gap[0]),
                        int(by[0]),
                    )
                )
            target = sent[(index - self.delay) % (self.delay + 1)]
            after, brake = self._driven(velocity, target, brake)
            pose = _moved(pose, 0.5 * (velocity + after), h)
            velocity = after
            now = index * h
            walking = np.where((now >= made.turn_time)[:, np.newaxis], made.turned, made.walk)
            walking = np.where((held | (now >= made.stop_time))[:, np.newaxis], 0.0, walking)
            before, before_toward = gap, toward
            person = person + walking * h
            gap, toward = self._gap(pose, velocity, person)
            touched = alive & (gap <= 0.0)
            if touched.any():
                share = np.clip(before / np.maximum(before - gap, 1e-12), 0.0, 1.0)
                speed = np.where(before > 0.0, before_toward + share * (toward - before_toward), toward)
                fault = touched & (speed > TOWARD)
                severity[fault], time[fault] = speed[fault], now + share[fault] * h
                alive &= ~fault
                # A person who walks against a robot that does not move toward him stops there.
                person = np.where(
                    (touched & ~fault & ~held)[:, np.newaxis],
                    person - (1.0 - share)[:, np.newaxis] * walking * h,
                    person,
                )
                held |= touched
            closing = alive & (toward > TOWARD)
            severity[closing] = np.maximum(severity[closing], -np.maximum(gap[closing], 0.0))
            if not alive.any():
                break
        return Attacked(np.where(np.isfinite(severity), severity, -self.reach - 10.0), time)

    def _smoothed(self, command: Array, wanted: Array) -> Array:
        """Return the commands that the smoother lets pass: falling ones no faster than their limits."""
        fall, turn_fall = self.conditions.command_fall, self.conditions.turn_command_fall
        period = self.period * self.step
        found = wanted.copy()
        if fall is not None:
            change = wanted[:, :2] - command[:, :2]
            size = np.linalg.norm(change, axis=1)
            falls = (change * command[:, :2]).sum(axis=1) < 0.0
            share = np.where(falls, np.minimum(1.0, fall * period / np.maximum(size, 1e-12)), 1.0)
            found[:, :2] = command[:, :2] + share[:, np.newaxis] * change
        if turn_fall is not None:
            change = wanted[:, 2] - command[:, 2]
            limited = np.clip(change, -turn_fall * period, turn_fall * period)
            found[:, 2] = command[:, 2] + np.where(change * command[:, 2] < 0.0, limited, change)
        return found

    def _decided(self, command: Array, seen_from: Array, rows: Indices, memory: MonitorState) -> tuple[Array, Indices]:
        """Return what the monitor makes of commands with what was seen from poses (n, 5) of robot and leg."""
        cos, sin = np.cos(seen_from[:, 2]), np.sin(seen_from[:, 2])
        away = seen_from[:, 3:] - seen_from[:, :2]
        leg = np.stack([cos * away[:, 0] + sin * away[:, 1], cos * away[:, 1] - sin * away[:, 0]], axis=1)
        rho = self.attack.leg[rows]
        near = np.linalg.norm(leg, axis=1) < self.reach + rho + self.conditions.error + 0.01
        found, by = np.empty_like(command), np.empty(len(command), dtype=np.intp)
        for chosen, seen in ((np.flatnonzero(near), True), (np.flatnonzero(~near), False)):
            if not len(chosen):
                continue
            place, there = (
                self._points(leg[chosen], rows[chosen])
                if seen
                else (np.zeros((len(chosen), 1, 2)), np.zeros((len(chosen), 1), dtype=np.bool_))
            )
            part = memory.of(chosen)
            found[chosen], by[chosen] = self.monitor.decide(command[chosen], place, there, part)
            memory.put(chosen, part)
        return found, by

    def _points(self, leg: Array, rows: Indices) -> tuple[Array, Flags]:
        """Return points (n, m, 2) of the beams that meet legs, in the base frame, and which exist."""
        made, given = self.attack, self.conditions
        rho, step = made.leg[rows], given.beam_step
        away = leg - np.asarray(given.scanner)
        distance = np.linalg.norm(away, axis=1)
        half = np.arcsin(np.clip(rho / np.maximum(distance, 1e-9), 0.0, 1.0))
        middle, phase = np.arctan2(away[:, 1], away[:, 0]), made.beam_phase[rows]
        first = np.ceil((middle - half) / step - phase)
        beams = np.floor((middle + half) / step - phase) - first + 1.0
        stride = np.maximum(1.0, np.ceil(beams / BEAMS))
        most = int(np.clip(beams.max(initial=1.0), 1.0, BEAMS))
        number = np.arange(most) * stride[:, np.newaxis]
        angle = (first[:, np.newaxis] + number + phase[:, np.newaxis]) * step
        off = angle - middle[:, np.newaxis]
        inner = rho[:, np.newaxis] ** 2 - (distance[:, np.newaxis] * np.sin(off)) ** 2
        length = distance[:, np.newaxis] * np.cos(off) - np.sqrt(np.maximum(inner, 0.0))
        length = length + (made.range_error[rows] * given.error)[:, np.newaxis]
        there = (number < beams[:, np.newaxis]) & (inner >= 0.0) & (distance > rho)[:, np.newaxis]
        there &= (length >= given.min_range) & (length <= given.max_range)
        place = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * length[..., np.newaxis] + np.asarray(given.scanner)
        return place, there

    def _driven(self, velocity: Array, target: Array, brake: Array) -> tuple[Array, Array]:
        """Return velocities a step later, and how far brakes have built up."""
        given, h = self.conditions, self.step
        change = target - velocity
        linear = np.sqrt(change[:, 0] ** 2 + change[:, 1] ** 2)
        slower = (change[:, 0] * velocity[:, 0] + change[:, 1] * velocity[:, 1] + change[:, 2] * velocity[:, 2]) < 0.0
        risen = np.where(slower, np.minimum(1.0, brake + h / given.build_up) if given.build_up > 0.0 else 1.0, 0.0)
        level = np.where(slower, 0.5 * (brake + risen) if given.build_up > 0.0 else 1.0, 1.0)
        limit = np.where(slower, given.deceleration * level, given.speeding) * h
        turn_limit = given.turn_braking * level * h
        share = np.minimum(1.0, limit / np.maximum(linear, 1e-12))
        turn_share = np.minimum(1.0, turn_limit / np.maximum(np.abs(change[:, 2]), 1e-12))
        stops = (target == 0.0).all(axis=1)
        if given.tracking_lag > 0.0:
            follows = -math.expm1(-h / given.tracking_lag)
            share = np.where(stops, share, np.minimum(share, follows))
            turn_share = np.where(stops, turn_share, np.minimum(turn_share, follows))
        # In a stop velocity and turn rate brake together.
        both = np.minimum(share, turn_share)
        shares = np.stack(
            [np.where(stops, both, share), np.where(stops, both, share), np.where(stops, both, turn_share)], axis=1
        )
        return velocity + shares * change, risen

    def _gap(self, pose: Array, velocity: Array, person: Array) -> tuple[Array, Array]:
        """Return the gaps between legs and footprints, and the speed of the nearest surface toward the legs."""
        away = person - pose[:, :2]
        rho = self.attack.leg
        distance = np.linalg.norm(away, axis=1)
        gap = distance - self.body.circumscribed - rho
        cos, sin = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        # Far away the speed of the base toward the leg tells the search where to go.
        along = away / np.maximum(distance, 1e-9)[:, np.newaxis]
        toward = (velocity[:, 0] * cos - velocity[:, 1] * sin) * along[:, 0]
        toward += (velocity[:, 0] * sin + velocity[:, 1] * cos) * along[:, 1]
        rows = np.flatnonzero(gap < self.near)
        if len(rows):
            cos, sin = cos[rows], sin[rows]
            x, y = away[rows].T
            leg = np.stack([cos * x + sin * y, cos * y - sin * x], axis=1)
            distance, nearest, way = self.body.distance(leg)
            gap[rows] = distance - rho[rows]
            touch = nearest + self.body.rounding * way
            moving = velocity[rows]
            toward[rows] = (moving[:, 0] - moving[:, 2] * touch[:, 1]) * way[:, 0]
            toward[rows] += (moving[:, 1] + moving[:, 2] * touch[:, 0]) * way[:, 1]
        return gap, toward


def _moved(pose: Array, velocity: Array, step: float) -> Array:
    """Return poses after a step with velocities in the base frame."""
    middle = pose[:, 2] + 0.5 * velocity[:, 2] * step
    cos, sin = np.cos(middle), np.sin(middle)
    x = pose[:, 0] + (velocity[:, 0] * cos - velocity[:, 1] * sin) * step
    y = pose[:, 1] + (velocity[:, 0] * sin + velocity[:, 1] * cos) * step
    return np.stack([x, y, pose[:, 2] + velocity[:, 2] * step], axis=1)


def _zone_reach(zone: MonitorPolygon, conditions: Conditions) -> float:
    """Return the distance from the base frame beyond which a zone sees nothing, in m."""
    shapes = [each.corners for each in zone.ranges] or ([] if zone.corners is None else [zone.corners])
    reach = max([zone.radius, *(float(np.linalg.norm(each, axis=1).max()) for each in shapes)])
    if zone.action == "approach":
        reach += conditions.max_speed * (zone.time_before_collision + zone.simulation_time_step)
    return max(reach, conditions.body.circumscribed)


def _made(plant: _Plant, genes: Array) -> _Attack:
    """Return attacks as physical numbers."""
    given, horizon = plant.conditions, plant.horizon
    by_name = dict(zip(GENES, genes.T, strict=True))
    first = _velocity(given, by_name["speed"], by_name["turn_rate"], by_name["direction"])
    other = _velocity(given, by_name["second_speed"], by_name["second_turn_rate"], by_name["second_direction"])
    kind = by_name["kind"][:, np.newaxis]
    turned = np.concatenate([first[:, :2], other[:, 2:]], axis=1)
    dropped = first * by_name["second_speed"][:, np.newaxis]
    # Constant, a drop to a share of the command, another turn rate, or any other command.
    second = np.where(kind < 0.4, first, np.where(kind < 0.6, dropped, np.where(kind < 0.8, turned, other)))
    bearing = 2.0 * math.pi * by_name["bearing"]
    leg = given.leg_radius * (1.0 + 3.0 * np.maximum(0.0, by_name["leg"] - 0.5))
    outside = _outside(plant, first, bearing) + leg + given.error + 0.005 + 0.8 * by_name["start"] ** 2
    start = outside[:, np.newaxis] * np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
    ahead = _moved(np.zeros_like(first), first, 1.0)  # of a straight way; the aim is shifted along it
    aim = ahead[:, :2] * (by_name["aim"] * horizon * 0.5)[:, np.newaxis]
    side = (2.0 * by_name["aim_side"] - 1.0) * (plant.body.circumscribed + 2.0 * leg)
    toward = aim - start
    length = np.maximum(np.linalg.norm(toward, axis=1, keepdims=True), 1e-9)
    toward = toward + side[:, np.newaxis] * np.stack([-toward[:, 1], toward[:, 0]], axis=1) / length
    heading = np.arctan2(toward[:, 1], toward[:, 0])
    pace = given.person_speed * np.minimum(1.0, 2.0 * by_name["pace"])
    turn = 2.0 * by_name["turn"] - 1.0
    turn = np.sign(turn) * math.pi * np.maximum(0.0, np.abs(turn) - 0.4) / 0.6
    return _Attack(
        first=first,
        second=second,
        change=by_name["change"] * horizon * 0.7,
        start=start,
        walk=pace[:, np.newaxis] * np.stack([np.cos(heading), np.sin(heading)], axis=1),
        turned=pace[:, np.newaxis] * np.stack([np.cos(heading + turn), np.sin(heading + turn)], axis=1),
        turn_time=by_name["turn_time"] * horizon,
        stop_time=np.where(by_name["stop"] > 0.5, math.inf, 2.0 * by_name["stop"] * horizon),
        scan_phase=np.minimum(by_name["scan_phase"], 1.0 - 1e-9),
        command_phase=np.minimum(by_name["command_phase"], 1.0 - 1e-9),
        beam_phase=by_name["beam_phase"],
        leg=leg,
        range_error=2.0 * by_name["range_error"] - 1.0,
    )


def _velocity(given: Conditions, speed: Array, turn: Array, direction: Array) -> Array:
    """Return commands from numbers: speeds often the largest, ways often straight."""
    share = np.clip(1.3 * speed - 0.15, 0.0, 1.0)
    side = 2.0 * turn - 1.0
    rate = given.max_turn_rate * np.sign(side) * np.maximum(0.0, np.abs(side) - 0.3) / 0.7
    if given.holonomic:
        way = 2.0 * math.pi * direction
        return np.stack([given.max_speed * share * np.cos(way), given.max_speed * share * np.sin(way), rate], axis=1)
    along = given.min_speed + share * (given.max_speed - given.min_speed)
    return np.stack([along, np.zeros_like(along), rate], axis=1)


def _outside(plant: _Plant, command: Array, bearing: Array) -> Array:
    """Return how far out along a bearing the zones reach for a command, in m."""
    reach = np.full(len(bearing), plant.body.circumscribed)
    ways = np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
    for zone in plant.monitor.polygons:
        if zone.action == "none":
            continue
        if zone.type == "circle":
            far = np.full(len(bearing), zone.radius)
        elif zone.type == "polygon":
            far = np.zeros(len(bearing)) if zone.corners is None else _along(zone.corners, ways)
        else:
            shape = zone.shapes(command, np.full(len(command), -1, dtype=np.intp))
            far = np.zeros(len(bearing))
            for index, each in enumerate(zone.ranges):
                rows = shape == index
                far[rows] = _along(each.corners, ways[rows])
        if zone.action == "approach":
            far = far + np.hypot(command[:, 0], command[:, 1]) * (
                zone.time_before_collision + zone.simulation_time_step
            )
        reach = np.maximum(reach, far)
    return reach


def _along(corners: Array, ways: Array) -> Array:
    """Return the farthest crossing of rays from the origin with the border of a polygon."""
    start, edge = corners, np.roll(corners, -1, axis=0) - corners
    cross = ways[:, :1] * edge[:, 1] - ways[:, 1:] * edge[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        far = (start[:, 0] * edge[:, 1] - start[:, 1] * edge[:, 0]) / cross
        share = (start[:, 0] * ways[:, 1:] - start[:, 1] * ways[:, :1]) / cross
    crossed = np.isfinite(far) & (far > 0.0) & (share >= -1e-9) & (share <= 1.0 + 1e-9)
    found: Array = np.where(crossed, far, 0.0).max(axis=1, initial=0.0)
    return found
