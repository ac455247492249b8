"""Histories of an impact: motion, force, compression."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, flag, instance, number, pair, positive, sequence, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.criteria.loads import Doubts, ImpactMetrics, check_parts, check_speeds, judged, speed_warnings
from hrsafety.impact.parameters import ConstrainedHead, Foam, Head, Manipulator
from hrsafety.plausibility import implausible, telling
from hrsafety.tables import Columns, Table, with_units

__all__ = ["ImpactResponse", "SetPoint", "simulate"]

Method = Literal["exact", "rk4"]
Contact = Literal["linear", "unilateral"]
Equations = Literal["corrected", "as_printed"]
Segment = tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class SetPoint(Parameters):
    """Motion of the manipulator's set-point: constant speed, then constant accelerations.

    Section 3.8 of Zeng (2011), x_d = v_r t + a_d t^2 / 2.

    Parameters
    ----------
    segments : sequence of (float, float)
        When an acceleration begins, in s from first contact, and the acceleration in m/s^2; in
        order of time. The last one lasts.
    feed_forward : bool
        Whether the controller adds the force M_r x_d''.

    Raises
    ------
    InvalidParameterError
        If times decrease or are negative, or a value is not finite.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.SetPoint.accelerating(5.0, duration=0.05)
    SetPoint(segments=((0.0, 5.0), (0.05, 0.0)), feed_forward=False)
    """

    segments: tuple[Segment, ...] = ()
    feed_forward: bool = False
    _native: _hrsafety.SetPoint = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(segments=_segments(self.segments), feed_forward=flag("feed_forward", self.feed_forward))
        self._set(_native=_hrsafety.SetPoint(segments=self.segments, feed_forward=self.feed_forward))

    @classmethod
    def accelerating(cls, acceleration: float, *, duration: float, feed_forward: bool = False) -> SetPoint:
        """Return an acceleration from first contact on, then constant speed.

        Parameters
        ----------
        acceleration : float
            In m/s^2; negative slows down.
        duration : float
            In s.
        feed_forward : bool
            As for the class.

        Returns
        -------
        SetPoint
            Of two segments.

        Raises
        ------
        InvalidParameterError
            If the acceleration is not finite or the duration not positive.
        """
        steady = positive("duration", duration)
        return cls(segments=((0.0, number("acceleration", acceleration)), (steady, 0.0)), feed_forward=feed_forward)

    @classmethod
    def stopping(
        cls,
        *,
        manipulator_speed: float,
        detection: float = 0.004,
        rest: float = 0.05,
        feed_forward: bool = False,
    ) -> SetPoint:
        """Return constant speed until the impact is detected, then a deceleration to rest.

        Parameters
        ----------
        manipulator_speed : float
            v_r in m/s.
        detection : float
            When the deceleration begins, in s from first contact.
        rest : float
            When the set-point is at rest, in s.
        feed_forward : bool
            As for the class.

        Returns
        -------
        SetPoint
            Of two segments.

        Raises
        ------
        InvalidParameterError
            If a value is not finite, or rest is not after detection.

        Examples
        --------
        >>> from hrsafety import impact
        >>> impact.SetPoint.stopping(manipulator_speed=0.25, detection=0.0, rest=0.05).segments
        ((0.0, -5.0), (0.05, 0.0))
        """
        segments = _hrsafety.stopping_segments(
            manipulator_speed=number("manipulator_speed", manipulator_speed),
            detection=number("detection", detection),
            rest=number("rest", rest),
        )
        return cls(segments=tuple(segments), feed_forward=feed_forward)


def _segments(value: object) -> tuple[Segment, ...]:
    rule = "be a sequence of (start, acceleration)"
    return tuple(pair("segments", each) for each in sequence("segments", rule, value))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ImpactResponse(Table):
    """Histories of an impact, one row for each instant.

    Positions count from the manipulator's place at first contact; the head stands at the
    foam's thickness then.

    Attributes
    ----------
    time : ndarray of shape (n,)
        In s, from first contact.
    contact_force : ndarray of shape (n,)
        f_c in N.
    head_acceleration : ndarray of shape (n,)
        a_h in m/s^2; NaN for a constrained head.
    head_position, head_velocity : ndarray of shape (n,)
        x_h in m and its rate in m/s.
    manipulator_position, manipulator_velocity : ndarray of shape (n,)
        x_r in m and its rate in m/s.
    compression : ndarray of shape (n,)
        eps = T_u - x_h + x_r in m; with unilateral contact it may be less than what is left in
        the foam while the bodies are apart.
    release_times, touch_times : ndarray
        When the bodies part and meet again, in s; unilateral contact only.
    metrics : ImpactMetrics
        Loads on the continuous solution, see `metrics`. With a moving set-point or the printed
        equations peaks and impact period over the duration; the other numbers are NaN.
    compression_status : str
        Whether the foam can do what the whole history shows, also after the impact period:
        ``"linear"``, ``"beyond_linear_range"`` or ``"bottomed"`` (compressed by more than its
        thickness, which no foam can be).
    """

    time: Annotated[Array, "s"]
    contact_force: Annotated[Array, "N"]
    head_acceleration: Annotated[Array, "m/s^2"]
    head_position: Annotated[Array, "m"]
    head_velocity: Array
    manipulator_position: Annotated[Array, "m"]
    manipulator_velocity: Array
    compression: Annotated[Array, "m"]
    release_times: Annotated[Array, "s"]
    touch_times: Annotated[Array, "s"]
    metrics: ImpactMetrics
    compression_status: str = "linear"

    @property
    def warnings(self) -> Doubts:
        """Numbers that are hardly what was meant, see `ImpactMetrics.warnings`."""
        return self.metrics.warnings

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Units are in the names.

        Examples
        --------
        >>> from hrsafety import impact
        >>> run = impact.simulate(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=0.8)
        >>> list(run.columns())[:3]
        ['t_s', 'contact_force_N', 'head_acceleration_m_per_s2']
        """
        units = {"time": "s", "contact_force": "N", "head_acceleration": "m/s^2"}
        units |= dict.fromkeys(("head_position", "manipulator_position", "compression"), "m")
        units |= dict.fromkeys(("head_velocity", "manipulator_velocity"), "m/s")
        return with_units(self, units)


def compression_status(compression: Array, foam: Foam) -> str:
    """Return whether a foam can be compressed like that."""
    largest = compression.max()
    if largest > foam.thickness:
        return "bottomed"
    return "beyond_linear_range" if largest > foam.linear_range else "linear"


def check_finite(closing_speed: float, *columns: Array) -> None:
    """Refuse an impact whose histories cannot be represented, rather than return numbers that are none."""
    # NaN and infinity both make the sum of extremes one that is not finite.
    if not all(np.isfinite(column.min()) and np.isfinite(column.max()) for column in columns if len(column)):
        raise InvalidParameterError(
            "closing_speed",
            "give positions and forces that are finite",
            closing_speed,
            "it, or a mass, stiffness or damping, is wrong by many orders of magnitude",
        )


@telling()
def simulate(
    manipulator: Manipulator,
    foam: Foam,
    head: Head | ConstrainedHead,
    *,
    closing_speed: float,
    manipulator_speed: float | None = None,
    duration: float = 0.06,
    step: float = 1e-3,
    method: Method = "exact",
    contact: Contact = "linear",
    set_point: SetPoint | None = None,
    equations: Equations = "corrected",
) -> ImpactResponse:
    """Return the histories of an impact.

    -f_c = M_r x_r'' + C_r (x_r' - x_d') + K_r (x_r - x_d), f_c = K_c eps + C_c eps',
    f_c = M_h x_h'' + C_h (x_h' - v_h) + K_h (x_h - x_t), section 3.5 of Zeng (2011).

    Parameters
    ----------
    manipulator : Manipulator
        What hits.
    foam : Foam
        What is between.
    head : Head or ConstrainedHead
        What is hit.
    closing_speed : float
        v_c = v_r(0) - v_h(0) in m/s, positive.
    manipulator_speed : float or None
        v_r in m/s; the closing speed when ``None``, so that the torso is at rest.
    duration : float
        In s.
    step : float
        Time between rows, in s; also the integration step of ``"rk4"``.
    method : str
        ``"exact"``: series of the exact solution, whatever the step. ``"rk4"``: classical
        Runge-Kutta steps of order 4.
    contact : str
        ``"linear"``: the foam may pull. ``"unilateral"``: the bodies part where the force would
        become negative, the foam relaxes and may be touched again.
    set_point : SetPoint or None
        Motion of the manipulator's set-point; constant speed when ``None``.
    equations : str
        ``"corrected"``: the equations above. ``"as_printed"``: the transfer functions with the
        coefficient q_2 of (3.5.14) as the source prints it, without C_r C_h / (M_r M_h). It is no
        law of two bodies (the compression is not their distance then) and is there only to
        explain printed numbers: exact method, linear contact, set-point at constant speed. Both
        are the same where C_r or C_h is zero.

    Returns
    -------
    ImpactResponse
        Histories and metrics.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, or the samples (at most 1e8) do not fit into memory.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C, however long the record is.

    Examples
    --------
    >>> from hrsafety import impact
    >>> run = impact.simulate(
    ...     impact.MANIPULATOR_1, impact.FOAM_3, impact.Head.minimum(), closing_speed=1.25,
    ...     contact="unilateral",
    ... )
    >>> round(float(run.release_times[0]), 7)
    0.0249281
    """
    check_parts(manipulator, foam, head)
    steady = SetPoint() if set_point is None else instance("set_point", set_point, SetPoint)
    speed = number("closing_speed", closing_speed)
    own_speed = None if manipulator_speed is None else number("manipulator_speed", manipulator_speed)
    check_speeds(speed, own_speed)
    lasting = number("duration", duration)
    columns, values = _hrsafety.impact_simulate(
        manipulator._native,
        foam._native,
        head._native,
        closing_speed=speed,
        manipulator_speed=own_speed,
        duration=lasting,
        step=number("step", step),
        runge_kutta=word("method", method, ("exact", "rk4")) == "rk4",
        unilateral=word("contact", contact, ("linear", "unilateral")) == "unilateral",
        as_printed=word("equations", equations, ("corrected", "as_printed")) == "as_printed",
        set_point=steady._native,
    )
    check_finite(speed, columns["contact_force"], columns["compression"], columns["manipulator_position"])
    doubts = manipulator.warnings + foam.warnings + head.warnings + speed_warnings(speed, own_speed)
    doubts += implausible({"duration": lasting}, {"duration": "impact_time"})
    return ImpactResponse(
        **columns,
        metrics=judged(values, foam, doubts),
        compression_status=compression_status(columns["compression"], foam),
    )
