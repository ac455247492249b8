"""Controller of the pneumatic cylinder that stands for the torso in the experiments."""

from __future__ import annotations

from dataclasses import field

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, number
from hrsafety._records import dataclass

__all__ = ["CylinderController"]


@dataclass(frozen=True, kw_only=True, slots=True)
class CylinderController(Parameters):
    """Feed-forward and proportional-derivative control of the cylinder that carries the head.

    Section A.3 of Zeng (2011); its gains are the defaults. They are for a command in V and
    positions in m, and keep the piston at constant speed before the impact.

    Parameters
    ----------
    acceleration_gain : float
        K_ffa in V s^2/m.
    velocity_gain : float
        K_ffv in V s/m.
    proportional : float
        K_p in V/m.
    derivative : float
        K_d in V s/m.
    sample_time : float
        T_s in s.

    Raises
    ------
    InvalidParameterError
        If a gain is negative or not finite, or the sample time is not positive.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.joints.CylinderController().derivative
    14.9
    """

    acceleration_gain: float = 0.34
    velocity_gain: float = 0.44
    proportional: float = 208.5
    derivative: float = 14.9
    sample_time: float = 0.001
    _native: _hrsafety.CylinderController = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("acceleration_gain", "velocity_gain", "proportional", "derivative", "sample_time")
        self._set(_native=_hrsafety.CylinderController(**self._as_numbers(*names)))

    def command(
        self,
        *,
        desired_position: float,
        desired_velocity: float,
        desired_acceleration: float = 0.0,
        position: float,
        velocity: float,
    ) -> float:
        """Return the command of the valve.

        u = K_ffa p_d'' + K_ffv p_d' + K_p (p_d - p) + K_d (p_d' - p'), (A.3.1).

        Parameters
        ----------
        desired_position, desired_velocity, desired_acceleration : float
            p_d and its rates, in m, m/s and m/s^2.
        position, velocity : float
            p and its rate, in m and m/s.

        Returns
        -------
        float
            In V.

        Raises
        ------
        InvalidParameterError
            If a value is not finite.

        Examples
        --------
        >>> from hrsafety import impact
        >>> controller = impact.joints.CylinderController()
        >>> round(controller.command(desired_position=0.1, desired_velocity=1.0, position=0.099, velocity=0.98), 6)
        0.9465
        """
        return self._native.command(
            desired_position=number("desired_position", desired_position),
            desired_velocity=number("desired_velocity", desired_velocity),
            desired_acceleration=number("desired_acceleration", desired_acceleration),
            position=number("position", position),
            velocity=number("velocity", velocity),
        )
