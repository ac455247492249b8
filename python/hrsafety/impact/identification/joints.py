"""Direct-drive joint from open-loop tests, its tube, and its controller (section A.2 of Zeng 2011)."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns, number, vector
from hrsafety._display import displayed

__all__ = [
    "DirectDriveFit",
    "OpenLoopFit",
    "PdGains",
    "TubeInertia",
    "fit_open_loop",
    "identify_direct_drive",
    "pd_gains",
    "tube_inertia",
]


@displayed
class OpenLoopFit(NamedTuple):
    """Fit of theta = A (kappa t - 1 + exp(-kappa t)) / kappa^2 to an open-loop test.

    Attributes
    ----------
    acceleration : float
        A in rad/s^2.
    decay : float
        kappa in 1/s.
    covariance : ndarray of shape (2, 2)
        Covariance of both.
    interval : ndarray of shape (2, 2)
        95 % confidence intervals of both.
    residual_deviation : float
        Standard deviation of the residuals, in rad.
    """

    acceleration: Annotated[float, "rad/s^2"]
    decay: Annotated[float, "1/s"]
    covariance: Array
    interval: Array
    residual_deviation: Annotated[float, "rad"]


@displayed
class DirectDriveFit(NamedTuple):
    """Direct-drive joint from open-loop tests at several voltages.

    Attributes
    ----------
    command_gain : float
        Theta in rad/(s^2 V).
    friction_offset : float
        Gamma in rad/s^2.
    decay : float
        Mean kappa in 1/s.
    torque_constant : float
        K_t in N m/A.
    viscous_friction : float
        B in N m s/rad.
    static_friction : float
        tau_st in N m.
    covariance : ndarray of shape (2, 2)
        Covariance of Theta and Gamma.
    interval : ndarray of shape (2, 2)
        95 % confidence intervals of Theta and Gamma.
    decay_interval : ndarray of shape (2,)
        95 % confidence interval of kappa.
    """

    command_gain: float
    friction_offset: Annotated[float, "rad/s^2"]
    decay: Annotated[float, "1/s"]
    torque_constant: Annotated[float, "N m/A"]
    viscous_friction: Annotated[float, "N m s/rad"]
    static_friction: Annotated[float, "N m"]
    covariance: Array
    interval: Array
    decay_interval: Array


@displayed
class PdGains(NamedTuple):
    """Gains of the controller of a direct-drive joint.

    Attributes
    ----------
    proportional : float
        K_p in V/rad.
    derivative : float
        K_d in V s/rad.
    """

    proportional: Annotated[float, "V/rad"]
    derivative: Annotated[float, "V s/rad"]


@displayed
class TubeInertia(NamedTuple):
    """Mass and inertia of a rectangular tube.

    Attributes
    ----------
    mass : float
        In kg.
    inertia : float
        About the center, across the length, in kg m^2.
    """

    mass: Annotated[float, "kg"]
    inertia: Annotated[float, "kg m^2"]


def fit_open_loop(time: npt.ArrayLike, angle: npt.ArrayLike) -> OpenLoopFit:
    """Return acceleration and decay of a joint that is driven by a constant voltage.

    Fits theta = A (kappa t - 1 + exp(-kappa t)) / kappa^2, (A.2.12) of Zeng (2011) with its
    letters in their places.

    Parameters
    ----------
    time : array_like of shape (n,)
        In s, increasing. The joint is at rest at the first sample.
    angle : array_like of shape (n,)
        In rad.

    Returns
    -------
    OpenLoopFit
        A and kappa with covariance and intervals.

    Raises
    ------
    InvalidParameterError
        If the signal is too short, unsorted or not finite.
    ShapeError
        If the arrays are not one-dimensional and of one length.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import impact
    >>> time = np.linspace(0.0, 2.0, 201)
    >>> angle = 1.504 * (0.111 * time - 1 + np.exp(-0.111 * time)) / 0.111**2
    >>> fit = impact.identification.fit_open_loop(time, angle)
    >>> round(fit.acceleration, 6), round(fit.decay, 6)
    (1.504, 0.111)
    """
    instants, signal = columns(time=time, angle=angle)
    return OpenLoopFit(**_hrsafety.fit_open_loop(instants, signal))


def identify_direct_drive(
    voltage: npt.ArrayLike,
    acceleration: npt.ArrayLike,
    decay: npt.ArrayLike,
    inertia: float,
    *,
    amplifier_gain: float = 1.0,
) -> DirectDriveFit:
    """Return torque constant and friction of a direct-drive joint from open-loop tests.

    A = Theta u + Gamma by linear regression; K_t = Theta m / K_amp, tau_st = -Gamma m,
    B = kappa m (section A.2.2 of Zeng 2011).

    Parameters
    ----------
    voltage : array_like of shape (n,)
        Commands u in V.
    acceleration : array_like of shape (n,)
        A of each test in rad/s^2, see `fit_open_loop`.
    decay : array_like of shape (k,)
        kappa of each test in 1/s, any number of them.
    inertia : float
        m_dd in kg m^2.
    amplifier_gain : float
        K_amp in A/V.

    Returns
    -------
    DirectDriveFit
        Parameters with covariance and intervals.

    Raises
    ------
    InvalidParameterError
        If there are too few tests, or a value is out of range.
    ShapeError
        If voltage and acceleration differ in length.

    Examples
    --------
    >>> from hrsafety import impact
    >>> fit = impact.identification.identify_direct_drive(
    ...     [0.3, 0.4, 0.6, 0.8, 1.0], [0.497, 0.808, 1.504, 2.555, 3.723],
    ...     [0.121, 0.161, 0.098, 0.110, 0.109, 0.113, 0.138, 0.138, 0.184, 0.183], 0.059,
    ... )
    >>> round(fit.command_gain, 3), round(fit.friction_offset, 3), round(fit.torque_constant, 5)
    (4.597, -1.033, 0.27121)
    """
    commands, slopes = columns(voltage=voltage, acceleration=acceleration)
    result = _hrsafety.identify_direct_drive(
        commands, slopes, vector("decay", decay), number("inertia", inertia), number("amplifier_gain", amplifier_gain)
    )
    return DirectDriveFit(**result)


def pd_gains(
    *,
    stiffness: float,
    damping: float,
    lever_arm: float,
    torque_constant: float,
    viscous_friction: float = 0.0,
    amplifier_gain: float = 1.0,
) -> PdGains:
    """Return the gains that give a direct-drive joint a stiffness and damping at the impact point.

    K_p = K_r l^2 / (K_t K_amp), K_d = (C_r l^2 - B) / (K_t K_amp), with B where it belongs
    (section A.2.3 of Zeng 2011).

    Parameters
    ----------
    stiffness, damping : float
        Wanted K_r in N/m and C_r in N s/m.
    lever_arm : float
        Distance l of the impact point from the joint, in m.
    torque_constant : float
        K_t in N m/A.
    viscous_friction : float
        B of the motors, in N m s/rad.
    amplifier_gain : float
        K_amp in A/V.

    Returns
    -------
    PdGains
        In V/rad and V s/rad.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import impact
    >>> gains = impact.identification.pd_gains(
    ...     stiffness=20e3, damping=250.0, lever_arm=0.078, torque_constant=0.2807, viscous_friction=0.0079)
    >>> round(gains.proportional, 3), round(gains.derivative, 5)
    (433.488, 5.39045)
    """
    return PdGains._make(
        _hrsafety.pd_gains(
            stiffness=number("stiffness", stiffness),
            damping=number("damping", damping),
            lever_arm=number("lever_arm", lever_arm),
            torque_constant=number("torque_constant", torque_constant),
            viscous_friction=number("viscous_friction", viscous_friction),
            amplifier_gain=number("amplifier_gain", amplifier_gain),
        )
    )


def tube_inertia(*, density: float, length: float, width: float, height: float, wall: float) -> TubeInertia:
    """Return mass and inertia of a rectangular tube with open ends.

    Parameters
    ----------
    density : float
        In kg/m^3.
    length, width, height : float
        Outer sizes in m; the rotation is in the plane of length and width.
    wall : float
        Thickness of the walls in m, less than half of width and height.

    Returns
    -------
    TubeInertia
        In kg and kg m^2.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import impact
    >>> side, wall = 0.0508, 0.0254 / 16
    >>> tube = impact.identification.tube_inertia(density=2700.0, length=0.664, width=side, height=side, wall=wall)
    >>> round(tube.inertia, 6), round(tube.mass, 3)
    (0.020811, 0.56)
    """
    return TubeInertia._make(
        _hrsafety.tube_inertia(
            density=number("density", density),
            length=number("length", length),
            width=number("width", width),
            height=number("height", height),
            wall=number("wall", wall),
        )
    )
