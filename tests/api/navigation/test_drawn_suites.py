"""Episodes of S4, S5 and crowds are those of their protocols, and the same whichever are drawn with them."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import benchmark, entry
from hrsafety.benchmarks.protocol import Case
from hrsafety.benchmarks.suites import SUITES


def case_of(word: str, cases: list[int], seed: int) -> Case:
    return Case(cases=cases, entry=entry(word), person_speed=1.0, data=None, seed=seed, threads=1)


def by_protocol(discs: int, seed: int, index: int) -> nav.Scenario:
    generator, shape = np.random.default_rng(seed), (2000, discs)
    x, y = generator.uniform(2.0, 9.0, shape), generator.uniform(-3.0, 3.0, shape)
    speed, course = generator.uniform(0.0, 1.0, shape), generator.uniform(-np.pi, np.pi, shape)
    return nav.Scenario(
        start=(0.0, 0.0),
        goal=(10.0, 0.0),
        obstacles=[
            nav.MovingDisc(
                center=(x[index, k], y[index, k]),
                velocity=(
                    speed[index, k] * np.cos(course)[index, k],
                    speed[index, k] * np.sin(course)[index, k],
                ),
                radius=0.3,
            )
            for k in range(discs)
        ],
        robot=nav.HolonomicRobot(radius=0.3, max_speed=1.5, max_acceleration=10.0),
        control_period=0.1,
        time_limit=15.0,
        rest_time=15.0,
        arrival_tolerance=0.3,
    )


@pytest.mark.parametrize(("suite", "discs"), [("s4", 3), ("s5", 12)])
def test_discs_drift_as_the_protocol_has_them(suite: str, discs: int) -> None:
    scene = SUITES[suite].scene
    assert scene is not None
    for seed, index in ((1, 0), (1, 1999), (3, 712)):
        drawn, _ = scene(case_of("field+shield", [index], seed), index)
        assert drawn == by_protocol(discs, seed, index)


def test_a_law_alone_has_the_slower_robot_and_the_reciprocal_law_its_horizon() -> None:
    scene = SUITES["s5"].scene
    assert scene is not None
    drawn, law = scene(case_of("orca", [4], 1), 4)
    assert drawn.robot.max_speed == 1.0
    assert law == nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.0)


def test_crowds_are_those_of_their_seeds() -> None:
    scene = SUITES["crowd"].scene
    assert scene is not None
    drawn, _ = scene(case_of("field", [7], 5000), 7)
    assert drawn == scenarios.random_traffic(12, seed=5007)


@pytest.mark.parametrize("suite", ["s4", "s5", "crowd"])
def test_an_episode_is_the_same_alone_and_among_others(suite: str) -> None:
    name = "field+shield+yielding"
    rows = benchmark(suite, [name], cases=60, person_speed=1.0).rows[name]
    scene = SUITES[suite].scene
    assert scene is not None
    for index in (0, 49, 50, 59):
        place, law = scene(case_of(name, [index], SUITES[suite].seed), index)
        run = nav.simulate(place, law, stop_on_contact=True)
        assert rows[index].case == index
        assert (rows[index].outcome, rows[index].arrival_time) == (str(run.outcome), run.arrival_time)
        assert rows[index].clearance == run.min_clearance.min()
