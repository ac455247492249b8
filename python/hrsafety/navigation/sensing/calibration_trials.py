"""How far off positions are that a calibrated camera measures (needs SciPy: ``pip install scipy``)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, followed, instance, not_negative, positive
from hrsafety._bounds import MOST_SEEDS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.sensing.calibration import CameraCalibration, calibrate_camera
from hrsafety.navigation.sensing.camera import Camera, _rows

__all__ = ["CalibrationStudy", "calibration_points", "calibration_study", "patch_places"]

# Patches of the study: heights in m of one on the robot and of one on a shoulder.
PATCH_HEIGHTS = (0.3, 1.4)
# The workspace of the source's configurations that its camera sees, in m.
LEAST_SPACING = 1e-3
"""Points of a workspace are no nearer to each other, in m."""
_ACROSS, _ALONG = (0.0, 4.0), (-0.4, 1.4)
_RAISED = (
    *((0.4, 0.0, 0.5), (2.0, 1.0, 0.6), (3.6, 0.1, 0.8)),
    *((0.9, 0.6, 1.0), (2.0, -0.2, 1.4), (3.2, 0.6, 1.2)),
)


def calibration_points() -> Array:
    """Return 26 points to calibrate a camera with: 20 on the floor, 6 at different heights.

    As many as in section D.4 of Zeng (2011), which does not print where they were: here a grid over
    the workspace, x from 0 to 4 m and y from -0.4 to 1.4 m, and six chosen points from 0.5 to 1.4 m
    above it.

    Returns
    -------
    ndarray of shape (26, 3)
        Points (X, Y, Z) in m.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> int((nav.sensing.calibration_points()[:, 2] == 0.0).sum())
    20
    """
    x, y = np.meshgrid(np.linspace(*_ACROSS, 5), np.linspace(*_ALONG, 4))
    floor = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    return np.vstack([floor, np.array(_RAISED)])


def patch_places(camera: Camera, *, spacing: float = 0.2) -> Array:
    """Return places of color patches that a camera sees, away from its calibration points.

    Parameters
    ----------
    camera : Camera
        Places outside its picture are left out.
    spacing : float
        Distance of neighbors in m.

    Returns
    -------
    ndarray of shape (n, 3)
        Points over the workspace at 0.3 m (robot) and 1.4 m (shoulder), in m.

    Raises
    ------
    InvalidParameterError
        If the spacing is not finite and positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.patch_places(nav.sensing.Camera()).shape
    (411, 3)
    """
    instance("camera", camera, Camera)
    apart = positive("spacing", spacing)
    if apart < LEAST_SPACING:
        raise InvalidParameterError("spacing", f"be at least {LEAST_SPACING:g} m", spacing)
    axes = [np.arange(low, high + 0.5 * apart, apart) for low, high in (_ACROSS, _ALONG)]
    x, y = (values.ravel() for values in np.meshgrid(*axes))
    layers = [np.column_stack([x, y, np.full(x.size, height)]) for height in PATCH_HEIGHTS]
    places = np.vstack(layers)
    pixels = camera._native.project(places)
    shown = np.flatnonzero(np.isfinite(pixels).all(axis=1))
    return places[shown[camera.contains(pixels[shown])]]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CalibrationStudy:
    """Calibrations of one camera from the same points with different noise of their pixels.

    Attributes
    ----------
    camera : Camera
        The camera as it is.
    pixel_deviation_px : float
        Standard deviation of the noise of each pixel coordinate.
    points : ndarray of shape (n, 3)
        Calibration points in m.
    places : ndarray of shape (m, 3)
        Where patches are measured afterwards, in m.
    parameters : ndarray of shape (seeds, 11)
        Calibrated numbers in the order of `CALIBRATED`; turns are angles from the camera as it is.
    deviation : ndarray of shape (seeds, 11)
        Standard deviations that each calibration states for them.
    point_error : ndarray of shape (seeds, n)
        Horizontal errors of the calibration points, from the pixels that they were calibrated with,
        in m.
    place_error : ndarray of shape (seeds, m)
        Horizontal errors of the patches, from centroids with noise of the same size, in m.
    place_bias : ndarray of shape (seeds, m)
        The same from exact centroids: what the calibration alone is off, in m.
    """

    camera: Camera
    pixel_deviation_px: float
    points: Annotated[Array, "m"]
    places: Annotated[Array, "m"]
    parameters: Array
    deviation: Array
    point_error: Annotated[Array, "m"]
    place_error: Annotated[Array, "m"]
    place_bias: Annotated[Array, "m"]


def calibration_study(
    camera: Camera | None = None,
    *,
    pixel_deviation_px: float = 0.5,
    seeds: int = 200,
    points: npt.ArrayLike | None = None,
    places: npt.ArrayLike | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> CalibrationStudy:
    """Return position errors of a camera that is calibrated from noisy pixels, over many seeds.

    Gaussian noise is added to the pixels of the calibration points, the camera is calibrated, and
    patches elsewhere are measured with it. Seed k gives the same noise whatever the number of seeds.

    Parameters
    ----------
    camera : Camera or None
        The camera as it is; ``None``: that of the source.
    pixel_deviation_px : float
        Standard deviation of each coordinate of a centroid in pixels.
    seeds : int
        Number of calibrations, with seeds from 0 on.
    points : array_like of shape (n, 3) or None
        Calibration points in m; ``None``: those of `calibration_points`.
    places : array_like of shape (m, 3) or None
        Places of the patches in m; ``None``: those of `patch_places`.
    progress : callable or None
        Called with (calibrations done, calibrations in all) at the start and after each.

    Returns
    -------
    CalibrationStudy
        Errors of every calibration.

    Raises
    ------
    InvalidParameterError
        If a number is out of range or a point has no image.
    ShapeError
        If a shape is wrong.
    SimulationError
        If a calibration fails.
    MissingExtraError
        If SciPy is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> study = nav.sensing.calibration_study(pixel_deviation_px=0.3, seeds=3)
    >>> study.point_error.shape, bool(study.place_error.mean() < 0.01)
    ((3, 26), True)
    """
    actual = Camera() if camera is None else instance("camera", camera, Camera)
    deviation = not_negative("pixel_deviation_px", pixel_deviation_px)
    markers = calibration_points() if points is None else _rows("points", points, 3)
    patches = patch_places(actual) if places is None else _rows("places", places, 3)
    exact_markers, exact_patches = actual.project(markers), actual.project(patches)
    fits, errors, biases = [], [], []
    for seed in followed(range(count("seeds", seeds, most=MOST_SEEDS)), progress):
        source = np.random.default_rng(seed)
        shown = exact_markers + source.normal(0.0, 1.0, exact_markers.shape) * deviation
        noisy = exact_patches + source.normal(0.0, 1.0, exact_patches.shape) * deviation
        fit = calibrate_camera(markers, shown, pixel_size=actual.pixel_size, image_size_px=actual.image_size_px)
        fits.append(fit)
        errors.append(_horizontal(fit.camera, noisy, patches))
        biases.append(_horizontal(fit.camera, exact_patches, patches))
    return CalibrationStudy(
        camera=actual,
        pixel_deviation_px=deviation,
        points=markers,
        places=patches,
        parameters=np.array([_numbers(fit, actual) for fit in fits]),
        deviation=np.array([fit.deviation for fit in fits]),
        point_error=np.array([fit.position_error for fit in fits]),
        place_error=np.array(errors),
        place_bias=np.array(biases),
    )


def _horizontal(camera: Camera, pixels: Array, places: Array) -> Array:
    offset = camera.reconstruct(pixels, places[:, 2]) - places
    return np.hypot(offset[:, 0], offset[:, 1])


def _numbers(fit: CameraCalibration, actual: Camera) -> list[float]:
    """Return the calibrated numbers; the turn from the actual camera is small, so its matrix is I + [w]."""
    camera = fit.camera
    turn = np.array(camera.rotation) @ np.array(actual.rotation).T
    small = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    lens = (camera.focal_length, camera.radial_distortion, camera.horizontal_scale, *camera.image_center_px)
    return [*lens, *small.tolist(), *camera.translation]
