"""Virtual impedance as a navigation law: the force of the reactive part, with everything known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import reactive, scenarios

ROBOT = 0.2
DISC = nav.Disc(center=(2.0, 0.3), radius=0.1)
PERSON = nav.Human(start=(2.5, 1.5), velocity=(-0.8, -0.4))
WALL = nav.Rectangle(center=(1.0, -1.5), length=2.0, width=0.4)
SCENE = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.5), obstacles=[DISC, PERSON, WALL])
POSITION, VELOCITY = np.array([0.6, 0.1]), np.array([0.5, -0.2])
# Nearest points of the three from there, and their velocities.
NEAREST = [
    (np.array([2.0, 0.3]), 0.1, np.zeros(2)),
    (np.array([2.5, 1.5]), 0.4, np.array([-0.8, -0.4])),
    (np.array([0.6, -1.3]), 0.0, np.zeros(2)),
]


def expected(form: str, *, view: float = math.pi) -> np.ndarray:
    """Return the force by the law of the reactive part, term by term."""
    options = {"stiffness": 40.0, "damping": 10.0, "safe_distance": 0.8, "speed_limit": 0.72}
    law = reactive.VirtualImpedance(form=form, **options)
    force = 2.0 * (np.array(SCENE.goal) - POSITION) - 1.0 * VELOCITY
    for point, radius, moving in NEAREST:
        center = point - POSITION
        distance = float(np.linalg.norm(center))
        toward = center / distance
        if math.acos(np.clip(toward @ VELOCITY / np.linalg.norm(VELOCITY), -1.0, 1.0)) > view:
            continue
        gap = distance - radius - ROBOT
        closing = max(0.0, -float(toward @ (moving - VELOCITY)))
        push = law.spring_force(gap) + law.damping_force(gap, closing)
        force -= toward * float(push)
    return force


@pytest.mark.parametrize("form", ["active", "conventional"])
@pytest.mark.parametrize("view", [math.pi, 0.9])
def test_force_is_that_of_the_reactive_part(form: str, view: float) -> None:
    law = nav.VirtualImpedanceLaw(form=form, view=view)
    found = nav.laws.command(law, SCENE, position=tuple(POSITION), velocity=tuple(VELOCITY))
    np.testing.assert_allclose(found, expected(form, view=view), rtol=1e-12)


def test_narrow_view_misses_what_is_beside() -> None:
    assert not np.allclose(expected("active"), expected("active", view=0.9))


def test_obstacles_beyond_reach_do_not_push() -> None:
    near = nav.VirtualImpedanceLaw(reach=0.5)
    found = nav.laws.command(near, SCENE, position=tuple(POSITION), velocity=tuple(VELOCITY))
    np.testing.assert_allclose(found, 2.0 * (np.array(SCENE.goal) - POSITION) - VELOCITY, rtol=1e-12)


def test_batch_does_what_single_runs_do() -> None:
    scenes = [scenarios.random_traffic(3, seed=seed) for seed in range(6)]
    law = nav.VirtualImpedanceLaw(form="conventional")
    gains = np.array([law.gains, (4.0, 3.0, 60.0, 20.0, 1.0, 0.8)])
    table = nav.simulate_batch(scenes, law, gains, threads=2)
    for row, (index, scene) in enumerate((g, s) for g in range(2) for s in scenes):
        changed = law.replaced(**dict(zip(law.GAIN_NAMES, gains[index], strict=True)))
        single = nav.simulate(scene, changed)
        assert table.outcome[row] == single.outcome
        np.testing.assert_array_equal(table.arrival_time[row], single.arrival_time)


def test_comparisons_take_it_beside_other_laws() -> None:
    laws = {"impedance": nav.VirtualImpedanceLaw(form="conventional"), "field": nav.VirtualForceField()}
    places = {str(seed): scenarios.random_traffic(3, seed=seed) for seed in range(4)}
    result = nav.compare(places, laws)
    assert result.standing("impedance").success.runs == 4
