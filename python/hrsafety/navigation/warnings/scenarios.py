"""Why a run of a scenario may not mean what it seems to: regions, plausible numbers, ways that are closed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Protocol

from hrsafety._arguments import Pair
from hrsafety._tracks import gaps_of_paths
from hrsafety.navigation import free_space
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human
from hrsafety.navigation.obstacles.moving_rectangle import Box, Mobile
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.obstacles.ways import through, way
from hrsafety.navigation.regions import region_radii
from hrsafety.navigation.robots.bodies import NUMBERS, DifferentialDriveRobot, HolonomicRobot, least_reach
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.plausibility import ResultWarning, gathered, implausible

__all__ = [
    "BELOW_SAFE",
    "CLOSED_IN",
    "GOAL_IN_REGION",
    "GOAL_NEAR_STOP",
    "IN_CRITICAL_REGION",
    "OUT_OF_REACH",
    "circled",
    "found",
    "own_speed",
    "pieces",
]

# A critical radius this far below the safe one is that one, typed with fewer digits; in m.
ROUNDING = 1e-9

BELOW_SAFE = "region_below_safe"
IN_CRITICAL_REGION = "start_in_critical_region"
GOAL_IN_REGION = "goal_in_active_region"
GOAL_NEAR_STOP = "goal_near_stop"
CLOSED_IN = "closed_in"
OUT_OF_REACH = "goal_out_of_reach"
IMPLAUSIBLE = "implausible"


class Described(Protocol):
    """Scene that the warnings examine; a `Scenario` is one, and knows this module."""

    @property
    def robot(self) -> HolonomicRobot | DifferentialDriveRobot: ...
    @property
    def start(self) -> Pair: ...
    @property
    def goal(self) -> Pair: ...
    @property
    def obstacles(self) -> Sequence[Obstacle]: ...
    @property
    def control_period(self) -> float: ...
    @property
    def time_limit(self) -> float: ...
    @property
    def arrival_tolerance(self) -> float: ...
    @property
    def heading(self) -> float: ...
    @property
    def walls(self) -> StaticMap | None: ...
    @property
    def measurement(self) -> Measurement | None: ...
    @property
    def doubts(self) -> Sequence[ResultWarning]: ...


def found(scenario: Described) -> tuple[ResultWarning, ...]:
    """Return the warnings of a scenario.

    Parameters
    ----------
    scenario : Scenario
        What is examined.

    Returns
    -------
    tuple of ResultWarning
        Codes ``"region_below_safe"``, ``"start_in_critical_region"``, ``"goal_in_active_region"``,
        ``"goal_near_stop"``, ``"recording_in_wall"``, ``"way_through_wall"``, ``"implausible"``,
        ``"goal_out_of_reach"``, ``"closed_in"``, ``"goal_in_wall"`` and ``"circle_around_footprint"``, and those of
        its ``doubts``.
    """
    about_ends = (*_starts(scenario), *_goals(scenario))
    own = (*_regions(scenario), *about_ends, *of_units(scenario), *_reach(scenario), *_closed(scenario))
    own = (*own, *circled("robot", scenario.robot), *_gaps(scenario), *_through(scenario))
    return tuple(dict.fromkeys((*scenario.doubts, *own)))


def _gaps(scenario: Described) -> tuple[ResultWarning, ...]:
    """Return the doubt about recorded motions with long times between two places."""
    moves = {
        f"obstacles[{index}]": each.path for index, each in enumerate(scenario.obstacles) if isinstance(each, Mobile)
    }
    return gaps_of_paths({name: path for name, path in moves.items() if path is not None}, scenario.doubts)


def _through(scenario: Described) -> Iterator[ResultWarning]:
    """Yield people who walk through walls, or through what stands in the scene."""
    things = [each for each in scenario.obstacles if isinstance(each, Disc | Rectangle)]
    solids = [] if scenario.walls is None else [("walls", scenario.walls)]
    solids += [("an obstacle that stands", StaticMap.from_obstacles(things))] if things else []
    people = [(f"obstacles[{index}]", each) for index, each in enumerate(scenario.obstacles) if isinstance(each, Human)]
    found = []
    for name, person in people if solids else ():
        gone, recorded = way(person, scenario.time_limit), person.path is not None
        told = [each for what, map in solids for each in through(gone, map, what, recorded=recorded)]
        found.append((name, told[:1]))
    yield from gathered(found, "people")


def circled(name: str, robot: HolonomicRobot | DifferentialDriveRobot) -> Iterator[ResultWarning]:
    """Yield what stands for the footprint of a robot where discs are needed.

    Parameters
    ----------
    name : str
        Name of the robot.
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot.

    Yields
    ------
    ResultWarning
        For a robot that is no disc.
    """
    if robot.footprint is not None:
        yield ResultWarning(
            "circle_around_footprint",
            f"{name}.footprint",
            f"laws, regions, yielding and foresight take the circle of {robot.radius:.4g} m around the footprint for "
            "the robot; contacts, clearances and the shield are those of the footprint itself",
            safe_side=True,  # the circle keeps the robot farther away
        )


def _regions(scenario: Described) -> Iterator[ResultWarning]:
    """Yield critical regions in which the robot cannot be sure to stop."""
    for index, obstacle in enumerate(scenario.obstacles):
        given = obstacle.as_given()
        sized, speed = _sized_for(given), own_speed(given, scenario.time_limit)
        faster = speed > sized + ROUNDING
        if not faster and given.critical_radius is None and given.critical_clearance is None:
            continue  # computed as the safe one
        checked = replace(given, max_speed=speed) if faster else given  # type: ignore[type-var]  # a dataclass
        safe = region_radii(scenario.robot, checked, scenario.control_period, measurement=scenario.measurement)
        radius = obstacle.critical_radius
        if radius is None or radius >= safe.critical_radius - ROUNDING:
            continue
        remedy = "leave it out"
        why = "region_radii"
        if scenario.measurement is not None:
            why += " with this measurement"
        if faster:
            how = "at which it moves" if speed <= own_speed(given, 0.0) else "that it reaches by time_limit"
            why += f" for the {speed:.4g} m/s {how}, above the {sized:g} m/s of max_speed"
            remedy = f"give max_speed={_up(speed):g}"
        yield ResultWarning(
            BELOW_SAFE,
            f"obstacles[{index}].critical_radius",
            f"critical_radius of obstacles[{index}] ({type(obstacle).__name__}) is {radius:.4g} m, below the "
            f"{_up(safe.critical_radius):.4f} m in which the robot can stop ({why}); {remedy}",
        )


def _up(value: float) -> float:
    return math.ceil(value * 1e4 - 1e-4) / 1e4


def _sized_for(obstacle: Obstacle) -> float:
    """Return the speed that the regions of an obstacle are sized for, in m/s."""
    if obstacle.max_speed is not None:
        return obstacle.max_speed
    if isinstance(obstacle, Human):
        return 1.0
    if isinstance(obstacle, Mobile) and obstacle.segments is not None:
        return max(math.hypot(*velocity) for _, velocity, _ in obstacle.segments)
    return own_speed(obstacle, 0.0)


def own_speed(obstacle: Obstacle, until: float) -> float:
    """Return the largest speed that the motion of an obstacle is known to have, in m/s.

    Parameters
    ----------
    obstacle : Obstacle
        Who moves.
    until : float
        When an acceleration without an end counts as over, in s.

    Returns
    -------
    float
        Speed in m/s; 0 for what stands.
    """
    if not isinstance(obstacle, Mobile):
        return 0.0
    if obstacle.path is not None:
        instants, places = obstacle.path
        steps = zip(instants, instants[1:], places, places[1:], strict=False)
        return max((math.dist(first, second) / (late - soon) for soon, late, first, second in steps), default=0.0)
    # The speed of an even acceleration is largest at one of its ends.
    ends = ((math.hypot(*first), math.hypot(*last)) for first, last, _ in pieces(obstacle, until))
    return max((max(pair) for pair in ends), default=0.0)


def pieces(obstacle: Mobile, until: float) -> Iterator[tuple[Pair, Pair, float]]:
    """Yield velocities in m/s at both ends of segments of a motion, and their accelerations in m/s^2.

    Parameters
    ----------
    obstacle : Human, MovingDisc or MovingRectangle
        Who follows no recording.
    until : float
        How long one without an end counts, in s.

    Yields
    ------
    tuple of two pairs and a float
        In the order of the segments.
    """
    endless = (math.inf, obstacle.velocity, getattr(obstacle, "acceleration", (0.0, 0.0)))
    for duration, velocity, acceleration in obstacle.segments or (endless,):
        length = until if math.isinf(duration) else duration
        last = [speed + length * more for speed, more in zip(velocity, acceleration, strict=True)]
        yield velocity, (last[0], last[1]), math.hypot(*acceleration)


def _starts(scenario: Described) -> Iterator[ResultWarning]:
    """Yield starts from which the robot never moves: in the critical region of something that stands."""
    for index, obstacle in enumerate(scenario.obstacles):
        if not free_space.stands(obstacle):
            continue
        distance = free_space.distance(obstacle, scenario.start)
        radius = obstacle.critical_radius
        if radius is not None and distance <= radius:
            yield ResultWarning(
                IN_CRITICAL_REGION,
                "start",
                f"start is {distance:.4g} m from obstacles[{index}] ({type(obstacle).__name__}), inside its critical "
                f"region of {radius:.4g} m, where the robot brakes and never leaves; move it by "
                f"{_up(radius - distance):g} m",
                safe_side=True,  # a doubt about arriving, and the run shows whether it does
            )


def _goals(scenario: Described) -> Iterator[ResultWarning]:
    """Yield goals that laws which keep to regions cannot reach: runs under one of them are refused."""
    for index, obstacle in enumerate(scenario.obstacles):
        radius = obstacle.active_radius
        if radius is None or not free_space.stands(obstacle):
            continue
        distance = free_space.distance(obstacle, scenario.goal)
        if distance < radius:
            yield ResultWarning(
                GOAL_IN_REGION,
                "goal",
                f"goal is {distance:.4g} m from obstacles[{index}] ({type(obstacle).__name__}), inside its active "
                f"region of {radius:.4g} m: force laws are refused, planners and safe navigation with a takeover may "
                f"reach it; move it by {_up(radius - distance):g} m for the others",
                safe_side=True,  # a doubt about arriving, and the run shows whether it does
            )
    yield from _near_stops(scenario)


def _near_stops(scenario: Described) -> Iterator[ResultWarning]:
    """Yield goals in the active region of a body that comes to a stop and stays there."""
    for index, obstacle in enumerate(scenario.obstacles):
        radius = obstacle.active_radius
        if radius is None or not isinstance(obstacle, Mobile) or free_space.stands(obstacle):
            continue
        time, places = way(obstacle, scenario.time_limit)
        last = places[-1] - places[-2:][0]
        stays = time[-1] < scenario.time_limit if obstacle.stop is not None else math.hypot(*last) < ROUNDING
        if obstacle.path is not None or not stays:
            continue
        gone = places[-1] - places[0]
        distance = free_space.distance(obstacle, (scenario.goal[0] - gone[0], scenario.goal[1] - gone[1]))
        if distance < radius - scenario.arrival_tolerance:
            noise = " with this measurement" if scenario.measurement is not None else ""
            yield ResultWarning(
                GOAL_NEAR_STOP,
                "goal",
                f"goal is {distance:.4g} m from the place where obstacles[{index}] ({type(obstacle).__name__}) stops "
                f"and stays, inside its active region of {radius:.4g} m{noise}: laws that keep to regions are pushed "
                f"away and may never arrive; move it by {_up(radius - distance):g} m, or take safe navigation with a "
                "takeover",
                safe_side=True,  # a doubt about arriving, and the run shows whether it does
            )


def of_units(scenario: Described) -> tuple[ResultWarning, ...]:
    """Return numbers outside the ranges of their quantities, and doubts of the scenario about units."""
    given = (each for each in scenario.doubts if each.code == IMPLAUSIBLE)
    robot = scenario.robot
    values: dict[str, object] = {
        "start": scenario.start,
        "goal": scenario.goal,
        "heading": scenario.heading,
        "control_period": scenario.control_period,
        "time_limit": scenario.time_limit,
        "arrival_tolerance": scenario.arrival_tolerance,
    }
    quantities = {"start": "floor_position", "goal": "floor_position"}
    for name in NUMBERS:
        values[f"robot.{name}"] = getattr(robot, name, None)
        quantities[f"robot.{name}"] = f"robot_{name}"
    if scenario.measurement is not None:
        values["measurement.scale"] = scenario.measurement.scale
        values["measurement.latency"] = scenario.measurement.latency
        quantities |= {"measurement.scale": "measurement_scale", "measurement.latency": "latency"}
    for index, obstacle in enumerate(scenario.obstacles):
        for name, (value, quantity) in _numbers(obstacle).items():
            values[f"obstacles[{index}].{name}"] = value
            quantities[f"obstacles[{index}].{name}"] = quantity
    return (*given, *implausible(values, quantities))


def _numbers(obstacle: Obstacle) -> dict[str, tuple[object, str]]:
    """Return the numbers of an obstacle with their quantities."""
    found: dict[str, tuple[object, str]] = {}
    own = obstacle.as_given()  # radii that were computed follow from the other numbers
    for name in ("critical_radius", "active_radius"):
        found[name] = (getattr(own, name, None), "region_radius")
    for name in ("critical_clearance", "active_clearance"):
        found[name] = (getattr(own, name, None), "region_clearance")
    for place in ("start", "center"):
        found[place] = (getattr(obstacle, place, None), "floor_position")
    if isinstance(obstacle, Box):
        found |= {name: (getattr(obstacle, name), "obstacle_size") for name in ("length", "width")}
        found["heading"] = (obstacle.heading, "heading")
    if isinstance(obstacle, Rectangle):
        return found
    person = isinstance(obstacle, Human)
    kind = "person_speed" if person else "obstacle_speed"
    found["radius"] = (getattr(obstacle, "radius", None), "person_radius" if person else "obstacle_size")
    return found | {"velocity": (own_speed(obstacle, 0.0), kind), "max_speed": (obstacle.max_speed, kind)}


def _reach(scenario: Described) -> Iterator[ResultWarning]:
    """Yield goals that are too far for the time limit."""
    away = math.dist(scenario.start, scenario.goal) - scenario.arrival_tolerance
    reach = scenario.robot.max_speed * scenario.time_limit
    if away > reach:
        needed = math.ceil(away / scenario.robot.max_speed)
        yield ResultWarning(
            OUT_OF_REACH,
            "goal",
            f"goal is {away:g} m away and the robot covers at most {reach:g} m at {scenario.robot.max_speed:g} m/s in "
            f"time_limit = {scenario.time_limit:g} s; give time_limit={needed} or more",
            safe_side=True,  # a doubt about arriving, and the run shows whether it does
        )


def _closed(scenario: Described) -> Iterator[ResultWarning]:
    """Yield stationary obstacles that leave no way for the robot, or no place near the goal."""
    radius = least_reach(scenario.robot)
    if scenario.walls is not None:
        within = radius - float(scenario.walls.clearance(scenario.goal))
        if within > scenario.arrival_tolerance:
            yield ResultWarning(
                "goal_in_wall",
                "goal",
                f"goal lies {within:.4g} m within walls, grown by the radius of the robot, {radius:g} m: the robot "
                f"touches them before it is within arrival_tolerance = {scenario.arrival_tolerance:g} m",
            )
            return
    for index, obstacle in enumerate(scenario.obstacles):
        if not free_space.stands(obstacle):
            continue
        depth = free_space.depth(obstacle, scenario.goal, radius)
        if depth > scenario.arrival_tolerance:
            yield ResultWarning(
                CLOSED_IN,
                "goal",
                f"goal lies {depth:.4g} m within obstacles[{index}] ({type(obstacle).__name__}), grown by the radius "
                f"of the robot, {radius:g} m: the robot touches it before it is within arrival_tolerance = "
                f"{scenario.arrival_tolerance:g} m; move it by {_up(depth):g} m",
                safe_side=True,  # a doubt about arriving, and the run shows whether it does
            )
            return
    closed = free_space.certainly_closed(
        scenario.obstacles,
        start=scenario.start,
        goal=scenario.goal,
        radius=radius,
        arrival_tolerance=scenario.arrival_tolerance,
    )
    if closed:
        yield ResultWarning(
            CLOSED_IN,
            "obstacles",
            f"standing obstacles leave no way from start to goal for a robot of radius {radius:g} m; "
            "move start, goal or an obstacle",
            safe_side=True,  # a doubt about arriving, and the run shows whether it does
        )
