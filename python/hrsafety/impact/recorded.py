"""Loads of a measured impact, from sampled signals."""

from __future__ import annotations

import math

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns, number, positive
from hrsafety.impact.criteria import ImpactMetrics

__all__ = ["recorded_metrics"]


def recorded_metrics(
    time: npt.ArrayLike,
    acceleration_g: npt.ArrayLike,
    *,
    contact_force: npt.ArrayLike | None = None,
    compression: npt.ArrayLike | None = None,
    manipulator_velocity: npt.ArrayLike | None = None,
    start: float | None = None,
    linear_range: float | None = None,
) -> ImpactMetrics:
    """Return the loads of a measured impact, with the definitions of `metrics`.

    Signals are linear between their samples. The impact period runs from first contact to the
    first zero at which the head acceleration falls; without one the status is ``"no_release"`` and
    maxima are over the rest of the record. Noise ends the period early and raises every maximum:
    filter measured signals first, see `channel_filter`.

    Parameters
    ----------
    time : array_like of shape (n,)
        Sample times in s, increasing.
    acceleration_g : array_like of shape (n,)
        Head acceleration in g.
    contact_force : array_like of shape (n,) or None
        f_c in N.
    compression : array_like of shape (n,) or None
        eps in m.
    manipulator_velocity : array_like of shape (n,) or None
        x_r' in m/s.
    start : float or None
        First contact, in s; the first sample when ``None``.
    linear_range : float or None
        Compression lambda up to which the foam is linear, in m; no limit when ``None``.

    Returns
    -------
    ImpactMetrics
        NaN where the signals for a field are missing: the power of the manipulator needs force and
        velocity, that of the foam force and compression.

    Raises
    ------
    InvalidParameterError
        If there are less than two samples, time does not increase, a value is not finite, or the
        start is outside the record.
    ShapeError
        If the arrays are not one-dimensional and of one length.

    Examples
    --------
    The loads of a simulated record are those of the simulation:

    >>> from hrsafety import impact
    >>> run = impact.simulate(
    ...     impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.25, step=1e-4)
    >>> found = impact.recorded_metrics(run.time, run.head_acceleration / 9.80665)
    >>> round(found.hic15, 3), round(run.metrics.hic15, 3), found.status
    (1.151, 1.151, 'released')
    """
    instants, signal = columns(time=time, acceleration_g=acceleration_g)
    others = {
        "contact_force": contact_force,
        "compression": compression,
        "manipulator_velocity": manipulator_velocity,
    }
    values = _hrsafety.recorded_metrics(
        instants,
        signal,
        **{name: _partner(instants, name, value) for name, value in others.items()},
        start=None if start is None else number("start", start),
        linear_range=math.inf if linear_range is None else positive("linear_range", linear_range),
    )
    return ImpactMetrics._make(values)


def _partner(time: Array, name: str, value: npt.ArrayLike | None) -> Array | None:
    return None if value is None else columns(**{"time": time, name: value})[1]
