"""Wheels of a robot as built: motor, friction, encoder, observer, controller."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import (
    Array,
    Pair,
    Parameters,
    columns,
    instance,
    number,
    pair,
    positive,
    sequence,
    vector,
    whole_steps,
)
from hrsafety._bounds import MOST_SAMPLES
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.tables import Columns, Table, with_units

__all__ = ["WheelDrive", "WheelReference", "WheelRun", "follow_wheel"]

Triple = tuple[float, float, float]
Feedback = Literal["observer", "observed_speed", "differences"]


@dataclass(frozen=True, kw_only=True, slots=True)
class WheelDrive(Parameters):
    """One wheel with its motor, encoder and controller.

    The wheel moves by J/K theta'' = i - B/K theta' - tau/K sgn(theta'), (D.2.1) of Zeng (2011)
    divided by K/J; at rest it sticks while the current is at most tau/K. The controller is (D.3.1):

    u = K_P (theta_d - theta) + K_D (theta_d' - theta') + J/K theta_d'' + B/K theta_d' + tau/K sgn(theta_d'),

    once per wheel period, its current held in between. `HOLONOMIC_WHEELS` and
    `DIFFERENTIAL_WHEELS` are the wheels of the thesis.

    Parameters
    ----------
    inertia : float
        J/K in A s^2.
    viscous_friction : float
        B/K in A s.
    static_friction : float
        tau/K in A.
    proportional_gain : float
        K_P in V/rad.
    derivative_gain : float
        K_D in V s/rad.
    model : (float, float, float), optional
        The J/K, B/K and tau/K that feed-forward and observer assume; by default the true ones.
    feedback : {"observer", "observed_speed", "differences"}
        Where the controller takes angle and speed from: both from the Luenberger observer
        (D.3.3); the angle as read and the speed from the observer; the angle as read and the
        difference of the last two readings.
    observer_poles : (float, float)
        In 1/s, negative.
    encoder_counts : float, optional
        Counts per turn of the motor; None reads the angle exactly.
    gear_ratio : float
        Turns of the motor per turn of the wheel.
    amplifier_gain : float
        K_amp in A/V.
    winding_resistance : float
        R_a in ohm. Not in the thesis: that of its motor.
    back_emf : float
        Induced voltage per wheel speed, torque constant times gear ratio, in V s/rad. Not in the
        thesis: that of its motor.
    current_limit : float
        Largest current in A. Not in the thesis: the range of a command of 10 V.
    supply_voltage : float
        In V. Not in the thesis: the nominal voltage of its motor.
    period : float
        Wheel control period in s. Not in the thesis: 20 ms and more are unstable.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.robots.HOLONOMIC_WHEELS[0].proportional_gain
    37.0
    """

    inertia: float
    viscous_friction: float
    static_friction: float
    proportional_gain: float
    derivative_gain: float
    model: Triple | None = None
    feedback: Feedback = "observer"
    observer_poles: Pair = (-10.0, -10.0)
    encoder_counts: float | None = 2000.0
    gear_ratio: float = 10.0
    amplifier_gain: float = 1.0
    winding_resistance: float = 1.16
    back_emf: float = 0.603
    current_limit: float = 10.0
    supply_voltage: float = 48.0
    period: float = 1e-3
    _native: _hrsafety.WheelDrive = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        truth = self._as_numbers("inertia", "viscous_friction", "static_friction")
        gains = self._as_numbers("proportional_gain", "derivative_gain", "gear_ratio", "amplifier_gain")
        motor = self._as_numbers("winding_resistance", "back_emf", "current_limit", "supply_voltage", "period")
        model = _model(tuple(truth.values()) if self.model is None else self.model)
        counts = None if self.encoder_counts is None else number("encoder_counts", self.encoder_counts)
        self._set(model=model, encoder_counts=counts, observer_poles=pair("observer_poles", self.observer_poles))
        if not isinstance(self.feedback, str):
            raise InvalidParameterError("feedback", "be a word", self.feedback)
        self._set(
            _native=_hrsafety.WheelDrive(
                model=model,
                feedback=self.feedback,
                observer_poles=self.observer_poles,
                encoder_counts=counts,
                **truth,
                **gains,
                **motor,
            )
        )

    @property
    def resolution(self) -> float:
        """Angle of the wheel for one count of the encoder, in rad; 0 for exact reading."""
        return 0.0 if self.encoder_counts is None else 2.0 * np.pi / (self.encoder_counts * self.gear_ratio)


def _model(value: object) -> Triple:
    rule = "be the three numbers J/K, B/K and tau/K"
    parts = sequence("model", rule, value)
    if len(parts) != 3:
        raise InvalidParameterError("model", rule, value)
    first, second, third = (number("model", part) for part in parts)
    return (first, second, third)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class WheelReference:
    """Wanted motion of a wheel, one row for each wheel period.

    Parameters
    ----------
    angle : array_like of shape (n,)
        In rad.
    speed : array_like of shape (n,)
        In rad/s.
    acceleration : array_like of shape (n,)
        In rad/s^2.

    Raises
    ------
    InvalidParameterError
        If a value is not a finite number, or there is none.
    ShapeError
        If the arrays are not one-dimensional and of one length.
    """

    angle: Annotated[Array, "rad"]
    speed: Annotated[Array, "rad/s"]
    acceleration: Annotated[Array, "rad/s^2"]

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("angle", "speed", "acceleration")
        arrays = columns(**{name: getattr(self, name) for name in names})
        for name, array in zip(names, arrays, strict=True):
            if not array.size or not np.isfinite(array).all():
                raise InvalidParameterError(name, "hold finite numbers", getattr(self, name))
            own = array.copy()
            own.setflags(write=False)
            object.__setattr__(self, name, own)

    @classmethod
    def sine(
        cls, *, speed: float = 1.0, frequency: float = 0.5, duration: float = 10.0, period: float = 1e-3
    ) -> WheelReference:
        """Return a sine of the speed, from rest at angle 0.

        Parameters
        ----------
        speed : float
            Amplitude in rad/s.
        frequency : float
            In Hz.
        duration : float
            In s.
        period : float
            Wheel control period in s.

        Returns
        -------
        WheelReference
            Of `duration / period` rows.

        Raises
        ------
        InvalidParameterError
            If a value is not finite, or not positive but for the speed.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> reference = nav.robots.WheelReference.sine(duration=1.0)
        >>> round(float(reference.speed[500]), 12), len(reference.angle)
        (1.0, 1000)
        """
        rate = 2.0 * np.pi * positive("frequency", frequency)
        length = positive("duration", duration)
        period = positive("period", period)
        rows = round(whole_steps("duration", length, period, MOST_SAMPLES))
        if not np.isfinite(rate * length) or not np.isfinite(number("speed", speed) * rate):
            raise InvalidParameterError("frequency", "give a finite phase and a finite acceleration", frequency)
        phase = rate * period * np.arange(rows)
        peak = number("speed", speed)
        return cls(
            angle=peak / rate * (1.0 - np.cos(phase)),
            speed=peak * np.sin(phase),
            acceleration=peak * rate * np.cos(phase),
        )

    @classmethod
    def from_speed(cls, speed: npt.ArrayLike, *, period: float = 1e-3) -> WheelReference:
        """Return the motion of a wheel that is to have given speeds, from rest at angle 0.

        The acceleration is the difference to the speed before, the angle the trapezoid sum
        (section 7.4 of Zeng 2011).

        Parameters
        ----------
        speed : array_like of shape (n,)
            In rad/s, one for each wheel period.
        period : float
            Wheel control period in s.

        Returns
        -------
        WheelReference
            Of n rows.

        Raises
        ------
        InvalidParameterError
            If a value is out of range.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.robots.WheelReference.from_speed([0.0, 1.0, 2.0], period=0.5).acceleration
        array([0., 2., 2.])
        """
        wanted = vector("speed", speed)
        angle, acceleration = _hrsafety.wheel_reference(wanted, positive("period", period))
        return cls(angle=angle, speed=wanted, acceleration=acceleration)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class WheelRun(Table):
    """A wheel after its reference; states at the start of each wheel period, currents over it.

    Attributes
    ----------
    time : ndarray of shape (n,)
        In s.
    wanted_angle, wanted_speed : ndarray of shape (n,)
        Reference, in rad and rad/s.
    angle, speed : ndarray of shape (n,)
        As they are, in rad and rad/s.
    read_angle : ndarray of shape (n,)
        What the encoder gives, in rad.
    known_angle, known_speed : ndarray of shape (n,)
        What the controller takes for angle and speed, in rad and rad/s.
    current : ndarray of shape (n,)
        Motor current in A.
    voltage : ndarray of shape (n,)
        Motor voltage at the start of the period, in V.
    ideal_current : ndarray of shape (n,)
        Current of a perfect follower, (D.3.2) of Zeng (2011), in A.
    energy : float
        Loss in the winding, the sum of R_a i^2 over the periods, in J.
    ideal_energy : float
        The same of a perfect follower, in J.
    """

    time: Annotated[Array, "s"]
    wanted_angle: Annotated[Array, "rad"]
    wanted_speed: Annotated[Array, "rad/s"]
    angle: Annotated[Array, "rad"]
    speed: Annotated[Array, "rad/s"]
    read_angle: Annotated[Array, "rad"]
    known_angle: Annotated[Array, "rad"]
    known_speed: Annotated[Array, "rad/s"]
    current: Annotated[Array, "A"]
    voltage: Annotated[Array, "V"]
    ideal_current: Annotated[Array, "A"]
    energy: Annotated[float, "J"]
    ideal_energy: Annotated[float, "J"]

    @property
    def angle_error(self) -> Array:
        """Wanted angle less the angle, in rad."""
        return self.wanted_angle - self.angle

    @property
    def speed_error(self) -> Array:
        """Wanted speed less the speed, in rad/s."""
        return self.wanted_speed - self.speed

    @property
    def rms_angle_error(self) -> float:
        """Root of the mean squared error of the angle, in rad."""
        return float(np.sqrt(np.mean(self.angle_error**2)))

    @property
    def rms_speed_error(self) -> float:
        """Root of the mean squared error of the speed, in rad/s."""
        return float(np.sqrt(np.mean(self.speed_error**2)))

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each wheel period.

        Returns
        -------
        dict of str to ndarray
            Units are in the names.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> run = nav.robots.follow_wheel(nav.robots.HOLONOMIC_WHEELS[0], nav.robots.WheelReference.sine(duration=1.0))
        >>> list(run.columns())[:3]
        ['t_s', 'wanted_angle_rad', 'angle_rad']
        """
        angles = ("wanted_angle", "angle", "read_angle", "known_angle")
        speeds = ("wanted_speed", "speed", "known_speed")
        units = {"time": "s", **dict.fromkeys(angles, "rad"), **dict.fromkeys(speeds, "rad/s")}
        units |= {"current": "A", "voltage": "V", "ideal_current": "A"}
        return with_units(self, units)


def _finite(name: str, value: object) -> float:
    given = number(name, value)
    if not np.isfinite(given):
        raise InvalidParameterError(name, "be finite", value)
    return given


def follow_wheel(
    drive: WheelDrive, reference: WheelReference, *, start_angle: float = 0.0, start_speed: float = 0.0
) -> WheelRun:
    """Let one wheel follow a wanted motion.

    Between two readings of the encoder the current is held and the motion is exact, with the
    instant at which friction stops the wheel.

    Parameters
    ----------
    drive : WheelDrive
        The wheel.
    reference : WheelReference
        One row for each wheel period.
    start_angle, start_speed : float
        State at the first row in rad and rad/s; the controller knows it.

    Returns
    -------
    WheelRun
        Of as many rows as the reference.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.
    SimulationError
        If the state does not stay finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> run = nav.robots.follow_wheel(nav.robots.HOLONOMIC_WHEELS[0], nav.robots.WheelReference.sine(duration=4.0))
    >>> run.rms_angle_error < 0.01
    True
    """
    wheel = instance("drive", drive, WheelDrive)
    wanted = instance("reference", reference, WheelReference)
    found = wheel._native.follow(
        angle=wanted.angle,
        speed=wanted.speed,
        acceleration=wanted.acceleration,
        start_angle=_finite("start_angle", start_angle),
        start_speed=_finite("start_speed", start_speed),
    )
    time = wheel.period * np.arange(len(wanted.angle), dtype=np.float64)
    return WheelRun(time=time, wanted_angle=wanted.angle, wanted_speed=wanted.speed, **found)
