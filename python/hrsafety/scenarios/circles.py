"""People and robots on circles who all go to the opposite point."""

from __future__ import annotations

import functools
import math

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import checked_seed, count, flag, instance, not_negative
from hrsafety.navigation.crowd.agents import Person, Robot
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.python_law import AnyLaw
from hrsafety.scenarios.placing import drawn, model_of

__all__ = ["antipodal", "circle_crossing"]

DISTURBANCE = 0.05
"""Disturbance of starts on a circle, in m: with 1 mm people who avoid each other reciprocally block the middle."""


@functools.cache
def _reciprocal() -> Pedestrian:
    return nav.crowd.ReciprocalAvoidance()


def antipodal(
    n: int,
    *,
    model: Pedestrian | None = None,
    law: AnyLaw | None = None,
    robots: int | None = None,
    robot: nav.HolonomicRobot | None = None,
    desired_speed: float | None = 1.0,
    disturbance: float = DISTURBANCE,
    seed: int = 0,
    time_limit: float = 60.0,
) -> World:
    """Return a circle of people or robots who all go to the opposite point.

    The radius is ``max(4, n/(2 pi))`` m. Starts are disturbed: who all aim at one middle block each other there, and
    `ReciprocalAvoidance` does so even with starts that are 1 mm from a perfect circle.

    Parameters
    ----------
    n : int
        How many, at most 10,000.
    model : Pedestrian or None
        Model of the people; ``None``: `CollisionFreeSpeed`.
    law : Law, callable, object or None
        Law of the robots.
    robots : int or None
        The first so many are robots; ``None``: all with a law, none without.
    robot : HolonomicRobot or None
        What they are; the default one when ``None``.
    desired_speed : float or None
        Of the people, in m/s; ``None``: drawn.
    disturbance : float
        Largest distance along each axis of a start from its place on the circle, in m.
    seed : int
        Seed of the disturbance and of the world.
    time_limit : float
        Longest simulated time in s.

    Returns
    -------
    World
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> world = scenarios.antipodal(20, law=nav.OptimalReciprocalCollisionAvoidance())
    >>> len(world.robots), len(world.people)
    (20, 0)
    """
    total = count("n", n, most=10_000)
    checked, generator = drawn(seed)
    driven = (0 if law is None else total) if robots is None else count("robots", robots, least=0, most=total)
    most = not_negative("disturbance", disturbance)
    radius = max(4.0, total / (2.0 * math.pi))
    angles = 2.0 * math.pi * np.arange(total) / total
    starts = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    disturbed = (starts + generator.uniform(-most, most, starts.shape)).tolist()
    goals = (-starts).tolist()
    body = nav.HolonomicRobot() if robot is None else robot
    of = model_of(model)
    return World(
        robots=[
            Robot(body, start=tuple(start), goal=tuple(goal), law=law)
            for start, goal in zip(disturbed[:driven], goals[:driven], strict=True)
        ],
        people=[
            Person(start=tuple(start), route=[tuple(goal)], model=of, desired_speed=desired_speed)
            for start, goal in zip(disturbed[driven:], goals[driven:], strict=True)
        ],
        seed=checked,
        time_limit=time_limit,
    )


def circle_crossing(
    case: int,
    *,
    law: AnyLaw | None = None,
    visible: bool = True,
    people: int = 5,
    model: Pedestrian | None = None,
    robot: nav.HolonomicRobot | None = None,
) -> World:
    """Return a case of CrowdNav: a robot from (0, -4) to (0, 4) among people who cross a circle of 4 m.

    Everybody has a radius of 0.3 m and walks at 1 m/s; the step is 0.25 s, the limit 25 s.

    Parameters
    ----------
    case : int
        Number of the case and seed; 0 to 499 are those of the benchmark.
    law : Law, callable, object or None
        Law of the robot; ``None``: it stands.
    visible : bool
        Whether people notice the robot (awareness 1) or not (0).
    people : int
        How many.
    model : Pedestrian or None
        Model of the people; ``None``: `ReciprocalAvoidance`.
    robot : HolonomicRobot or None
        What it is; ``None``: radius 0.3 m, 1 m/s.

    Returns
    -------
    World
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> world = scenarios.circle_crossing(3, law=nav.OptimalReciprocalCollisionAvoidance())
    >>> nav.simulate(world).outcomes
    ('arrived',)
    """
    of = _reciprocal() if model is None else instance("model", model, Pedestrian)
    awareness = 1.0 if flag("visible", visible) else 0.0
    starts = nav.crowd.circle_starts(checked_seed("case", case), people).tolist()
    body = nav.HolonomicRobot(radius=0.3, max_speed=1.0) if robot is None else robot
    driven = Robot(body, start=(0.0, -4.0), goal=(0.0, 4.0), law=law, heading=0.5 * math.pi)
    return World(
        people=[
            Person(start=(x, y), route=[(-x, -y)], model=of, radius=0.3, desired_speed=1.0, awareness=awareness)
            for x, y in starts
        ],
        robots=[driven],
        step=0.25,
        time_limit=25.0,
        seed=case,
    )
