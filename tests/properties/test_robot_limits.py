"""No run exceeds a limit of its robot; limits that are ``None`` change no bit."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._arguments import Array
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation import SafeNavigation, Shield, Yielding
from hrsafety.navigation.laws.known import LAWS

STEP = 0.01
SLACK = 1.0 + 1e-9
LEAST = 1e-9
PARTS: dict[str, dict[str, Any]] = {
    "bare": {},
    "shield": {"shield": Shield(person_speed=1.0)},
    "shield, yielding": {"shield": Shield(person_speed=1.0), "yielding": Yielding()},
}
TRACKING = (
    nav.tracking.FullSpeedTracking(),
    nav.tracking.NonlinearTracking(),
    nav.tracking.ExponentialTracking(),
    nav.tracking.VirtualTorque(),
)
RATES = st.floats(0.3, 20.0)
SEEDS = st.integers(0, 2**31)


def within(law: nav.Law, parts: str) -> nav.Law:
    return SafeNavigation(law, **PARTS[parts]) if PARTS[parts] else law


def crowd(robot: nav.HolonomicRobot | nav.DifferentialDriveRobot, seed: int, **changes: object) -> nav.Scenario:
    scene = scenarios.random_traffic(6, seed=seed)
    return replace(scene, robot=robot, time_limit=8.0, **changes)  # type: ignore[arg-type]


def keeps(velocity: Array, robot: Any) -> None:
    """Assert the limits of a holonomic robot from its velocities at all motion steps."""
    speed = np.linalg.norm(velocity, axis=1)
    change = np.linalg.norm(np.diff(velocity, axis=0), axis=1)
    faster, slower = robot.max_acceleration * STEP, robot.deceleration * STEP
    assert speed.max() <= robot.max_speed * SLACK
    assert np.diff(speed).max() <= faster * SLACK + LEAST
    assert (-np.diff(speed)).max() <= slower * SLACK + LEAST
    assert change.max() <= max(faster, slower) * SLACK + LEAST
    # Who does not brake has the acceleration only.
    begun = np.einsum("ij,ij->i", velocity[:-1], np.diff(velocity, axis=0))
    assert change[begun >= 0.0].max(initial=0.0) <= faster * SLACK + LEAST


@settings(max_examples=60, deadline=None)
@given(SEEDS, RATES, RATES, st.sampled_from(sorted(LAWS)), st.sampled_from(sorted(PARTS)), st.booleans())
def test_a_holonomic_robot_keeps_acceleration_and_deceleration(
    seed: int, acceleration: float, deceleration: float, law: str, parts: str, rk4: bool
) -> None:
    robot = nav.HolonomicRobot(max_acceleration=acceleration, max_deceleration=deceleration)
    held: dict[str, Any] = {"integrator": "rk4"} if rk4 else {}
    run = nav.simulate(crowd(robot, seed), within(LAWS[law](), parts), step=STEP, **held)
    keeps(run.velocity, robot)


@settings(max_examples=60, deadline=None)
@given(SEEDS, RATES, RATES, RATES, st.floats(0.2, 4.0), st.sampled_from(sorted(PARTS)), st.data())
def test_two_wheels_keep_turn_rate_turn_acceleration_and_deceleration(
    seed: int, acceleration: float, deceleration: float, turning: float, rate: float, parts: str, data: st.DataObject
) -> None:
    law = data.draw(st.sampled_from(sorted(LAWS)))
    robot = nav.DifferentialDriveRobot(
        max_acceleration=acceleration,
        max_deceleration=deceleration,
        max_turn_rate=rate,
        max_turn_acceleration=turning,
    )
    heading = data.draw(st.floats(-3.0, 3.0))
    built = nav.robots.AsBuilt(tracking=data.draw(st.sampled_from(TRACKING)))
    run = nav.simulate(crowd(robot, seed, heading=heading), within(LAWS[law](), parts), step=STEP, built=built)
    ahead = np.column_stack([np.cos(run.heading), np.sin(run.heading)])
    speed = np.einsum("ij,ij->i", run.velocity, ahead)
    turn = np.diff(run.heading) / STEP
    assert np.abs(turn).max() <= rate * SLACK + LEAST
    # At rest at first, and then the changes from step to step.
    assert np.abs(np.diff(turn, prepend=0.0)).max() <= turning * STEP * SLACK + 1e-7
    assert np.diff(np.abs(speed)).max() <= acceleration * STEP * SLACK + LEAST
    crossed = speed[1:] * speed[:-1] < 0.0
    braked = np.where(crossed, np.abs(np.diff(speed)), -np.diff(np.abs(speed)))
    most = np.where(crossed, max(acceleration, deceleration), deceleration) * STEP
    assert (braked <= most * SLACK + LEAST).all()


@settings(max_examples=20, deadline=None)
@given(SEEDS, RATES, RATES)
def test_lanes_keep_the_limits_with_the_same_bits(seed: int, acceleration: float, deceleration: float) -> None:
    robot = nav.HolonomicRobot(max_acceleration=acceleration, max_deceleration=deceleration)
    scenes = [crowd(robot, seed + place) for place in range(9)]
    table = nav.simulate_many(scenes, [nav.VirtualForceField()])
    for place, scene in enumerate(scenes):
        one = nav.simulate(scene, nav.VirtualForceField())
        assert table.path_length[place] == one.path_length


@settings(max_examples=25, deadline=None)
@given(SEEDS, st.sampled_from(sorted(LAWS)), st.sampled_from(sorted(PARTS)))
def test_limits_that_say_the_same_as_none_change_no_outcome(seed: int, law: str, parts: str) -> None:
    plain = nav.HolonomicRobot()
    given_one = nav.HolonomicRobot(max_deceleration=plain.max_acceleration)
    runs = [nav.simulate(crowd(robot, seed), within(LAWS[law](), parts)) for robot in (plain, given_one)]
    assert runs[0].position[-1] == pytest.approx(runs[1].position[-1], abs=1e-6)


@settings(max_examples=25, deadline=None)
@given(SEEDS, st.sampled_from(sorted(PARTS)))
def test_limits_of_two_wheels_that_the_wheels_have_anyway_change_no_bit(seed: int, parts: str) -> None:
    plain = nav.DifferentialDriveRobot()
    wheels = {"max_turn_rate": 2.0 * plain.max_speed / plain.wheel_span, "max_turn_acceleration": 70.0}
    scene = crowd(plain, seed)
    # Regions that are not given grow by the time for a quarter of a turn.
    sized = [replace(one, active_radius=2.0, critical_radius=0.9) for one in scene.obstacles]
    robots = (plain, nav.DifferentialDriveRobot(**wheels))
    fixed = [replace(scene, robot=robot, obstacles=sized) for robot in robots]
    runs = [nav.simulate(scene, within(nav.VirtualForceField(), parts)) for scene in fixed]
    assert np.array_equal(runs[0].position, runs[1].position)


def test_the_default_robot_spins_and_a_limited_one_does_not() -> None:
    """A robot at 0.8 m/s on wheels 0.28 m apart turned at 5.71 rad/s, and nothing could limit it."""
    spins = nav.DifferentialDriveRobot(max_speed=0.8)
    limited = replace(spins, max_turn_rate=1.0, max_turn_acceleration=3.0)
    found = []
    for robot in (spins, limited):
        scene = nav.Scenario(robot=robot, start=(0.0, 0.0), goal=(-4.0, 0.5), heading=0.0)
        run = nav.simulate(scene, SafeNavigation(nav.VirtualForceField(), shield=Shield()))
        found.append(np.abs(np.diff(run.heading)).max() / STEP)
        assert run.outcome == "arrived"
    assert found[0] == pytest.approx(2.0 * 0.8 / 0.28, rel=1e-9)
    assert found[1] == pytest.approx(1.0, rel=1e-9)


def test_a_run_after_a_reference_keeps_them_too() -> None:
    robot = nav.DifferentialDriveRobot(max_turn_rate=0.8, max_turn_acceleration=2.0, max_deceleration=0.5)
    line = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(0.3, 0.2))
    run = nav.tracking.track(line, TRACKING[0], robot=robot, position=(0.5, -0.5), heading=3.0)
    assert np.abs(run.turn_rate).max() == pytest.approx(0.8)
    assert np.abs(np.diff(run.turn_rate)).max() <= 2.0 * STEP * SLACK
    assert (-np.diff(np.abs(run.speed))).max() <= 0.5 * STEP * SLACK


@pytest.mark.parametrize(("rate", "turning", "wanted"), [(None, None, 70.0), (1.0, None, 70.0), (1.0, 1.0, 1.0)])
def test_regions_grow_by_the_time_to_turn(rate: float | None, turning: float | None, wanted: float) -> None:
    robot = nav.DifferentialDriveRobot(max_turn_rate=rate, max_turn_acceleration=turning)
    person = nav.Human(start=(3.0, 0.0), velocity=(-0.5, 0.0))
    quarter = math.sqrt(math.pi / wanted)
    if rate is not None and wanted * quarter > rate:
        quarter = 0.5 * math.pi / rate + 0.5 * rate / wanted
    plain = nav.region_radii(nav.DifferentialDriveRobot(), person)
    grown = nav.region_radii(robot, person)
    extra = (quarter - math.sqrt(math.pi / 70.0)) * (robot.max_speed + 1.0)
    assert grown.active_radius - plain.active_radius == pytest.approx(extra, abs=1e-12)


def test_regions_hold_for_the_weaker_brake() -> None:
    person = nav.Human(start=(3.0, 0.0), velocity=(-0.5, 0.0))
    weak = nav.region_radii(nav.HolonomicRobot(max_deceleration=0.5), person)
    slow = nav.region_radii(nav.HolonomicRobot(max_acceleration=0.5), person)
    assert weak == slow
    strong = nav.region_radii(nav.HolonomicRobot(max_deceleration=50.0), person)
    assert strong == nav.region_radii(nav.HolonomicRobot(), person)


@pytest.mark.parametrize("name", ["max_deceleration", "max_turn_rate", "max_turn_acceleration"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "fast"])
def test_bad_limits_are_refused_by_name(name: str, value: object) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        nav.DifferentialDriveRobot(**{name: value})
    if name == "max_deceleration":
        with pytest.raises(InvalidParameterError, match=name):
            nav.HolonomicRobot(max_deceleration=value)  # type: ignore[arg-type]


def test_implausible_limits_are_doubted() -> None:
    robot = nav.DifferentialDriveRobot(max_turn_rate=90.0, max_turn_acceleration=5000.0, max_deceleration=900.0)
    scene = nav.Scenario(robot=robot, start=(0.0, 0.0), goal=(3.0, 0.0))
    found = {warning.subject for warning in scene.warnings}
    assert {"robot.max_turn_rate", "robot.max_turn_acceleration", "robot.max_deceleration"} <= found


def test_files_hold_them(tmp_path: Path) -> None:
    limits = {"max_turn_rate": 1.0, "max_turn_acceleration": 3.0, "max_deceleration": 2.0}
    path = tmp_path / "scene.toml"
    lines = [f"{name} = {value}" for name, value in limits.items()]
    path.write_text("\n".join(["start = [0, 0]", "goal = [3, 0]", "[robot]", 'type = "differential_drive"', *lines]))
    assert scenarios.load(path).scenario.robot == nav.DifferentialDriveRobot(**limits)
    path.write_text("start = [0, 0]\ngoal = [3, 0]\n[robot]\nmax_turn_rate = 1.0")
    with pytest.raises(InvalidParameterError, match="max_turn_rate"):
        scenarios.load(path)


def test_a_python_law_is_told_the_deceleration() -> None:
    seen = []

    def law(situation: nav.laws.Situation) -> tuple[float, float]:
        seen.append(situation.robot.max_deceleration)
        return 1.0, 0.0

    for given_one in (None, 3.0):
        robot = nav.HolonomicRobot(max_deceleration=given_one)
        nav.simulate(nav.Scenario(robot=robot, start=(0.0, 0.0), goal=(3.0, 0.0), time_limit=0.5), law)
    assert set(seen) == {10.0, 3.0}


def test_robots_of_a_crowd_keep_them() -> None:
    robot = nav.DifferentialDriveRobot(max_turn_rate=0.7, max_turn_acceleration=2.0, max_deceleration=1.0)
    law = SafeNavigation(nav.VirtualForceField(), shield=Shield(), yielding=Yielding())
    driven = nav.Robot(robot, start=(0.0, 0.0), goal=(-5.0, 1.0), law=law, control_period=0.1)
    person = nav.Person(start=(-4.0, 0.0), route=[(4.0, 0.5)])
    run = nav.simulate(nav.World(people=[person], robots=[driven], time_limit=20.0))
    times, heading = run.time, run.robot_heading[:, 0]
    turn = np.diff(heading) / np.diff(times)
    assert np.abs(turn).max() <= 0.7 * SLACK + 1e-7


def test_a_learner_turns_no_faster_than_its_robot() -> None:
    pytest.importorskip("gymnasium")
    from hrsafety.gym.environments import turn_rate_of

    plain, limited = nav.DifferentialDriveRobot(), nav.DifferentialDriveRobot(max_turn_rate=1.0)
    assert (turn_rate_of(plain, None), turn_rate_of(limited, None), turn_rate_of(limited, 0.5)) == (math.pi, 1.0, 0.5)
    assert turn_rate_of(nav.HolonomicRobot(), 9.0) == 9.0
    with pytest.raises(InvalidParameterError, match="max_turn_rate"):
        turn_rate_of(limited, 1.1)
