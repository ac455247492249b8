"""Tracking converges from anywhere: random starts with all limits, invariances, the goal phase."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety import scenarios

Array = np.ndarray[Any, np.dtype[np.float64]]

STARTS, POSES = 2000, 10_000
PERIODS = (0.06, 0.01)
MAX_SPEED, MAX_TURN_RATE = 0.7, 5.0
SHARE = 0.9
CONVERGED = 1e-6  # m: five decades below a start 2 m away; rounding ends near 1e-12
MILLIMETER = 1e-3
RATE = 0.5  # 1/s, of the exponential convergence to the goal
LEVELS = (0.3, 0.1, 0.01, 1e-3, 1e-4)
NEAR = 0.4  # m: from here to the goal neither limit of the default gains is reached, 0.7/1.5 = 0.47
PATH = 1e-9  # m: two runs that differ by roundings, over a few seconds of converging motion


def random_starts(seed: int, count: int, reach: float, *, moving: bool = True) -> Array:
    """Positions within a square, any heading, any motion that the robot can have."""
    top = (reach, reach, math.pi, MAX_SPEED, MAX_TURN_RATE)
    starts = np.random.default_rng(seed).uniform(-np.array(top), top, (count, 5))
    return starts if moving else starts[:, :3]


def random_lines(seed: int, count: int, low: float, high: float) -> list[nav.tracking.Reference]:
    """References from the origin in any direction, at shares of the largest speed."""
    generator = np.random.default_rng(seed)
    speed = MAX_SPEED * generator.uniform(low, high, count)
    angle = generator.uniform(-math.pi, math.pi, count)
    velocity = speed[:, np.newaxis] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return [nav.tracking.LineReference(start=(0.0, 0.0), velocity=tuple(each)) for each in velocity]


def random_circles(seed: int, count: int, high: float) -> list[nav.tracking.Reference]:
    """References on circles that a robot can drive, in both directions."""
    generator = np.random.default_rng(seed)
    speed = MAX_SPEED * generator.uniform(0.1, high, count) * generator.choice((-1.0, 1.0), count)
    radius = generator.uniform(0.3, 3.0, count)
    angle = generator.uniform(-math.pi, math.pi, count)
    return [
        nav.tracking.CircleReference(center=(-r * math.cos(a), -r * math.sin(a)), radius=r, speed=v, start_angle=a)
        for v, r, a in zip(speed, radius, angle, strict=True)
    ]


@pytest.mark.parametrize("period", PERIODS)
def test_full_speed_tracking_converges_from_every_start(period: float) -> None:
    starts, lines = random_starts(1, STARTS, 2.0), random_lines(2, STARTS, 0.0, SHARE)
    table = nav.tracking.track_batch(lines, starts=starts, control_period=period, duration=60.0)
    assert table.max_error.max() > 2.0
    assert table.final_error.max() < CONVERGED


@pytest.mark.parametrize("period", PERIODS)
def test_nonlinear_tracking_converges_from_every_start(period: float) -> None:
    # Its rate is proportional to the speed of the reference, so the slowest need the longest.
    starts, lines = random_starts(3, STARTS, 2.0), random_lines(4, STARTS, 0.1, SHARE)
    table = nav.tracking.track_batch(
        lines, nav.tracking.NonlinearTracking(), starts=starts, control_period=period, duration=102.0
    )
    assert table.final_error.max() < MILLIMETER


@pytest.mark.parametrize("period", PERIODS)
@pytest.mark.parametrize(
    "law", [nav.tracking.FullSpeedTracking(), nav.tracking.NonlinearTracking(gain=30.0)], ids=["full", "nonlinear"]
)
def test_both_laws_stay_on_circles(law: nav.tracking.Tracking, period: float) -> None:
    starts, circles = random_starts(5, 500, 1.0), random_circles(6, 500, SHARE)
    table = nav.tracking.track_batch(circles, law, starts=starts, control_period=period, duration=90.0)
    assert table.final_error.max() < CONVERGED


def test_a_reference_at_full_speed_cannot_be_caught_up_with() -> None:
    # Why the reference gets 90 %: whoever falls behind stays there.
    starts, lines = random_starts(7, STARTS, 2.0), random_lines(8, STARTS, 1.0, 1.0)
    for law in (nav.tracking.FullSpeedTracking(), nav.tracking.NonlinearTracking()):
        table = nav.tracking.track_batch(lines, law, starts=starts, duration=60.0)
        assert np.mean(table.final_error > MILLIMETER) > 0.5
        slower = nav.tracking.track_batch(random_lines(8, STARTS, SHARE, SHARE), law, starts=starts, duration=60.0)
        assert np.mean(slower.final_error > MILLIMETER) == 0.0


UNLIMITED = nav.DifferentialDriveRobot(
    max_speed=100.0, max_acceleration=1e6, max_angular_acceleration=1e9, wheel_span=0.01
)


@pytest.mark.parametrize(("heading", "grows"), [(0.45, False), (0.51, False), (0.54, True), (0.7, True)])
def test_printed_turn_rate_diverges_beyond_half_a_radian(heading: float, grows: bool) -> None:
    # omega_d = phi_e/T_s removes phi_e in one period and K_phi phi_e comes on top: the next error is at least
    # 2 xi phi_e^2 of the other sign, which is larger than phi_e beyond 1/(2 xi) = 0.526 rad.
    line = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(0.05, 0.0))
    printed = nav.tracking.NonlinearTracking(reference_turn="printed")
    run = nav.tracking.track(line, printed, heading=heading, robot=UNLIMITED, step=0.06, duration=0.18)
    assert bool(abs(run.heading[3]) > heading) is grows
    corrected = nav.tracking.track(
        line, heading=heading, tracking=nav.tracking.NonlinearTracking(), robot=UNLIMITED, duration=60.0
    )
    assert abs(corrected.heading[-1]) < 1e-3


@pytest.mark.parametrize("period", PERIODS)
def test_printed_turn_rate_leaves_centimeters_on_curves(period: float) -> None:
    circle = nav.tracking.CircleReference(center=(0.0, 0.0), radius=1.0, speed=0.4)
    start: dict[str, Any] = {"position": (1.0, 0.0), "heading": math.pi / 2, "speed": 0.4, "turn_rate": 0.4}

    def error(law: nav.tracking.Tracking) -> float:
        run = nav.tracking.track(circle, law, control_period=period, duration=60.0, **start)
        return float(run.error[-1000:].max())

    assert 0.01 < error(nav.tracking.NonlinearTracking(reference_turn="printed")) < 0.07
    assert error(nav.tracking.NonlinearTracking(error_frame="world")) > 0.05
    assert error(nav.tracking.NonlinearTracking()) < CONVERGED
    assert error(nav.tracking.FullSpeedTracking()) < CONVERGED


def goal_rates(table: nav.tracking.TrackingSummary) -> Array:
    """Rate between each level and the next, the error as an exponential of time."""
    with np.errstate(divide="ignore"):  # a start below both levels
        return np.asarray(np.log(table.levels[:-1] / table.levels[1:]) / np.diff(table.settling_time, axis=1))


@pytest.mark.parametrize("period", PERIODS)
@pytest.mark.parametrize("heading", [None, 0.7])
def test_goal_phase_converges_exponentially(heading: float | None, period: float) -> None:
    law = nav.tracking.ExponentialTracking(goal_heading=heading)
    starts = random_starts(11, POSES, 5.0)
    still = nav.tracking.LineReference(start=(0.0, 0.0))
    table = nav.tracking.track_batch(
        still, law, starts=starts, levels=LEVELS, control_period=period, duration=30.0, goal=(0.0, 0.0)
    )
    assert table.final_error.max() < 1e-5 < MILLIMETER
    assert goal_rates(table).min() > RATE
    if heading is not None:
        turns = (table.final_heading - heading) / math.tau
        assert np.abs(turns - np.round(turns)).max() * math.tau < 1e-6


@pytest.mark.parametrize("heading", [None, 0.7])
def test_error_stays_below_one_exponential_from_anywhere_near(heading: float | None) -> None:
    # e(t) <= M e(0) exp(-t/2): the robot needs time to turn, and with a wanted heading a detour.
    law = nav.tracking.ExponentialTracking(goal_heading=heading, capture_radius=math.inf)
    generator = np.random.default_rng(12)
    angle = generator.uniform(-math.pi, math.pi, POSES)
    starts = np.stack([NEAR * np.cos(angle), NEAR * np.sin(angle), generator.uniform(-math.pi, math.pi, POSES)], axis=1)
    levels = NEAR * np.exp(-np.arange(0.0, 8.0, 0.1))
    table = nav.tracking.track_batch(
        nav.tracking.LineReference(start=(0.0, 0.0)), law, starts=starts, levels=levels, duration=15.0, goal=(0.0, 0.0)
    )
    # Between two settling times the error is below the level of the first.
    bound = levels[:-1] / NEAR * np.exp(RATE * table.settling_time[:, 1:])
    assert bound.max() < (1.9 if heading is None else 4.0)


@pytest.mark.parametrize("name", ["n1", "n2", "n3", "n4"])
def test_robot_follows_the_path_of_a_law(name: str) -> None:
    # A point mass may turn at once, so the robot is up to a turning circle beside it; then it catches up.
    robot = nav.HolonomicRobot(mass=3.7, max_speed=SHARE * MAX_SPEED)
    scenario = dataclasses.replace(scenarios.configuration(name), robot=robot)
    run = nav.simulate(scenario, nav.VirtualForceField(stabilizing="off"))
    path = nav.tracking.PathReference.from_run(run)
    duration = round(run.time[-1] / 0.06) * 0.06
    followed = nav.tracking.track(path, position=run.position[0], heading=math.pi, duration=duration + 6.0)
    assert followed.error.max() < 0.15
    assert followed.error[-1] < CONVERGED
    assert followed.reference_position[-1] == pytest.approx(run.position[-1])


def turned(points: Array, angle: float, offset: Array, mirrored: bool) -> Array:
    """Points after a mirror image about the x axis, a rotation and a shift."""
    flipped = points * np.array([1.0, -1.0 if mirrored else 1.0])
    cos, sin = math.cos(angle), math.sin(angle)
    return np.asarray(flipped @ np.array([[cos, sin], [-sin, cos]]) + offset)


LAWS = (nav.tracking.FullSpeedTracking(), nav.tracking.NonlinearTracking(), nav.tracking.ExponentialTracking())


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    law=st.sampled_from(LAWS),
    angle=st.floats(-math.pi, math.pi),
    mirrored=st.booleans(),
)
def test_run_turns_shifts_and_mirrors_with_its_scene(
    seed: int, law: nav.tracking.Tracking, angle: float, mirrored: bool
) -> None:
    generator = np.random.default_rng(seed)
    (start,) = random_starts(seed, 1, 1.0)
    offset = generator.uniform(-3.0, 3.0, 2)
    velocity = generator.uniform(-0.4, 0.4, 2)
    goal = generator.uniform(-0.5, 0.5, 2)
    sign = -1.0 if mirrored else 1.0

    def run(place: Array, heading: float, turn_rate: float, way: Array, end: Array, origin: Array) -> nav.Trajectory:
        return nav.tracking.track(
            nav.tracking.LineReference(start=tuple(origin), velocity=tuple(way)),
            law,
            position=place,
            heading=heading,
            speed=start[3],
            turn_rate=turn_rate,
            duration=3.0,
            goal=end,
        )

    none = np.zeros(2)
    plain = run(start[:2], start[2], start[4], velocity, goal, none)
    moved = run(
        turned(start[:2], angle, offset, mirrored),
        sign * start[2] + angle,
        sign * start[4],
        turned(velocity, angle, none, mirrored),
        turned(goal, angle, offset, mirrored),
        offset,
    )
    assert turned(plain.position, angle, offset, mirrored) == pytest.approx(moved.position, abs=PATH)
    assert sign * plain.turn_rate == pytest.approx(moved.turn_rate, abs=1e-6)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_no_run_exceeds_a_limit(law: nav.tracking.Tracking) -> None:
    robot = nav.DifferentialDriveRobot()
    for start, line in zip(random_starts(13, 20, 1.0), random_lines(14, 20, 0.1, SHARE), strict=True):
        run = nav.tracking.track(
            line, law, position=start[:2], heading=start[2], speed=start[3], turn_rate=start[4], goal=(0.2, 0.1)
        )
        step = 0.01 * (1.0 + 1e-9)
        assert np.abs(run.speed).max() <= robot.max_speed
        assert np.abs(run.turn_rate).max() <= 2.0 * robot.max_speed / robot.wheel_span
        assert np.abs(np.diff(run.speed)).max() <= robot.max_acceleration * step
        assert np.abs(np.diff(run.turn_rate)).max() <= robot.max_angular_acceleration * step
