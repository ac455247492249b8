"""Loads of a measured impact, from sampled signals."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns, number, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.criteria.loads import STANDARD_GRAVITY, Doubts, ImpactMetrics
from hrsafety.plausibility import ResultWarning, implausible, telling

__all__ = ["recorded_metrics"]

HELD_WINDOW = 0.003
"""Window of the 3 ms criteria, in s."""


@telling()
def recorded_metrics(
    time: npt.ArrayLike,
    acceleration_g: npt.ArrayLike,
    *,
    contact_force: npt.ArrayLike | None = None,
    compression: npt.ArrayLike | None = None,
    manipulator_velocity: npt.ArrayLike | None = None,
    start: float | None = None,
    linear_range: float | None = None,
    thickness: float | None = None,
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
    thickness : float or None
        Thickness of the foam in m, at least its linear range; no limit when ``None``.

    Returns
    -------
    ImpactMetrics
        NaN where the signals for a field are missing: the power of the manipulator needs force and
        velocity, that of the foam force and compression.

    Raises
    ------
    InvalidParameterError
        If there are less than two samples, time does not increase, a value is not finite, or the
        start is outside the record, or a step is longer than the 15 ms of the head injury criterion, as
        with milliseconds.
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
    partners = {name: _partner(instants, name, value) for name, value in others.items()}
    foam_range = math.inf if linear_range is None else positive("linear_range", linear_range)
    depth = math.inf if thickness is None else positive("thickness", thickness)
    if linear_range is not None and foam_range > depth:
        raise InvalidParameterError("linear_range", f"be at most the thickness of {depth:g} m", linear_range)
    values = _hrsafety.recorded_metrics(
        instants,
        signal,
        **partners,
        start=None if start is None else number("start", start),
        linear_range=min(foam_range, depth),
        thickness=depth,
    )
    found = ImpactMetrics._make(values)
    found.bottomed = found.max_compression > depth
    found.warnings = _warnings(instants, signal, partners, found)
    return found


def _partner(time: Array, name: str, value: npt.ArrayLike | None) -> Array | None:
    return None if value is None else columns(**{"time": time, name: value})[1]


def _warnings(time: Array, acceleration_g: Array, others: dict[str, Array | None], found: ImpactMetrics) -> Doubts:
    """Return what is doubtful about a record: its units, from what the signals say about each other."""
    step = float(time[-1] - time[0]) / (len(time) - 1)
    lasting = found.impact_duration if math.isfinite(found.impact_duration) else step * (len(time) - 1)
    force, peak = found.peak_contact_force, found.peak_head_acceleration
    named: dict[str, tuple[object, str]] = {
        "time": (step, "sampling_step"),
        "acceleration_g": (_extremes(acceleration_g), "head_acceleration_g"),
        "velocity that the head gains by acceleration_g": (
            STANDARD_GRAVITY * found.mean_head_acceleration_g * lasting,
            "head_velocity_gain",
        ),
        "mass of the head by contact_force and acceleration_g": (
            force / peak if force > 0.0 and peak > 0.0 else None,
            "apparent_head_mass",
        ),
    }
    ranges = {
        "contact_force": "contact_force",
        "compression": "compression",
        "manipulator_velocity": "manipulator_speed",
    }
    named |= {name: (None if values is None else _extremes(values), ranges[name]) for name, values in others.items()}
    doubts = implausible(
        {name: value for name, (value, _) in named.items()}, {name: quantity for name, (_, quantity) in named.items()}
    )
    if np.diff(time).max() > HELD_WINDOW:
        message = (
            f"time has steps of up to {np.diff(time).max():g} s, longer than the 3 ms over which average_3ms_g and "
            "clip_3ms_g are taken; between samples the signal is a straight line"
        )
        doubts += (ResultWarning("coarse_sampling", "time", message),)
    return doubts


def _extremes(values: Array) -> Array:
    return np.array([values.min(), values.max()])
