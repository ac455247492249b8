"""Late measurements: every way to run a robot sees the positions of some time ago."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError

LAW = nav.VirtualForceField()
REGIONS = {"critical_radius": 0.8, "active_radius": 2.1}


def scene(obstacle: nav.Obstacle, **fields: object) -> nav.Scenario:
    return nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=(obstacle,), **fields)  # type: ignore[arg-type]  # by name


@pytest.mark.parametrize("latency", [0.06, 0.1, 0.137])
def test_a_late_view_of_a_person_is_that_of_one_who_is_farther_behind(latency: float) -> None:
    late = nav.Measurement(scale=0.0, latency=latency)
    person = nav.Human(start=(0.6, 0.75), velocity=(1.0, 0.1), **REGIONS)
    behind = replace(person, start=(0.6 - latency, 0.75 - 0.1 * latency))
    seen, same = nav.simulate(scene(person, measurement=late), LAW), nav.simulate(scene(behind), LAW)
    assert seen.position.shape == same.position.shape
    assert np.abs(seen.position - same.position).max() < 1e-9
    exact = nav.simulate(scene(person), LAW)
    rows = min(len(exact.time), len(seen.time))
    assert np.abs(seen.position[:rows] - exact.position[:rows]).max() > 1e-3


def test_before_the_start_an_accelerating_person_moves_on_the_parabola() -> None:
    late = nav.Measurement(scale=0.0, latency=0.5)
    quick = nav.Human.from_segments((2.3, 2.0), [(9.0, (0.0, 0.0), (0.0, -2.0))], **REGIONS)
    seen = nav.simulate(scene(quick, measurement=late), LAW)
    # 0.5 s before the start it was at y = 2.0 - 0.25: within 2.1 m of the robot, which feels it at once.
    assert seen.force[0][1] < -1e-6


@pytest.mark.parametrize("begin", [0.0, -0.2])
def test_a_recording_that_has_begun_at_the_start_is_seen_from_the_start(begin: float) -> None:
    late = nav.Measurement(scale=0.0, latency=0.5)
    path = [begin, 9.0], [[2.3, 1.75], [2.3, 1.75]]
    seen = nav.simulate(scene(nav.Human.from_path(*path, **REGIONS), measurement=late), LAW)
    stands = nav.Human(start=(2.3, 1.75), velocity=(0.0, 0.0), **REGIONS)
    exact = nav.simulate(scene(stands), LAW)
    assert seen.force[0][1] < -1e-6
    rows = seen.time < 0.4
    assert np.abs(seen.position[rows] - exact.position[: rows.sum()]).max() < 1e-9


def test_a_recording_that_begins_later_is_seen_late() -> None:
    late = nav.Measurement(scale=0.0, latency=0.5)
    recorded = nav.Human.from_path([0.3, 9.0], [[2.3, 1.75], [2.3, 1.75]], **REGIONS)
    unseen = nav.simulate(scene(recorded, measurement=late), LAW)
    assert np.abs(unseen.force[unseen.time < 0.77][:, 1]).max() < 1e-9
    assert np.abs(unseen.force[unseen.time < 0.9][:, 1]).max() > 1e-6


@pytest.mark.parametrize("latency", [0.06, 0.035, 0.25])
def test_a_robot_that_measures_itself_late_acts_on_where_it_was(latency: float) -> None:
    disc = nav.Disc(center=(2.45, 0.595), radius=0.1, active_radius=0.8, critical_radius=0.4)
    late = scene(disc, measurement=nav.Measurement(scale=0.0, of="robot", latency=latency))
    run = nav.simulate(late, LAW)
    free = replace(late, measurement=None)

    def where(time: float) -> np.ndarray:
        return np.array([np.interp(time, run.time, run.position[:, axis]) for axis in (0, 1)])

    for sample in (1, 5, 20, 60):
        time = sample * late.control_period
        place = where(max(time - latency, 0.0))
        before = where(max(time - late.control_period - latency, 0.0))
        velocity = (place - before) / late.control_period
        force = nav.force_terms(LAW, free, position=place, velocity=velocity, time=time).total
        assert run.force[round(time / 0.01)] == pytest.approx(force, abs=1e-7)


@pytest.mark.parametrize("of", ["obstacles", "robot", "both"])
def test_every_way_to_run_a_robot_is_late_alike(of: str) -> None:
    measured = nav.Measurement(scale=0.01, of=of, latency=0.085)  # type: ignore[arg-type]  # words of a list
    place = replace(scenarios.configuration("c4"), measurement=measured, seed=5)
    run = nav.simulate(place, LAW)
    one, two = (nav.simulate_batch([place] * 9, LAW, threads=threads) for threads in (1, 2))
    assert (one.min_distance == run.min_distance).all()
    assert (one.min_distance == two.min_distance).all()
    assert (one.energy == two.energy).all()
    gains = nav.simulate_batch([place], LAW, {"attractive_gain": [LAW.attractive_gain] * 17})
    assert (gains.path_length == one.path_length[0]).all()
    assert nav.evaluate(place, LAW).trajectory.position.tolist() == run.position.tolist()
    assert nav.compare(place, LAW).min_clearance[0, 0] == run.min_clearance.min()
    built = nav.simulate(place, LAW, built=nav.robots.AsBuilt())
    assert built.position.tolist() == run.position.tolist()
    again = nav.simulate_many(place, LAW, seeds=[5], paths=True)
    assert again.path_length[0] == built.path_length
    prompt = nav.simulate(replace(place, measurement=replace(measured, latency=0.0)), LAW)
    assert prompt.path_length != run.path_length


def test_two_wheels_take_a_late_fix_too() -> None:
    place = replace(
        scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot(), measurement=nav.Measurement(of="both")
    )
    late = replace(place, measurement=nav.Measurement(of="both", latency=0.1))
    assert nav.simulate(place, LAW).path_length != nav.simulate(late, LAW).path_length


def test_regions_grow_by_what_late_and_noisy_sensing_hides() -> None:
    robot, person = nav.HolonomicRobot(), nav.Human(start=(0, 0), velocity=(1, 0), max_speed=1.6)
    wall = nav.Rectangle(center=(0, 0), length=1.4, width=0.6)
    exact = nav.region_radii(robot, person)
    noise = 0.025 * np.sqrt(2.0)
    for measured, body, slack in (
        (nav.Measurement(latency=0.1), person, 0.16 + noise),
        (nav.Measurement(latency=0.1, of="both"), person, 0.23 + 2 * noise),
        (nav.Measurement(scale=0.003, distribution="gaussian"), person, 0.024),
        (nav.Measurement(latency=0.1), wall, 0.0),
        (nav.Measurement(latency=0.1, of="robot"), wall, 0.07 + noise),
    ):
        grown = nav.region_radii(robot, body, measurement=measured).critical_radius
        assert grown == pytest.approx(nav.region_radii(robot, body).critical_radius + slack, abs=1e-12)
    told = nav.region_radii(robot, person, latency=0.1, position_error=0.05)
    assert told.critical_radius == pytest.approx(exact.critical_radius + 0.21)
    assert told.active_radius == pytest.approx(exact.active_radius + 0.21 * (2.3 / 0.7 + 1.0))
    over = nav.region_radii(robot, person, latency=0.0, measurement=nav.Measurement(latency=0.1, scale=0.0))
    assert over == exact


def test_a_scenario_sizes_its_regions_for_its_own_measurement_and_anew_when_that_is_replaced() -> None:
    person = nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0), max_speed=1.6)
    measured = nav.Measurement(latency=0.1)
    exact = scene(person)
    late = replace(exact, measurement=measured)
    assert late == scene(person, measurement=measured)
    assert late.obstacles[0].critical_radius == pytest.approx(exact.obstacles[0].critical_radius + 0.1954, abs=1e-4)
    assert replace(late, measurement=None) == exact
    assert late.obstacles[0].as_given() == person
    assert replace(pickle.loads(pickle.dumps(late)), measurement=None) == exact
    given = scene(nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0), **REGIONS))
    assert replace(given, measurement=measured).obstacles == given.obstacles


def test_a_scenario_file_says_how_late(tmp_path: Path) -> None:
    file = tmp_path / "late.toml"
    file.write_text("start = [4, 0]\ngoal = [0, 0]\n[measurement]\nscale = 0.01\nlatency = 0.1\n")
    assert scenarios.load(file).scenario.measurement == nav.Measurement(scale=0.01, latency=0.1)


def test_a_latency_in_milliseconds_is_refused() -> None:
    with pytest.raises(InvalidParameterError, match=r"latency must be at most 60 s, got 100\.0; give seconds"):
        nav.Measurement(latency=100.0)


@pytest.mark.parametrize("of", ["obstacles", "both"])
@pytest.mark.parametrize("settings", [{}, {"built": nav.robots.AsBuilt()}, {"sensors": [nav.Lidar()]}], ids=str)
def test_people_of_a_world_are_seen_where_they_were(settings: dict[str, Any], of: str) -> None:
    walker = nav.Person(start=(6.0, 3.0), route=[(-9.0, 3.0)], velocity=(-1.2, 0.0), desired_speed=1.2, awareness=0.0)
    late = nav.Measurement(scale=1e-9, latency=0.23, of=of)
    robot = nav.Robot(start=(0.0, 0.0), goal=(5.0, 0.0), measurement=late, **settings)
    run = nav.Run(nav.World(people=[walker], robots=[robot], time_limit=30.0), nav.VirtualForceField())
    while run.time < 1.99:
        seen = run.step()
    place = 6.0 - 1.2 * (run.time - 0.23)
    assert seen.obstacle_position[0] == pytest.approx([place, 3.0], abs=1e-6)
    assert seen.obstacle_velocity[0] == pytest.approx([-1.2, 0.0], abs=1e-5)
