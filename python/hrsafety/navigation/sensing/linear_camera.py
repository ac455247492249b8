"""The camera without distortion that shows points nearest to their pixels, in closed form."""

from __future__ import annotations

import numpy as np

from hrsafety._arguments import Array, Pair
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.sensing.camera import Camera, _as_matrix, _as_triple, nearest_rotation

__all__ = ["linear_camera"]

# Points on planes only: the singular value of a plane relative to the largest.
_FLAT = 1e-6


def linear_camera(points: Array, pixels: Array, pixel_size: Pair, image_size_px: tuple[int, int]) -> Camera:
    """Return the camera without distortion of the direct linear transformation.

    Pixel ~ P (X, 1): P is the singular vector of the smallest singular value, with points and
    pixels centered and scaled to unit spread; P = K (R | T) by a triangular decomposition.
    """
    to_points, to_pixels = _standardizing(points), _standardizing(pixels)
    world = np.column_stack([points, np.ones(len(points))]) @ to_points.T
    spread = np.linalg.svd(world[:, :3], compute_uv=False)
    if spread[-1] < _FLAT * spread[0]:
        raise InvalidParameterError(
            "points", "not lie in one plane unless initial is given", Shown("points of one plane")
        )
    picture = np.column_stack([pixels, np.ones(len(pixels))]) @ to_pixels.T
    nothing = np.zeros_like(world)
    rows = [np.hstack([world, nothing, -picture[:, :1] * world]), np.hstack([nothing, world, -picture[:, 1:2] * world])]
    solution = np.linalg.svd(np.vstack(rows))[2][-1].reshape(3, 4)
    projection = np.linalg.solve(to_pixels, solution @ to_points)
    depth = projection[2, :3] @ points.mean(axis=0) + projection[2, 3]
    projection *= np.sign(depth) / np.linalg.norm(projection[2, :3])
    inner, rotation = _upper_times_rotation(projection[:, :3])
    if np.linalg.det(rotation) < 0.0:
        raise InvalidParameterError("points", "be in a right-handed frame, as their pixels", Shown("a mirror image"))
    focal = inner[1, 1] * pixel_size[1]
    return Camera(
        focal_length=focal,
        radial_distortion=0.0,
        horizontal_scale=inner[0, 0] * pixel_size[0] / focal,
        image_center_px=(inner[0, 2], inner[1, 2]),
        pixel_size=pixel_size,
        image_size_px=image_size_px,
        rotation=_as_matrix(nearest_rotation(rotation)),
        translation=_as_triple(np.linalg.solve(inner, projection[:, 3]).astype(np.float64)),
    )


def _standardizing(places: Array) -> Array:
    """Return the homogeneous matrix that moves the mean to the origin and scales the spread to one."""
    size = places.shape[1]
    scale = np.sqrt(size) / max(float(np.sqrt(((places - places.mean(axis=0)) ** 2).sum(axis=1).mean())), 1e-300)
    matrix = np.eye(size + 1)
    matrix[:size, :size] *= scale
    matrix[:size, size] = -scale * places.mean(axis=0)
    return matrix


def _upper_times_rotation(matrix: Array) -> tuple[Array, Array]:
    """Return an upper triangular matrix with a positive diagonal and an orthonormal one."""
    orthonormal, upper = np.linalg.qr(matrix[::-1].T)
    inner, rotation = upper.T[::-1, ::-1], orthonormal.T[::-1]
    signs = np.sign(np.diagonal(inner))
    return inner * signs, signs[:, None] * rotation
