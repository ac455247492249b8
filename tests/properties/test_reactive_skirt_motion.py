"""The skirt's kinematics and runs hold their laws, recomputed here by other means."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrsafety import reactive

EXACT = 1e-14
SPEED = st.floats(-1.0, 1.0)
PLATFORM = reactive.skirt.TriOmniKinematics()
WHEELS = np.radians([90.0, 210.0, 330.0])
Array = npt.NDArray[np.float64]


# ---- kinematics -------------------------------------------------------------------------------------


@given(x=SPEED, y=SPEED, yaw_rate=SPEED)
def test_wheel_speeds_and_body_velocity_are_inverse(x: float, y: float, yaw_rate: float) -> None:
    velocity, rate = PLATFORM.body_velocity(PLATFORM.wheel_speeds([x, y], yaw_rate))
    assert np.abs(velocity - [x, y]).max() < EXACT
    assert abs(float(rate) - yaw_rate) < EXACT


def contact_point(wheel: float, time: float, motion: tuple[float, float, float], speed: float) -> Array:
    """Where the point of the tread that touches the ground at time 0 is a moment later."""
    x, y, yaw_rate = motion
    heading = yaw_rate * time
    arm = PLATFORM.chassis_radius - PLATFORM.wheel_width / 2
    axle = np.array([math.cos(wheel + heading), math.sin(wheel + heading), 0.0])
    hub = np.array([x * time, y * time, PLATFORM.wheel_radius]) + arm * axle
    # The tread point, below the hub at first, turned about the outward axle by speed * time.
    angle = speed * time
    down, aside = np.array([0.0, 0.0, -1.0]), np.cross(axle, [0.0, 0.0, -1.0])
    return hub + PLATFORM.wheel_radius * (math.cos(angle) * down + math.sin(angle) * aside)


@given(x=SPEED, y=SPEED, yaw_rate=SPEED)
def test_treads_do_not_slip_along_the_wheels(x: float, y: float, yaw_rate: float) -> None:
    # Numerical velocities of the contact points: positions a moment before and after.
    moment = 1e-5
    speeds = PLATFORM.wheel_speeds([x, y], yaw_rate)
    for wheel, speed in zip(WHEELS, speeds, strict=True):
        before, after = (contact_point(wheel, time, (x, y, yaw_rate), float(speed)) for time in (-moment, moment))
        slip = (after - before) / (2 * moment)
        along = slip @ np.array([-math.sin(wheel), math.cos(wheel), 0.0])
        # Central differences: error moment^2/6 times third derivatives, below 40^3 r_w, and rounding.
        assert abs(along) < 1e-6


def test_arrays_broadcast_and_agree_with_single_calls() -> None:
    velocity = np.array([[[0.1, 0.2]], [[0.3, -0.4]]])
    rates = np.array([0.0, 0.5, -0.5])
    speeds = PLATFORM.wheel_speeds(velocity, rates)
    assert speeds.shape == (2, 3, 3)
    for i, j in np.ndindex(2, 3):
        assert np.array_equal(speeds[i, j], PLATFORM.wheel_speeds(velocity[i, 0], rates[j]))
    back, again = PLATFORM.body_velocity(speeds)
    assert np.abs(back - velocity).max() < EXACT
    assert np.abs(again - rates).max() < EXACT


def test_magnitudes_alone_spin_the_robot() -> None:
    angles = np.linspace(0.0, 2 * math.pi, 361)
    speeds = PLATFORM.wheel_speeds(0.3 * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    rates = PLATFORM.body_velocity(np.abs(speeds))[1]
    assert (rates.min().round(2), rates.max().round(2)) == (-0.64, -0.56)


# ---- decisions --------------------------------------------------------------------------------------


@given(readings=st.lists(st.floats(0.02, 0.8), min_size=9, max_size=9))
def test_the_nearest_triggered_sensor_decides_between_the_rows(readings: list[float]) -> None:
    skirt = reactive.UltrasonicSkirt()
    listed = {state.pattern for state in reactive.skirt.skirt_states()}
    nearest = int(np.argmin(readings))
    if skirt.pattern(readings) not in listed:
        alone = np.full(9, 3.0)
        alone[nearest] = readings[nearest]
        assert skirt.action(readings) == skirt.action(alone)


@given(readings=st.lists(st.floats(0.02, 0.8), min_size=9, max_size=9))
def test_the_best_direction_maximizes_the_documented_sum(readings: list[float]) -> None:
    skirt = reactive.UltrasonicSkirt(policy="best_direction")
    listed = {state.pattern for state in reactive.skirt.skirt_states()}
    if skirt.pattern(readings) in listed:
        return
    near, limits = np.array(readings), skirt.trigger_distances
    weight = np.where(near <= limits, 1.2 - near / limits, 0.0)
    sums = {
        name: -float(np.sum(np.exp(2 * np.cos(angle - skirt.bearings)) * weight))
        for name, angle in reactive.skirt.MOTION_DIRECTIONS.items()
    }
    assert sums[skirt.action(readings)] >= max(sums.values()) - 1e-12


# ---- runs -------------------------------------------------------------------------------------------


def cone_range(run: reactive.SkirtRun, row: int, sensor: int) -> float:
    """Range of a sensor by the angles of the discs in its cone, not by rays."""
    skirt = run.skirt
    # A sensor fires before the robot moves on: at the position of the row before.
    position = run.position[row - 1] if row else np.zeros(2)
    bearing = skirt.bearings[sensor]
    face = position + skirt.positions[sensor]
    least = skirt.most_range
    for center, radius in zip(run.disc_center, run.disc_radius, strict=True):
        offset = center - face
        distance = float(np.hypot(*offset))
        off = abs((math.atan2(offset[1], offset[0]) - bearing + math.pi) % (2 * math.pi) - math.pi)
        beyond = max(off - skirt.beam_width / 2, 0.0)
        across = distance * math.sin(beyond)
        if beyond < math.pi / 2 and across <= radius:
            least = min(least, distance * math.cos(beyond) - math.sqrt(radius**2 - across**2))
    return least


@pytest.mark.parametrize("direction", ["N", "SW", "E"])
def test_readings_are_ranges_within_the_cone_one_sensor_at_a_time(direction: str) -> None:
    skirt = reactive.UltrasonicSkirt(range_noise=0.0, rays=2001)
    run = reactive.skirt_run(skirt, direction=direction)
    before = np.full(9, skirt.most_range)
    for row, readings in enumerate(run.readings):
        sensor = row % 9
        assert np.array_equal(np.delete(readings, sensor), np.delete(before, sensor))
        # At the tangent to a disc the range changes fast between two rays.
        assert readings[sensor] == pytest.approx(cone_range(run, row, sensor), abs=0.02)
        before = readings
    ranges = [cone_range(run, row, row % 9) for row in range(len(run.time))]
    off = np.abs(run.readings[np.arange(len(ranges)), np.arange(len(ranges)) % 9] - ranges)
    assert np.median(off) < 1e-6


def test_motion_follows_the_decisions_within_the_limits() -> None:
    motion = reactive.SkirtMotion()
    for direction in reactive.skirt.MOTION_DIRECTIONS:
        run = reactive.skirt_run(direction=direction, motion=motion)
        step = run.skirt.firing_period
        assert run.time == pytest.approx(step * np.arange(1, len(run.time) + 1), rel=1e-12)
        velocity = np.vstack([[0.0, 0.0], run.velocity])
        assert np.linalg.norm(np.diff(velocity, axis=0), axis=1).max() <= motion.acceleration * step * (1 + 1e-12)
        assert np.linalg.norm(velocity, axis=1).max() <= motion.speed * (1 + 1e-12)
        position = np.vstack([[0.0, 0.0], run.position])
        assert np.diff(position, axis=0) == pytest.approx(run.velocity * step, abs=1e-15)
        assert [run.skirt.action(readings) for readings in run.readings] == run.action.tolist()
        assert not run.heading.any()


def test_the_clearance_of_a_run_is_that_of_its_path() -> None:
    for layout in range(5):
        run = reactive.skirt_run(layout=layout)
        path = np.vstack([[0.0, 0.0], run.position])
        gaps = np.linalg.norm(path[:, np.newaxis] - run.disc_center, axis=2) - run.disc_radius - 0.33
        assert run.min_clearance == pytest.approx(gaps.min(), abs=1e-14)


def test_shares_of_mirrored_directions_are_alike() -> None:
    # East and west, north-east and north-west are mirrored, but for the rounding of the ring.
    tests = reactive.skirt_test(layouts=60, scene=reactive.SkirtScene(unseen_share=0.1))
    for one, other in (("E", "W"), ("NE", "NW"), ("SE", "SW")):
        first, second = (tests.collided[tests.direction == name] for name in (one, other))
        p = (first.mean() + second.mean()) / 2
        error = math.sqrt(2 * p * (1 - p) / len(first))
        assert abs(first.mean() - second.mean()) < 4 * error
