"""Steps from echoes to forces, one by one: each is the one that a run evaluates."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, flag, number, numbers, word
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["attraction_force", "collision_point", "collision_vector", "printed_foot", "rotate_to_world"]


def collision_point(sensor: npt.ArrayLike, angle: npt.ArrayLike, reading: npt.ArrayLike) -> Array:
    """Return the point that an echo comes from, (11) and (13) of Avi (2019), corrected.

    P_i = S_i + r_i (cos th_i, sin th_i); the printed minus sign would put the obstacle behind the
    sensor, and the printed (13) leaves the sensor out.

    Parameters
    ----------
    sensor : array_like, shape (2,) or (n, 2)
        Places S_i of the sensors, x to the front, y to the left, in m.
    angle : array_like
        Angles th_i of their axes from the front, positive to the left, in rad.
    reading : array_like
        Readings r_i, in m.

    Returns
    -------
    ndarray of shape (2,) or (n, 2)
        In m, in the frame of the sensors.

    Raises
    ------
    InvalidParameterError
        If an argument is not made of finite numbers.
    ShapeError
        If the arrays do not broadcast.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.follower.collision_point((0.0, 0.15), 0.0, 1.0).tolist()
    [1.0, 0.15]
    """
    places, (axes, ranges) = _rows(("sensor", sensor), angle=angle, reading=reading)
    found: Array = _hrsafety.collision_points(places.reshape(-1, 2), axes, ranges)["point"]
    return _finite(found, sensor=places, angle=axes, reading=ranges).reshape(places.shape)


def collision_vector(one: npt.ArrayLike, other: npt.ArrayLike, *, clamp: bool = True) -> Array:
    """Return the collision vector of two echoes: foot of the perpendicular from the sensors.

    P - (P.d) d with the unit vector d of the line through both points: (14) of Avi (2019) as a
    vector, which has no singular direction.

    Parameters
    ----------
    one, other : array_like, shape (2,) or (n, 2)
        Points of the echoes, counted from the origin of the sensors, in m.
    clamp : bool
        Move a foot that lies outside to the end of the segment between the points.

    Returns
    -------
    ndarray of shape (2,) or (n, 2)
        In m; the point itself if both are one.

    Raises
    ------
    InvalidParameterError
        If a number is not finite.
    ShapeError
        If the points are of another shape.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.follower.collision_vector((1.0, -1.0), (1.0, 1.0)).tolist()
    [1.0, 0.0]
    """
    return _feet(one, other, "segment" if flag("clamp", clamp) else "line")


def printed_foot(one: npt.ArrayLike, other: npt.ArrayLike) -> Array:
    """Return what the printed components of (14) of Avi (2019) give; `collision_vector` is right.

    Printed: x_C = (V x_i - y_i)/(V + 1/V), y_C = (x_i + y_i/V)/(V + 1/V) with the slope V of the
    line. The sign of x_i in y_C is misprinted, so the vector is not perpendicular to the line.

    Parameters
    ----------
    one, other : array_like, shape (2,) or (n, 2)
        Points of the echoes, counted from the origin of the sensors, in m.

    Returns
    -------
    ndarray of shape (2,) or (n, 2)
        In m; NaN for lines along an axis, which have no slope or no inverse one.

    Raises
    ------
    InvalidParameterError
        If a number is not finite.
    ShapeError
        If the points are of another shape.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> points = (2.0, 0.0), (0.0, 2.0)
    >>> reactive.follower.printed_foot(*points).tolist(), reactive.follower.collision_vector(*points).tolist()
    ([1.0, -1.0], [1.0, 1.0])
    """
    return _feet(one, other, "printed")


def _feet(one: npt.ArrayLike, other: npt.ArrayLike, form: str) -> Array:
    first, second = numbers("one", one), numbers("other", other)
    if first.shape[-1:] != (2,) or first.ndim not in (1, 2):
        raise ShapeError("one", "(2,) or (n, 2)", first.shape)
    if second.shape != first.shape:
        raise ShapeError("other", str(first.shape), second.shape)
    rows = [np.ascontiguousarray(points).reshape(-1, 2) for points in (first, second)]
    found: Array = _hrsafety.collision_feet(*rows, form=form)["foot"]
    if form != "printed":  # that is NaN for lines along an axis
        _finite(found, one=first, other=second)
    return found.reshape(first.shape)


def _finite(found: Array, **given: Array) -> Array:
    """Return what follows from some numbers, or name the one of which it cannot be told."""
    if np.isfinite(found).all():
        return found
    for name, values in given.items():
        if not np.isfinite(values).all():
            raise InvalidParameterError(name, "be finite", float(values[~np.isfinite(values)][0]))
    name, values = max(given.items(), key=lambda each: float(np.abs(each[1]).max()))
    raise InvalidParameterError(name, "be so small that the result is finite", float(np.abs(values).max()))


def rotate_to_world(
    vector: npt.ArrayLike, heading: npt.ArrayLike, *, rotation: Literal["heading", "printed"] = "heading"
) -> Array:
    """Return a vector of the robot in the directions of the world, (15) of Avi (2019), corrected.

    [cos, -sin; sin, cos] for a counterclockwise heading.

    Parameters
    ----------
    vector : array_like, shape (2,) or (n, 2)
        In the frame of the robot.
    heading : array_like
        theta_R in rad.
    rotation : str
        ``"heading"``, or ``"printed"``: the printed matrix [cos, sin; -sin, cos], which turns the
        other way.

    Returns
    -------
    ndarray of shape (2,) or (n, 2)
        In the unit of the vector.

    Raises
    ------
    InvalidParameterError
        If an argument is not made of finite numbers, or the word is unknown.
    ShapeError
        If the arrays do not broadcast.

    Examples
    --------
    >>> import math
    >>> from hrsafety import reactive
    >>> reactive.follower.rotate_to_world((1.0, 0.0), math.pi / 2.0).round(12).tolist()
    [0.0, 1.0]
    """
    chosen = word("rotation", rotation, ("heading", "printed"))
    vectors, (headings,) = _rows(("vector", vector), heading=heading)
    found: Array = _hrsafety.vectors_to_world(vectors.reshape(-1, 2), headings, chosen)["vector"]
    return _finite(found, vector=vectors, heading=headings).reshape(vectors.shape)


def attraction_force(
    offset: npt.ArrayLike, velocity: npt.ArrayLike, *, stiffness: float = 2.0, damping: float = 1.0
) -> Array:
    """Return the attraction to the target, F_m = K_r (X_r - X_s) - D_r V of (18) of Avi (2019).

    Parameters
    ----------
    offset : array_like, shape (2,) or (n, 2)
        From the robot to the target, X_r - X_s, in m.
    velocity : array_like, shape (2,) or (n, 2)
        Virtual velocity V, in m/s.
    stiffness, damping : float
        K_r in N/m and D_r in N s/m; the defaults are those of `Follower`.

    Returns
    -------
    ndarray of shape (2,) or (n, 2)
        In N.

    Raises
    ------
    InvalidParameterError
        If a number is negative or an argument not made of finite numbers.
    ShapeError
        If the arrays are of different shapes.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.follower.attraction_force((5.0, 0.0), (0.5, 0.0)).tolist()
    [9.5, 0.0]
    """
    away, speed = numbers("offset", offset), numbers("velocity", velocity)
    if away.shape[-1:] != (2,) or away.ndim not in (1, 2):
        raise ShapeError("offset", "(2,) or (n, 2)", away.shape)
    if speed.shape != away.shape:
        raise ShapeError("velocity", str(away.shape), speed.shape)
    found: Array = _hrsafety.attraction_forces(
        *(np.ascontiguousarray(each).reshape(-1, 2) for each in (away, speed)),
        stiffness=number("stiffness", stiffness),
        damping=number("damping", damping),
    )["force"]
    return _finite(found, offset=away, velocity=speed).reshape(away.shape)


def _rows(first: tuple[str, npt.ArrayLike], **columns: npt.ArrayLike) -> tuple[Array, list[Array]]:
    """Return rows of two and columns as contiguous arrays of one length."""
    name, given = first
    rows = numbers(name, given)
    if rows.shape[-1:] != (2,) or rows.ndim not in (1, 2):
        raise ShapeError(name, "(2,) or (n, 2)", rows.shape)
    arrays = {own: numbers(own, value) for own, value in columns.items()}
    shape = rows.shape[:-1]
    for own, array in arrays.items():
        try:
            shape = np.broadcast_shapes(shape, array.shape)
        except ValueError:
            raise ShapeError(own, f"that broadcasts with {shape}", array.shape) from None
        if len(shape) > 1:
            raise ShapeError(own, "() or (n,)", array.shape)
    flat = [np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in arrays.values()]
    return np.ascontiguousarray(np.broadcast_to(rows, (*shape, 2))), flat
