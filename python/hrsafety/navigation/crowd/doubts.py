"""Whether the shields of robots in a world assume as much as the world has."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair
from hrsafety._tracks import gaps_of_paths
from hrsafety.navigation.crowd.agents import FASTEST_DRAWN, Person, Robot, Source, middle_of
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.maps.outlines import Shape, standing
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.ways import through, way
from hrsafety.navigation.robots.bodies import NUMBERS
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.warnings.filters import of_filter
from hrsafety.navigation.warnings.scans import of_object, of_robot, unwatched
from hrsafety.navigation.warnings.scenarios import circled, own_speed
from hrsafety.navigation.warnings.shields import (
    ASSUMES_LESS,
    SEES_LESS,
    Motion,
    Mover,
    maps_of,
    of_built,
    of_order,
    of_surroundings,
    shield_of,
)
from hrsafety.navigation.warnings.walls import unknown_walls
from hrsafety.plausibility import RANGES, ResultWarning, gathered, implausible

__all__ = [
    "of_footprints",
    "of_gaps",
    "of_maps",
    "of_numbers",
    "of_people",
    "of_robots",
    "of_scans",
    "of_sensors",
    "of_unknown_walls",
    "of_walls",
]

MOST_TIME = 1e7
"""Longest time of a world, in s."""
KEPT = 0.1
"""Share of the radius of a person that the center keeps off walls."""


def of_numbers(
    people: Sequence[Person], sources: Sequence[Source], robots: Sequence[Robot], time_limit: float
) -> tuple[ResultWarning, ...]:
    """Return a warning about numbers of a world outside the ranges of their quantities, if there are any.

    Parameters
    ----------
    people, sources, robots : sequence of Person, Source, Robot
        Who is in the world.
    time_limit : float
        In s.

    Returns
    -------
    tuple of ResultWarning
        The first with the number of the others; the code is ``"implausible"``.
    """
    found = [("world", implausible({"time_limit": time_limit}))]
    for index, person in enumerate(people):
        values: dict[str, object] = {"start": person.start, **_body(person), "recording": _recorded_speed(person)}
        found.append((f"people[{index}]", implausible(values, _QUANTITIES)))
    found += [(f"sources[{index}]", implausible(_body(each), _QUANTITIES)) for index, each in enumerate(sources)]
    for index, robot in enumerate(robots):
        values = {"start": robot.start, "goal": robot.goal, "heading": robot.heading}
        values |= {f"robot_{name}": getattr(robot.body, name, None) for name in NUMBERS}
        if robot.measurement is not None:
            values |= {"measurement_scale": robot.measurement.scale, "latency": robot.measurement.latency}
        found.append((f"robots[{index}]", implausible(values, _QUANTITIES)))
    return gathered(found, "bodies")


def of_people(wall_rescues: int, max_person_speed: float, desired_speed: Array) -> tuple[ResultWarning, ...]:
    """Return the doubts about people in a world that has run.

    Parameters
    ----------
    wall_rescues : int
        How often a person was set back at a wall.
    max_person_speed : float
        Largest speed of a person, in m/s.
    desired_speed : ndarray of shape (m,)
        Speeds that people want, in m/s.

    Returns
    -------
    tuple of ResultWarning
        With the codes ``"wall_rescues"`` and ``"people_too_fast"``.
    """
    found = []
    if wall_rescues:
        found.append(
            ResultWarning(
                "wall_rescues",
                "wall_rescues",
                f"people were set back {wall_rescues} times who would have passed a wall or come nearer to it than "
                "a tenth of their radius: their model does not keep them off these walls, and near them they move as "
                "no model says; a larger wall_strength or wall_range, slower people or starts apart help",
            )
        )
    most = max(RANGES["walking_speed"].most, _PUSHED * float(desired_speed.max(initial=0.0)))
    if max_person_speed > most:
        found.append(
            ResultWarning(
                "people_too_fast",
                "max_person_speed",
                f"somebody moved at {max_person_speed:.4g} m/s, faster than {most:.3g} m/s, the fastest that people "
                "are pushed: bodies that overlap push each other apart without bound; let people start apart, or take "
                "a model that bounds the speed",
            )
        )
    return tuple(found)


_PUSHED = 1.3
"""Multiple of the desired speed that other models of force permit."""


def of_walls(
    people: Sequence[Person],
    sources: Sequence[Source],
    robots: Sequence[Robot],
    native: _hrsafety.CrowdWorld,
    walls: Sequence[Shape] | StaticMap,
    time_limit: float,
) -> tuple[ResultWarning, ...]:
    """Return a warning about starts, goals and ways in walls, the first of each kind with how many follow.

    Parameters
    ----------
    people, sources, robots : sequence of Person, Source, Robot
        Who is in the world.
    native : CrowdWorld
        The world as the core has it.
    walls : sequence of Disc, Rectangle or tuple of points, or StaticMap
        Its walls.
    time_limit : float
        In s.

    Returns
    -------
    tuple of ResultWarning
        With the codes ``"start_in_wall"``, ``"goal_in_wall"``, ``"recording_in_wall"`` and ``"way_through_wall"``.
    """
    acting = [(f"people[{index}]", person) for index, person in enumerate(people) if person.reacts]
    # A center keeps a tenth of its radius off walls; on a line its side is not known.
    starts = [(owner, "start", person.start, KEPT * person.radius) for owner, person in acting]
    walking: list[tuple[str, Person | Source]] = [*acting]
    walking += [(f"sources[{index}]", source) for index, source in enumerate(sources)]
    goals = [
        (owner, f"route[{place}]", middle_of(element), 0.0)
        for owner, each in walking
        for place, element in enumerate(each.route)
    ]
    # A robot has arrived as soon as it is within the tolerance.
    goals += [
        (f"robots[{index}]", "goal", robot.goal, max(0.0, robot.body.radius - robot.arrival_tolerance))
        for index, robot in enumerate(robots)
    ]
    inside = [
        (owner, (ResultWarning("start_in_wall", name, f"{said}: who is inside is set out at the first step"),))
        for owner, name, said in _in_walls(starts, native)
    ]
    behind = [
        (owner, (ResultWarning("goal_in_wall", name, f"{said}: nobody passes a wall to get there"),))
        for owner, name, said in _in_walls(goals, native)
    ]
    map = standing(walls) if len(acting) < len(people) else StaticMap()
    crossing = [
        (f"people[{index}]", tuple(_through_walls(person, time_limit, map)))
        for index, person in enumerate(people)
        if not person.reacts
    ]
    return (*gathered(inside, "starts"), *gathered(behind, "goals"), *gathered(crossing, "people"))


def of_scans(
    people: Sequence[Person], sources: Sequence[Source], robots: Sequence[Robot], time_limit: float, *, walls: bool
) -> tuple[ResultWarning, ...]:
    """Return the doubts of laws with a map or an observation of their own, the first of each kind with how many follow.

    Parameters
    ----------
    people, sources, robots : sequence of Person, Source, Robot
        Who is in the world.
    time_limit : float
        In s.
    walls : bool
        Whether there are any.

    Returns
    -------
    tuple of ResultWarning
        With the codes of `hrsafety.navigation.warnings.scans.unwatched` and ``of_object``.
    """
    movers = len(people) + len(sources) + len(robots) - 1
    found = []
    for index, robot in enumerate(robots):
        there = walls or bool(maps_of(robot.law, whole=False))
        own = of_object(robot.law, robot.body, robot.as_built(), time_limit, walls=there)
        found.append((f"robots[{index}]", (*unwatched(robot.law, movers), *own)))
    return gathered(found, "robots")


def of_sensors(
    people: Sequence[Person], robots: Sequence[Robot], step: float, walls: StaticMap | None
) -> tuple[ResultWarning, ...]:
    """Return the warnings of sensors that see less of a world than they must, the first of each kind.

    Parameters
    ----------
    people, robots : sequence of Person, Robot
        Who is in the world.
    step : float
        Its step in s, the control period of robots without one.
    walls : StaticMap or None
        What stands.

    Returns
    -------
    tuple of ResultWarning
        Those of `nav.simulate` for a scenario with the same robot and people who move at their largest speeds.
    """
    found = []
    for index, robot in enumerate(robots):
        built = robot.as_built(walls)
        if built is None or math.dist(robot.start, robot.goal) <= robot.arrival_tolerance:
            continue
        there = [person for person in people if person.enters <= 0.0]
        scene = Scenario(
            robot=robot.body,
            start=robot.start,
            goal=robot.goal,
            obstacles=tuple(map(_mover_of, there)),
            control_period=step if robot.control_period is None else robot.control_period,
            arrival_tolerance=robot.arrival_tolerance,
            measurement=robot.measurement,
        )
        told = of_robot(scene, robot.law, built)
        found.append(
            (f"robots[{index}]", tuple(replace(each, subject=f"robots[{index}].{each.subject}") for each in told))
        )
    return gathered(found, "robots")


def _mover_of(person: Person) -> MovingDisc:
    """Return a person as a disc that moves at the largest speed of the person."""
    recorded = _recorded_speed(person)
    speed = _largest_speed(person) if recorded is None else recorded
    return MovingDisc(center=person.start, velocity=(min(speed, 1e3), 0.0), radius=person.radius)


def of_unknown_walls(walls: StaticMap, robots: Sequence[Robot]) -> tuple[ResultWarning, ...]:
    """Return a warning about laws that do not know the walls of their world, the first with how many follow.

    Parameters
    ----------
    walls : StaticMap
        What stands.
    robots : sequence of Robot
        The robots.

    Returns
    -------
    tuple of ResultWarning
        With the code ``"unknown_wall"``.
    """
    found = []
    for index, robot in enumerate(robots):
        built = robot.as_built(walls)
        own = () if built is None else tuple(each.map for each in built.sensors if isinstance(each, Lidar))
        found.append((f"robots[{index}]", tuple(unknown_walls(walls, robot.law, own))))
    return gathered(found, "robots")


def of_gaps(people: Sequence[Person], told: Sequence[ResultWarning]) -> tuple[ResultWarning, ...]:
    """Return the doubt about recorded people with long times between two places; ``told``: of their recording."""
    paths = {
        f"people[{index}]": each.recording or getattr(each.mover, "path", None) for index, each in enumerate(people)
    }
    return gaps_of_paths({name: path for name, path in paths.items() if path is not None}, told)


def of_maps(robots: Sequence[Robot]) -> Iterator[ResultWarning]:
    """Yield the doubts of the maps that laws of robots know, each once: whoever drives by a map trusts it."""
    yield from dict.fromkeys(doubt for robot in robots for map in maps_of(robot.law) for doubt in map.warnings)


def _through_walls(person: Person, until: float, walls: StaticMap) -> Iterator[ResultWarning]:
    """Yield a doubt about somebody who walks through walls as recorded or told."""
    if person.recording is not None:
        gone = np.array(person.recording[0], dtype=np.float64), np.array(person.recording[1], dtype=np.float64)
        yield from through(gone, walls, "walls", recorded=True)
    elif isinstance(person.mover, Human):
        yield from through(way(person.mover, until), walls, "walls", recorded=person.mover.path is not None)


def _in_walls(
    places: Sequence[tuple[str, str, Pair, float]], native: _hrsafety.CrowdWorld
) -> Iterator[tuple[str, str, str]]:
    """Yield owner, name and what is wrong of places that are not so far from walls as they need to be."""
    gaps = native.nearest_walls([place for _, _, place, _ in places])
    for (owner, name, (x, y), least), (gap, wall) in zip(places, gaps, strict=True):
        if gap < least:
            there = f"{-gap:.3g} m inside" if gap < 0.0 else f"{gap:.3g} m from"
            needed = "" if least == 0.0 or gap < 0.0 else f", nearer than the {least:.3g} m that it needs"
            yield owner, name, f"{name} ({x:.6g}, {y:.6g}) is {there} walls[{wall}]{needed}"


_QUANTITIES = {
    "start": "floor_position",
    "goal": "floor_position",
    "radius": "person_radius",
    "desired_speed": "person_speed",
    "recording": "person_speed",
}


def _body(owner: Person | Source) -> dict[str, object]:
    return {"radius": owner.radius, "desired_speed": owner.desired_speed}


def of_footprints(
    people: Sequence[Person], sources: Sequence[Source], robots: Sequence[Robot]
) -> Iterator[ResultWarning]:
    """Yield what takes the circle around the footprint of a robot for it.

    Parameters
    ----------
    people, sources, robots : sequence of Person, Source, Robot
        Who is in the world.

    Yields
    ------
    ResultWarning
        With the codes ``"circle_around_footprint"`` and ``"people_avoid_circle"``.
    """
    reacting = len(sources) > 0 or any(person.reacts and person.awareness > 0.0 for person in people)
    for index, robot in enumerate(robots):
        yield from circled(f"robots[{index}].body", robot.body)
        if robot.body.footprint is not None and reacting:
            yield ResultWarning(
                "people_avoid_circle",
                f"robots[{index}].body.footprint",
                f"people who react keep away from the circle of {robot.body.radius:.4g} m around the footprint, "
                "farther than they would from the footprint itself: there may be fewer contacts than with a robot that "
                "looks as it is; people who are distracted or follow recordings do not know the circle",
            )


def of_robots(
    people: Sequence[Person], sources: Sequence[Source], robots: Sequence[Robot], step: float, *, walls: bool
) -> tuple[ResultWarning, ...]:
    """Return the warnings of shields in a world, for each bound of a robot the one that is exceeded most.

    Parameters
    ----------
    people, sources, robots : sequence of Person, Source, Robot
        Who is in the world.
    step : float
        Its step in s, the control period of robots without one.
    walls : bool
        Whether there are any.

    Returns
    -------
    tuple of ResultWarning
        With the codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    found: list[ResultWarning] = []
    for index, robot in enumerate(robots):
        shield, knows_map = shield_of(robot.law)
        measured = robot.measurement is not None or robot.as_built() is not None
        found += of_filter(robot.law, f"robots[{index}].law", measured=measured, walls=walls or knows_map)
        if shield is None:
            continue
        found += of_order(robot.law, f"robots[{index}].law")
        if shield.unseen is not None and (people or sources):
            message = (
                "people of a world keep a tenth of their radius off walls and come out of sources; the shield takes "
                f"cores of {shield.unseen.person_core:.3g} m to be off all walls and nobody to appear where it sees: "
                "nothing is proved about those whom it does not see; take scenarios for that"
            )
            found.append(ResultWarning(ASSUMES_LESS, f"robots[{index}].law.shield.unseen", message))
        others = [each for each in _speeds(people, sources, robots) if each[0] != f"robots[{index}]"]
        fastest = max(others, key=lambda each: each[1], default=None)
        built = robot.as_built()
        # Wheels of a robot as built move in steps of 0.01 s at most.
        steps = step if built is None else min(step, 0.01)
        motion = Motion(robot.body, step if robot.control_period is None else robot.control_period, steps)
        found += [] if built is None else of_built(shield, built)
        found += of_surroundings(
            shield,
            # Everybody decides anew at each step, for any velocity up to the largest speed.
            () if fastest is None else (Mover(*fastest, jump=2.0 * fastest[1]),),
            measurement=robot.measurement,
            motion=motion,
            walls=walls or knows_map,
            owner=f"robots[{index}].law.shield",
        )
        sizes = [size for who, size in _radii(people, sources, robots) if who != f"robots[{index}]"]
        found += _of_range(f"robots[{index}]", robot, motion, shield, max(sizes, default=0.0))
        found += _of_occlusion(f"robots[{index}]", robot, shield, walls=walls)
    return tuple(found)


def _speeds(
    people: Iterable[Person], sources: Iterable[Source], robots: Iterable[Robot]
) -> Iterator[tuple[str, float]]:
    """Yield who is in a world, and the largest speed in m/s."""
    for index, person in enumerate(people):
        recorded = _recorded_speed(person)
        yield f"people[{index}]", _largest_speed(person) if recorded is None else recorded
    for index, source in enumerate(sources):
        yield f"sources[{index}]", _largest_speed(source)
    for index, robot in enumerate(robots):
        yield f"robots[{index}]", robot.body.max_speed


def _radii(people: Iterable[Person], sources: Iterable[Source], robots: Iterable[Robot]) -> Iterator[tuple[str, float]]:
    """Yield who is in a world, and the radius in m."""
    yield from ((f"people[{index}]", person.radius) for index, person in enumerate(people))
    yield from ((f"sources[{index}]", source.radius) for index, source in enumerate(sources))
    yield from ((f"robots[{index}]", robot.body.radius) for index, robot in enumerate(robots))


def _of_range(owner: str, robot: Robot, motion: Motion, shield: Shield, radius: float) -> Iterator[ResultWarning]:
    """Warn of a range within which a person may stand unseen by the robot, which cannot stop in time."""
    if shield.person_speed is None or radius == 0.0 or shield.unseen is not None:
        return
    plan = motion.plan_duration
    touch = robot.body.radius + radius + shield.margin + shield.position_error
    least = touch + shield.person_speed * (shield.latency + plan) + robot.body.max_speed * plan
    if robot.sensing_range < least:
        yield ResultWarning(
            SEES_LESS,
            f"{owner}.sensing_range",
            f"sensing_range of {owner} is {robot.sensing_range:.4g} m, but its shield reckons with people up to "
            f"{least:.4g} m away until the robot stands: who is farther than the range is not there for it; give at "
            f"least sensing_range={math.ceil(least * 1e3) / 1e3:g}",
        )


def _of_occlusion(owner: str, robot: Robot, shield: Shield, *, walls: bool) -> Iterator[ResultWarning]:
    """Warn of walls that hide people from a robot whose shield reckons with nobody who is not seen."""
    if robot.occlusion and walls and shield.unseen is None:
        yield ResultWarning(
            SEES_LESS,
            f"{owner}.occlusion",
            f"walls hide people from {owner}, and its shield keeps off those whom the robot sees: who steps out from "
            "behind a wall is not there for it before",
        )


def _largest_speed(owner: Person | Source) -> float:
    desired = FASTEST_DRAWN if owner.desired_speed is None else owner.desired_speed
    # Where a model has no largest speed, forces move those who do not want to go as well.
    ratio = owner.model.max_speed_ratio
    return desired * ratio if desired or math.isfinite(ratio) else math.inf


def _recorded_speed(person: Person) -> float | None:
    """Return the largest speed of a person who follows a recording or moves as an obstacle, else ``None``."""
    if person.mover is not None:
        return own_speed(person.mover, MOST_TIME)
    if person.recording is None:
        return None
    time, places = np.array(person.recording[0]), np.array(person.recording[1])
    return float((np.hypot(*np.diff(places, axis=0).T) / np.diff(time)).max(initial=0.0))
