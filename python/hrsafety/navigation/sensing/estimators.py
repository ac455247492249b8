"""Position and velocity of a body from its measured positions."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, number, points, vector
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["AlphaBeta", "Differences", "Estimator", "Kalman", "TrackedPositions", "track_positions"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Differences(Parameters):
    """The last position, and the difference of the last two over their interval as velocity.

    What the source does. With independent errors of standard deviation s and a period T, the
    velocity has sqrt(2) s / T.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.Differences()
    Differences()
    """

    _native: _hrsafety.Estimator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Make the native counterpart."""
        self._set(_native=_hrsafety.Estimator.differences())


@dataclass(frozen=True, kw_only=True, slots=True)
class AlphaBeta(Parameters):
    """Filter with constant gains for a body of constant velocity.

    With the residual r of the predicted position, x += alpha r and v += beta r / dt. The first two
    measurements start it.

    Parameters
    ----------
    position_gain : float
        Gain alpha, above 0 and at most 1.
    velocity_gain : float
        Gain beta, above 0 and below 4 - 2 alpha, where the filter becomes unstable.

    Raises
    ------
    InvalidParameterError
        If a gain is out of its range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.AlphaBeta(position_gain=0.5, velocity_gain=0.2).velocity_gain
    0.2
    """

    position_gain: float
    velocity_gain: float
    _native: _hrsafety.Estimator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        gains = self._as_numbers("position_gain", "velocity_gain")
        self._set(_native=_hrsafety.Estimator.alpha_beta(**gains))

    @classmethod
    def from_deviations(cls, *, acceleration: float, position: float, period: float) -> AlphaBeta:
        """Return the filter with the steady gains of a Kalman filter.

        Closed form of Kalata (1984) in L = acceleration period^2 / position.

        Parameters
        ----------
        acceleration : float
            Standard deviation of the acceleration, constant over a period, in m/s^2.
        position : float
            Standard deviation of a measured coordinate in m.
        period : float
            Time between two measurements in s.

        Returns
        -------
        AlphaBeta
            The filter.

        Raises
        ------
        InvalidParameterError
            If a value is not finite and positive.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> filter_ = nav.sensing.AlphaBeta.from_deviations(acceleration=1.0, position=0.0032, period=0.06)
        >>> round(filter_.position_gain, 3), round(filter_.velocity_gain, 3)
        (0.769, 0.54)
        """
        alpha, beta = _hrsafety.steady_gains(
            acceleration_deviation=number("acceleration", acceleration),
            position_deviation=number("position", position),
            period=number("period", period),
        )
        return cls(position_gain=alpha, velocity_gain=beta)


@dataclass(frozen=True, kw_only=True, slots=True)
class Kalman(Parameters):
    """Kalman filter of a body whose acceleration is random, constant from one measurement to the next.

    State position and velocity, x and y alike; F = (1, dt; 0, 1), Q = s_a^2 g g^T with
    g = (dt^2/2, dt). A lost frame makes the interval dt longer.

    Parameters
    ----------
    acceleration_deviation : float
        Standard deviation s_a of the acceleration in m/s^2. With people who stop, start and turn at
        1 m/s^2 and periods near 0.06 s, 1 m/s^2 gives smaller errors of the velocity than 2 to 10.
    position_deviation : float
        Standard deviation of a measured coordinate in m.
    speed_deviation : float
        Standard deviation of each component of the velocity before the first measurement, in m/s.

    Raises
    ------
    InvalidParameterError
        If a value is not positive, or not between 1e-100 and 1e100.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.Kalman().acceleration_deviation
    1.0
    """

    acceleration_deviation: float = 1.0
    position_deviation: float = 0.0032
    speed_deviation: float = 1.0
    _native: _hrsafety.Estimator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers("acceleration_deviation", "position_deviation", "speed_deviation")
        self._set(_native=_hrsafety.Estimator.kalman(**values))


Estimator = Differences | AlphaBeta | Kalman


def checked_estimator(value: object) -> Estimator:
    """Return ``value`` if it is an estimator, or say that it should have been."""
    if not isinstance(value, Estimator):
        raise InvalidParameterError("estimator", "be a Differences, an AlphaBeta or a Kalman", value)
    return value


@displayed
class TrackedPositions(NamedTuple):
    """Estimates at the times of measured positions.

    Attributes
    ----------
    position, velocity : ndarray of shape (n, 2)
        In m and m/s; the first velocity is zero.
    measured_at : ndarray of shape (n,)
        Times of the measurements in s.
    covariance : ndarray of shape (n, 3)
        Of one coordinate, with a Kalman filter: position (m^2), position with velocity (m^2/s),
        velocity (m^2/s^2); zero for other estimators.
    """

    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    measured_at: Annotated[Array, "s"]
    covariance: Array


def track_positions(time: npt.ArrayLike, position: npt.ArrayLike, estimator: Estimator) -> TrackedPositions:
    """Return position and velocity of a body from measured positions.

    Parameters
    ----------
    time : array_like of shape (n,)
        Times of the measurements in s, rising; the intervals may differ.
    position : array_like of shape (n, 2)
        Measured positions in m. Rows of NaN are lost frames: they are left out of the result.
    estimator : Differences, AlphaBeta or Kalman
        How position and velocity follow.

    Returns
    -------
    TrackedPositions
        One row for each measurement.

    Raises
    ------
    InvalidParameterError
        If the times do not rise, a number is not finite, or the estimator is none.
    ShapeError
        If a shape is wrong.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> places = [[0.0, 0.0], [0.1, 0.0], [0.3, 0.0]]
    >>> track = nav.sensing.track_positions([0.0, 0.1, 0.2], places, nav.sensing.Differences())
    >>> track.velocity.round(3).tolist()
    [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]
    """
    instants, places = measured_path(time, position, lost=True)
    taken = np.flatnonzero(~np.isnan(places).all(axis=1))
    fields = checked_estimator(estimator)._native.track(instants[taken], places[taken])
    return TrackedPositions(**fields)


def measured_path(time: npt.ArrayLike, position: npt.ArrayLike, *, lost: bool) -> tuple[Array, Array]:
    """Return rising times and positions; rows of NaN are refused unless frames may be lost."""
    instants, places = vector("time", time), points("position", position)
    if len(instants) != len(places):
        raise ShapeError("position", f"({len(instants)}, 2)", places.shape)
    for name, values in (("time", instants), ("position", places)):
        kept = values[~np.isnan(places).all(axis=1)] if lost and name == "position" else values
        bad = kept[np.logical_not(np.isfinite(kept))]
        if bad.size:
            raise InvalidParameterError(name, "be finite", float(bad[0]))
    falls = np.flatnonzero(np.diff(instants) <= 0.0)
    if len(falls):
        raise InvalidParameterError("time", "rise from sample to sample", float(instants[falls[0] + 1]))
    return instants, places
