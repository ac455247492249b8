"""An adversary walks into the moving robot: it must fail where the regions are sized for the sensing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hrsafety import navigation as nav

LAW = nav.VirtualForceField()
ROBOT = nav.HolonomicRobot()
SPEED = 1.6
PERSON = nav.Human(start=(0.0, 0.0), velocity=(SPEED, 0.0), max_speed=SPEED)

DRAWN, KEPT, ROUNDS = 1000, 20, 4
SPREAD = np.array([0.3, 0.3, 0.2])  # of a refinement: place in m, course in rad, time in s

SENSING = {
    "exact": None,
    "late": nav.Measurement(scale=0.0, latency=0.1),
    "noisy": nav.Measurement(),
    "late and noisy": nav.Measurement(latency=0.1),
}


def person(walk: NDArray[np.float64], radii: nav.Regions) -> nav.Human | None:
    """A person who crosses the way at a place, on a course, earlier or later than the robot."""
    place, course, offset = walk.tolist()
    velocity = (SPEED * np.cos(course), SPEED * np.sin(course))
    when = place / ROBOT.max_speed + offset
    start = (place - when * velocity[0], -when * velocity[1])
    if np.hypot(*start) < 1.5:
        return None
    return nav.Human(start=start, velocity=velocity, max_speed=SPEED, **radii._asdict())


def episode(
    walks: NDArray[np.float64], sized_for: nav.Measurement | None, sensing: nav.Measurement | None, seed: int
) -> nav.Scenario | None:
    """People who cross the way together, if nobody of them is near the robot at the start."""
    radii = nav.region_radii(ROBOT, PERSON, measurement=sized_for)
    people = [person(walk, radii) for walk in walks]
    if None in people:
        return None
    return nav.Scenario(
        start=(0, 0),
        goal=(6, 0),
        obstacles=tuple(filter(None, people)),
        measurement=sensing,
        seed=seed,
        time_limit=15.0,
    )


def attacks(
    sized_for: nav.Measurement | None, sensing: nav.Measurement | None, seed: int, people: int = 1
) -> tuple[int, int]:
    """Return how many of how many walks touch the moving robot: drawn at first, then near the closest ones."""
    generator = np.random.default_rng(seed)
    low, high = (0.5, 0.0, -1.5), (5.5, 2 * np.pi, 1.5)
    walks = generator.uniform(low, high, (DRAWN, people, 3))
    touched = tried = 0
    for refinement in range(ROUNDS + 1):
        built = [(walk, episode(walk, sized_for, sensing, seed)) for seed, walk in enumerate(walks)]
        there = [(walk, scene) for walk, scene in built if scene is not None]
        table = nav.simulate_batch([scene for _, scene in there], LAW, stop_on_contact=True)
        hit = table.contacts_moving > 0
        touched, tried = touched + int(hit.sum()), tried + len(there)
        best = np.argsort(table.min_clearance - hit, kind="stable")[:KEPT]
        near = np.array([there[row][0] for row in best])
        walks = np.concatenate([near + 0.6**refinement * SPREAD * generator.normal(size=near.shape) for _ in range(10)])
    return touched, tried


@pytest.mark.parametrize("sensing", SENSING)
@pytest.mark.parametrize("seed", [1, 2])
def test_nobody_touches_the_moving_robot_where_regions_are_sized_for_the_sensing(sensing: str, seed: int) -> None:
    touched, tried = attacks(SENSING[sensing], SENSING[sensing], seed)
    assert tried > 1500
    assert touched == 0


@pytest.mark.parametrize("sensing", SENSING)
def test_three_people_together_do_not_either(sensing: str) -> None:
    touched, tried = attacks(SENSING[sensing], SENSING[sensing], seed=3, people=3)
    assert tried > 900
    assert touched == 0


@pytest.mark.parametrize("people", [1, 3])
@pytest.mark.parametrize("sensing", ["late", "late and noisy"])
def test_the_same_adversary_touches_it_where_they_are_sized_without_latency(sensing: str, people: int) -> None:
    touched, tried = attacks(None, SENSING[sensing], seed=1, people=people)
    assert touched > 0.1 * tried
