"""Symmetries of cameras, estimators and vision."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hrsafety import navigation as nav

METERS = 1e-9  # m
PIXELS = 1e-8  # pixels; a turned world carries 1e-15 of 10 m, times 1000 pixels per meter and more near the camera
ESTIMATORS: list[nav.sensing.Differences | nav.sensing.AlphaBeta | nav.sensing.Kalman] = [
    nav.sensing.Differences(),
    nav.sensing.AlphaBeta(position_gain=0.6, velocity_gain=0.3),
    nav.sensing.Kalman(),
]

angles = st.floats(-3.0, 3.0)
coordinates = st.floats(-1.0, 5.0)
heights = st.floats(0.0, 1.6)
points = st.tuples(coordinates, st.floats(-1.0, 2.0), heights)
seeds = st.integers(0, 2**32 - 1)
kinds = st.sampled_from(ESTIMATORS)


def turned(angle: float) -> np.ndarray:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


@given(points, st.floats(-5e3, 5e4), st.floats(3e-3, 12e-3), st.floats(0.9, 1.1))
def test_reconstruction_inverts_projection(
    point: tuple[float, float, float], radial: float, focal: float, scale: float
) -> None:
    camera = replace(nav.sensing.Camera(), radial_distortion=radial, focal_length=focal, horizontal_scale=scale)
    try:
        pixels = camera.project([point])
    except nav.InvalidParameterError:
        assume(False)
    # Next to the fold of a negative distortion the inverse has no slope.
    assume(1.0 + 3.0 * radial * (4.65e-6 * np.hypot(*(pixels - camera.image_center_px).T)[0] / scale) ** 2 > 1e-2)
    assert np.abs(camera.reconstruct(pixels, point[2]) - point).max() < METERS


@given(seeds)
def test_calibration_finds_every_camera_that_shows_its_points(seed: int) -> None:
    source, markers = np.random.default_rng(seed), nav.sensing.calibration_points()
    eye = np.array([source.uniform(-2.0, 6.0), source.choice([-5.0, 6.0]), source.uniform(1.8, 5.0)])
    ahead = np.array([2.0, 0.5, 0.3]) + source.normal(0.0, 0.3, 3) - eye
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    axes = np.array([axis / np.linalg.norm(axis) for axis in (right, np.cross(ahead, right), ahead)])
    camera = nav.sensing.Camera(
        focal_length=source.uniform(2.5e-3, 9e-3),
        radial_distortion=source.uniform(-8e3, 4e4),
        horizontal_scale=source.uniform(0.9, 1.1),
        image_center_px=(source.uniform(300.0, 700.0), source.uniform(250.0, 500.0)),
        rotation=nav.sensing.nearest_rotation(axes).tolist(),
        translation=tuple(-axes @ eye),
    )
    try:
        pixels = camera.project(markers)
    except nav.InvalidParameterError:
        assume(False)
    assume(bool(camera.contains(pixels).all()))
    found = nav.sensing.calibrate_camera(markers, pixels)
    assert found.camera.focal_length == pytest.approx(camera.focal_length, rel=1e-7)
    assert found.max_position_error < 1e-7


@given(points, angles, st.tuples(coordinates, coordinates))
def test_moving_world_and_camera_together_changes_no_pixel(
    point: tuple[float, float, float], angle: float, shift: tuple[float, float]
) -> None:
    camera, turn = nav.sensing.Camera(), turned(angle)
    moved = turn @ np.array(point) + [*shift, 0.0]
    rotation = np.array(camera.rotation) @ turn.T
    other = replace(
        camera,
        rotation=nav.sensing.nearest_rotation(rotation).tolist(),
        translation=tuple(np.array(camera.translation) - rotation @ [*shift, 0.0]),
    )
    assert other.project([moved]) == pytest.approx(camera.project([point]), abs=PIXELS)


@given(points, st.floats(0.2, 5.0))
def test_unit_of_the_sensor_does_not_matter(point: tuple[float, float, float], unit: float) -> None:
    camera = nav.sensing.Camera()
    scaled = replace(
        camera,
        focal_length=unit * camera.focal_length,
        pixel_size=(unit * camera.pixel_size[0], unit * camera.pixel_size[1]),
        radial_distortion=camera.radial_distortion / unit**2,
    )
    assert scaled.project([point]) == pytest.approx(camera.project([point]), abs=PIXELS)


@given(seeds, kinds, angles, st.floats(0.1, 10.0))
def test_estimates_turn_and_scale_with_what_is_measured(
    seed: int,
    estimator: nav.sensing.Differences | nav.sensing.AlphaBeta | nav.sensing.Kalman,
    angle: float,
    factor: float,
) -> None:
    source = np.random.default_rng(seed)
    time = np.cumsum(source.uniform(0.02, 0.2, 40))
    position = np.cumsum(source.normal(0.0, 0.05, (40, 2)), axis=0)
    turn = factor * turned(angle)[:2, :2]
    if isinstance(estimator, nav.sensing.Kalman):
        scaled: nav.sensing.Differences | nav.sensing.AlphaBeta | nav.sensing.Kalman = nav.sensing.Kalman(
            acceleration_deviation=factor * estimator.acceleration_deviation,
            position_deviation=factor * estimator.position_deviation,
            speed_deviation=factor * estimator.speed_deviation,
        )
    else:
        scaled = estimator
    plain = nav.sensing.track_positions(time, position, estimator)
    other = nav.sensing.track_positions(time, position @ turn.T, scaled)
    assert other.position == pytest.approx(plain.position @ turn.T, abs=1e-10)
    assert other.velocity == pytest.approx(plain.velocity @ turn.T, abs=1e-8)


@given(seeds, st.floats(0.0, 0.3), st.floats(0.0, 0.6), kinds)
def test_only_frames_that_have_arrived_are_known(
    seed: int,
    delay: float,
    drop: float,
    estimator: nav.sensing.Differences | nav.sensing.AlphaBeta | nav.sensing.Kalman,
) -> None:
    time = np.arange(0.0, 2.0, 0.01)
    path = np.column_stack([np.sin(time), time**2])
    vision = nav.sensing.Vision(delay=delay, drop_probability=drop, estimator=estimator)
    seen = nav.sensing.observe(vision, time, path, seed=seed)
    known = np.isfinite(seen.measured_at)
    assert (seen.measured_at[known] + delay <= time[known] + 1e-9).all()
    assert (np.diff(seen.measured_at[known]) >= 0.0).all()
    # What happens later changes nothing that was known before.
    bent = path.copy()
    bent[time > 1.0] += 3.0
    again = nav.sensing.observe(vision, time, bent, seed=seed)
    before = time <= 1.0
    assert np.array_equal(again.position[before], seen.position[before], equal_nan=True)
    assert np.array_equal(again.velocity[before], seen.velocity[before], equal_nan=True)
