"""A camera above the floor: pixels of points, and points at a known height from pixels."""

from __future__ import annotations

from dataclasses import field

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, Parameters, count, number, numbers, pair, sequence, square
from hrsafety._bounds import MOST_PIXELS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Camera", "nearest_rotation"]

Triple = tuple[float, float, float]
Matrix = tuple[Triple, Triple, Triple]

# Appendix D.4 of Zeng (2011) as printed; orthonormal to 6e-7 only.
_PRINTED_ROTATION = (
    (-0.941126, -0.318152, -0.114288),
    (-0.053498, 0.473980, -0.878909),
    (0.333797, -0.821050, -0.463095),
)


def nearest_rotation(matrix: npt.ArrayLike) -> Array:
    """Return the rotation matrix that is nearest to a matrix.

    The orthonormal factor U V^T of the singular value decomposition U S V^T, which minimizes the
    sum of squared differences. Rounded rotation matrices become exact with it.

    Parameters
    ----------
    matrix : array_like of shape (3, 3)
        A rotation matrix with errors.

    Returns
    -------
    ndarray of shape (3, 3)
        Orthonormal, with determinant 1.

    Raises
    ------
    InvalidParameterError
        If an entry is not finite or the determinant is not positive.
    ShapeError
        If the shape is another one.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.nearest_rotation([[1.0, 0.001, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).round(6).tolist()
    [[1.0, 0.0005, 0.0], [-0.0005, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """
    given = square("matrix", matrix, 3)
    if not np.isfinite(given).all():
        raise InvalidParameterError("matrix", "be finite", float(given[~np.isfinite(given)][0]))
    if not np.linalg.det(given) > 0.0:
        raise InvalidParameterError("matrix", "have a positive determinant", float(np.linalg.det(given)))
    left, _, right = np.linalg.svd(given)
    rotation: Array = left @ right
    return rotation


def _as_matrix(array: Array) -> Matrix:
    first, second, third = (_as_triple(row) for row in array)
    return (first, second, third)


def _as_triple(array: Array) -> Triple:
    x, y, z = (float(entry) for entry in array)
    return (x, y, z)


_ROTATION = _as_matrix(nearest_rotation(_PRINTED_ROTATION))


@dataclass(frozen=True, kw_only=True, slots=True)
class Camera(Parameters):
    """A camera that stands still, with radial distortion after Tsai (1987).

    World to picture, with the corrected equations of section D.5 of Zeng (2011)::

        x = R X + T                              (6.4.4)
        u = f (x_1, x_2) / x_3
        u = d (1 + k |d|^2)                      (6.4.2), corrected
        pixel = C + (S d_1 / s_x, d_2 / s_y)     (6.4.1)

    Defaults are the calibration of section D.4. Picture and pixel size are not printed there:
    1024 x 768 pixels of 4.65 um show the workspace, 640 x 480 of 7.4 um do not.

    Parameters
    ----------
    focal_length : float
        Focal length f in m.
    radial_distortion : float
        Radial distortion k in 1/m^2; positive for a barrel.
    horizontal_scale : float
        Factor S on horizontal pixel numbers.
    image_center_px : tuple of float
        Center (C_x, C_y) of projection and distortion, in pixels. The center of the first pixel
        is (0, 0).
    pixel_size : tuple of float
        Width and height (s_x, s_y) of a pixel on the sensor, in m.
    image_size_px : tuple of int
        Width and height of the picture, in pixels.
    rotation : array_like of shape (3, 3)
        Rotation R from the world to the camera, orthonormal to 1e-9; `nearest_rotation` makes one
        of rounded numbers. Kept as tuples.
    translation : tuple of float
        Translation T from the world to the camera, in m.

    Attributes
    ----------
    position : tuple of float
        Where the camera is, -R^T T, in m.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or not positive where it must be, or the rotation is not one.
    ShapeError
        If a value has another shape.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> camera = nav.sensing.Camera()
    >>> [round(coordinate, 3) for coordinate in camera.position]
    [1.09, 4.162, 2.585]
    >>> pixels = camera.project([[2.0, 0.6, 0.0]])
    >>> pixels.round(2).tolist()
    [[484.54, 414.38]]
    >>> camera.reconstruct(pixels, 0.0).round(9).tolist()
    [[2.0, 0.6, 0.0]]
    """

    focal_length: float = 4.76e-3
    radial_distortion: float = 1.68e4
    horizontal_scale: float = 0.987
    image_center_px: Pair = (355.3, 292.1)
    pixel_size: Pair = (4.65e-6, 4.65e-6)
    image_size_px: tuple[int, int] = (1024, 768)
    rotation: Matrix = _ROTATION
    translation: Triple = (2.6458, 0.35738, 4.25018)
    position: Triple = field(init=False, repr=False, compare=False)
    _native: _hrsafety.Camera = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        scalars = self._as_numbers("focal_length", "radial_distortion", "horizontal_scale")
        self._set(image_center_px=pair("image_center_px", self.image_center_px))
        self._set(pixel_size=pair("pixel_size", self.pixel_size))
        self._set(image_size_px=_picture_size(self.image_size_px))
        self._set(rotation=_as_matrix(square("rotation", self.rotation, 3)))
        self._set(translation=_triple("translation", self.translation))
        native = _hrsafety.Camera(
            **scalars,
            image_center=self.image_center_px,
            pixel_size=self.pixel_size,
            image_size=self.image_size_px,
            rotation=self.rotation,
            translation=self.translation,
        )
        self._set(_native=native, position=native.position())

    def project(self, points: npt.ArrayLike) -> Array:
        """Return the pixels of points of the world.

        Parameters
        ----------
        points : array_like of shape (n, 3)
            Points (X, Y, Z) in m, Z up from the floor.

        Returns
        -------
        ndarray of shape (n, 2)
            Pixel numbers with fractions; they may lie outside the picture, see `contains`.

        Raises
        ------
        InvalidParameterError
            If a point is not finite, lies behind the camera, or farther out than the lens maps.
        ShapeError
            If the shape is another one.
        """
        places = _rows("points", points, 3)
        pixels = self._native.project(places)
        _require_all("points", "lie in front of the camera and within the reach of its lens", places, pixels)
        return pixels

    def contains(self, pixels: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return whether pixels lie in the picture.

        Parameters
        ----------
        pixels : array_like of shape (n, 2)
            Pixel numbers.

        Returns
        -------
        ndarray of bool, shape (n,)
            True from half a pixel before the first to half a pixel after the last.

        Raises
        ------
        InvalidParameterError
            If a number is not finite.
        ShapeError
            If the shape is another one.
        """
        return np.array(self._native.contains(_rows("pixels", pixels, 2)), dtype=np.bool_)

    def reconstruct(self, pixels: npt.ArrayLike, height: npt.ArrayLike) -> Array:
        """Return the points at known heights that pixels show.

        The ray of a pixel meets the plane Z = height; (6.4.3) is printed garbled.

        Parameters
        ----------
        pixels : array_like of shape (n, 2)
            Pixel numbers with fractions, e.g. centroids of color patches.
        height : float or array_like of shape (n,)
            Height Z of the points in m.

        Returns
        -------
        ndarray of shape (n, 3)
            Points (X, Y, Z) in m.

        Raises
        ------
        InvalidParameterError
            If a number is not finite, or a ray does not meet its plane in front of the camera.
        ShapeError
            If a shape is another one.
        """
        places = _rows("pixels", pixels, 2)
        heights = _heights(height, len(places))
        points = self._native.reconstruct(places, heights)
        _require_all("pixels", "show a point of the plane", places, points)
        return points


def _rows(name: str, value: npt.ArrayLike, width: int) -> Array:
    array = numbers(name, value)
    if array.ndim != 2 or array.shape[1] != width:
        raise ShapeError(name, f"(n, {width})", array.shape)
    if not np.isfinite(array).all():
        raise InvalidParameterError(name, "be finite", float(array[~np.isfinite(array)][0]))
    return array


def _heights(value: npt.ArrayLike, length: int) -> Array:
    array = numbers("height", value)
    if array.shape not in ((), (length,)):
        raise ShapeError("height", f"() or ({length},)", array.shape)
    if not np.isfinite(array).all():
        raise InvalidParameterError("height", "be finite", float(array[~np.isfinite(array)][0]))
    return np.ascontiguousarray(np.broadcast_to(array, (length,)))


def _require_all(name: str, rule: str, given: Array, found: Array) -> None:
    missing = np.isnan(found[:, 0])
    if missing.any():
        first = int(missing.argmax())
        raise InvalidParameterError(f"{name}[{first}]", rule, tuple(given[first].tolist()))


def _picture_size(value: object) -> tuple[int, int]:
    parts = sequence("image_size_px", "be two whole numbers", value)
    if len(parts) != 2:
        raise ShapeError("image_size_px", "(2,)", (len(parts),))
    width, height = (count("image_size_px", part, most=MOST_PIXELS) for part in parts)
    if max(width, height) >= 2**32:
        raise InvalidParameterError("image_size_px", "be below 2^32", (width, height))
    return (width, height)


def _triple(name: str, value: object) -> Triple:
    parts = sequence(name, "be three numbers", value)
    if len(parts) != 3:
        raise ShapeError(name, "(3,)", (len(parts),))
    x, y, z = (number(name, part) for part in parts)
    return (x, y, z)
