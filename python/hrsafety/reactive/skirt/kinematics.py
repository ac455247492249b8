"""Kinematics of a platform with three omni-wheels."""

from __future__ import annotations

from dataclasses import field

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, numbers
from hrsafety._records import dataclass
from hrsafety.errors import ShapeError

__all__ = ["TriOmniKinematics"]


@dataclass(frozen=True, kw_only=True, slots=True)
class TriOmniKinematics(Parameters):
    """Wheel speeds of a platform with omni-wheels at 90, 210 and 330 deg, and their inverse.

    Defaults are the robot of Gussu and Lin (2017). Signs matter: with magnitudes only, as in its
    Algorithm 1, a robot that should translate at 0.3 m/s spins at about -0.6 rad/s.

    Parameters
    ----------
    wheel_radius : float
        r_w in m.
    wheel_width : float
        b_w in m.
    chassis_radius : float
        R in m; the wheel centers are R - b_w/2 from the center.

    Raises
    ------
    InvalidParameterError
        If a size is not finite and positive, or the wheels are too wide.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> platform = reactive.skirt.TriOmniKinematics()
    >>> platform.wheel_speeds([0.3, 0.0]).round(6).tolist()
    [4.8, -2.4, -2.4]
    """

    wheel_radius: float = 0.0625
    wheel_width: float = 0.038
    chassis_radius: float = 0.33
    _native: _hrsafety.TriOmniKinematics = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        sizes = self._as_numbers("wheel_radius", "wheel_width", "chassis_radius")
        self._set(_native=_hrsafety.TriOmniKinematics(**sizes))

    def wheel_speeds(self, velocity: npt.ArrayLike, yaw_rate: npt.ArrayLike = 0.0) -> Array:
        """Return the wheel speeds for a motion of the body.

        Parameters
        ----------
        velocity : array_like, shape (..., 2)
            Velocity in the frame of the body, in m/s.
        yaw_rate : array_like, shape (...)
            phi' in rad/s, counterclockwise.

        Returns
        -------
        ndarray, shape (..., 3)
            omega in rad/s, positive about the outward axles: -(t . v + (R - b_w/2) phi') / r_w with
            the tangents t of (14) and Table 2 of Gussu and Lin (2017).

        Raises
        ------
        InvalidParameterError
            If something is no number.
        ShapeError
            If the last axis of velocity is not 2, or the shapes do not broadcast.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.skirt.TriOmniKinematics().wheel_speeds([0.0, 0.0], 1.0).round(3).tolist()
        [-4.976, -4.976, -4.976]
        """
        linear = _rows("velocity", velocity, 2)
        rate = numbers("yaw_rate", yaw_rate)
        try:
            shape = np.broadcast_shapes(linear.shape[:-1], rate.shape)
        except ValueError:
            raise ShapeError("yaw_rate", f"that broadcasts with {linear.shape[:-1]}", rate.shape) from None
        flat = np.ascontiguousarray(np.broadcast_to(linear, (*shape, 2))).reshape(-1, 2)
        rates = np.ascontiguousarray(np.broadcast_to(rate, shape)).reshape(-1)
        return self._native.wheel_speeds(flat, rates).reshape(*shape, 3)

    def body_velocity(self, wheel_speeds: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the motion of the body for wheel speeds: the inverse of `wheel_speeds`.

        Parameters
        ----------
        wheel_speeds : array_like, shape (..., 3)
            omega in rad/s, positive about the outward axles.

        Returns
        -------
        velocity : ndarray, shape (..., 2)
            In the frame of the body, in m/s: two thirds of the sum of the rim velocities; (10) of
            Gussu and Lin (2017) lacks the factor.
        yaw_rate : ndarray, shape (...)
            phi' in rad/s: mean of the rim speeds over R - b_w/2.

        Raises
        ------
        InvalidParameterError
            If something is no number.
        ShapeError
            If the last axis is not 3.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> velocity, yaw_rate = reactive.skirt.TriOmniKinematics().body_velocity([4.8, -2.4, -2.4])
        >>> velocity.round(12).tolist(), abs(float(yaw_rate)) < 1e-14
        ([0.3, 0.0], True)
        """
        speeds = _rows("wheel_speeds", wheel_speeds, 3)
        shape = speeds.shape[:-1]
        linear, rates = self._native.body_velocity(np.ascontiguousarray(speeds.reshape(-1, 3)))
        return linear.reshape(*shape, 2), rates.reshape(shape)


def _rows(name: str, value: npt.ArrayLike, size: int) -> Array:
    array = numbers(name, value, "be an array of numbers")
    if array.ndim == 0 or array.shape[-1] != size:
        raise ShapeError(name, f"(..., {size})", array.shape)
    return array
