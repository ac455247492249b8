from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError

ROUNDING = 1e-9
"""Room for the rounding of positions of some metres."""


@pytest.mark.parametrize("name", scenarios.CONFIGURATIONS)
def test_every_configuration_can_be_run(name: str) -> None:
    run = nav.simulate(scenarios.configuration(name), nav.VirtualForceField(stabilizing="off"))
    assert run.outcome == "arrived"


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("c1", [nav.Disc]),
        ("c2", [nav.Human]),
        ("c3", [nav.Rectangle, nav.Disc]),
        ("c4", [nav.Human, nav.Rectangle, nav.Disc]),
        ("n1", [nav.Disc]),
        ("n2", [nav.Human]),
        ("n3", [nav.Rectangle, nav.Disc]),
        ("n4", [nav.Human, nav.Rectangle, nav.Disc]),
        ("parallel_human", [nav.Human]),
        ("unpredictable_human", [nav.Human]),
        ("multiple_obstacles", [nav.Human, nav.Disc, nav.MovingDisc]),
    ],
)
def test_obstacles_come_in_the_documented_order(name: str, kinds: list[type]) -> None:
    assert [type(obstacle) for obstacle in scenarios.configuration(name).obstacles] == kinds


REGIONS = {
    "c": {"Human": (0.8, 2.1), "Disc": (0.4, 0.8), "Rectangle": (0.4, 0.8)},
    "n": {"Human": (0.8, 2.5), "Disc": (0.4, 0.65), "Rectangle": (0.3, 0.55), "MovingDisc": (0.55, 1.35)},
}


@pytest.mark.parametrize("name", scenarios.CONFIGURATIONS)
def test_regions_are_those_of_the_source(name: str) -> None:
    chapter = "n" if name[0] == "n" or name == "multiple_obstacles" else "c"
    for obstacle in scenarios.configuration(name).obstacles:
        assert (obstacle.critical_radius, obstacle.active_radius) == REGIONS[chapter][type(obstacle).__name__]


@pytest.mark.parametrize(
    ("name", "x", "y"),
    [("c3", (1.6, 3.0), (-0.3, 0.3)), ("n3", (1.6, 3.0), (-0.1, 0.5)), ("n4", (1.6, 3.0), (-0.1, 0.5))],
)
def test_rectangles_lie_where_the_source_has_them(name: str, x: tuple[float, float], y: tuple[float, float]) -> None:
    (box,) = [o for o in scenarios.configuration(name).obstacles if isinstance(o, nav.Rectangle)]
    assert box.heading == 0.0
    sides = (
        box.center[0] - box.length / 2,
        box.center[0] + box.length / 2,
        box.center[1] - box.width / 2,
        box.center[1] + box.width / 2,
    )
    assert sides == pytest.approx((*x, *y), abs=ROUNDING)


@pytest.mark.parametrize(
    ("instant", "expected"),
    [
        (0.5, (1.1, 0.0)),
        (1.0, (1.6, 0.0)),
        (1.5, (1.975, 0.0)),
        (2.0, (2.1, 0.0)),
        (3.0, (2.1, 0.5)),
        (4.0, (2.1, 1.5)),
    ],
)
def test_the_unpredictable_human_brakes_and_walks_off_sideways(instant: float, expected: tuple[float, float]) -> None:
    run = nav.simulate(scenarios.configuration("unpredictable_human"), nav.VirtualForceField(stabilizing="off"))
    row = int(np.argmin(abs(run.time - instant)))
    assert run.time[row] == pytest.approx(instant, abs=ROUNDING)
    np.testing.assert_allclose(run.obstacle_position[row, 0], expected, atol=ROUNDING)


@pytest.mark.parametrize("name", ["c5", "C1", "", None, 1, ["c1"]])
def test_an_unknown_configuration_is_an_error_that_lists_the_names(name: object) -> None:
    with pytest.raises(InvalidParameterError, match=r"name must be one of c1, c2, .*multiple_obstacles"):
        scenarios.configuration(name)  # type: ignore[arg-type]  # bad on purpose


@pytest.mark.parametrize("people", [0, 1, 3, 12, 40])
def test_random_crowds_are_legal_for_any_seed(people: int) -> None:
    for seed in (*range(60), 2**32, 2**64 - 1):
        crowd = scenarios.random_crowd(people, seed=seed)
        assert len(crowd.obstacles) == people
        for person in crowd.obstacles:
            assert isinstance(person, nav.Human)
            assert math.dist(person.start, crowd.start) > 0.8
            assert 0.5 <= math.hypot(*person.velocity) <= 1.4 + ROUNDING
            x, y = person.start
            inside = 0.0 < x < 8.0 and 0.0 < y < 8.0
            on_border = min(abs(x), abs(x - 8.0), abs(y), abs(y - 8.0)) < ROUNDING
            assert not inside or on_border
            if person.stop is not None:
                assert math.dist(person.stop, crowd.goal) > 2.1


def test_random_crowds_are_the_same_for_the_same_seed() -> None:
    assert scenarios.random_crowd(8, seed=5) == scenarios.random_crowd(8, seed=5)
    assert scenarios.random_crowd(8, seed=5) != scenarios.random_crowd(8, seed=6)


def test_a_larger_crowd_holds_the_smaller_one() -> None:
    small, large = scenarios.random_crowd(3, seed=11), scenarios.random_crowd(12, seed=11)
    assert large.obstacles[:3] == small.obstacles


def test_most_people_of_a_crowd_walk_through_the_way_of_the_robot() -> None:
    crossing = stopping = 0
    for seed in range(40):
        for person in scenarios.random_crowd(10, seed=seed).obstacles:
            assert isinstance(person, nav.Human)
            rise = person.velocity[1]
            instant = (4.0 - person.start[1]) / rise if rise else math.inf
            place = person.start[0] + instant * person.velocity[0]
            crossing += instant > 0.0 and 0.0 < place < 8.0 and person.stop is None
            stopping += person.stop is not None
    assert crossing > 150
    assert 30 < stopping < 120


@pytest.mark.parametrize(
    ("people", "seed", "argument"),
    [(-1, 0, "people"), (1.5, 0, "people"), (True, 0, "people"), (3, -1, "seed"), (3, 2**64, "seed"), (3, "a", "seed")],
)
def test_bad_crowds_are_errors(people: object, seed: object, argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        scenarios.random_crowd(people, seed=seed)  # type: ignore[arg-type]  # bad on purpose
    assert caught.value.argument == argument


def test_radii_are_filled_in_when_the_obstacles_are_looked_at() -> None:
    person = nav.Human(start=(2.0, 1.0), velocity=(0.0, -0.5))
    wall = nav.Rectangle(center=(2.0, -3.0), length=1.0, width=0.4, critical_radius=0.5)
    given = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=[person, wall], control_period=0.1)
    for obstacle, original in zip(given.obstacles, (person, wall), strict=True):
        regions = nav.region_radii(given.robot, original, control_period=0.1)
        assert obstacle.active_radius == regions.active_radius
        assert obstacle.critical_radius == (original.critical_radius or regions.critical_radius)
        assert obstacle.as_given() is original
        # The native obstacle has them too: its own regions are the given ones.
        assert nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=[obstacle]).obstacles[0].as_given() == original
    assert given.obstacles is given.obstacles
    assert pickle.loads(pickle.dumps(given)) == given == replace(given)
    assert hash(given) == hash(replace(given))
