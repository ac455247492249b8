"""Random crowds that walk through the way of a robot."""

from __future__ import annotations

import math

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import checked_seed, count
from hrsafety._bounds import MOST_OBSTACLES
from hrsafety.navigation.run_arguments import Seeds
from hrsafety.navigation.scenario_arrays import Scenarios, checked_robot
from hrsafety.scenarios.drawn import seeds_of

__all__ = ["random_crowd", "random_crowd_batch"]

SIDE = 8.0
"""Side of the square area, in m."""
START = (0.5, SIDE / 2)
GOAL = (SIDE - 0.5, SIDE / 2)
CRITICAL_RADIUS = 0.8
ACTIVE_RADIUS = 2.1
SLOWEST, FASTEST = 0.5, 1.4
"""Walking speeds in m/s."""
LATEST_ENTRY = 8.0
"""Last instant at which a person reaches the border of the area, in s."""
STOPPING_SHARE = 0.2
TIME_LIMIT = 60.0
"""In s; also the time that the robot may rest."""
INNER_MARGIN = 1.0
"""Distance from the border within which no person's way is aimed, in m."""


def random_crowd(
    people: int, *, seed: int, robot: nav.HolonomicRobot | nav.DifferentialDriveRobot | None = None
) -> nav.Scenario:
    """Return a robot that crosses a square of 8 m while people walk through it.

    The robot goes from (0.5, 4) to (7.5, 4). Each person (radius 0.4 m, regions 0.8 m and
    2.1 m) enters at a place that is uniform on the border of the square, at an instant that is
    uniform from 0 to 8 s, walks straight through a point that is uniform in the inner square
    1..7 m, at a speed uniform from 0.5 to 1.4 m/s, and walks on for ever; before entering, a
    person comes from outside on the same line. With probability 0.2 the person stops for good
    at the inner point. Drawn again are people who at time 0 are within the critical radius of
    the robot, and people who would stop within the active radius of its start or goal. People
    do not avoid each other or the robot.

    The robot may rest as long as the time limit: waiting for people is not giving up.

    Parameters
    ----------
    people : int
        How many people, from 0 to 10,000.
    seed : int
        Seed of the draw and of the scenario, 0 <= seed < 2**64. Person k is the same in any
        crowd of the same seed with more than k people.
    robot : HolonomicRobot or None
        The robot; the default one when ``None``.

    Returns
    -------
    Scenario
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If people or seed is not an integer in its range.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> crowd = scenarios.random_crowd(12, seed=3)
    >>> len(crowd.obstacles), crowd == scenarios.random_crowd(12, seed=3)
    (12, True)
    """
    count("people", people, least=0, most=MOST_OBSTACLES)
    checked = checked_seed("seed", seed)
    generator = np.random.Generator(np.random.PCG64(checked))
    crowd = tuple(_walker(generator) for _ in range(people))
    return nav.Scenario(
        start=START,
        goal=GOAL,
        obstacles=crowd,
        robot=nav.HolonomicRobot() if robot is None else robot,
        time_limit=TIME_LIMIT,
        rest_time=TIME_LIMIT,
        seed=checked,
    )


def random_crowd_batch(
    seeds: Seeds, *, people: int = 12, robot: nav.HolonomicRobot | nav.DifferentialDriveRobot | None = None
) -> Scenarios:
    """Return `random_crowd` of many seeds, drawn in one call.

    Parameters
    ----------
    seeds : int or iterable of int
        Seeds, or their number: then 0, 1, 2 and so on.
    people : int
        How many people each has, from 0 to 10,000.
    robot : HolonomicRobot or None
        The robot; the default one when ``None``.

    Returns
    -------
    Scenarios
        Row i has the bits of ``random_crowd(people, seed=seeds[i])``.

    Raises
    ------
    InvalidParameterError
        As `random_crowd`, or if there are more than ten million scenarios and people together.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> drawn = scenarios.random_crowd_batch(100, people=5)
    >>> len(drawn), drawn[7] == scenarios.random_crowd(5, seed=7)
    (100, True)
    """
    count("people", people, least=0, most=MOST_OBSTACLES)
    drawn = seeds_of(seeds, people)
    driven = checked_robot(robot)
    again = random_crowd_batch, {"seeds": drawn, "people": people, "robot": driven}
    return Scenarios._drawn(
        "random_crowd", people, driven, drawn, again, lambda row: random_crowd(people, seed=drawn[row], robot=driven)
    )


def _walker(generator: np.random.Generator) -> nav.Human:
    """Draw people until one may be there."""
    while True:
        draw = generator.random(6).tolist()
        entry, aim = _border_point(draw[0]), _inner_point(draw[1], draw[2])
        speed = SLOWEST + (FASTEST - SLOWEST) * draw[3]
        way = math.dist(entry, aim)
        velocity = (speed * (aim[0] - entry[0]) / way, speed * (aim[1] - entry[1]) / way)
        delay = LATEST_ENTRY * draw[4]
        start = (entry[0] - delay * velocity[0], entry[1] - delay * velocity[1])
        stops = draw[5] < STOPPING_SHARE
        if math.dist(start, START) <= CRITICAL_RADIUS:
            continue
        if stops and min(math.dist(aim, START), math.dist(aim, GOAL)) <= ACTIVE_RADIUS:
            continue
        return nav.Human(
            start=start,
            velocity=velocity,
            stop=aim if stops else None,
            critical_radius=CRITICAL_RADIUS,
            active_radius=ACTIVE_RADIUS,
        )


def _border_point(share: float) -> tuple[float, float]:
    """Return the point at a share of the way around the square."""
    edge, along = divmod(4.0 * share, 1.0)
    offset = SIDE * along
    corners = ((offset, 0.0), (SIDE, offset), (SIDE - offset, SIDE), (0.0, SIDE - offset))
    return corners[int(edge)]


def _inner_point(share_x: float, share_y: float) -> tuple[float, float]:
    inner = SIDE - 2.0 * INNER_MARGIN
    return (INNER_MARGIN + inner * share_x, INNER_MARGIN + inner * share_y)
