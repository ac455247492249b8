"""Calibration of a camera from points that it shows (needs SciPy: ``pip install scipy``)."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, instance, pair
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import HrsafetyError, InvalidParameterError, MissingExtraError, ShapeError, SimulationError
from hrsafety.navigation.sensing.camera import Camera, _as_matrix, _as_triple, _picture_size, _rows, nearest_rotation
from hrsafety.navigation.sensing.linear_camera import linear_camera

__all__ = ["CALIBRATED", "CameraCalibration", "calibrate_camera"]

#: Calibrated numbers in the order of a covariance: lens, small turn of the camera about the axes of
#: the camera in rad, translation.
CALIBRATED = (
    "focal_length",
    "radial_distortion",
    "horizontal_scale",
    "image_center_x_px",
    "image_center_y_px",
    "turn_x",
    "turn_y",
    "turn_z",
    "translation_x",
    "translation_y",
    "translation_z",
)

# Columns of the image center that fits start from, as shares of the width: center and distortion
# replace each other, which leaves local minima. Of 400 random cameras with centers within 0.2
# widths and distortions up to 35 % all are found from these three, 389 from the middle one alone.
_CENTERS = (0.3, 0.5, 0.7)
_ROUGH = 1e-6  # tolerance of the fits with a fixed center
_FINE = 1e-15  # tolerance of the others: to rounding
_IMAGE_CENTER = slice(3, 5)
# Residual in pixels of a trial camera that shows a point nowhere: the step is refused.
_NOWHERE = 1e6
# A singular value that says nothing, relative to the largest, after scaling every parameter.
_SINGULAR = 1e-12


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CameraCalibration:
    """A camera from points of the world and their pixels.

    The order of the eleven numbers is that of `CALIBRATED`.

    Attributes
    ----------
    camera : Camera
        The camera that shows the points nearest to their pixels.
    covariance : ndarray of shape (11, 11)
        Covariance of the numbers, s^2 (J^T J)^-1, with SI units and pixels.
    deviation : ndarray of shape (11,)
        Standard deviations, the roots of its diagonal.
    residual_px : ndarray of shape (n, 2)
        Pixels shown less pixels given.
    pixel_deviation_px : float
        Standard deviation s of the residuals, per coordinate; NaN without degrees of freedom.
    degrees_of_freedom : int
        2 n - 11.
    position_error : ndarray of shape (n,)
        Horizontal distance of each point from what the camera makes of its pixel at the point's
        height, in m: the error that section D.4 of Zeng (2011) states.
    evaluations : int
        Evaluations of the projection that the fits took.
    """

    camera: Camera
    covariance: Array
    deviation: Array
    residual_px: Array
    pixel_deviation_px: float
    degrees_of_freedom: int
    position_error: Annotated[Array, "m"]
    evaluations: int

    @property
    def mean_position_error(self) -> float:
        """Mean of `position_error`, in m."""
        return float(self.position_error.mean())

    @property
    def max_position_error(self) -> float:
        """Maximum of `position_error`, in m."""
        return float(self.position_error.max())


def calibrate_camera(
    points: npt.ArrayLike,
    pixels: npt.ArrayLike,
    *,
    pixel_size: tuple[float, float] = (4.65e-6, 4.65e-6),
    image_size_px: tuple[int, int] = (1024, 768),
    initial: Camera | None = None,
) -> CameraCalibration:
    """Return the camera of Tsai's model that shows points at given pixels.

    Eleven numbers are fitted by least squares of the pixels (Levenberg and Marquardt, analytic
    derivatives): focal length, distortion, horizontal scale, center, rotation, translation. The
    start is the linear camera without distortion (direct linear transformation), with the image
    center moved to three places of which the best fit counts, so the points must not lie in one
    plane unless a start is given. Section D.4 of Zeng (2011) uses 26 points, 20
    on the floor and 6 above it.

    Parameters
    ----------
    points : array_like of shape (n, 3)
        Points (X, Y, Z) of the world in m, at least six.
    pixels : array_like of shape (n, 2)
        Their pixels, with fractions.
    pixel_size : tuple of float
        Width and height of a pixel on the sensor in m. It cannot be found from points: only its
        ratio to the focal length shows in a picture.
    image_size_px : tuple of int
        Width and height of the picture, in pixels.
    initial : Camera or None
        Start of the fit; its pixel and picture size replace those above. ``None``: the linear
        camera.

    Returns
    -------
    CameraCalibration
        The camera with covariance and errors.

    Raises
    ------
    InvalidParameterError
        If there are too few points, a number is not finite, or all points lie in one plane and
        no start is given.
    ShapeError
        If a shape is wrong.
    SimulationError
        If the fit fails, or the points leave a number open.
    MissingExtraError
        If SciPy is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> x, y, z = np.meshgrid([0.5, 2.0, 3.5], [-0.3, 0.6, 1.5], [0.0, 0.8])
    >>> points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    >>> fit = nav.sensing.calibrate_camera(points, nav.sensing.Camera().project(points))
    >>> round(fit.camera.focal_length, 9), round(fit.camera.radial_distortion, 3)
    (0.00476, 16800.0)
    """
    places, shown = _rows("points", points, 3), _rows("pixels", pixels, 2)
    if len(places) != len(shown):
        raise ShapeError("pixels", f"({len(places)}, 2)", shown.shape)
    if len(places) < 6:
        raise InvalidParameterError("points", "be at least six", len(places))
    if initial is None:
        sizes = (pair("pixel_size", pixel_size), _picture_size(image_size_px))
        fit = _Fit(linear_camera(places, shown, *sizes), places, shown)
        results = fit.solved_from_everywhere()
    else:
        fit = _Fit(instance("initial", initial, Camera), places, shown)
        results = [fit.solved(fit.start(), _FINE)]
    best = min(results, key=lambda result: float(result.cost))
    if best.status <= 0 or not np.isfinite(best.x).all():
        raise SimulationError(f"the calibration did not converge: {best.message}")
    return _calibration(fit, best.x, sum(int(result.nfev) for result in results))


class _Fit:
    """Residuals and derivatives of a camera near a first one."""

    def __init__(self, first: Camera, points: Array, pixels: Array) -> None:
        self.first, self.points, self.pixels = first, points, pixels

    def start(self) -> Array:
        """Return the numbers of the first camera; its turn is zero."""
        camera = self.first
        lens = (camera.focal_length, camera.radial_distortion, camera.horizontal_scale)
        return np.array([*lens, *camera.image_center_px, 0.0, 0.0, 0.0, *camera.translation])

    def shown(self, values: Array) -> tuple[Array, Array]:
        """Return pixels and derivatives of the points; NaN where the camera shows nothing."""
        return self.first._native.linearize(values.tolist(), self.points)

    def residuals(self, values: Array) -> Array:
        """Return the differences of the pixels."""
        try:
            pixels, _ = self.shown(values)
        except HrsafetyError:
            return np.full(self.pixels.size, _NOWHERE)
        return np.nan_to_num((pixels - self.pixels).ravel(), nan=_NOWHERE)

    def slopes(self, values: Array) -> Array:
        """Return the derivatives of the residuals."""
        return self.shown(values)[1]

    def solved(self, start: Array, tolerance: float, *, fixed_center: bool = False) -> Any:
        """Return the result of SciPy from a start; ``x`` holds all numbers."""
        free = np.ones(len(start), dtype=np.bool_)
        free[_IMAGE_CENTER] = not fixed_center

        def whole(values: Array) -> Array:
            every = start.copy()
            every[free] = values
            return every

        result = scipy_least_squares()(
            lambda values: self.residuals(whole(values)),
            start[free],
            jac=lambda values: self.slopes(whole(values))[:, free],
            method="lm",
            x_scale="jac",
            xtol=tolerance,
            ftol=tolerance,
            gtol=tolerance,
        )
        result.x = whole(result.x)
        return result

    def solved_from_everywhere(self) -> list[Any]:
        """Return fits of all numbers that begin with the image center at several columns."""
        width, height = self.first.image_size_px
        results = []
        for share in _CENTERS:
            start = self.start()
            start[_IMAGE_CENTER] = share * width, 0.5 * height
            rough = self.solved(start, _ROUGH, fixed_center=True)
            results.append(self.solved(rough.x, _FINE))
        return results

    def camera(self, values: Array) -> Camera:
        """Return the camera with these numbers."""
        focal_length, distortion, scale, x, y = (float(value) for value in values[:5])
        turned = np.array(self.first._native.turned(values.tolist()))
        return replace(
            self.first,
            focal_length=focal_length,
            radial_distortion=distortion,
            horizontal_scale=scale,
            image_center_px=(x, y),
            rotation=_as_matrix(nearest_rotation(turned)),
            translation=_as_triple(values[8:]),
        )


def _calibration(fit: _Fit, values: Array, evaluations: int) -> CameraCalibration:
    camera = fit.camera(values)
    # About the camera that was found, so that turns and their covariance are about its own axes.
    again = _Fit(camera, fit.points, fit.pixels)
    pixels, slopes = again.shown(again.start())
    residual = pixels - fit.pixels
    freedom = residual.size - len(values)
    deviation = float(np.sqrt((residual**2).sum() / freedom)) if freedom else float("nan")
    covariance = _covariance(slopes) * deviation**2
    heights = np.ascontiguousarray(fit.points[:, 2])
    offset = camera.reconstruct(fit.pixels, heights)[:, :2] - fit.points[:, :2]
    return CameraCalibration(
        camera=camera,
        covariance=covariance,
        deviation=np.sqrt(np.diagonal(covariance)),
        residual_px=residual,
        pixel_deviation_px=deviation,
        degrees_of_freedom=freedom,
        position_error=np.hypot(offset[:, 0], offset[:, 1]),
        evaluations=evaluations,
    )


def _covariance(slopes: Array) -> Array:
    """Return (J^T J)^-1 from the singular values of J with columns of length one."""
    lengths = np.linalg.norm(slopes, axis=0)
    _, values, right = np.linalg.svd(slopes / np.where(lengths > 0.0, lengths, 1.0), full_matrices=False)
    if not lengths.all() or values[-1] < _SINGULAR * values[0]:
        raise SimulationError("the points leave a number of the camera open")
    half = right.T / values / lengths[:, None]
    covariance: Array = half @ half.T
    return covariance


def scipy_least_squares() -> Any:
    """Return the function of SciPy, or say how to get it."""
    try:
        from scipy.optimize import least_squares
    except ImportError as error:
        raise MissingExtraError("calibration needs SciPy: pip install scipy") from error
    return least_squares
