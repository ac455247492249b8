"""Loads of a measured impact, from sampled signals."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns, number, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.criteria.declared import CRITERIA
from hrsafety.impact.criteria.doubts import FORCE_REST, SignalShape, cut_off, issued, measurement_doubts
from hrsafety.impact.criteria.filters import filtered_pulse
from hrsafety.impact.criteria.loads import STANDARD_GRAVITY, Doubts, ImpactMetrics, hic_doubts, merged
from hrsafety.plausibility import ResultWarning, implausible, telling

__all__ = ["recorded_metrics"]

HELD_WINDOW = 0.003
"""Window of the 3 ms criteria, in s."""
INJURY_WINDOW = 0.015
"""Shorter window of the head injury criterion, in s."""

# Not loads, or the same load in another unit.
_OF_PERIOD = ("peak_head_acceleration", "mean_head_acceleration_g", "impact_duration")
# Rounding apart.
_NOTICEABLE = 1.0 + 1e-3
_PART_OF_LEVEL = 0.01
# A part of the record with a peak of so much of the largest one is a hit of its own.
_PART_OF_PEAK = 0.3
_OF_PARTNER = ("negative_axis", "saturated")


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
    channel_class: int | None = None,
) -> ImpactMetrics:
    """Return the loads of a measured impact, with the definitions of `metrics`.

    Signals are linear between their samples, and only positive accelerations and forces are loads. The impact period
    lies around the largest acceleration of the record: from the last zero before it to the first zero after it;
    noise, a smaller hit or an undershoot elsewhere neither begins nor ends it. Without a zero after it the status
    is ``"no_release"`` and maxima are over the rest of the record. Noise raises every maximum, and where it
    crosses zero near the peak it ends the period early: filter measured signals first, see `channel_filter`.

    Nothing is repaired. What makes loads doubtful is in ``warnings``, and is issued through `warnings.warn`
    unless its error is on the safe side: a criterion that is larger over the whole record than over the period,
    as with a second hit (``"outside_period"``); a signal whose larger part is negative (``"negative_axis"``), or that
    is never positive (``"no_push"``); a rest away from zero (``"offset"``); a flat top (``"saturated"``); too few
    samples in the peak (``"coarse_sampling"``); a record that begins or ends within the push
    (``"starts_inside"``, ``"ends_inside"``); a filter that took away part of the pulse (``"filtered_pulse"``). With
    one of them no limit counts as kept, see `FoamLimits.verdict`.

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
        First contact, in s, if it is known: what is before is left out, and the impact period begins there unless
        the acceleration is negative between it and its largest value.
    linear_range : float or None
        Compression lambda up to which the foam is linear, in m; no limit when ``None``.
    thickness : float or None
        Thickness of the foam in m, at least its linear range; no limit when ``None``.
    channel_class : int or None
        Channel class through which the acceleration was filtered, 60, 180, 600 or 1000: only to tell whether the
        pulse was too short for it (needs SciPy); nothing is filtered here.

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
        with milliseconds. For a channel class also as `channel_filter`.
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
    contact = None if start is None else number("start", start)
    values, whole = _hrsafety.recorded_metrics(
        instants,
        signal,
        **partners,
        start=contact,
        linear_range=min(foam_range, depth),
        thickness=depth,
    )
    found = ImpactMetrics._make(values)
    found.bottomed = found.max_compression > depth
    record = _Record(instants, signal, partners, contact, SignalShape.of(instants, signal, (instants[0], instants[0])))
    doubts = (
        *_outside(found, dict(zip(CRITERIA, whole, strict=True))),
        *_measured(record, found),
        *(() if channel_class is None else filtered_pulse(instants, signal, channel_class)),
        *_units(record, found),
    )
    found.warnings = issued(merged(doubts), stacklevel=4)
    return found


class _Record(NamedTuple):
    time: Array
    acceleration_g: Array
    others: dict[str, Array | None]
    start: float | None
    shape: SignalShape


def _partner(time: Array, name: str, value: npt.ArrayLike | None) -> Array | None:
    return None if value is None else columns(**{"time": time, name: value})[1]


def _outside(found: ImpactMetrics, whole: dict[str, float]) -> Iterator[ResultWarning]:
    """Give every load that the impact period leaves out."""
    for name, criterion in CRITERIA.items():
        inside, outside = getattr(found, name), whole[name]
        # A period of less than 3 ms has no level over 3 ms, the rest of the record should have none either.
        if name == "clip_3ms_g" and math.isnan(inside):
            inside = _PART_OF_PEAK * found.peak_head_acceleration_g
        # Levels over 3 ms of a period of little more than that are next to nothing, and so are their differences.
        least = _PART_OF_LEVEL * found.peak_head_acceleration_g if name.endswith("3ms_g") else 0.0
        if name not in _OF_PERIOD and outside > inside * _NOTICEABLE + least:
            unit = f" {criterion.unit}" if criterion.unit else ""
            message = (
                f"{criterion.label} ({name}) is {outside:.4g}{unit} over the whole record, and {inside:.4g}{unit} over "
                "the impact period around the largest acceleration: a second hit, or zeros within the push; judge "
                "every hit by itself, and the record by the larger number"
            )
            yield ResultWarning("outside_period", name, message)


def _measured(record: _Record, found: ImpactMetrics) -> Iterator[ResultWarning]:
    """Give what is doubtful about how the signals were measured."""
    time, signal, shape = record.time, record.acceleration_g, record.shape
    yield from cut_off("acceleration_g", "g", time, signal, shape, record.start)
    yield from measurement_doubts("acceleration_g", "g", shape)
    yield from hic_doubts(time, signal, shape, max(found.hic15, 0.0), INJURY_WINDOW, True)
    if record.start is not None and shape.most > found.peak_head_acceleration_g * _NOTICEABLE:
        message = (
            f"start is {record.start:g} s, and before it acceleration_g reaches {shape.most:g} g, more than the "
            f"{found.peak_head_acceleration_g:g} g after it: is the first contact earlier?"
        )
        yield ResultWarning("outside_period", "start", message)
    if shape.longest_step > HELD_WINDOW:
        message = (
            f"time has steps of up to {shape.longest_step:g} s, longer than the 3 ms over which average_3ms_g and "
            "clip_3ms_g are taken; between samples the signal is a straight line"
        )
        yield ResultWarning("coarse_sampling", "time", message)
    for name, unit in (("contact_force", "N"), ("compression", "m")):
        values = record.others[name]
        if values is not None:
            own = SignalShape.of(time, values, (time[0], time[0]), FORCE_REST)
            # Foam that is not touched yet may well be compressed by less than nothing: that is a distance.
            doubts = measurement_doubts(name, unit, own)
            yield from (each for each in doubts if each.code in _OF_PARTNER or name == "contact_force")


def _units(record: _Record, found: ImpactMetrics) -> Doubts:
    """Return what is doubtful about units, from what the signals say about each other."""
    time, shape = record.time, record.shape
    step = float(time[-1] - time[0]) / (len(time) - 1)
    lasting = found.impact_duration if math.isfinite(found.impact_duration) else step * (len(time) - 1)
    force, peak = found.peak_contact_force, found.peak_head_acceleration
    named: dict[str, tuple[object, str]] = {
        "time": (step, "sampling_step"),
        "acceleration_g": (np.array([shape.least, shape.most]), "head_acceleration_g"),
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
    named |= {
        name: (None if values is None else _extremes(values), ranges[name]) for name, values in record.others.items()
    }
    return implausible(
        {name: value for name, (value, _) in named.items()}, {name: quantity for name, (_, quantity) in named.items()}
    )


def _extremes(values: Array) -> Array:
    return np.array([values.min(), values.max()])
