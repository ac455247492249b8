"""Wheel speeds from the motion of a robot and back, and slip."""

from __future__ import annotations

from dataclasses import field

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, number, numbers, positive, vector
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["DifferentialKinematics", "OmniKinematics", "Slip"]


def _rows(name: str, value: object, size: int) -> tuple[Array, tuple[int, ...]]:
    array = numbers(name, value)
    if array.ndim not in (1, 2) or array.shape[-1] != size:
        raise ShapeError(name, f"({size},) or (n, {size})", array.shape)
    return np.ascontiguousarray(array.reshape(-1, size)), array.shape


def _headings(value: object, count: int) -> Array:
    array = numbers("heading", value)
    if array.ndim and array.shape != (count,):
        raise ShapeError("heading", f"() or ({count},)", array.shape)
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))


@dataclass(frozen=True, kw_only=True, slots=True)
class OmniKinematics(Parameters):
    """Three omni-wheels with axes at 120, 240 and 0 degrees, (D.1.2) of Zeng (2011).

    Parameters
    ----------
    wheel_radius : float
        r_w in m. Not in the thesis: that of its other robot, whose wheels have the same motors.
    center_distance : float
        Distance l_w of the wheels from the center of the robot, in m. Not in the thesis.

    Raises
    ------
    InvalidParameterError
        If a length is not finite and positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> robot = nav.robots.OmniKinematics()
    >>> robot.body_velocity(robot.wheel_speeds([0.3, -0.2, 1.0])).round(12)
    array([ 0.3, -0.2,  1. ])
    """

    wheel_radius: float = 0.025
    center_distance: float = 0.17
    _native: _hrsafety.OmniKinematics = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(_native=_hrsafety.OmniKinematics(**self._as_numbers("wheel_radius", "center_distance")))

    def wheel_speeds(self, velocity: npt.ArrayLike, *, heading: npt.ArrayLike = 0.0) -> Array:
        """Return the wheel speeds for a velocity, (D.1.4) of Zeng (2011).

        Parameters
        ----------
        velocity : array_like of shape (3,) or (n, 3)
            Velocity along x and y in m/s and turn rate in rad/s, in the world.
        heading : array_like of shape () or (n,)
            Of the robot, in rad; 0 makes the world the frame of the robot.

        Returns
        -------
        ndarray of shape (3,) or (n, 3)
            In rad/s.

        Raises
        ------
        ShapeError
            If a shape is another.
        """
        rows, shape = _rows("velocity", velocity, 3)
        return self._native.wheel_speeds(rows, _headings(heading, len(rows))).reshape(shape)

    def body_velocity(self, speeds: npt.ArrayLike, *, heading: npt.ArrayLike = 0.0) -> Array:
        """Return the velocity for wheel speeds, the inverse of (D.1.4).

        Parameters
        ----------
        speeds : array_like of shape (3,) or (n, 3)
            Of the wheels, in rad/s.
        heading : array_like of shape () or (n,)
            Of the robot, in rad.

        Returns
        -------
        ndarray of shape (3,) or (n, 3)
            Velocity along x and y in m/s and turn rate in rad/s, in the world.

        Raises
        ------
        ShapeError
            If a shape is another.
        """
        rows, shape = _rows("speeds", speeds, 3)
        return self._native.body_velocity(rows, _headings(heading, len(rows))).reshape(shape)


@dataclass(frozen=True, kw_only=True, slots=True)
class DifferentialKinematics(Parameters):
    """Two driven wheels on one axis, the right one first, (E.1.3) of Zeng (2011).

    Parameters
    ----------
    wheel_radius : float
        r_w in m.
    span : float
        Distance l between the wheels, in m.

    Raises
    ------
    InvalidParameterError
        If a length is not finite and positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.robots.DifferentialKinematics().wheel_speeds([0.7, 0.0])
    array([28., 28.])
    """

    wheel_radius: float = 0.025
    span: float = 0.28
    _native: _hrsafety.DifferentialKinematics = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(_native=_hrsafety.DifferentialKinematics(**self._as_numbers("wheel_radius", "span")))

    def wheel_speeds(self, motion: npt.ArrayLike) -> Array:
        """Return the wheel speeds for a motion, (E.1.3) of Zeng (2011).

        Parameters
        ----------
        motion : array_like of shape (2,) or (n, 2)
            Speed in m/s and turn rate in rad/s.

        Returns
        -------
        ndarray of shape (2,) or (n, 2)
            In rad/s.

        Raises
        ------
        ShapeError
            If the shape is another.
        """
        rows, shape = _rows("motion", motion, 2)
        return self._native.wheel_speeds(rows).reshape(shape)

    def body_velocity(self, speeds: npt.ArrayLike) -> Array:
        """Return speed and turn rate for wheel speeds, (E.1.4) with 4/l where 1/l is printed.

        Parameters
        ----------
        speeds : array_like of shape (2,) or (n, 2)
            Of the right and the left wheel, in rad/s.

        Returns
        -------
        ndarray of shape (2,) or (n, 2)
            Speed in m/s and turn rate in rad/s.

        Raises
        ------
        ShapeError
            If the shape is another.
        """
        rows, shape = _rows("speeds", speeds, 2)
        return self._native.body_velocity(rows).reshape(shape)

    def world_velocity(self, speeds: npt.ArrayLike, *, heading: npt.ArrayLike) -> Array:
        """Return the velocity in the world for wheel speeds, (E.1.5) with the same correction.

        Parameters
        ----------
        speeds : array_like of shape (2,) or (n, 2)
            Of the right and the left wheel, in rad/s.
        heading : array_like of shape () or (n,)
            Of the robot, in rad.

        Returns
        -------
        ndarray of shape (3,) or (n, 3)
            Velocity along x and y in m/s and turn rate in rad/s.

        Raises
        ------
        ShapeError
            If a shape is another.
        """
        rows, shape = _rows("speeds", speeds, 2)
        return self._native.world_velocity(rows, _headings(heading, len(rows))).reshape((*shape[:-1], 3))


@dataclass(frozen=True, kw_only=True, slots=True)
class Slip(Parameters):
    """How the ground speed of a wheel differs from the speed of its rim.

    The ground speed follows (1 - creep) r theta' and changes by at most `grip` per second: a wheel
    that accelerates or brakes harder spins or locks. The thesis gives no slip; a coefficient of
    friction mu allows about 9.81 mu m/s^2, so its 10 m/s^2 need mu of 1.02.

    Parameters
    ----------
    creep : float
        Share of the rim speed that is lost; negative for a wheel that is larger than assumed.
    grip : float
        Largest acceleration that the ground gives, in m/s^2; infinite for no limit.

    Raises
    ------
    InvalidParameterError
        If the creep is not between -1 and 1, or the grip not positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.robots.Slip(grip=5.0).ground_speed([0.2, 0.2, 0.2], period=0.02).round(12)
    array([0.1, 0.2, 0.2])
    """

    creep: float = 0.0
    grip: float = float("inf")
    _native: _hrsafety.Slip = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(_native=_hrsafety.Slip(**self._as_numbers("creep", "grip")))

    def ground_speed(self, rim_speed: npt.ArrayLike, *, start: float = 0.0, period: float = 1e-3) -> Array:
        """Return the ground speed of a wheel over time.

        Parameters
        ----------
        rim_speed : array_like of shape (n,)
            r theta' at the end of each period, in m/s.
        start : float
            Ground speed before the first period, in m/s.
        period : float
            In s.

        Returns
        -------
        ndarray of shape (n,)
            At the end of each period, in m/s.

        Raises
        ------
        InvalidParameterError
            If a value is out of range.
        """
        rim = vector("rim_speed", rim_speed)
        if not np.isfinite(rim).all():
            raise InvalidParameterError("rim_speed", "hold finite numbers", rim_speed)
        first = number("start", start)
        if not np.isfinite(first):
            raise InvalidParameterError("start", "be finite", start)
        return self._native.ground_speeds(rim, start=first, period=positive("period", period))
