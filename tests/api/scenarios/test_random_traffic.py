"""Random traffic: what is said of the draw holds, for many seeds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from api.spoiled import names
from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav

ROBOT = nav.HolonomicRobot()
CROWDS = [scenarios.random_traffic(12, seed=seed) for seed in range(500)]
DISCS = [disc for crowd in CROWDS for disc in crowd.obstacles if isinstance(disc, nav.MovingDisc)]
CENTER = np.array([disc.center for disc in DISCS])
VELOCITY = np.array([disc.velocity for disc in DISCS])
SPEED = np.hypot(*VELOCITY.T)
COURSE = np.arctan2(VELOCITY[:, 1], VELOCITY[:, 0])
CROSSING_TIME = -CENTER[:, 1] / VELOCITY[:, 1]
CROSSED = CENTER[:, 0] + CROSSING_TIME * VELOCITY[:, 0]


def test_way_is_ten_meters_with_time_to_wait() -> None:
    assert len(DISCS) == 12 * len(CROWDS)
    for crowd in CROWDS:
        assert (crowd.start, crowd.goal) == ((0.0, 0.0), (10.0, 0.0))
        assert crowd.rest_time == crowd.time_limit == 60.0
        assert crowd.robot == ROBOT
        assert crowd.measurement is None
    assert [crowd.seed for crowd in CROWDS] == list(range(len(CROWDS)))


def test_obstacles_are_as_documented() -> None:
    assert {disc.radius for disc in DISCS} == {0.3}
    assert {disc.acceleration for disc in DISCS} == {(0.0, 0.0)}
    assert {disc.stop for disc in DISCS} == {None}
    assert SPEED.min() >= 0.3 - 1e-12
    assert SPEED.max() <= 1.0 + 1e-12
    assert CROSSED.min() >= 2.0 - 1e-9
    assert CROSSED.max() <= 8.0 + 1e-9
    least = math.radians(20.0) - 1e-12
    assert (np.abs(np.sin(COURSE)) >= math.sin(least)).all()
    assert (np.abs(CROSSING_TIME - CROSSED / ROBOT.max_speed) <= 4.0 + 1e-9).all()


def test_nobody_starts_with_the_robot_in_a_critical_region() -> None:
    for disc, center in zip(DISCS, CENTER, strict=True):
        assert disc.critical_radius is not None
        assert np.hypot(*center) > disc.critical_radius
    for disc in DISCS[:50]:
        bare = nav.MovingDisc(center=disc.center, velocity=disc.velocity, radius=disc.radius)
        assert (disc.critical_radius, disc.active_radius) == tuple(nav.region_radii(ROBOT, bare))


def test_draws_are_uniform_where_none_is_drawn_again() -> None:
    # Only crossings early and near to the start are drawn again.
    kept = CROSSED > 4.5
    assert kept.sum() > 3000
    for values, low, high in (
        (SPEED[kept], 0.3, 1.0),
        (CROSSED[kept], 4.5, 8.0),
        (CROSSING_TIME[kept] - CROSSED[kept] / ROBOT.max_speed, -4.0, 4.0),
    ):
        assert values.min() < low + 0.02 * (high - low)
        assert values.max() > high - 0.02 * (high - low)
        assert stats.kstest((values - low) / (high - low), "uniform").pvalue > 1e-3
    left, right = COURSE[kept & (COURSE > 0.0)], -COURSE[kept & (COURSE < 0.0)]
    assert len(left) == pytest.approx(len(right), rel=0.1)
    for values in (left, right):
        least = math.radians(20.0)
        assert stats.kstest((values - least) / (math.pi - 2.0 * least), "uniform").pvalue > 1e-3


def test_same_seed_is_the_same_traffic() -> None:
    for seed in (0, 1, 2**64 - 1):
        assert scenarios.random_traffic(5, seed=seed) == scenarios.random_traffic(5, seed=seed)
    assert len({crowd.obstacles for crowd in CROWDS}) == len(CROWDS)


def test_more_obstacles_come_after_the_ones_before() -> None:
    for seed in range(20):
        crowd = scenarios.random_traffic(12, seed=seed)
        for count in (0, 1, 3, 11):
            assert scenarios.random_traffic(count, seed=seed).obstacles == crowd.obstacles[:count]


def test_robot_sets_the_times_and_the_regions() -> None:
    robot = nav.HolonomicRobot(max_speed=1.4, radius=0.35)
    for seed in range(30):
        crowd = scenarios.random_traffic(6, seed=seed, robot=robot)
        assert crowd.robot == robot
        for disc in crowd.obstacles:
            assert isinstance(disc, nav.MovingDisc)
            time = -disc.center[1] / disc.velocity[1]
            place = disc.center[0] + time * disc.velocity[0]
            assert abs(time - place / 1.4) <= 4.0 + 1e-9
            assert disc.critical_radius == nav.region_radii(robot, disc).critical_radius


def test_straight_on_is_not_free() -> None:
    """Whoever does not look touches somebody: the traffic is worth avoiding."""
    blind = nav.OptimalReciprocalCollisionAvoidance(reach=1e-9, margin=0.0, turn=0.0)
    for count, least in ((3, 0.2), (12, 0.6)):
        crowds = [scenarios.random_traffic(count, seed=seed) for seed in range(200)]
        outcome = nav.simulate_batch(crowds, blind).outcome
        assert (outcome == "collided").mean() > least


@pytest.mark.parametrize(
    ("arguments", "argument"),
    [
        ({"obstacles": -1}, "obstacles"),
        ({"obstacles": 1.0}, "obstacles"),
        ({"obstacles": True}, "obstacles"),
        ({"obstacles": "3"}, "obstacles"),
        ({"obstacles": None}, "obstacles"),
        ({"seed": -1}, "seed"),
        ({"seed": 2**64}, "seed"),
        ({"seed": 1.0}, "seed"),
        ({"seed": None}, "seed"),
        ({"robot": 3}, "robot"),
        ({"robot": nav.DifferentialDriveRobot()}, "robot"),
    ],
)
def test_bad_argument_is_refused_by_name(arguments: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        scenarios.random_traffic(**({"obstacles": 3, "seed": 1} | arguments))
    assert names(caught.value) == argument
