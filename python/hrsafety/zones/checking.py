"""Verdict on the zones of a collision monitor: closed forms, then attacks by chance and by search."""

from __future__ import annotations

import math
from collections.abc import Callable
from os import PathLike
from typing import Annotated, Any

import numpy as np

from hrsafety._arguments import Array, callback, checked_seed, count
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.zones.attacks import GENES, AttackRun, attack, refuse_reaction, replay
from hrsafety.zones.conditions import Conditions
from hrsafety.zones.field_design import CommandRange, limits_of, needed_zone
from hrsafety.zones.formulas import allowed_speed, blind_range
from hrsafety.zones.monitor import CollisionMonitor, MonitorPolygon, first_gap
from hrsafety.zones.monitor_files import load_monitor
from hrsafety.zones.polygons import distance_outside
from hrsafety.zones.search import adapted

__all__ = ["VERDICTS", "ShapeCheck", "ZoneCheck", "check"]

VERDICTS = ("broken", "not_covered", "holds")
"""Words of a verdict; of several that apply the first one counts."""
ROUND = 72
BATCH = 4000
ROUNDING = 5e-4
"""Distance in m that corners lose in files."""
SPEED_ROUNDING = 2e-3
"""Speed in m/s within which a margin and its commands agree."""
MOST_ATTACKS = 10_000_000
EVOLUTIONS = 8
POPULATION = 16


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ShapeCheck:
    """A shape that stops the robot, beside the one that its commands need if it has to hold alone.

    Attributes
    ----------
    name : str
        Zone, and range of a velocity polygon.
    commands : CommandRange
        Commands that it is for, within the limits of the robot.
    corners : ndarray (n, 2)
        The shape, in m.
    needed : ndarray (n, 2) or None
        The shape that is needed, in m; ``None`` where legs that far are not seen.
    margin : float
        Least distance between robot and border along its way, in m.
    standing_speed, walking_speed : float
        Greatest speeds for which the margin holds, of people who stand and who walk, in m/s.
    missing : float
        Largest distance by which the needed shape lies outside, in m; NaN beyond sight.
    missing_front, missing_rear, missing_left, missing_right : float
        How much farther the needed shape reaches, in m.
    blind_range : float
        Distance beyond which a leg may have too few beams, in m.
    """

    name: str
    commands: CommandRange
    corners: Annotated[Array, "m"]
    needed: Annotated[Array | None, "m"]
    margin: Annotated[float, "m"]
    standing_speed: Annotated[float, "m/s"]
    walking_speed: Annotated[float, "m/s"]
    missing: Annotated[float, "m"]
    missing_front: Annotated[float, "m"]
    missing_rear: Annotated[float, "m"]
    missing_left: Annotated[float, "m"]
    missing_right: Annotated[float, "m"]
    blind_range: Annotated[float, "m"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ZoneCheck:
    """Verdict on the zones of a monitor.

    Attributes
    ----------
    verdict : str
        ``"broken"``: an attack made the robot touch a person while it moved toward the person; ``"not_covered"``: none
        did, but commands are without a zone, or a needed zone lies beyond sight; ``"holds"``: no attack of so many did.
    shapes : tuple of ShapeCheck
        Shapes that stop.
    broken : Share
        Attacks by chance at fault, with the 95 % Wilson interval.
    searched : int
        Attacks of the search that followed.
    searched_broken : int
        Those of them at fault.
    worst : AttackRun
        The worst attack, step by step.
    uncovered : tuple of (str, tuple of float)
        Zones, and a command (m/s, m/s, rad/s) of each that none of its ranges holds.
    monitor : CollisionMonitor
        Zones that were checked.
    conditions : Conditions
        What they were checked for.
    seed : int
        Of the attacks.
    warnings : tuple of ResultWarning
        Doubts; with one that may lie on the unsafe side the verdict is not checked.
    """

    verdict: str
    shapes: tuple[ShapeCheck, ...]
    broken: Share
    searched: int
    searched_broken: int
    worst: AttackRun
    uncovered: tuple[tuple[str, tuple[float, ...]], ...]
    monitor: CollisionMonitor
    conditions: Conditions
    seed: int
    warnings: tuple[ResultWarning, ...] = ()


def check(
    monitor: CollisionMonitor | str | PathLike[str],
    conditions: Conditions | None = None,
    *,
    attacks: int = 1000,
    generations: int = 6,
    seed: int = 0,
    progress: Callable[[int, int], object] | None = None,
    **given: Any,
) -> ZoneCheck:
    """Judge the zones of a collision monitor: closed forms first, then attacks.

    An attack is a person (start outside the zones, bearing, speed up to u, turn, stop, leg), phases of scans, commands
    and beams, and a command that stays, drops, turns or reverses. A contact while the surface of the robot moves
    toward the person by more than 1 mm/s breaks the zones.

    Parameters
    ----------
    monitor : CollisionMonitor or path-like
        Zones, or the YAML file that holds them.
    conditions : Conditions or None
        Robot, delays, scanner and people; ``None``: those of `given`.
    attacks : int
        Attacks by chance.
    generations : int
        Generations of the search from the worst of them, each of 128 attacks; 0 for none.
    seed : int
        Of the draws: the same attacks, the same verdict.
    progress : callable or None
        Called with (done, all).
    **given
        Parameters of `Conditions`; what is missing is taken from the default robot of Nav2 and doubted.

    Returns
    -------
    ZoneCheck
        The verdict, shapes that are needed, and the worst attack.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, or the file is no collision monitor.

    Examples
    --------
    >>> from hrsafety import zones
    >>> circle = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=0.3)
    >>> found = zones.check(
    ...     zones.CollisionMonitor(polygons=(circle,), source_timeout=0.15), attacks=50, generations=0, footprint=0.22,
    ...     max_speed=0.5, max_turn_rate=1.0, deceleration=2.5, reaction_time=0.15, error=0.02, beam_step=0.0087,
    ... )
    >>> found.verdict, round(found.shapes[0].standing_speed, 3), found.shapes[0].walking_speed
    ('broken', 0.289, 0.0)
    """
    assumed: tuple[ResultWarning, ...] = ()
    if conditions is None:
        conditions, assumed = Conditions.assumed(**given)
    elif not isinstance(conditions, Conditions) or given:
        raise InvalidParameterError("conditions", "be Conditions, or its parameters by name", conditions)
    refuse_reaction(conditions)  # before any work
    if not isinstance(monitor, CollisionMonitor):
        monitor = load_monitor(monitor, footprint=conditions.footprint)
    drawn = count("attacks", attacks, most=MOST_ATTACKS)
    rounds = count("generations", generations, least=0, most=10_000)
    told = callback("progress", progress)
    generator = np.random.Generator(np.random.PCG64(checked_seed("seed", seed)))
    low, high = limits_of(conditions, 0.0)
    gaps = [(zone.name, first_gap(zone, (low, high))) for zone in monitor.polygons]
    shapes = tuple(_shapes(monitor, conditions))
    genes, severity, broken = _by_chance(
        monitor, conditions, drawn, generator, told, drawn + rounds * EVOLUTIONS * POPULATION
    )
    worst, worst_severity = genes[:1], severity[:1]
    searched, hit = 0, 0
    if rounds:
        tried, found = adapted(
            lambda each: attack(monitor, conditions, each).severity,
            genes[:EVOLUTIONS],
            generations=rounds,
            population=POPULATION,
            generator=generator,
        )
        searched, hit = len(found), int((found > 0.0).sum())
        best = int(np.argmax(found))
        if found[best] > worst_severity[0]:
            worst = tried[best : best + 1]
    if told is not None:
        told(drawn + searched, drawn + searched)
    uncovered = tuple((name, gap) for name, gap in gaps if gap is not None)
    beyond = [each.name for each in shapes if each.needed is None]
    verdict = "broken" if broken or hit else "not_covered" if uncovered or beyond else "holds"
    return ZoneCheck(
        verdict=verdict,
        shapes=shapes,
        broken=wilson(broken, drawn),
        searched=searched,
        searched_broken=hit,
        worst=replay(monitor, conditions, worst[0]),
        uncovered=uncovered,
        monitor=monitor,
        conditions=conditions,
        seed=seed,
        warnings=(
            *monitor.warnings,
            *monitor.doubts(reaction_time=conditions.reaction_time, limits=(low, high)),
            *_beyond_sight(beyond, shapes),
            *_beyond_closed_form(monitor, shapes),
            *assumed,
            *(each for each in conditions.warnings if not (assumed and each.code == "assumed")),
        ),
    )


def _beyond_sight(names: list[str], shapes: tuple[ShapeCheck, ...]) -> tuple[ResultWarning, ...]:
    if not names:
        return ()
    sight = min(each.blind_range for each in shapes)
    message = (
        f"what {', '.join(names)} would need reaches to where a leg may have too few beams ({sight:.2f} m) or lies "
        "beyond the range of the scanner: finer beams, fewer min_points or a slower robot"
    )
    return (ResultWarning("blind_range", ", ".join(names), message),)


def _beyond_closed_form(monitor: CollisionMonitor, shapes: tuple[ShapeCheck, ...]) -> tuple[ResultWarning, ...]:
    """Doubt shapes whose margin is too small for their commands, where no zone slows the robot before."""
    if any(zone.action in {"slowdown", "limit", "approach"} for zone in monitor.polygons):
        return ()
    found = []
    for each in shapes:
        fastest = max(abs(each.commands.linear_min), abs(each.commands.linear_max))
        if each.walking_speed < fastest - SPEED_ROUNDING:
            message = (
                f"the margin of {each.name} holds up to {each.walking_speed:.3g} m/s, its commands reach {fastest:.3g} "
                "m/s: attacks that do not break it are a sample; make it larger"
            )
            found.append(ResultWarning("beyond_closed_form", each.name, message))
    return tuple(found)


def _by_chance(
    monitor: CollisionMonitor,
    conditions: Conditions,
    drawn: int,
    generator: np.random.Generator,
    told: Callable[[int, int], object] | None,
    whole: int,
) -> tuple[Array, Array, int]:
    """Return the worst attacks of so many, their severities, and how many broke the zones."""
    kept, severities, broken = np.zeros((0, len(GENES))), np.zeros(0), 0
    for first in range(0, drawn, BATCH):
        genes = generator.random((min(BATCH, drawn - first), len(GENES)))
        if first == 0:
            known = _known()[: len(genes)]
            genes[: len(known)] = known
        found = attack(monitor, conditions, genes)
        broken += int(found.broken.sum())
        kept, severities = np.concatenate([kept, genes]), np.concatenate([severities, found.severity])
        order = np.argsort(-severities, kind="stable")[:EVOLUTIONS]
        kept, severities = kept[order], severities[order]
        if told is not None:
            told(min(first + BATCH, drawn), whole)
    return kept, severities, broken


def _known() -> Array:
    """Return attacks that closed forms speak of: a person in the way at both ends of speed, who stands or walks."""
    genes = dict.fromkeys(GENES, 0.5)
    genes |= {"kind": 0.0, "start": 0.0, "aim": 0.0, "turn": 0.5, "stop": 1.0, "leg": 0.0, "range_error": 1.0}
    rows = []
    for speed, bearing in ((1.0, 0.0), (1.0, 0.02), (0.5, 0.0), (0.0, 0.5)):
        for pace in (0.0, 1.0):
            for phase in (0.0, 0.45, 0.9):
                each = {**genes, "speed": speed, "bearing": bearing, "pace": pace, "scan_phase": phase}
                rows += [list((each | {"command_phase": share}).values()) for share in (0.1, 0.6)]
    return np.array(rows)


def _shapes(monitor: CollisionMonitor, conditions: Conditions) -> list[ShapeCheck]:
    """Return every shape that stops beside the one that its commands need."""
    low, high = limits_of(conditions, 0.0)
    found = []
    for zone in monitor.polygons:
        if zone.action != "stop":
            continue
        if zone.type == "velocity_polygon":
            for each in zone.ranges:
                commands = CommandRange(
                    max(each.linear_min, 0.0 if zone.holonomic else float(low[0])),
                    min(each.linear_max, float(high[0])),
                    max(each.theta_min, float(low[2])),
                    min(each.theta_max, float(high[2])),
                    each.direction_start_angle,
                    each.direction_end_angle,
                )
                if commands.linear_min <= commands.linear_max and commands.theta_min <= commands.theta_max:
                    found.append(_shape(f"{zone.name}.{each.name}", commands, each.corners, zone, conditions))
            continue
        first = 0.0 if conditions.holonomic else float(low[0])
        commands = CommandRange(first, float(high[0]), float(low[2]), float(high[2]))
        corners = _round(zone.radius) if zone.type == "circle" else zone.corners
        if corners is not None:
            found.append(_shape(zone.name, commands, corners, zone, conditions))
    return found


def _round(radius: float) -> Array:
    angles = np.arange(ROUND) * (2.0 * math.pi / ROUND)
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _shape(
    name: str, commands: CommandRange, corners: Array, zone: MonitorPolygon, conditions: Conditions
) -> ShapeCheck:
    points = max(zone.min_points, 1)
    needed = needed_zone(conditions, commands, min_points=points)
    margin = min(_margin(conditions, corners, way) for way in _ways(commands, conditions.holonomic))
    speeds = [
        allowed_speed(
            margin,
            deceleration=conditions.deceleration,
            reaction_time=conditions.reaction_time + 0.5 * conditions.build_up,
            person_speed=speed,
            error=conditions.error,
        )
        for speed in (0.0, conditions.person_speed)
    ]
    missing, sides = math.nan, [math.nan] * 4
    if needed is not None:
        shares = np.linspace(0.0, 1.0, 9)[:, np.newaxis, np.newaxis]
        border = needed[0] + shares * (np.roll(needed[0], -1, axis=0) - needed[0])
        missing = float(distance_outside(corners, border.reshape(-1, 2)).max())
        missing = missing if missing > ROUNDING else 0.0
        high, low = needed[0].max(axis=0) - corners.max(axis=0), corners.min(axis=0) - needed[0].min(axis=0)
        sides = [float(each) if each > ROUNDING else 0.0 for each in (high[0], low[0], high[1], low[1])]
    return ShapeCheck(
        name=name,
        commands=commands,
        corners=corners,
        needed=None if needed is None else needed[0],
        margin=margin,
        standing_speed=speeds[0],
        walking_speed=speeds[1],
        missing=missing,
        missing_front=sides[0],
        missing_rear=sides[1],
        missing_left=sides[2],
        missing_right=sides[3],
        blind_range=blind_range(conditions.leg_radius, beam_step=conditions.beam_step, points=points),
    )


def _ways(commands: CommandRange, holonomic: bool) -> list[float]:
    """Return directions in rad in which commands of a range drive."""
    if holonomic:
        width = (commands.direction_end_angle - commands.direction_start_angle) % (2.0 * math.pi) or 2.0 * math.pi
        return [commands.direction_start_angle + width * share for share in np.linspace(0.0, 1.0, 9)]
    ahead, behind = commands.linear_max > SPEED_ROUNDING, commands.linear_min < -SPEED_ROUNDING
    return [0.0] * (ahead or not behind) + [math.pi] * behind


def _margin(conditions: Conditions, corners: Array, way: float) -> float:
    """Return the least distance from the leading faces of the robot to the border of a shape along a way in m."""
    turned = np.array([[math.cos(way), -math.sin(way)], [math.sin(way), math.cos(way)]])
    place, normals = conditions.body.boundary()
    if len(conditions.body.corners) == 1:  # on the disc, not about it
        place = place * (conditions.body.rounding / np.linalg.norm(place, axis=1).max())
    border, place, normals = corners @ turned, place @ turned, normals @ turned
    ahead = place[normals[:, 0] > 1e-9]
    if distance_outside(border, ahead).max() > 0.0:
        return 0.0
    start, end = border, np.roll(border, -1, axis=0)
    y = ahead[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = start[:, 0] + (y - start[:, 1]) * (end[:, 0] - start[:, 0]) / (end[:, 1] - start[:, 1])
    crossed = (start[:, 1] <= y) != (end[:, 1] <= y)
    gap = np.where(crossed, at - ahead[:, :1], math.inf)
    return float(np.where(gap >= -1e-12, np.maximum(gap, 0.0), math.inf).min())
