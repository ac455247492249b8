"""Cameras: what is refused, what a calibration says, how large its errors are."""

from __future__ import annotations

import pickle
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError, SimulationError
from hrsafety import navigation as nav
from hrsafety.errors import MissingExtraError
from hrsafety.navigation.sensing.calibration import CALIBRATED

NAN, INF = float("nan"), float("inf")
SEEDS = 200


@pytest.fixture(scope="module")
def studies() -> dict[float, nav.sensing.CalibrationStudy]:
    return {noise: nav.sensing.calibration_study(pixel_deviation_px=noise, seeds=SEEDS) for noise in (0.3, 0.5)}


def test_cameras_are_equal_by_value_and_survive_pickling() -> None:
    camera = nav.sensing.Camera(focal_length=5e-3)
    again = pickle.loads(pickle.dumps(camera))
    assert again == camera
    assert hash(again) == hash(camera)
    assert again != nav.sensing.Camera()
    assert np.array_equal(again.project([[2.0, 0.6, 0.0]]), camera.project([[2.0, 0.6, 0.0]]))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *[("focal_length", value) for value in (0.0, -1.0, NAN, INF, "wide", None)],
        *[("radial_distortion", value) for value in (NAN, INF, True)],
        *[("horizontal_scale", value) for value in (0.0, NAN)],
        *[("image_center_px", value) for value in ((NAN, 0.0), (1.0,), 3.0)],
        *[("pixel_size", value) for value in ((0.0, 1e-6), (-1e-6, 1e-6))],
        *[("image_size_px", value) for value in ((0, 768), (1024.0, 768), (1024,), 5, (2**32, 5))],
        *[("rotation", value) for value in (np.eye(2), 2.0 * np.eye(3), -np.eye(3), np.full((3, 3), NAN))],
        *[("translation", value) for value in ((1.0, 2.0), (NAN, 0.0, 0.0), "abc")],
    ],
)
def test_wrong_numbers_of_a_camera_are_named(name: str, value: Any) -> None:
    arguments: dict[str, Any] = {name: value}
    with pytest.raises((InvalidParameterError, ShapeError)) as caught:
        nav.sensing.Camera(**arguments)
    assert name in str(caught.value)


def test_rounded_rotation_is_refused_and_can_be_made_one() -> None:
    rounded = np.round(np.array(nav.sensing.Camera().rotation), 6)
    with pytest.raises(InvalidParameterError, match="nearest_rotation"):
        nav.sensing.Camera(rotation=rounded)  # type: ignore[arg-type]  # arrays are taken and kept as tuples
    assert nav.sensing.Camera(rotation=nav.sensing.nearest_rotation(rounded)) is not None  # type: ignore[arg-type]  # as above


@pytest.mark.parametrize("matrix", [-np.eye(3), np.zeros((3, 3)), np.full((3, 3), NAN)])
def test_what_is_near_no_rotation_is_refused(matrix: np.ndarray) -> None:
    with pytest.raises(InvalidParameterError, match="matrix"):
        nav.sensing.nearest_rotation(matrix)


def test_points_without_an_image_and_pixels_without_a_point_are_named() -> None:
    camera = nav.sensing.Camera()
    behind = 2.0 * np.array(camera.position) - [2.0, 0.6, 0.0]
    with pytest.raises(InvalidParameterError, match=r"points\[1\]"):
        camera.project([[2.0, 0.6, 0.0], behind])
    above = camera.position[2] + 1.0
    with pytest.raises(InvalidParameterError, match=r"pixels\[0\]"):
        camera.reconstruct([[500.0, 400.0]], above)
    with pytest.raises(InvalidParameterError, match="points"):
        camera.project([[NAN, 0.0, 0.0]])
    with pytest.raises(ShapeError, match="height"):
        camera.reconstruct([[500.0, 400.0]], [0.0, 0.0])
    with pytest.raises(ShapeError, match="points"):
        camera.project([2.0, 0.6, 0.0])


def test_picture_ends_half_a_pixel_around_its_pixels() -> None:
    corners = [[-0.5, -0.5], [-0.51, 0.0], [1023.49, 767.49], [1023.5, 0.0], [0.0, 767.5]]
    assert nav.sensing.Camera().contains(corners).tolist() == [True, False, True, False, False]


def test_nothing_is_projected_from_no_points() -> None:
    camera = nav.sensing.Camera()
    assert camera.project(np.empty((0, 3))).shape == (0, 2)
    assert camera.reconstruct(np.empty((0, 2)), 0.0).shape == (0, 3)


def test_calibration_states_residuals_errors_and_their_size(studies: dict[float, nav.sensing.CalibrationStudy]) -> None:
    camera, points = nav.sensing.Camera(), nav.sensing.calibration_points()
    shown = camera.project(points) + np.random.default_rng(0).normal(0.0, 1.0, (26, 2)) * 0.5
    fit = nav.sensing.calibrate_camera(points, shown)
    assert fit.degrees_of_freedom == 2 * 26 - 11
    assert fit.residual_px == pytest.approx(fit.camera.project(points) - shown, abs=1e-9)
    assert fit.pixel_deviation_px == pytest.approx(0.5, rel=0.3)
    assert fit.deviation**2 == pytest.approx(np.diagonal(fit.covariance))
    assert fit.covariance == pytest.approx(fit.covariance.T)
    assert fit.mean_position_error == fit.position_error.mean()
    assert np.array_equal(studies[0.5].point_error[0], fit.position_error)


def test_stated_deviations_are_those_of_many_calibrations(studies: dict[float, nav.sensing.CalibrationStudy]) -> None:
    camera = nav.sensing.Camera()
    lens = (camera.focal_length, camera.radial_distortion, camera.horizontal_scale, *camera.image_center_px)
    truth = np.array([*lens, 0.0, 0.0, 0.0, *camera.translation])
    for study in studies.values():
        assert study.parameters.shape == (SEEDS, len(CALIBRATED))
        # Intervals of Student's t with 41 degrees of freedom; 200 draws of 95 % have a deviation of 1.5 %.
        inside = np.abs(study.parameters - truth) < 2.02 * study.deviation
        assert inside.mean(axis=0) == pytest.approx(np.full(11, 0.95), abs=0.06)


def test_errors_grow_with_the_noise_and_are_those_of_the_source(
    studies: dict[float, nav.sensing.CalibrationStudy],
) -> None:
    small, large = studies[0.3], studies[0.5]
    # Seed by seed the same noise, so errors scale with it as far as the camera is linear.
    ratio = large.place_error.mean() / small.place_error.mean()
    assert ratio == pytest.approx(0.5 / 0.3, rel=0.01)
    for study in (small, large):
        assert study.point_error.shape == (SEEDS, 26)
        assert study.place_bias.mean() < study.point_error.mean() < study.place_error.mean()
    # Section D.4: 4 mm in the mean and 25 mm at most; a centroid of half a pixel gives the mean.
    assert large.point_error.mean() == pytest.approx(4e-3, rel=0.1)
    assert large.point_error.max() < 25e-3


def test_noise_of_a_seed_does_not_depend_on_the_number_of_seeds() -> None:
    some, more = nav.sensing.calibration_study(seeds=2), nav.sensing.calibration_study(seeds=4)
    assert np.array_equal(some.place_error, more.place_error[:2])


def test_points_of_one_plane_need_a_start() -> None:
    camera, points = nav.sensing.Camera(), nav.sensing.calibration_points()
    flat = points[points[:, 2] == 0.0]
    with pytest.raises(InvalidParameterError, match="one plane"):
        nav.sensing.calibrate_camera(flat, camera.project(flat))
    near = replace(camera, focal_length=4.7e-3, translation=(2.6, 0.3, 4.3))
    fit = nav.sensing.calibrate_camera(flat, camera.project(flat), initial=near)
    assert fit.camera.focal_length == pytest.approx(camera.focal_length, rel=1e-6)


def test_what_cannot_be_calibrated_is_refused() -> None:
    camera, points = nav.sensing.Camera(), nav.sensing.calibration_points()
    pixels = camera.project(points)
    with pytest.raises(InvalidParameterError, match="six"):
        nav.sensing.calibrate_camera(points[:5], pixels[:5])
    with pytest.raises(ShapeError, match="pixels"):
        nav.sensing.calibrate_camera(points, pixels[:-1])
    with pytest.raises(InvalidParameterError, match="pixels"):
        nav.sensing.calibrate_camera(points, np.where(pixels > 900.0, NAN, pixels))
    with pytest.raises(InvalidParameterError, match="initial"):
        nav.sensing.calibrate_camera(points, pixels, initial="near")  # type: ignore[arg-type]  # wrong on purpose
    with pytest.raises(InvalidParameterError, match="right-handed"):
        nav.sensing.calibrate_camera(points * [-1.0, 1.0, 1.0], pixels)
    with pytest.raises((SimulationError, InvalidParameterError)):
        nav.sensing.calibrate_camera(np.repeat(points[:1], 8, axis=0), np.repeat(pixels[:1], 8, axis=0))


def test_calibration_says_how_to_get_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    points = nav.sensing.calibration_points()
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(MissingExtraError, match=r"pip install scipy"):
        nav.sensing.calibrate_camera(points, nav.sensing.Camera().project(points))
