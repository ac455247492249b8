"""Odd but legal input has a documented outcome; extreme values never give a silent NaN."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
import pytest

from hrsafety import HrsafetyError
from hrsafety import navigation as nav

SCENE = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Disc(center=(2.45, 0.595), radius=0.1)])
LAW = nav.VirtualForceField()

HUGE = [
    (nav.HolonomicRobot, {"mass": 1e308}),
    (nav.HolonomicRobot, {"mass": 1e-308}),
    (nav.HolonomicRobot, {"max_speed": 1e308, "max_acceleration": 1e308}),
    (nav.HolonomicRobot, {"max_acceleration": 1e-300}),
    (nav.HolonomicRobot, {"wheel_radius": 1e-308}),
    (nav.VirtualForceField, {"attractive_gain": 1e308}),
    (nav.VirtualForceField, {"repulsive_gain": 1e308, "detour_gain": 1e308, "gain_ratio": 1e308}),
    (nav.Disc, {"center": (1e308, 1e308), "radius": 0.1}),
    (nav.Disc, {"center": (2.0, 0.6), "radius": 0.1, "active_radius": 1.0, "critical_radius": 0.0}),
    (nav.Human, {"start": (0.6, 0.6), "velocity": (1e308, 0.0)}),
    (nav.Human, {"start": (-1e308, 0.6), "velocity": (1e308, 1e308), "max_speed": 1e-300}),
    (nav.Rectangle, {"center": (2.0, 1e150), "length": 1e150, "width": 1e-300, "heading": 1e300}),
]


@pytest.mark.parametrize(("build", "fields"), HUGE)
def test_huge_value_gives_a_finite_run_or_an_error_of_the_package(build: Any, fields: dict[str, Any]) -> None:
    with contextlib.suppress(HrsafetyError):
        part = build(**fields)
        scene = nav.Scenario(
            start=(3.9, 0.6),
            goal=(0.0, 0.6),
            time_limit=5.0,
            robot=part if isinstance(part, nav.HolonomicRobot) else nav.HolonomicRobot(),
            obstacles=[part] if isinstance(part, nav.Obstacle) else SCENE.obstacles,
        )
        run = nav.simulate(scene, part if isinstance(part, nav.VirtualForceField) else LAW)
        assert np.isfinite(run.position).all()
        assert np.isfinite(run.velocity).all()


# Braking takes six steps to end in rest; their rounding stays far below this speed, in m/s.
AT_REST = 1e-12


def test_robot_that_starts_in_a_critical_region_stays_there() -> None:
    disc = nav.Disc(center=(3.5, 0.6), radius=0.1, active_radius=0.8, critical_radius=0.5)
    run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[disc]), LAW)
    assert run.outcome == "stopped"
    assert (run.position == [3.9, 0.6]).all()
    assert run.path_length == 0.0


def test_robot_brakes_for_a_person_who_appears_in_its_way() -> None:
    appears = 1.5
    person = nav.Human.from_path([appears, 9.0], [[2.15, 0.6], [2.15, 0.6]])
    scene = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[person])
    run = nav.simulate(scene, LAW)
    inside = (run.distance[:, 0] < scene.obstacles[0].critical_radius) & (run.time > appears + 0.2)
    assert inside.any()
    assert np.hypot(*run.velocity[inside].T)[:5].max() < AT_REST
    assert run.outcome == "stopped"
    assert run.min_clearance[0] > 0.0


def test_person_who_appears_on_top_of_the_robot_is_counted_apart() -> None:
    appears = 1.0
    person = nav.Human.from_path([appears, 2.0], [[3.4, 0.6], [3.4, 3.6]])
    run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[person]), LAW)
    assert (run.outcome, run.contacts_apart, run.contacts_at_fault) == ("arrived", 1, 0)
    assert np.isnan(run.contact_time[0])
    assert run.min_clearance[0] < 0.0
    assert np.isfinite(run.position).all()


def test_absent_person_has_no_distance() -> None:
    person = nav.Human.from_path([1e6, 1e6 + 1.0], [[3.4, 0.6], [3.4, 3.6]])
    run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[person]), LAW)
    assert run.outcome == "arrived"
    assert np.isnan(run.distance).all()
    assert np.isposinf(run.min_distance).all()


def test_recording_with_one_sample_is_legal() -> None:
    person = nav.Human.from_path([0.0], [[2.0, 2.0]])
    run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[person]), LAW)
    assert run.outcome == "arrived"


def test_moving_obstacle_may_cover_the_goal() -> None:
    person = nav.Human(start=(0.0, 0.6), velocity=(1.0, 0.0))
    run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[person]), nav.VirtualForceField())
    assert np.isfinite(run.position).all()
    assert np.isfinite(run.force).all()


def test_force_that_overflows_is_an_error_not_a_robot_at_rest() -> None:
    far = nav.Scenario(start=(0.0, 0.0), goal=(1e300, 0.0))
    with pytest.raises(nav.SimulationError, match="non-finite at 0 s"):
        nav.simulate(far, LAW)


def test_error_of_a_batch_names_the_row() -> None:
    scenes = [nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0)), nav.Scenario(start=(5.0, 0.0), goal=(0.0, 0.0))]
    sets = [LAW.gains, (1e308, 0.0, 0.0, 0.0)]
    for lanes in (1, 8):
        with pytest.raises(nav.SimulationError, match=r"\(run [23]\)"):
            nav.simulate_batch(scenes, LAW, sets, lanes=lanes)


def test_control_period_longer_than_the_run_is_one_sample() -> None:
    scene = nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), control_period=1e6, time_limit=20.0)
    table = nav.simulate_batch([scene], LAW)
    assert table.force_evaluations.tolist() == [1]
    assert table.outcome.tolist() == ["arrived"]
