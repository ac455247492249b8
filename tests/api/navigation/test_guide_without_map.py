"""A guide without a map: it leads around those who stand, and costs nothing where nobody does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety.navigation import Guide, SafeNavigation, Shield, Yielding

FIELD = nav.VirtualForceField()
ROBOT = nav.HolonomicRobot(radius=0.3, max_speed=1.5)


def drifting(seed: int, *, slowest: float = 0.1) -> nav.Scenario:
    """Return twelve discs that drift across the way of the robot."""
    generator = np.random.default_rng(seed)
    places = np.column_stack([generator.uniform(2.0, 9.0, 12), generator.uniform(-3.0, 3.0, 12)])
    speeds, courses = generator.uniform(slowest, 1.0, 12), generator.uniform(-np.pi, np.pi, 12)
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
