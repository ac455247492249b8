"""Zones that hold: least-area polygons for ranges of commands, from robot limits, delays, scanner and people."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array, count, flag
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InfeasibleError, InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.zones.conditions import Conditions
from hrsafety.zones.formulas import blind_range
from hrsafety.zones.monitor import CollisionMonitor, MonitorPolygon, VelocityRange
from hrsafety.zones.polygons import area, from_supports, simplified
from hrsafety.zones.reach import stopping_paths, supports

__all__ = ["CommandRange", "Zone", "ZoneSet", "design", "limits_of", "needed_zone"]

DIRECTIONS = 72
SPEEDS = 9
HOLONOMIC_SPEEDS = 4
HOLONOMIC_STEP = math.pi / 16.0
SAMPLED = 0.004
"""Distance in m that is added for motions between those that are computed."""
MOST_TURNS = 201
MOST_RANGES = 20
GROWN = 181
BORDER = 1e-4
"""Speed in m/s and turn rate in rad/s by which the outermost ranges reach beyond the limits of the robot: a command at
a limit that is rounded up must not be without a zone."""
ROUNDED = 1e-3
"""Corners are written to 1 mm, outward."""


@displayed
class CommandRange(NamedTuple):
    """Commands that a zone is for.

    Attributes
    ----------
    linear_min, linear_max : float
        vx, of a holonomic robot the speed, in m/s.
    theta_min, theta_max : float
        Turn rates, in rad/s.
    direction_start_angle, direction_end_angle : float
        Directions of a holonomic robot, in rad.
    """

    linear_min: Annotated[float, "m/s"]
    linear_max: Annotated[float, "m/s"]
    theta_min: Annotated[float, "rad/s"]
    theta_max: Annotated[float, "rad/s"]
    direction_start_angle: Annotated[float, "rad"] = -math.pi
    direction_end_angle: Annotated[float, "rad"] = math.pi


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Zone:
    """A zone and the commands it is for.

    Attributes
    ----------
    name : str
        Of its range in the file.
    commands : CommandRange
        Commands it is for.
    corners : ndarray (n, 2)
        In m, in the base frame, counter-clockwise.
    leg_depth : float
        Largest distance that was added so that a leg between beams is seen, in m.
    """

    name: str
    commands: CommandRange
    corners: Annotated[Array, "m"]
    leg_depth: Annotated[float, "m"]

    @property
    def area(self) -> float:
        """Area in m^2."""
        return area(self.corners)

    @property
    def extents(self) -> tuple[float, float, float, float]:
        """Reach ahead, behind, to the left and to the right of the base frame in m."""
        high, low = self.corners.max(axis=0), self.corners.min(axis=0)
        return float(high[0]), float(-low[0]), float(high[1]), float(-low[1])


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ZoneSet:
    """Zones for all commands of a robot, slowest first.

    Attributes
    ----------
    zones : tuple of Zone
        In the order in which the monitor tries them.
    conditions : Conditions
        What they hold for.
    min_points : int
        Points in a zone that stop the robot.
    faults_only : bool
        Whether the zones keep the robot from touching only, or people from reaching it while it moves, too.
    source_timeout : float
        Silence of the scanner after which the robot stops, in s.
    warnings : tuple of ResultWarning
        Numbers that are hardly meant.
    """

    zones: tuple[Zone, ...]
    conditions: Conditions
    min_points: int
    faults_only: bool
    source_timeout: Annotated[float, "s"]
    warnings: tuple[ResultWarning, ...] = ()

    def monitor(self) -> CollisionMonitor:
        """Return the collision monitor with these zones.

        Returns
        -------
        CollisionMonitor
            One velocity polygon that stops.
        """
        ranges = tuple(
            VelocityRange(name=each.name, corners=each.corners, **each.commands._asdict()) for each in self.zones
        )
        zone = MonitorPolygon(
            name="Zones",
            type="velocity_polygon",
            action="stop",
            ranges=ranges,
            holonomic=self.conditions.holonomic,
            min_points=self.min_points,
        )
        return CollisionMonitor(polygons=(zone,), source_timeout=self.source_timeout)

    def yaml(self) -> str:
        """Return the parameters of a ``collision_monitor`` node.

        Returns
        -------
        str
            YAML with comments.
        """
        from hrsafety.zones.monitor_text import zone_text

        return zone_text(self)


def design(
    conditions: Conditions,
    *,
    ranges: int = 3,
    turn_ranges: int = 1,
    corners: int = 16,
    min_points: int = 4,
    faults_only: bool = True,
) -> ZoneSet:
    """Return zones that hold: the least convex polygons for ranges of commands, slowest first.

    Each is the hull of the union over t of the footprint grown by u t, for every motion that the base may have when the
    last command of the range passed, grown by the error, the supplement, and what a leg may enter before it is seen.

    Parameters
    ----------
    conditions : Conditions
        Robot, delays, scanner and people.
    ranges : int
        Ranges of speed forward, as many backward in proportion. Without ``command_fall`` there is one zone, since a
        command may drop at once while the robot is still at its largest speed.
    turn_ranges : int
        Ranges of the turn rate: 1, or 3 for right, ahead and left.
    corners : int
        Largest number of corners of a zone, at least 4.
    min_points : int
        Points in a zone that stop the robot. Fewer let the scanner see legs farther away; more ignore dust.
    faults_only : bool
        Whether only faces that move outward must stay clear, so that the robot touches no person; ``False``: no person
        reaches the robot from any side before it stands.

    Returns
    -------
    ZoneSet
        Zones with their commands.

    Raises
    ------
    InfeasibleError
        If a zone would reach to where a leg is not seen; it names the greatest speed that holds.
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import zones
    >>> robot = zones.Conditions(
    ...     footprint=0.22, max_speed=0.5, max_turn_rate=1.0, deceleration=2.5, reaction_time=0.15, error=0.02,
    ...     beam_step=0.0087, command_fall=2.5, turn_command_fall=3.2,
    ... )
    >>> found = zones.design(robot, ranges=2)
    >>> [(zone.name, round(zone.extents[0], 2)) for zone in found.zones]
    [('forward_1', 0.72), ('forward_2', 0.94)]
    """
    if not isinstance(conditions, Conditions):
        raise InvalidParameterError("conditions", "be Conditions", conditions)
    speeds, turns = count("ranges", ranges, most=MOST_RANGES), count("turn_ranges", turn_ranges, most=3)
    if turns == 2:
        raise InvalidParameterError("turn_ranges", "be 1 or 3", turn_ranges)
    most = count("corners", corners, least=4, most=DIRECTIONS)
    beams, leading = count("min_points", min_points, most=1000), flag("faults_only", faults_only)
    _refuse_near_blind(conditions)
    given: dict[str, Any] = {"corners": most, "min_points": beams, "faults_only": leading}
    zones = []
    for name, commands in _ranges(conditions, speeds, turns):
        found = needed_zone(conditions, commands, **given)
        if found is None:
            raise _beyond_sight(conditions, commands, given)
        zones.append(Zone(name=name, commands=commands, corners=found[0], leg_depth=found[1]))
    return ZoneSet(
        zones=tuple(zones),
        conditions=conditions,
        min_points=beams,
        faults_only=leading,
        source_timeout=conditions.scan_time + conditions.scan_age,
        warnings=conditions.warnings,
    )


def needed_zone(
    conditions: Conditions,
    commands: CommandRange,
    *,
    min_points: int,
    corners: int = DIRECTIONS,
    faults_only: bool = True,
) -> tuple[Array, float] | None:
    """Return the polygon that commands of a range need, and the largest depth for legs; ``None`` beyond sight.

    Parameters
    ----------
    conditions : Conditions
        Robot, delays, scanner and people.
    commands : CommandRange
        Commands it is for.
    min_points, corners, faults_only
        As for `design`.

    Returns
    -------
    tuple of ndarray (n, 2) and float, or None
        Corners in m, counter-clockwise, and a distance in m.
    """
    angles: Array = np.arange(float(DIRECTIONS)) * (2.0 * math.pi / DIRECTIONS)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    moving = _motions(conditions, commands)
    paths = stopping_paths(
        moving[0],
        deceleration=conditions.deceleration,
        turn_deceleration=conditions.turn_braking,
        reaction_time=conditions.reaction_time,
        build_up=conditions.build_up,
        drift=moving[1],
        drift_time=conditions.drift_time,
        limits=limits_of(conditions),
    )
    spread = (0.0, 0.0)
    if conditions.holonomic and conditions.command_fall is not None:
        spread = (conditions.command_fall, conditions.drift_time)
    people = conditions.person_speed
    reach = supports(paths, conditions.body, directions, person_speed=people, leading=faults_only, spread=spread)
    # What does not move outward needs no room; the body is in its zone all the same.
    body = directions @ conditions.body.corners.T
    reach = np.maximum(reach, body.max(axis=1) + conditions.body.rounding)
    reach = reach + conditions.error + conditions.supplement + SAMPLED
    kept = simplified(angles, reach, corners)
    return _grown_for_legs(conditions, angles[kept], reach[kept], min_points)


def limits_of(conditions: Conditions, border: float = BORDER) -> tuple[Array, Array]:
    """Return the least and the largest velocities of commands, with what rounding may add to them."""
    side = conditions.max_speed + border if conditions.holonomic else 0.0
    turn = conditions.max_turn_rate + border
    low = np.array([conditions.slowest - border, -side, -turn])
    return low, np.array([conditions.max_speed + border, side, turn])


def _motions(conditions: Conditions, commands: CommandRange) -> tuple[Array, Array]:
    """Return velocities that the base may have when a command of the range was the last to pass, and their drifts."""
    fall, turn_fall = conditions.command_fall, conditions.turn_command_fall
    low, high = limits_of(conditions)
    drifts = (0.0,) if fall is None else (-fall, 0.0, fall)
    turn_low, turn_high = low[2], high[2]
    if turn_fall is not None:
        wide = turn_fall * conditions.drift_time
        turn_low = max(turn_low, min(0.0, commands.theta_min) - wide)
        turn_high = min(turn_high, max(0.0, commands.theta_max) + wide)
    stop = conditions.reaction_time + conditions.build_up
    stop += max(conditions.max_speed / conditions.deceleration, conditions.max_turn_rate / conditions.turn_braking)
    far = conditions.body.circumscribed + conditions.max_speed * stop
    step = 2.0 * math.acos(max(0.0, 1.0 - 0.5 * SAMPLED / far)) / stop
    turns = np.linspace(
        turn_low, turn_high, int(min(MOST_TURNS, 2 * math.ceil((turn_high - turn_low) / step / 2.0) + 1))
    )
    if conditions.holonomic:
        speeds = np.linspace(0.0, high[0] if fall is None else commands.linear_max, HOLONOMIC_SPEEDS)
        start, end = commands.direction_start_angle, commands.direction_end_angle
        if fall is None:
            start, end = -math.pi, math.pi
        width = (end - start) % (2.0 * math.pi) or 2.0 * math.pi
        ways = start + width * np.linspace(0.0, 1.0, 1 + round(width / HOLONOMIC_STEP))
        moves = np.unique([(v * math.cos(a), v * math.sin(a)) for v in speeds for a in ways], axis=0)
        drifts = (0.0,)  # they go any way: the reach is spread by them
    else:
        least, most = min(0.0, commands.linear_min), max(0.0, commands.linear_max)
        if fall is None:
            least, most = low[0], high[0]
        moves = np.array([(v, 0.0) for v in np.unique(np.append(np.linspace(least, most, SPEEDS), 0.0))])
    rows = [(*move, turn) for move in moves for _ in drifts for turn in turns]
    drift = [(each, 0.0, 0.0) for _ in moves for each in drifts for _ in turns]
    return np.array(rows), np.array(drift)


def _grown_for_legs(conditions: Conditions, angles: Array, reach: Array, min_points: int) -> tuple[Array, float] | None:
    """Return the polygon whose edges are moved out until a leg that enters by the distance has enough beams in it."""
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shares = np.linspace(0.0, 1.0, 11)[:, np.newaxis]
    depth = np.zeros(len(angles))
    for _ in range(3):
        for index, normal in enumerate(normals):
            # The edge before its leg depth: between its meetings with its neighbors.
            before, after = index - 1, (index + 1) % len(angles)
            ends = [_corner(normals, reach + depth, before, index), _corner(normals, reach + depth, index, after)]
            place = ends[0] + shares * (ends[1] - ends[0])
            away = np.asarray(conditions.scanner) - (place + conditions.leg_radius * normal)
            found = _leg_depths(conditions, away, normal, min_points)
            depth[index] = max(depth[index], float(found.max()))
            if not math.isfinite(depth[index]):
                return None
    rounded = np.ceil((reach + depth) / ROUNDED) * ROUNDED
    corners = from_supports(angles, rounded)
    # Rounding of the corners in the file must not take from the zone.
    corners = np.round(from_supports(angles, rounded + ROUNDED), 4)
    far = np.linalg.norm(corners - conditions.scanner, axis=1).max() + 2.0 * conditions.leg_radius
    return (corners, float(depth.max())) if far <= conditions.max_range else None


def _corner(normals: Array, reach: Array, first: int, second: int) -> Array:
    a, b = normals[first], normals[second]
    cross = a[0] * b[1] - a[1] * b[0]
    found: Array = np.array([reach[first] * b[1] - reach[second] * a[1], a[0] * reach[second] - b[0] * reach[first]])
    return np.asarray(found / cross, dtype=np.float64)


def _leg_depths(conditions: Conditions, away: Array, normal: Array, min_points: int) -> Array:
    """Return how deep legs must enter an edge before they have enough beams, by their way to the scanner (n, 2)."""
    rho, distance = conditions.leg_radius, np.linalg.norm(away, axis=1)
    width = min_points * conditions.beam_step * distance
    facing = np.arccos(np.clip(-(away @ normal) / np.maximum(distance, 1e-12), -1.0, 1.0))[:, np.newaxis]
    cap = np.linspace(0.0, math.pi, GROWN)
    quarter = 0.5 * math.pi
    seen = np.sin(np.clip(facing + cap, -quarter, quarter)) - np.sin(np.clip(facing - cap, -quarter, quarter))
    enough = rho * seen >= width[:, np.newaxis]
    first = enough.argmax(axis=1)
    return np.where(enough.any(axis=1), rho * (1.0 - np.cos(cap[first])), np.inf)


def _ranges(conditions: Conditions, ranges: int, turn_ranges: int) -> list[tuple[str, CommandRange]]:
    """Return names and commands of the zones, slowest first."""
    if conditions.command_fall is None:
        ranges = 1
    most, turn = conditions.max_speed, conditions.max_turn_rate + BORDER
    turns = [("", -turn, turn)]
    if turn_ranges == 3 and conditions.turn_command_fall is not None and turn > 0.0:
        third = _down(turn / 3.0)
        turns = [("", -third, third), ("_right", -turn, -third), ("_left", third, turn)]
    if conditions.holonomic:
        return _holonomic_ranges(conditions, ranges, turns)
    edges = [0.0, *(_down(most * each / ranges) for each in range(1, ranges)), most + BORDER]
    forward = list(itertools.pairwise(edges))
    if conditions.min_speed < 0.0 and ranges > 1:
        behind = max(1, round(-conditions.min_speed / most * ranges))
        back = [_down(-conditions.min_speed * each / behind) for each in range(1, behind)]
        edges = [0.0, *back, BORDER - conditions.min_speed]
        backward = [(-high, -low) for low, high in itertools.pairwise(edges)]
    else:
        forward[0] = (conditions.min_speed - BORDER, forward[0][1])
        backward = []
    speeds = [("forward", *each) for each in forward] + [("backward", *each) for each in backward]
    speeds.sort(key=lambda each: max(abs(each[1]), abs(each[2])))
    counts = {"forward": 0, "backward": 0}
    found = []
    for word, low, high in speeds:
        counts[word] += 1
        for side, first, last in turns:
            found.append((f"{word}_{counts[word]}{side}", CommandRange(low, high, first, last)))
    return found


def _holonomic_ranges(
    conditions: Conditions, ranges: int, turns: list[tuple[str, float, float]]
) -> list[tuple[str, CommandRange]]:
    """Return the slowest range for every direction, and four directions of the others."""
    edges = [
        0.0,
        *(_down(conditions.max_speed * each / ranges) for each in range(1, ranges)),
        conditions.max_speed + BORDER,
    ]
    found = [(f"around{side}", CommandRange(edges[0], edges[1], first, last)) for side, first, last in turns]
    ways = {"forward": 0.0, "left": 0.5 * math.pi, "backward": math.pi, "right": -0.5 * math.pi}
    for index, (low, high) in enumerate(itertools.pairwise(edges[1:])):
        for word, way in ways.items():
            start, end = _wrapped(way - 0.25 * math.pi), _wrapped(way + 0.25 * math.pi)
            for side, first, last in turns:
                found.append((f"{word}_{index + 2}{side}", CommandRange(low, high, first, last, start, end)))
    return found


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def _down(value: float) -> float:
    """Return a border between ranges as the file shows it."""
    return math.floor(value * 1e3) / 1e3


def _refuse_near_blind(conditions: Conditions) -> None:
    """Refuse a scanner that does not see a place beside the robot."""
    gap = _border_distance(conditions)
    if conditions.min_range > gap:
        rule = f"be at most the distance from the scanner to the border of the footprint ({gap:.3g} m)"
        remedy = "a leg beside the robot would not be seen"
        raise InvalidParameterError("min_range", rule, conditions.min_range, remedy)


def _border_distance(conditions: Conditions) -> float:
    """Return the distance from the scanner to the border of the body in m; 0 outside it."""
    found, _, _ = conditions.body.distance(np.array([conditions.scanner]))
    if len(conditions.body.corners) == 1:
        return max(
            0.0, conditions.body.rounding - math.hypot(*(np.asarray(conditions.scanner) - conditions.body.corners[0]))
        )
    return max(0.0, -float(found[0]))


def _beyond_sight(conditions: Conditions, commands: CommandRange, given: dict[str, Any]) -> InfeasibleError:
    """Return the error that names the greatest speed that holds."""
    sight = blind_range(conditions.leg_radius, beam_step=conditions.beam_step, points=given["min_points"])
    low, high = 0.0, conditions.max_speed
    for _ in range(8):
        middle = 0.5 * (low + high)
        slower = replace(conditions, max_speed=middle, min_speed=max(conditions.min_speed, -middle))
        reduced = commands._replace(linear_min=max(commands.linear_min, slower.slowest), linear_max=middle)
        low, high = (middle, high) if needed_zone(slower, reduced, **given) else (low, middle)
    finding = (
        f"the zone for {commands.linear_max:g} m/s reaches to where a leg is not seen: {given['min_points']} "
        f"beams meet a leg of radius {conditions.leg_radius:g} m up to {sight:.2f} m, and the scanner looks "
        f"{conditions.max_range:g} m far"
    )
    speed = f"a max_speed of {low:.2f} m/s holds" if low > 0.0 else "no speed holds"
    remedy = f"{speed}; finer beams, fewer min_points, a shorter reaction or a stronger brake allow more"
    return InfeasibleError(finding, remedy)
