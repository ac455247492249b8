"""A direct-drive joint with its controller, friction and limited voltage in an impact."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, instance, number
from hrsafety._records import dataclass
from hrsafety.impact.criteria.loads import Doubts, check_speeds, speed_warnings
from hrsafety.impact.parameters import Foam, Head, Manipulator
from hrsafety.impact.response import check_finite, compression_status
from hrsafety.tables import Columns, Table, with_units

__all__ = ["DirectDrive", "DirectDriveResponse", "simulate_direct_drive"]


@dataclass(frozen=True, kw_only=True, slots=True)
class DirectDrive(Parameters):
    """Arm on a motor without gears, under proportional-derivative control with feed-forward.

    Section A.2 of Zeng (2011). Defaults are the arm of the experiments, with the constants that
    its own tests give.

    Parameters
    ----------
    proportional, derivative : float
        K_p in V/rad and K_d in V s/rad, see `pd_gains`.
    inertia : float
        m_dd in kg m^2.
    lever_arm : float
        Distance l_1 of the impact point from the joint, in m.
    torque_constant : float
        K_t in N m/A.
    amplifier_gain : float
        K_amp in A/V.
    viscous_friction : float
        B in N m s/rad.
    static_friction : float
        tau_st in N m.
    voltage_limit : float
        Largest absolute command in V; infinite for none.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import impact
    >>> drive = impact.joints.DirectDrive(proportional=448.7, derivative=5.579)
    >>> round(drive.linear().stiffness, -1)
    20000.0
    """

    proportional: float
    derivative: float
    inertia: float = 0.059
    lever_arm: float = 0.078
    torque_constant: float = 0.27121
    amplifier_gain: float = 1.0
    viscous_friction: float = 0.0079945
    static_friction: float = 0.061
    voltage_limit: float = 5.0
    _native: _hrsafety.DirectDrive = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("proportional", "derivative", "inertia", "lever_arm", "torque_constant", "amplifier_gain")
        limits = ("viscous_friction", "static_friction", "voltage_limit")
        self._set(_native=_hrsafety.DirectDrive(**self._as_numbers(*names, *limits)))

    def linear(self) -> Manipulator:
        """Return the same joint without static friction and voltage limit.

        Returns
        -------
        Manipulator
            As it is felt at the impact point.
        """
        mass, damping, stiffness = self._native.linear()
        return Manipulator(mass=mass, damping=damping, stiffness=stiffness)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class DirectDriveResponse(Table):
    """Histories of a direct-drive joint in an impact, and their maxima.

    Attributes
    ----------
    time : ndarray of shape (n,)
        In s, from first contact.
    manipulator_position, manipulator_velocity : ndarray of shape (n,)
        Of the impact point, in m and m/s.
    head_position, head_velocity, head_acceleration : ndarray of shape (n,)
        In m, m/s and m/s^2.
    contact_force : ndarray of shape (n,)
        In N.
    compression : ndarray of shape (n,)
        In m.
    command : ndarray of shape (n,)
        Voltage after the limit, in V.
    requested_command : ndarray of shape (n,)
        Voltage that the controller asks for, in V.
    peak_head_acceleration : float
        Over the impact period, in m/s^2.
    peak_contact_force : float
        Over the impact period, in N.
    max_compression : float
        Over the impact period, in m.
    impact_duration : float
        In s; infinite without release.
    saturated_from : float
        When the limit is reached first, in s; NaN if never.
    saturated_time : float
        How long the command is at its limit, in s.
    status : str
        What the maxima mean: ``"released"``, ``"no_release"``, ``"beyond_linear_range"`` or
        ``"bottomed"``, as for `ImpactMetrics`.
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant.
    """

    time: Annotated[Array, "s"]
    manipulator_position: Annotated[Array, "m"]
    manipulator_velocity: Annotated[Array, "m/s"]
    head_position: Annotated[Array, "m"]
    head_velocity: Annotated[Array, "m/s"]
    head_acceleration: Annotated[Array, "m/s^2"]
    contact_force: Annotated[Array, "N"]
    compression: Annotated[Array, "m"]
    command: Annotated[Array, "V"]
    requested_command: Annotated[Array, "V"]
    peak_head_acceleration: Annotated[float, "m/s^2"]
    peak_contact_force: Annotated[float, "N"]
    max_compression: Annotated[float, "m"]
    impact_duration: Annotated[float, "s"]
    saturated_from: Annotated[float, "s"]
    saturated_time: Annotated[float, "s"]
    status: str = "released"
    warnings: Doubts = ()

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Units are in the names.

        Examples
        --------
        >>> from hrsafety import impact
        >>> drive = impact.joints.DirectDrive(proportional=448.7, derivative=5.579)
        >>> run = impact.joints.simulate_direct_drive(drive, impact.FOAM_1, impact.Head.apparatus(), closing_speed=1.25)
        >>> list(run.columns())[-2:]
        ['command_V', 'requested_command_V']
        """
        units = {"time": "s", "contact_force": "N", "head_acceleration": "m/s^2"}
        units |= dict.fromkeys(("head_position", "manipulator_position", "compression"), "m")
        units |= dict.fromkeys(("head_velocity", "manipulator_velocity"), "m/s")
        units |= dict.fromkeys(("command", "requested_command"), "V")
        return with_units(self, units)


def simulate_direct_drive(
    drive: DirectDrive,
    foam: Foam,
    head: Head,
    *,
    closing_speed: float,
    manipulator_speed: float | None = None,
    duration: float = 0.06,
    step: float = 1e-4,
) -> DirectDriveResponse:
    """Return what a direct-drive joint does in an impact, friction and voltage limit included.

    Parameters
    ----------
    drive : DirectDrive
        The joint; ``math.inf`` as its voltage limit and no static friction make it linear.
    foam : Foam
        What is between.
    head : Head
        What is hit.
    closing_speed : float
        v_c in m/s, positive.
    manipulator_speed : float or None
        v_r in m/s; the closing speed when ``None``.
    duration : float
        In s.
    step : float
        Of the integration and of the histories, in s.

    Returns
    -------
    DirectDriveResponse
        Histories and maxima.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    The limit of 5 V is reached long before the impact ends:

    >>> from hrsafety import impact
    >>> drive = impact.joints.DirectDrive(proportional=448.7, derivative=5.579)
    >>> run = impact.joints.simulate_direct_drive(drive, impact.FOAM_1, impact.Head.apparatus(), closing_speed=1.25)
    >>> run.saturated_from < 0.005, run.saturated_time > 0.02
    (True, True)
    """
    speed = number("closing_speed", closing_speed)
    own_speed = None if manipulator_speed is None else number("manipulator_speed", manipulator_speed)
    check_speeds(speed, own_speed)
    result = _hrsafety.simulate_direct_drive(
        instance("drive", drive, DirectDrive)._native,
        instance("foam", foam, Foam)._native,
        instance("head", head, Head)._native,
        closing_speed=speed,
        manipulator_speed=speed if own_speed is None else own_speed,
        duration=number("duration", duration),
        step=number("step", step),
    )
    check_finite(speed, result["contact_force"], result["compression"], result["manipulator_position"])
    worst = compression_status(np.array([result["max_compression"]]), foam)
    lasting = "no_release" if np.isinf(result["impact_duration"]) else "released"
    return DirectDriveResponse(
        **result,
        status=lasting if worst == "linear" else worst,
        warnings=foam.warnings + head.warnings + speed_warnings(speed, own_speed),
    )
