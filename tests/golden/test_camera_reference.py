"""Projection, calibration and filters beside independent evaluations: mpmath, textbook matrices, SciPy."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy import linalg, optimize

from hrsafety import navigation as nav

# The camera of section D.4 as printed.
FOCAL, RADIAL, SCALE, CENTER = "4.76e-3", "1.68e4", "0.987", ("355.3", "292.1")
PRINTED_ROTATION = [
    [-0.941126, -0.318152, -0.114288],
    [-0.053498, 0.473980, -0.878909],
    [0.333797, -0.821050, -0.463095],
]
PRINTED_POSITION = (1.090, 4.162, 2.585)  # m, to a millimeter
PIXELS = 1e-9  # pixels; rounding of numbers near 1000 is 1e-13, times a few operations
METERS = 1e-9  # m, what is asked for
PERIOD = 0.06


def exact_pixel(point: np.ndarray, camera: nav.sensing.Camera) -> list[mp.mpf]:
    """Return the pixel of a point with 40 digits: the cubic of the distortion by a secant method."""
    with mp.workdps(40):
        rotation, translation = mp.matrix(camera.rotation), mp.matrix(camera.translation)
        x, y, z = rotation * mp.matrix([mp.mpf(float(value)) for value in point]) + translation
        focal, radial = mp.mpf(camera.focal_length), mp.mpf(camera.radial_distortion)
        u, v = focal * x / z, focal * y / z
        undistorted = mp.sqrt(u**2 + v**2)
        distorted = mp.findroot(lambda radius: radial * radius**3 + radius - undistorted, undistorted)
        ratio = distorted / undistorted
        (cx, cy), (sx, sy) = camera.image_center_px, camera.pixel_size
        return [
            mp.mpf(cx) + mp.mpf(camera.horizontal_scale) * ratio * u / mp.mpf(sx),
            mp.mpf(cy) + ratio * v / mp.mpf(sy),
        ]


@pytest.fixture(scope="module")
def places() -> np.ndarray:
    return np.vstack([nav.sensing.calibration_points(), nav.sensing.patch_places(nav.sensing.Camera())[::7]])


def test_defaults_are_the_printed_camera() -> None:
    camera = nav.sensing.Camera()
    assert camera.focal_length == float(FOCAL)
    assert camera.radial_distortion == float(RADIAL)
    assert camera.horizontal_scale == float(SCALE)
    assert camera.image_center_px == tuple(map(float, CENTER))
    # The printed matrix is orthonormal to 6e-7; the nearest rotation differs by half of that.
    assert np.abs(np.array(camera.rotation) - PRINTED_ROTATION).max() < 3e-7
    assert np.array(camera.rotation) @ np.array(camera.rotation).T == pytest.approx(np.eye(3), abs=2e-15)
    assert camera.position == pytest.approx(PRINTED_POSITION, abs=6e-4)


def test_nearest_rotation_is_the_polar_factor() -> None:
    rotation, _ = linalg.polar(np.array(PRINTED_ROTATION))
    assert nav.sensing.nearest_rotation(PRINTED_ROTATION) == pytest.approx(rotation, abs=1e-15)


def test_projection_is_that_of_forty_digits(places: np.ndarray) -> None:
    camera = nav.sensing.Camera()
    exact = np.array([[float(value) for value in exact_pixel(point, camera)] for point in places])
    assert np.abs(camera.project(places) - exact).max() < PIXELS


def test_reconstruction_of_exact_pixels_is_the_point(places: np.ndarray) -> None:
    camera = nav.sensing.Camera()
    exact = np.array([[float(value) for value in exact_pixel(point, camera)] for point in places])
    assert np.abs(camera.reconstruct(exact, places[:, 2]) - places).max() < METERS


def test_calibration_recovers_the_camera_from_exact_points() -> None:
    camera, points = nav.sensing.Camera(), nav.sensing.calibration_points()
    fit = nav.sensing.calibrate_camera(points, camera.project(points))
    found = fit.camera
    assert found.focal_length == pytest.approx(camera.focal_length, rel=1e-10)
    assert found.radial_distortion == pytest.approx(camera.radial_distortion, rel=1e-10)
    assert found.horizontal_scale == pytest.approx(camera.horizontal_scale, rel=1e-10)
    assert found.image_center_px == pytest.approx(camera.image_center_px, abs=1e-8)
    assert np.array(found.rotation) == pytest.approx(np.array(camera.rotation), abs=1e-11)
    assert found.translation == pytest.approx(camera.translation, abs=1e-10)
    assert fit.max_position_error < METERS


def test_noisy_calibration_is_the_least_squares_camera_of_another_solver() -> None:
    """An own projection, numerical derivatives, another parametrization and another algorithm."""
    camera, points = nav.sensing.Camera(), nav.sensing.calibration_points()
    pixels = camera.project(points) + np.random.default_rng(5).normal(0.0, 0.5, (len(points), 2))

    def residuals(values: np.ndarray) -> np.ndarray:
        focal, radial, scale, cx, cy = values[:5] * np.array([1e-3, 1e4, 1.0, 100.0, 100.0])
        turn = linalg.expm(np.cross(np.eye(3), -values[5:8])) @ np.array(camera.rotation)
        local = points @ turn.T + values[8:]
        u = focal * local[:, :2] / local[:, 2:]
        radius = np.hypot(u[:, 0], u[:, 1])
        # The cubic's real root by Cardano's formula in hyperbolic form.
        p = 1.0 / radial
        ratio = (
            2.0 * np.sqrt(p / 3.0) * np.sinh(np.arcsinh(1.5 * radius / radial / p * np.sqrt(3.0 / p)) / 3.0) / radius
        )
        x = cx + scale * ratio * u[:, 0] / camera.pixel_size[0]
        return np.concatenate([x - pixels[:, 0], cy + ratio * u[:, 1] / camera.pixel_size[1] - pixels[:, 1]])

    start = np.array([4.76, 1.68, 0.987, 3.553, 2.921, 0.0, 0.0, 0.0, *camera.translation])
    other = optimize.least_squares(residuals, start, method="trf", xtol=1e-14, ftol=1e-14, gtol=1e-14)
    fit = nav.sensing.calibrate_camera(points, pixels)
    assert np.sqrt((fit.residual_px**2).sum()) == pytest.approx(np.sqrt(2.0 * other.cost), rel=1e-9)
    assert fit.camera.focal_length == pytest.approx(1e-3 * other.x[0], rel=1e-6)
    assert fit.camera.translation == pytest.approx(other.x[8:], abs=1e-5)
    freedom = 2 * len(points) - 11
    spread = np.sqrt(np.diagonal(np.linalg.inv(other.jac.T @ other.jac)) * 2.0 * other.cost / freedom)
    units = np.array([1e-3, 1e4, 1.0, 100.0, 100.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    # The turns are about other cameras here and there; the rest does not depend on that.
    same = [0, 1, 2, 3, 4, 8, 9, 10]
    assert fit.deviation[same] == pytest.approx((spread * units)[same], rel=1e-4)


def textbook_filter(
    time: np.ndarray, position: np.ndarray, acceleration: float, noise: float, speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return states (x, y, vx, vy) and their covariance, with 4 x 4 matrices and Joseph's form."""
    measure = np.hstack([np.eye(2), np.zeros((2, 2))])
    state = np.array([*position[0], 0.0, 0.0])
    covariance = np.diag([noise**2, noise**2, speed**2, speed**2])
    states, covariances = [state], [covariance]
    for before, after, seen in zip(time[:-1], time[1:], position[1:], strict=True):
        step = after - before
        move = np.eye(4) + step * np.diag([1.0, 1.0], 2)
        push = np.vstack([0.5 * step**2 * np.eye(2), step * np.eye(2)])
        state, covariance = move @ state, move @ covariance @ move.T + acceleration**2 * push @ push.T
        innovation = measure @ covariance @ measure.T + noise**2 * np.eye(2)
        gain = covariance @ measure.T @ np.linalg.inv(innovation)
        state = state + gain @ (seen - measure @ state)
        rest = np.eye(4) - gain @ measure
        covariance = rest @ covariance @ rest.T + noise**2 * gain @ gain.T
        states.append(state)
        covariances.append(covariance)
    return np.array(states), np.array(covariances)


def test_kalman_filter_is_that_of_the_textbook() -> None:
    source = np.random.default_rng(3)
    time = np.cumsum(source.uniform(0.03, 0.2, 200))
    position = np.cumsum(source.normal(0.0, 0.05, (200, 2)), axis=0)
    track = nav.sensing.track_positions(
        time, position, nav.sensing.Kalman(acceleration_deviation=2.0, position_deviation=0.01, speed_deviation=1.5)
    )
    states, covariances = textbook_filter(time, position, 2.0, 0.01, 1.5)
    assert track.position == pytest.approx(states[:, :2], abs=1e-11)
    assert track.velocity == pytest.approx(states[:, 2:], abs=1e-9)
    assert track.covariance[:, 0] == pytest.approx(covariances[:, 0, 0], rel=1e-9)
    assert track.covariance[:, 1] == pytest.approx(covariances[:, 0, 2], rel=1e-9, abs=1e-15)
    assert track.covariance[:, 2] == pytest.approx(covariances[:, 2, 2], rel=1e-9)


@pytest.mark.parametrize("acceleration", [0.1, 1.0, 10.0])
def test_steady_gains_solve_the_riccati_equation(acceleration: float) -> None:
    noise = 0.0032
    move, measure = np.array([[1.0, PERIOD], [0.0, 1.0]]), np.array([[1.0, 0.0]])
    push = np.array([[0.5 * PERIOD**2], [PERIOD]])
    ahead = linalg.solve_discrete_are(move.T, measure.T, acceleration**2 * push @ push.T, [[noise**2]])
    gain = ahead[:, 0] / (ahead[0, 0] + noise**2)
    steady = nav.sensing.AlphaBeta.from_deviations(acceleration=acceleration, position=noise, period=PERIOD)
    assert steady.position_gain == pytest.approx(gain[0], rel=1e-8)
    assert steady.velocity_gain == pytest.approx(gain[1] * PERIOD, rel=1e-8)
    kalman = nav.sensing.Kalman(acceleration_deviation=acceleration, position_deviation=noise)
    still = nav.sensing.track_positions(np.arange(2000) * PERIOD, np.zeros((2000, 2)), kalman)
    assert still.covariance[-1, 0] == pytest.approx(steady.position_gain * noise**2, rel=1e-8)


def test_alpha_beta_filter_is_its_difference_equation() -> None:
    source = np.random.default_rng(9)
    time, position = np.arange(100) * PERIOD, source.normal(0.0, 1.0, (100, 2))
    track = nav.sensing.track_positions(time, position, nav.sensing.AlphaBeta(position_gain=0.6, velocity_gain=0.3))
    where, speed = position[1], (position[1] - position[0]) / PERIOD
    for row in range(2, 100):
        residual = position[row] - (where + PERIOD * speed)
        where, speed = where + PERIOD * speed + 0.6 * residual, speed + 0.3 / PERIOD * residual
        assert track.position[row] == pytest.approx(where, abs=1e-10)
        assert track.velocity[row] == pytest.approx(speed, abs=1e-9)
