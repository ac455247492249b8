"""Foam and direct-drive parameters from tests (appendix A of Zeng 2011), and controller gains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns, count, number, vector, word
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.impact.parameters import Foam

__all__ = [
    "DirectDriveFit",
    "FoamFit",
    "OpenLoopFit",
    "PdGains",
    "TubeInertia",
    "drop_trajectory",
    "fit_open_loop",
    "identify_direct_drive",
    "identify_foam",
    "pd_gains",
    "tube_inertia",
]

Contact = Literal["unilateral", "attached"]
_CONTACTS = ("unilateral", "attached")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FoamFit:
    """Foam parameters from static and drop tests.

    The order of the three parameters is stiffness, damping ratio, friction.

    Attributes
    ----------
    stiffness : float
        K_c in N/m.
    damping_ratio : float
        xi_c on the rig.
    friction : float
        Friction of the slide in N.
    drop_heights : ndarray of shape (drops,)
        Fitted heights of the drops in m.
    covariance : ndarray of shape (3, 3)
        Covariance of the three parameters.
    interval : ndarray of shape (3, 2)
        Confidence intervals of the three parameters.
    bootstrap_interval : ndarray of shape (3, 2) or None
        The same from resampled residuals, if asked for.
    force_deviation : float
        Standard deviation of the static residuals, in N.
    position_deviation : float
        Standard deviation of the drop residuals, in m.
    degrees_of_freedom : int
        Of the drop fit.
    iterations : int
        Steps that the drop fit took.
    """

    stiffness: float
    damping_ratio: float
    friction: float
    drop_heights: Array
    covariance: Array
    interval: Array
    bootstrap_interval: Array | None
    force_deviation: float
    position_deviation: float
    degrees_of_freedom: int
    iterations: int

    def foam(self, moving_mass: float, *, thickness: float = 0.0254, linear_range: float = 0.02) -> Foam:
        """Return the foam with its damping scaled to a moving mass.

        Parameters
        ----------
        moving_mass : float
            Mass that the foam meets, in kg: the head's in an impact.
        thickness, linear_range : float
            As for `Foam`, in m.

        Returns
        -------
        Foam
            With C_c = 2 xi sqrt(M K_c).
        """
        return Foam.from_damping_ratio(
            stiffness=self.stiffness,
            damping_ratio=self.damping_ratio,
            moving_mass=moving_mass,
            thickness=thickness,
            linear_range=linear_range,
        )


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

    acceleration: float
    decay: float
    covariance: Array
    interval: Array
    residual_deviation: float


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
    friction_offset: float
    decay: float
    torque_constant: float
    viscous_friction: float
    static_friction: float
    covariance: Array
    interval: Array
    decay_interval: Array


class PdGains(NamedTuple):
    """Gains of the controller of a direct-drive joint.

    Attributes
    ----------
    proportional : float
        K_p in V/rad.
    derivative : float
        K_d in V s/rad.
    """

    proportional: float
    derivative: float


class TubeInertia(NamedTuple):
    """Mass and inertia of a rectangular tube.

    Attributes
    ----------
    mass : float
        In kg.
    inertia : float
        About the center, across the length, in kg m^2.
    """

    mass: float
    inertia: float


def identify_foam(
    static_force: npt.ArrayLike,
    static_compression: npt.ArrayLike,
    drop_time: npt.ArrayLike | Sequence[npt.ArrayLike],
    drop_position: npt.ArrayLike | Sequence[npt.ArrayLike],
    moving_mass: float,
    *,
    gravity: float = 9.80665,
    confidence: float = 0.95,
    contact: Contact = "unilateral",
    bootstrap: int = 0,
    seed: int = 0,
) -> FoamFit:
    """Return stiffness, damping ratio and friction of a foam from static and drop tests.

    The static test is a line, f = K_c eps. The drops are fitted as trajectories, not as
    differentiated samples: m y'' + C y' + K y = -(m g + f sign(y')) in contact, a fall with
    friction before it (section A.1 of Zeng 2011).

    Parameters
    ----------
    static_force, static_compression : array_like of shape (n,)
        In N and m.
    drop_time, drop_position : array_like of shape (k,), or a sequence of them
        One drop or several: times in s, heights above the surface of the foam in m, released
        at rest at the first sample.
    moving_mass : float
        Mass that is dropped, in kg.
    gravity : float
        In m/s^2.
    confidence : float
        Level of the intervals, between 0 and 1.
    contact : str
        ``"unilateral"``: the foam lets go when its force would become a pull. ``"attached"``: it holds the
        mass until its own undeformed surface is reached.
    bootstrap : int
        Number of resamplings for `FoamFit.bootstrap_interval`; 0 for none.
    seed : int
        Seed of the resampling.

    Returns
    -------
    FoamFit
        Parameters with covariance and intervals.

    Raises
    ------
    InvalidParameterError
        If a signal is too short, unsorted or not finite, or a number is out of range.
    ShapeError
        If arrays of a pair differ in length.
    SimulationError
        If the fit does not converge.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import impact
    >>> compression = np.linspace(0.0, 0.01, 11)
    >>> time = np.arange(0.0, 0.3, 0.001)
    >>> drop = impact.drop_trajectory(
    ...     time, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112, friction=2.0)
    >>> fit = impact.identify_foam(24250.0 * compression, compression, time, drop, 1.54)
    >>> round(fit.stiffness), round(fit.damping_ratio, 6), round(fit.friction, 6)
    (24250, 0.112, 2.0)
    """
    force, compression = columns(static_force=static_force, static_compression=static_compression)
    result = _hrsafety.identify_foam(
        force,
        compression,
        _drops(drop_time, drop_position),
        moving_mass=number("moving_mass", moving_mass),
        gravity=number("gravity", gravity),
        confidence=number("confidence", confidence),
        attached=word("contact", contact, _CONTACTS) == "attached",
        bootstrap=count("bootstrap", bootstrap, least=0),
        seed=_seed(seed),
    )
    return FoamFit(**result)


def _seed(seed: int) -> int:
    if count("seed", seed, least=0) >= 2**64:
        raise InvalidParameterError("seed", "be below 2^64", seed)
    return int(seed)


def _drops(drop_time: object, drop_position: object) -> list[tuple[Array, Array]]:
    """Return pairs of arrays, one for each drop."""
    times, positions = _signals("drop_time", drop_time), _signals("drop_position", drop_position)
    if len(times) != len(positions):
        raise ShapeError("drop_position", f"of {len(times)} drops, as drop_time", (len(positions),))
    pairs = []
    for index, (time, position) in enumerate(zip(times, positions, strict=True)):
        if time.shape != position.shape:
            raise ShapeError(f"drop_position[{index}]", f"({len(time)},)", position.shape)
        pairs.append((time, position))
    return pairs


def _signals(name: str, value: object) -> list[Array]:
    """Return one signal, or a sequence of signals, as a list of arrays."""
    if isinstance(value, (str, bytes)) or not isinstance(value, (Sequence, np.ndarray)) or len(value) == 0:
        raise InvalidParameterError(name, "be a signal or a sequence of signals", value)
    if np.ndim(value[0]) == 0:
        return [vector(name, value)]
    return [vector(f"{name}[{index}]", each) for index, each in enumerate(value)]


def drop_trajectory(
    time: npt.ArrayLike,
    *,
    height: float,
    mass: float,
    stiffness: float,
    damping_ratio: float,
    friction: float = 0.0,
    gravity: float = 9.80665,
    contact: Contact = "unilateral",
) -> Array:
    """Return the height of a mass that is dropped on foam.

    Parameters
    ----------
    time : array_like of shape (n,)
        In s, increasing; released at rest at the first.
    height : float
        Height of release above the surface of the foam, in m.
    mass : float
        In kg.
    stiffness : float
        K_c in N/m.
    damping_ratio : float
        xi_c = C_c / (2 sqrt(m K_c)).
    friction : float
        Friction of the slide in N.
    gravity : float
        In m/s^2.
    contact : str
        As for `identify_foam`.

    Returns
    -------
    ndarray of shape (n,)
        Height above the surface in m, negative in the foam.

    Raises
    ------
    InvalidParameterError
        If a value is out of range or the times are not sorted.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.drop_trajectory(
    ...     [0.0, 0.05], height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112).round(6).tolist()
    [0.05, 0.037742]
    """
    return _hrsafety.drop_trajectory(
        vector("time", time),
        height=number("height", height),
        mass=number("mass", mass),
        stiffness=number("stiffness", stiffness),
        damping_ratio=number("damping_ratio", damping_ratio),
        friction=number("friction", friction),
        gravity=number("gravity", gravity),
        attached=word("contact", contact, _CONTACTS) == "attached",
    )


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
    >>> fit = impact.fit_open_loop(time, angle)
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
    >>> fit = impact.identify_direct_drive(
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
    >>> gains = impact.pd_gains(
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
    >>> tube = impact.tube_inertia(density=2700.0, length=0.664, width=0.0508, height=0.0508, wall=0.0254 / 16)
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
