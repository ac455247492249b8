"""A guide without a map leads around those who stand where the robot is stuck behind them, and else changes no bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark
from hrsafety.navigation import Guide, SafeNavigation, Shield, Yielding

FIELD = nav.VirtualForceField()
ROBOT = nav.HolonomicRobot(radius=0.3, max_speed=1.5)


def drifting(seed: int, *, slowest: float = 0.1, most: float = 1.0) -> nav.Scenario:
    """Return twelve discs that drift across the way of the robot."""
    generator = np.random.default_rng(seed)
    places = np.column_stack([generator.uniform(2.0, 9.0, 12), generator.uniform(-3.0, 3.0, 12)])
    speeds, courses = generator.uniform(slowest, most, 12), generator.uniform(-np.pi, np.pi, 12)
    people = [
        nav.MovingDisc(center=place, velocity=(speed * np.cos(course), speed * np.sin(course)), radius=0.3)
        for place, speed, course in zip(places.tolist(), speeds, courses, strict=True)
    ]
    rules = {"control_period": 0.1, "time_limit": 15.0, "arrival_tolerance": 0.3}
    return nav.Scenario(start=(0.0, 0.0), goal=(10.0, 0.0), obstacles=people, robot=ROBOT, **rules)


def run(scene: nav.Scenario, law: nav.Law, guide: Guide | None) -> nav.Trajectory:
    """Return the run of the law with shield, yielding and takeover, and perhaps a guide."""
    parts = {"shield": Shield(person_speed=1.0), "yielding": Yielding(), "preferred_speed": 1.0, "takeover": True}
    return nav.simulate(scene, SafeNavigation(law, guide=guide, **parts))


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([FIELD, nav.OptimalReciprocalCollisionAvoidance()]))
def test_without_a_map_a_guide_changes_no_bit_where_everybody_moves(seed: int, law: nav.Law) -> None:
    scene = drifting(seed)
    led, alone = run(scene, law, Guide()), run(scene, law, None)
    assert led.outcome == alone.outcome
    assert np.array_equal(led.position, alone.position)


LAWS = [FIELD, nav.OptimalReciprocalCollisionAvoidance(), nav.VelocityObstacle(), nav.Khatib()]


@settings(max_examples=16, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(LAWS))
def test_the_law_within_does_what_it_does_alone(seed: int, law: nav.Law) -> None:
    """Velocities above the limit, and forces above the largest acceleration, are limited by the robot alone."""
    scene = drifting(seed, most=ROBOT.max_speed)
    alone = nav.simulate(scene, law)
    for wrapped in (SafeNavigation(law), SafeNavigation(law, guide=Guide())):
        led = nav.simulate(scene, wrapped)
        assert led.outcome == alone.outcome
        assert np.array_equal(led.position, alone.position)
        assert np.array_equal(led.force, alone.force)


def test_a_limit_below_that_of_the_robot_holds() -> None:
    law = SafeNavigation(FIELD, guide=Guide(), preferred_speed=0.4)
    speeds = np.linalg.norm(nav.simulate(drifting(3), law).velocity, axis=1)
    assert 0.39 < speeds.max() <= 0.4 + 1e-9


def standing(seed: int, count: int = 12) -> nav.Scenario:
    """Return discs that stand about the straight way."""
    generator = np.random.default_rng(seed)
    places = np.column_stack([generator.uniform(2.0, 8.8, count), generator.uniform(-3.0, 3.0, count)])
    people = [nav.MovingDisc(center=place, velocity=(0.0, 0.0), radius=0.3) for place in places.tolist()]
    rules = {"control_period": 0.1, "time_limit": 60.0, "arrival_tolerance": 0.3, "rest_time": 60.0}
    return nav.Scenario(start=(0.0, 0.0), goal=(10.0, 0.0), obstacles=people, robot=ROBOT, **rules)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_law_that_gets_past_those_who_stand_is_left_alone(seed: int) -> None:
    """The velocity obstacle finds its way: a plan that stands in for the goal now and then led it nowhere."""
    scene = standing(seed)
    alone, led = (nav.simulate(scene, law) for law in (nav.VelocityObstacle(), guided(nav.VelocityObstacle())))
    if alone.outcome == "arrived":
        assert led.outcome == "arrived"


def guided(law: nav.Law) -> SafeNavigation:
    """Return the law with a guide and nothing else."""
    return SafeNavigation(law, guide=Guide())


def test_a_law_that_stops_behind_those_who_stand_gets_past_them() -> None:
    """ORCA ends in the way of those who stand beside each other."""
    orca = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.0)
    scenes = [standing(seed) for seed in range(40)]
    alone, led = ([nav.simulate(scene, law).outcome for scene in scenes] for law in (orca, guided(orca)))
    assert not any(mine == "arrived" != its for mine, its in zip(alone, led, strict=True))
    assert led.count("arrived") >= alone.count("arrived") + 5


def test_s5_loses_nothing_by_a_guide() -> None:
    """Cases that no table shows; a robot with a guide alone has the limits of the law."""
    laws = ["field", "field+guide", "field+shield", "field+shield+guide"]
    result = benchmark("s5", laws, cases=200, seed=77, person_speed=1.0, threads=1)
    won, lost = {}, {}
    for name, guided_name in (("field", "field+guide"), ("field+shield", "field+shield+guide")):
        pairs = [
            (mine.outcome == "arrived", its.outcome == "arrived")
            for mine, its in zip(result.rows[name], result.rows[guided_name], strict=True)
        ]
        won[name], lost[name] = pairs.count((False, True)), pairs.count((True, False))
    assert sum(lost.values()) <= sum(won.values()) + 1, (won, lost)
    assert max(lost.values()) <= 2, lost


def test_numbers_of_the_takeover_that_are_given_hold_without_a_map_too() -> None:
    scene = drifting(7)
    usual, given_ones = run(scene, FIELD, Guide()), run(scene, FIELD, Guide(takeover_progress=0.6, takeover_window=0.7))
    assert np.array_equal(usual.position, given_ones.position)
    other = run(scene, FIELD, Guide(takeover_progress=2.0, takeover_window=0.1))
    assert not np.array_equal(usual.position, other.position)
    assert (Guide().takeover_progress, Guide().takeover_window) == (None, None)


@pytest.mark.parametrize("parts", [{}, {"shield": Shield(person_speed=1.0)}])
def test_without_a_map_and_yielding_a_guide_takes_nothing_over(parts: dict[str, Shield]) -> None:
    """The takeover drives straight to the goal: nothing but a plan or yielding keeps it off people."""
    for seed in range(6):
        scene = drifting(seed)
        led, alone = (nav.simulate(scene, SafeNavigation(FIELD, guide=guide, **parts)) for guide in (Guide(), None))
        assert np.array_equal(led.position, alone.position)


def test_it_leads_around_a_row_of_people_who_stand() -> None:
    people = [nav.Human(start=(3.0, 0.5 * place), velocity=(0.0, 0.0), radius=0.3) for place in range(-3, 4)]
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=people, time_limit=60.0, rest_time=60.0)
    law = SafeNavigation(
        FIELD, guide=Guide(box=((-2, -4), (8, 4))), shield=Shield(person_speed=0.0), yielding=Yielding()
    )
    assert nav.simulate(scene, law).outcome == "arrived"


def test_it_leads_around_a_wall_that_stands() -> None:
    """A rectangle of the scene is a wall for shield and law; without a map the guide sees it as they do."""
    wall = nav.Rectangle(center=(3.0, 0.0), length=0.2, width=4.0)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[wall], time_limit=60.0, rest_time=60.0)
    parts = {"shield": Shield(person_speed=0.0), "yielding": Yielding()}
    alone, led = (
        nav.simulate(scene, SafeNavigation(FIELD, guide=guide, **parts)).outcome
        for guide in (None, Guide(box=((-2, -4), (8, 4))))
    )
    assert (alone, led) == ("timed_out", "arrived")


def test_it_leads_out_of_a_pocket_deeper_than_the_look_ahead() -> None:
    """The way back is led until the whole straight way is free, not only the part that is looked at."""
    sides = [(0.45 * place, side) for place in range(4, 14) for side in (-1.2, 1.2)]
    end = [(6.0, 0.5 * place - 1.25) for place in range(6)]
    people = [nav.Human(start=place, velocity=(0.0, 0.0), radius=0.3) for place in (*sides, *end)]
    scene = nav.Scenario(start=(0.0, 0.0), goal=(9.0, 0.0), obstacles=people, time_limit=120.0, rest_time=120.0)
    parts = {"shield": Shield(person_speed=0.0), "yielding": Yielding()}
    for guide, outcome in ((None, "timed_out"), (Guide(box=((-2, -4), (11, 4)), look_ahead=1.5), "arrived")):
        run = nav.simulate(scene, SafeNavigation(FIELD, guide=guide, **parts))
        assert run.outcome == outcome
        x, y = run.position.T
        assert x[(np.abs(y) < 0.6) & (x < 6.0)].max() > 4.4
