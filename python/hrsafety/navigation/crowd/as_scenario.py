"""A world, or the run of one, as one of its robots has it: a scenario whose obstacles are the others as they go."""

from __future__ import annotations

import functools
import math
import operator
from dataclasses import fields
from typing import Any

import numpy as np

from hrsafety._arguments import Array, Pair, assign
from hrsafety.navigation.crowd.agents import Person, Robot, middle_of
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.replays import walls_of
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning

__all__ = ["run_in_scenario", "scenario_at_start"]

USUAL_SPEED = 1.34
"""Mean speed in m/s of people whose own is drawn, Weidmann (1993)."""


def scenario_at_start(world: World, robot: int = 0) -> Scenario:
    """Return a robot of a world before the run, and the others as they start.

    Parameters
    ----------
    world : World
        The world.
    robot : int
        Index of the robot.

    Returns
    -------
    Scenario
        People go straight to the first point of their route, at the usual speed where their own is drawn; who moves
        as told does so.
    """
    others = [each for index, each in enumerate(world.robots) if index != robot]
    return _scenario(world, world.robots[robot], [*map(_starting, world.people), *map(_bound, others)])


def run_in_scenario(run: Trajectory) -> Trajectory:
    """Return the run of a robot of a world as that in a scenario, whose obstacles are people and robots as they went.

    Parameters
    ----------
    run : Trajectory
        Of a world, as one robot has it.

    Returns
    -------
    Trajectory
        With the numbers and the warnings of the run; people come first among the obstacles. The columns of a force are
        ``None``.
    """
    return _RunInScenario(run)


class _RunInScenario(Trajectory):
    """A `Trajectory` with the warnings of the run of the world."""

    __slots__ = ("_run",)
    _run: Trajectory

    def __init__(self, run: Trajectory) -> None:
        world: World = run.scenario
        own = world.robots[run.robot]
        others = [index for index in range(len(world.robots)) if index != run.robot]
        bodies = [world.robots[index].body.radius for index in others]
        place = np.concatenate([run.obstacle_position, run.robot_position[:, others]], axis=1)
        away = place - run.position[:, None]
        distance = np.hypot(away[..., 0], away[..., 1])
        least = np.fmin.reduce(distance[:, len(run.min_distance) :], axis=0) if len(run.time) else np.array([])
        untouched = {"time": np.nan, "speed": np.nan, "toward": False, "at_fault": False, "apart": False}
        people = [
            _walked(run, index, radius, speed, place[:, index])
            for index, (radius, speed) in enumerate(zip(run.obstacle_radius, run.desired_speed, strict=True))
        ]
        robots: list[Obstacle] = [
            MovingDisc.from_path(run.time, place[:, len(people) + index], radius=radius)
            for index, radius in enumerate(bodies)
        ]
        values = {each.name: getattr(run, each.name) for each in fields(Trajectory)}
        values |= {
            "scenario": _scenario(world, own, [*people, *robots]),
            "built": own.as_built(),
            "obstacle_position": place,
            "distance": distance,
            "min_distance": np.append(run.min_distance, least),
            "min_clearance": np.append(run.min_clearance, least - own.body.radius - bodies),
            **{
                f"contact_{name}": np.append(getattr(run, f"contact_{name}"), np.full(len(others), value))
                for name, value in untouched.items()
            },
            "_run": run,
        }
        for name, value in values.items():
            assign(self, name, value)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Warnings of the run of the world."""
        return self._run.warnings


def _scenario(world: World, own: Robot, obstacles: list[Obstacle]) -> Scenario:
    maps = walls_of(world)
    return Scenario(
        robot=own.body,
        start=own.start,
        goal=own.goal,
        obstacles=tuple(obstacles),
        control_period=world.step if own.control_period is None else own.control_period,
        time_limit=world.time_limit,
        arrival_tolerance=own.arrival_tolerance,
        heading=own.heading,
        measurement=own.measurement,
        seed=world.seed,
        walls=functools.reduce(operator.add, maps) if maps else None,
    )


def _starting(person: Person) -> Obstacle:
    """Return a person as the start of a world has it."""
    if person.mover is not None:
        return person.mover
    if person.recording is not None:
        time, places = person.recording
        return Human.from_path(time, places, radius=person.radius)
    speed = USUAL_SPEED if person.desired_speed is None else person.desired_speed
    goal = middle_of(person.route[0]) if person.route else person.start
    velocity = _toward(person.start, goal, speed)
    return Human(start=person.start, velocity=velocity, radius=person.radius, max_speed=_most(person, speed))


def _bound(robot: Robot) -> Obstacle:
    velocity = _toward(robot.start, robot.goal, robot.body.max_speed)
    return MovingDisc(center=robot.start, velocity=velocity, radius=robot.body.radius)


def _toward(start: Pair, goal: Pair, speed: float) -> Pair:
    """Return the velocity in m/s at a speed from a place to another one; 0 there."""
    away = math.dist(start, goal)
    share = speed / away if away > 0.0 else 0.0
    return share * (goal[0] - start[0]), share * (goal[1] - start[1])


def _most(person: Person, speed: float) -> float | None:
    """Return the speed in m/s that laws size the regions of a person for, who wants to walk at a speed."""
    most = speed * person.model.max_speed_ratio
    return (most if math.isfinite(most) else speed) or None


def _walked(run: Trajectory, index: int, radius: float, speed: float, place: Array) -> Obstacle:
    """Return a person of a run as it went; one who never came appears after the end."""
    world: World = run.scenario
    there = np.flatnonzero(np.isfinite(place).all(axis=1))
    given: dict[str, Any] = {"radius": float(radius)}
    if index < len(world.people) and world.people[index].reacts:
        given["max_speed"] = _most(world.people[index], float(speed))
    if not len(there):
        return Human.from_path([float(run.time[-1]) + 1.0], [(0.0, 0.0)], **given)
    rows = slice(int(there[0]), int(there[-1]) + 1)
    return Human.from_path(run.time[rows], place[rows], **given)
