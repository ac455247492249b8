"""Joints, and what two of them make of an arm: inertia and speed of the impact point."""

from __future__ import annotations

from dataclasses import field

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, number, numbers, pair
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.parameters import Manipulator

__all__ = ["Joint", "dashpots_in_series", "impact_point_speed", "uniform_links"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Joint(Parameters):
    """Elastic joint under proportional-derivative control, as one spring and one damper.

    The mechanical part (m) and the control (c) act in series. With the torque
    tau_J = (K_J + C_J s)(theta_d - theta_J) the reduced stiffness and damping are

        K_J = K_m K_c / (K_m + K_c),    C_J = (K_c^2 C_m + K_m^2 C_c) / (K_m + K_c)^2,

    section 3.4 of Zeng (2011) with the sign of (3.4.6) and (3.4.7) reversed. What the
    reduction leaves out is `model_error`.

    Parameters
    ----------
    inertia : float
        Inertia of the link about the joint, in kg m^2.
    mechanical_stiffness, mechanical_damping : float
        K_m in N m/rad and C_m in N m s/rad, of transmission and shaft.
    control_stiffness, control_damping : float
        K_c in N m/rad and C_c in N m s/rad, of the controller.

    Raises
    ------
    InvalidParameterError
        If inertia or a stiffness is not finite and positive, or a damping is negative.

    Examples
    --------
    >>> from hrsafety import impact
    >>> joint = impact.Joint(
    ...     inertia=0.059, mechanical_stiffness=1216.8, mechanical_damping=0.0,
    ...     control_stiffness=121.68, control_damping=1.521,
    ... )
    >>> round(joint.stiffness, 3), round(joint.damping, 3)
    (110.618, 1.257)
    """

    inertia: float
    mechanical_stiffness: float
    mechanical_damping: float
    control_stiffness: float
    control_damping: float
    _native: _hrsafety.Joint = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers(
            "inertia", "mechanical_stiffness", "mechanical_damping", "control_stiffness", "control_damping"
        )
        self._set(_native=_hrsafety.Joint(**values))

    @property
    def stiffness(self) -> float:
        """Stiffness K_J of the reduced joint, in N m/rad."""
        return self._native.stiffness

    @property
    def damping(self) -> float:
        """Damping C_J of the reduced joint, in N m s/rad."""
        return self._native.damping

    def model_error(self, omega: npt.ArrayLike) -> Array:
        """Return how far the reduced joint is from the exact one at a frequency.

        Parameters
        ----------
        omega : array_like
            Angular frequencies in rad/s, not negative.

        Returns
        -------
        ndarray of the shape of omega
            abs(exact - reduced) / abs(exact) of the torque, a ratio.

        Raises
        ------
        InvalidParameterError
            If a frequency is negative or not finite.

        Examples
        --------
        >>> from hrsafety import impact
        >>> joint = impact.Joint(
        ...     inertia=0.059, mechanical_stiffness=1216.8, mechanical_damping=0.0,
        ...     control_stiffness=121.68, control_damping=1.521,
        ... )
        >>> float(joint.model_error(95.0).round(3))
        0.075
        """
        given = numbers("omega", omega)
        bad = given[~(np.isfinite(given) & (given >= 0.0))]
        if bad.size:
            raise InvalidParameterError("omega", "be finite and not negative", float(bad[0]))
        return self._native.model_error(given.ravel()).reshape(given.shape)

    def at(self, lever_arm: float) -> Manipulator:
        """Return the effective manipulator at a distance from the joint.

        Parameters
        ----------
        lever_arm : float
            Distance l of the impact point from the joint, in m.

        Returns
        -------
        Manipulator
            M_r = m/l^2, C_r = C_J/l^2, K_r = K_J/l^2.

        Raises
        ------
        InvalidParameterError
            If the distance is not finite and positive.
        """
        return Manipulator.from_joint(
            inertia=self.inertia, damping=self.damping, stiffness=self.stiffness, lever_arm=lever_arm
        )


def uniform_links(*, mass: npt.ArrayLike, length: npt.ArrayLike, elbow: float = 0.0) -> Array:
    """Return the inertia matrix of two uniform links about joints 2 and 3.

    Its off-diagonal element is m_3 a_3^2 / 3 + m_3 a_2 a_3 cos(theta_3) / 2; the printed one makes
    the matrix indefinite.

    Parameters
    ----------
    mass : array_like of shape (2,)
        m_2, m_3 in kg.
    length : array_like of shape (2,)
        a_2, a_3 in m.
    elbow : float
        Angle theta_3 in rad; 0 is stretched.

    Returns
    -------
    ndarray of shape (2, 2)
        In kg m^2, for `Manipulator.from_two_joints`.

    Raises
    ------
    InvalidParameterError
        If a mass or length is not finite and positive.
    ShapeError
        If an array has another shape.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.joints.uniform_links(mass=(3.0, 3.0), length=(1.0, 1.0)).tolist()
    [[8.0, 2.5], [2.5, 1.0]]
    """
    masses, lengths = pair("mass", mass), pair("length", length)
    return np.array(_hrsafety.uniform_links(mass=masses, length=lengths, elbow=number("elbow", elbow)))


def dashpots_in_series(damping: npt.ArrayLike, *, second_link: float, lever_arm: float, elbow: float = 0.0) -> float:
    """Return the effective damping of two joints with their dashpots alone in series, (3.4.29).

    C_r = 1/(J_2^2/C_2 + J_3^2/C_3) with the lever arms J = [a_2 cos(theta_3) + l_3, l_3]. It is the
    printed form; `Manipulator.from_two_joints` has the damping that is consistent with the springs,
    C_r = K_r^2 J K^-1 C K^-1 J^T, and both agree only for equal ratios C/K.

    Parameters
    ----------
    damping : array_like, shape (2,)
        Damping C_J2, C_J3 of the joints, in N m s/rad, above zero.
    second_link : float
        Length a_2 of link 2, in m.
    lever_arm : float
        Distance l_3 from joint 3 to the impact point, in m.
    elbow : float
        theta_3 in rad; 0 is stretched.

    Returns
    -------
    float
        In N s/m.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.
    ShapeError
        If there are not two dampings.

    Examples
    --------
    >>> from hrsafety import impact
    >>> round(impact.joints.dashpots_in_series((40.0, 10.0), second_link=0.432, lever_arm=0.4), 3)
    30.025
    """
    return _hrsafety.dashpots_in_series(
        pair("damping", damping),
        second_link=number("second_link", second_link),
        lever_arm=number("lever_arm", lever_arm),
        elbow=number("elbow", elbow),
    )


def impact_point_speed(rates: npt.ArrayLike, *, second_link: float, lever_arm: float, elbow: float = 0.0) -> float:
    """Return the speed v_r of the impact point on the third link along its normal.

    v_r = (a_2 cos(theta_3) + l_3) theta_2' + l_3 theta_3', (3.4.23) of Zeng (2011) for any elbow.
    A single joint at the distance l_3 is the case theta_2' = 0.

    Parameters
    ----------
    rates : array_like of shape (2,)
        theta_2', theta_3' in rad/s.
    second_link : float
        Length a_2 of the second link, in m.
    lever_arm : float
        Distance l_3 of the impact point from joint 3, in m.
    elbow : float
        Angle theta_3 in rad; 0 is stretched.

    Returns
    -------
    float
        In m/s.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.
    ShapeError
        If there are not two rates.

    Examples
    --------
    >>> from hrsafety import impact
    >>> round(impact.joints.impact_point_speed((0.2, 0.1), second_link=0.43, lever_arm=0.4), 6)
    0.206
    """
    return _hrsafety.impact_point_speed(
        pair("rates", rates),
        second_link=number("second_link", second_link),
        lever_arm=number("lever_arm", lever_arm),
        elbow=number("elbow", elbow),
    )
