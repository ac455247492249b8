"""Random obstacles that cross the straight way of a robot."""

from __future__ import annotations

import math

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import checked_seed, count, instance
from hrsafety._bounds import MOST_OBSTACLES
from hrsafety.navigation.run_arguments import Seeds
from hrsafety.navigation.scenario_arrays import Scenarios
from hrsafety.scenarios.drawn import seeds_of

__all__ = ["random_traffic", "random_traffic_batch"]

WAY = 10.0
"""Distance from start to goal, in m."""
MIDDLE = (2.0, 8.0)
"""Part of the way that is crossed, in m from the start."""
RADIUS = 0.3
"""Radius of the obstacles in m."""
SLOWEST, FASTEST = 0.3, 1.0
"""Speeds of the obstacles in m/s."""
SPREAD = 4.0
"""Most by which an obstacle crosses earlier or later than the robot would be there, in s."""
SHALLOWEST = math.radians(20.0)
"""Least angle between the way of an obstacle and that of the robot, in rad."""
TIME_LIMIT = 60.0
"""In s; also the time that the robot may rest."""


def random_traffic(obstacles: int, *, seed: int, robot: nav.HolonomicRobot | None = None) -> nav.Scenario:
    """Return a robot that goes 10 m straight on while discs cross the middle 6 m of its way.

    The robot goes from (0, 0) to (10, 0). Each obstacle is a disc of 0.3 m that moves straight
    on for ever, at a speed uniform from 0.3 to 1.0 m/s, over a point of the way that is uniform
    from 2 to 8 m, on a course uniform over all directions that differ by at least 20 degrees
    from the way, at an instant uniform within 4 s of the one at which a robot at full speed
    would be there. Drawn again are obstacles that start so near to the robot that it is inside
    their critical region. No person gives way; the regions are the computed ones.

    The robot may rest as long as the time limit: waiting is not giving up.

    Parameters
    ----------
    obstacles : int
        How many obstacles, from 0 to 10,000.
    seed : int
        Seed of the draw and of the scenario, 0 <= seed < 2**64. Obstacle k is the same in any
        traffic of the same seed with more than k obstacles.
    robot : HolonomicRobot or None
        The robot; the default one when ``None``.

    Returns
    -------
    Scenario
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If obstacles or seed is not an integer in its range, or robot is not a HolonomicRobot.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> traffic = scenarios.random_traffic(3, seed=1)
    >>> len(traffic.obstacles), traffic == scenarios.random_traffic(3, seed=1)
    (3, True)
    """
    count("obstacles", obstacles, least=0, most=MOST_OBSTACLES)
    checked = checked_seed("seed", seed)
    robot = instance("robot", nav.HolonomicRobot() if robot is None else robot, nav.HolonomicRobot)
    generator = np.random.Generator(np.random.PCG64(checked))
    return nav.Scenario(
        start=(0.0, 0.0),
        goal=(WAY, 0.0),
        obstacles=tuple(_crossing(generator, robot) for _ in range(obstacles)),
        robot=robot,
        time_limit=TIME_LIMIT,
        rest_time=TIME_LIMIT,
        seed=checked,
    )


def random_traffic_batch(seeds: Seeds, *, obstacles: int = 3, robot: nav.HolonomicRobot | None = None) -> Scenarios:
    """Return `random_traffic` of many seeds, drawn in one call.

    Parameters
    ----------
    seeds : int or iterable of int
        Seeds, or their number: then 0, 1, 2 and so on.
    obstacles : int
        How many obstacles each has, from 0 to 10,000.
    robot : HolonomicRobot or None
        The robot; the default one when ``None``.

    Returns
    -------
    Scenarios
        Row i has the bits of ``random_traffic(obstacles, seed=seeds[i])``.

    Raises
    ------
    InvalidParameterError
        As `random_traffic`, or if there are more than ten million scenarios and obstacles together.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> drawn = scenarios.random_traffic_batch(100, obstacles=5)
    >>> len(drawn), drawn[7] == scenarios.random_traffic(5, seed=7)
    (100, True)
    """
    count("obstacles", obstacles, least=0, most=MOST_OBSTACLES)
    drawn = seeds_of(seeds, obstacles)
    robot = instance("robot", nav.HolonomicRobot() if robot is None else robot, nav.HolonomicRobot)
    again = random_traffic_batch, {"seeds": drawn, "obstacles": obstacles, "robot": robot}
    return Scenarios._drawn(
        "random_traffic",
        obstacles,
        robot,
        drawn,
        again,
        lambda row: random_traffic(obstacles, seed=drawn[row], robot=robot),
    )


def _crossing(generator: np.random.Generator, robot: nav.HolonomicRobot) -> nav.MovingDisc:
    """Draw obstacles until one may be there."""
    while True:
        draw = generator.random(4).tolist()
        place = MIDDLE[0] + (MIDDLE[1] - MIDDLE[0]) * draw[0]
        course = _course(draw[1])
        speed = SLOWEST + (FASTEST - SLOWEST) * draw[2]
        velocity = (speed * math.cos(course), speed * math.sin(course))
        when = place / robot.max_speed + SPREAD * (2.0 * draw[3] - 1.0)
        start = (place - when * velocity[0], -when * velocity[1])
        obstacle = nav.MovingDisc(center=start, velocity=velocity, radius=RADIUS)
        critical, _ = nav.region_radii(robot, obstacle)
        if math.hypot(*start) > critical:
            return obstacle


def _course(share: float) -> float:
    """Return a direction that is not nearly along the way, either way round."""
    span = math.pi - 2.0 * SHALLOWEST
    side, along = divmod(2.0 * share, 1.0)
    return SHALLOWEST + along * span + math.pi * side
