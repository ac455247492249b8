"""Scenarios from arrays: rows are ordinary scenarios, and runs have their bits."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError, ShapeError

RNG = np.random.default_rng(5)
ROWS, MOST = 23, 4
POSITION = np.stack([RNG.uniform(2.0, 8.0, (ROWS, MOST)), RNG.uniform(-3.0, 3.0, (ROWS, MOST))], axis=-1)
POSITION[RNG.uniform(size=(ROWS, MOST)) < 0.3] = np.nan
VELOCITY = RNG.uniform(-0.7, 0.7, (ROWS, MOST, 2))
RADIUS = RNG.uniform(0.1, 0.4, (ROWS, MOST))
START = np.column_stack([np.zeros(ROWS), RNG.uniform(-0.5, 0.5, ROWS)])
GIVEN = {
    "start": START,
    "goal": (10.0, 0.0),
    "obstacle_position": POSITION,
    "obstacle_velocity": VELOCITY,
    "obstacle_radius": RADIUS,
    "seed": np.arange(ROWS),
    "control_period": 0.1,
    "time_limit": 15.0,
    "arrival_tolerance": 0.3,
}


def scenes(**changed: object) -> nav.Scenarios:
    return nav.Scenarios.from_arrays(**{**GIVEN, **changed})  # type: ignore[arg-type]  # by name


def one_by_one(kind: type, place: str) -> list[nav.Scenario]:
    found = []
    for row in range(ROWS):
        obstacles = [
            kind(**{place: tuple(at), "velocity": tuple(velocity), "radius": radius})
            for at, velocity, radius in zip(
                POSITION[row].tolist(), VELOCITY[row].tolist(), RADIUS[row].tolist(), strict=True
            )
            if not np.isnan(at[0])
        ]
        found.append(
            nav.Scenario(
                start=tuple(START[row].tolist()),
                goal=(10.0, 0.0),
                obstacles=obstacles,
                seed=row,
                control_period=0.1,
                time_limit=15.0,
                arrival_tolerance=0.3,
            )
        )
    return found


def assert_same_runs(one: nav.RunTable, other: nav.RunTable) -> None:
    first, second = one.columns(), other.columns()
    assert list(first) == list(second)
    for name, values in first.items():
        assert np.array_equal(values, second[name], equal_nan=values.dtype.kind == "f"), name


@pytest.mark.parametrize(("kind", "place"), [(nav.Human, "start"), (nav.MovingDisc, "center")])
def test_rows_are_ordinary_scenarios(kind: type, place: str) -> None:
    made, expected = scenes(person=kind is nav.Human), one_by_one(kind, place)
    assert list(made) == expected
    assert made[-1] == expected[-1]
    assert list(made[3:20:5]) == expected[3:20:5]
    assert list(made[::-1]) == expected[::-1]
    assert len({len(scene.obstacles) for scene in made}) > 1


@pytest.mark.parametrize(
    "law",
    [nav.VirtualForceField(), nav.Masoud(), nav.OptimalReciprocalCollisionAvoidance()],
    ids=lambda law: type(law).__name__,
)
def test_runs_have_the_bits_of_single_scenarios(law: nav.Law) -> None:
    made, expected = scenes(), one_by_one(nav.Human, "start")
    runs = nav.simulate_many(made, law)
    assert_same_runs(runs, nav.simulate_many(expected, law))
    assert_same_runs(nav.simulate_batch(made, law), nav.simulate_batch(expected, law, lanes=1))
    for row in (0, 7, ROWS - 1):
        single = nav.evaluate(expected[row], law)
        assert runs.energy[row] == single.trajectory.energy
        assert runs.performance_total[row] == single.total
    assert_same_runs(nav.simulate_many(made, law, seeds=2), nav.simulate_many(expected, law, seeds=2))


def test_paths_comparisons_and_searches_take_them() -> None:
    made, expected = scenes()[:5], one_by_one(nav.Human, "start")[:5]
    law = nav.VirtualForceField()
    paths = nav.simulate_many(made, law, paths=True)
    assert_same_runs(paths, nav.simulate_many(expected, law, paths=True))
    laws = {"field": law, "Masoud": nav.Masoud()}
    assert_same_runs(nav.compare(made, laws).runs, nav.compare(expected, laws).runs)
    options = {"grid": (2, 2, 2, 2), "refinements": 0, "local_starts": 0, "survivors": 2}
    found = [nav.optimize_gains(each, **options) for each in (made, expected)]  # type: ignore[arg-type]  # by name
    assert found[0].best_value == found[1].best_value
    table = nav.simulate_many(made, law)
    assert table.scenario.tolist() == ["0", "1", "2", "3", "4"]
    assert len(table.select(scenario="3")) == 1
    assert table.warnings == nav.simulate_many(expected, law).warnings


def test_copies_are_the_same() -> None:
    made = scenes()
    for again in (pickle.loads(pickle.dumps(made)), copy.copy(made)):
        assert list(again) == list(made)
    part = pickle.loads(pickle.dumps(made[4:9]))
    assert list(part) == list(made)[4:9]
    assert repr(made) == "Scenarios(23 rows)"


@pytest.mark.parametrize("obstacles", [0, 3, 12])
def test_drawn_traffic_has_the_bits_of_single_scenes(obstacles: int) -> None:
    seeds = [*range(60), 2**32 - 1, 2**32, 2**63 + 11, 2**64 - 1]
    drawn = scenarios.random_traffic_batch(seeds, obstacles=obstacles)
    singles = [scenarios.random_traffic(obstacles, seed=seed) for seed in seeds]
    assert list(drawn) == singles
    law = nav.VirtualForceField()
    assert_same_runs(nav.simulate_many(drawn, law, step=0.06), nav.simulate_many(singles, law, step=0.06))


def test_drawn_crowds_have_the_bits_of_single_crowds() -> None:
    singles = [scenarios.random_crowd(12, seed=seed) for seed in range(80)]
    drawn = scenarios.random_crowd_batch(80)
    assert list(drawn) == singles
    law = nav.Khatib()
    assert_same_runs(nav.simulate_many(drawn, law, step=0.06), nav.simulate_many(singles, law, step=0.06))
    assert list(pickle.loads(pickle.dumps(drawn[5:7]))) == singles[5:7]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"goal": np.where(np.arange(ROWS)[:, None] == 5, START, 9.0)}, r"scenarios\[5\]"),
        ({"obstacle_radius": np.where(np.arange(ROWS)[:, None] == 9, -1.0, RADIUS)}, r"scenarios\[9\].obstacles\[0\]"),
        ({"obstacle_velocity": np.full((ROWS, MOST, 2), np.inf)}, r"scenarios\[0\].obstacles\[0\].velocity"),
        ({"control_period": 0.0}, "control_period"),
        ({"seed": np.arange(ROWS) - 1}, "seed"),
        ({"seed": np.zeros(ROWS)}, "seed"),
        ({"robot": "robot"}, "robot"),
        ({"person": 1}, "person"),
        ({"obstacle_position": None}, "obstacle_velocity"),
    ],
)
def test_an_error_names_the_row(changed: dict[str, object], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        scenes(**changed)


@pytest.mark.parametrize(
    "changed",
    [
        {"start": np.zeros((ROWS + 1, 2))},
        {"start": np.zeros((ROWS, 3))},
        {"obstacle_position": POSITION[:, :, 0]},
        {"obstacle_velocity": VELOCITY[:, :2]},
        {"obstacle_radius": RADIUS[:, :1]},
        {"seed": np.arange(3)},
        {"start": (0.0, 0.0), "obstacle_position": None, "obstacle_velocity": None},
    ],
)
def test_arrays_that_do_not_fit_together_are_refused(changed: dict[str, object]) -> None:
    with pytest.raises(ShapeError):
        scenes(**changed)


def test_bounds_are_checked_before_memory_is_taken() -> None:
    wide = np.lib.stride_tricks.as_strided(np.zeros(2), (1000, 20_000, 2), (0, 0, 8))
    with pytest.raises(InvalidParameterError, match="together"):
        scenes(start=(0.0, 0.0), obstacle_position=wide, obstacle_velocity=None, obstacle_radius=0.4)
    with pytest.raises(InvalidParameterError, match="together"):
        scenarios.random_crowd_batch(100_000, people=1000)
    with pytest.raises(InvalidParameterError, match="row"):
        scenes(start=np.zeros((0, 2)), obstacle_position=None, obstacle_velocity=None)


def test_only_rows_that_may_have_warnings_are_looked_at() -> None:
    calm = scenes(obstacle_velocity=VELOCITY, person=True)
    assert [row for row, scene in enumerate(calm) if scene.warnings] == []
    assert calm.doubtful() == []
    fast = np.where(np.arange(ROWS)[:, None, None] == 6, 2.0, VELOCITY)
    still = np.where(np.arange(ROWS)[:, None, None] == 8, 0.0, fast)
    large = np.where(np.arange(ROWS)[:, None] == 10, 1.2, np.full((ROWS, MOST), 0.2))
    near = np.where(np.arange(ROWS)[:, None] == 12, 14.9, 10.0) * [1.0, 0.0]
    odd = scenes(obstacle_velocity=still, obstacle_radius=large, goal=np.where(near == 14.9, 19.0, near))
    found = {row for row, scene in enumerate(odd) if scene.warnings}
    assert {6, 10, 12} <= found <= set(odd.doubtful()) < set(range(ROWS))
    table = nav.simulate_many(odd, nav.VirtualForceField(), step=0.1)
    singles = nav.simulate_many(list(odd), nav.VirtualForceField(), step=0.1)
    assert table.warnings == singles.warnings
    assert odd[6:9].doubtful() == [0, 2]
