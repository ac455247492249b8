"""Velocity obstacles touch nothing that keeps its velocity, whichever rule selects: ten thousand meetings of discs."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from hrsafety import navigation as nav

Array = npt.NDArray[np.float64]

CASES = 3_334
GOAL = (6.0, 0.0)
ROBOT = nav.HolonomicRobot()
PERIOD = 0.06
KEPT = 0.02
"""Distance in m by which a way is to miss all discs, well above what the robot moves while it speeds up."""

TOUCHED_STRAIGHT = 0.9
"""Share of the meetings in which a robot that drives straight touches something."""

ARRIVED = 0.98
"""Share of them in which the goal is reached: the rest is boxed in until the time is over."""


def meetings(source: np.random.Generator, count: int) -> tuple[Array, Array, Array]:
    """Return places, velocities and radii of one to five discs near the straight way about when the robot is there."""
    many = (count, 5)
    speed, course = source.uniform(0.0, 1.0, many), source.uniform(-np.pi, np.pi, many)
    velocity = np.stack([speed * np.cos(course), speed * np.sin(course)], axis=-1)
    time = source.uniform(1.0, 8.0, many)
    offset = source.uniform(-0.5, 0.5, (*many, 2))
    place = offset - velocity * time[..., None]
    place[..., 0] += ROBOT.max_speed * time
    place[np.arange(5) >= source.integers(1, 6, count)[:, None]] = np.nan
    return place, velocity, source.uniform(0.1, 0.5, many)


def least_distance(place: Array, velocity: Array, radius: Array, driven: Array) -> Array:
    """Return the least distance in m to any disc, ever, of a robot that drives on at a velocity from the origin."""
    relative = velocity - driven
    square = np.maximum((relative**2).sum(axis=-1), 1e-12)
    soonest = np.maximum(-(place * relative).sum(axis=-1) / square, 0.0)
    passed = np.linalg.norm(place + relative * soonest[..., None], axis=-1) - radius - ROBOT.radius
    return np.nanmin(passed, axis=-1)


def has_a_way(place: Array, velocity: Array, radius: Array) -> npt.NDArray[np.bool_]:
    """Return where a velocity that a robot at rest can reach in a control period leads past all discs for ever."""
    found = np.zeros(len(place), dtype=bool)
    fastest = min(ROBOT.max_speed, ROBOT.max_acceleration * PERIOD)
    for speed in np.linspace(0.0, fastest, 4):
        for course in np.linspace(-np.pi, np.pi, 24, endpoint=False):
            driven = speed * np.array([np.cos(course), np.sin(course)])
            found |= least_distance(place, velocity, radius, driven) > KEPT
    return found


def scenes(seed: int) -> nav.Scenarios:
    """Return meetings in which there is a way at the start, with no disc at the goal for ever."""
    place, velocity, radius = meetings(np.random.default_rng(seed), 3 * CASES)
    apart = np.nanmin(np.linalg.norm(place, axis=-1) - radius, axis=-1) > ROBOT.radius
    chosen = np.flatnonzero(apart & has_a_way(place, velocity, radius))[:CASES]
    assert len(chosen) == CASES
    return nav.Scenarios.from_arrays(
        start=(0.0, 0.0),
        goal=GOAL,
        obstacle_position=place[chosen],
        obstacle_velocity=velocity[chosen],
        obstacle_radius=radius[chosen],
        person=False,
        control_period=PERIOD,
        time_limit=20.0,
    )


@pytest.mark.parametrize(
    ("seed", "law"),
    [
        (1, nav.VelocityObstacle(margin=0.01)),
        (2, nav.VelocityObstacle(margin=0.01, selection="fastest", sector=1.0)),
        (3, nav.VelocityObstacle(margin=0.01, selection="time_and_risk")),
    ],
)
def test_velocity_obstacles_touch_nothing_that_keeps_its_velocity(seed: int, law: nav.Law) -> None:
    meeting = scenes(seed)
    straight = nav.simulate_batch(meeting, nav.BorensteinKoren(attractive_gain=100.0, repulsive_gain=0.0))
    assert np.mean(straight.outcome == "collided") > TOUCHED_STRAIGHT
    table = nav.simulate_batch(meeting, law)
    assert not np.any(table.outcome == "collided")
    assert np.nanmin(table.min_clearance) > 0.0
    assert np.mean(table.outcome == "arrived") >= ARRIVED
