"""Shape of a measured trace: its rest, where it is above a threshold, and whether the channel was full."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.criteria.doubts import SignalShape, measurement_doubts
from hrsafety.plausibility import ResultWarning

__all__ = ["Part", "Rest", "even_step", "full", "integral", "parts", "rest", "shape_doubts", "threshold"]

_NOTICEABLE_REST = 0.05
"""Noise, and offset, as shares of the peak, from which on they are told."""
_THRESHOLD = 0.05
_OF_SHAPE = ("offset", "coarse_sampling")
_DEVIATIONS = 3.0
FULL_SCALE = 0.995
"""Share of the full scale of a channel from which on it counts as full."""


class Rest(NamedTuple):
    """Quiet part of a record before its peak.

    Attributes
    ----------
    offset : ndarray, shape (channels,)
        Values at rest.
    noise : float
        Root mean square of the channels about them.
    known : bool
        Whether there is a quiet part; offset and noise are 0 without one.
    """

    offset: Array
    noise: float
    known: bool


class Part(NamedTuple):
    """Part of a record that is above a threshold.

    Attributes
    ----------
    start, end : float or None
        Crossings of the threshold in s; ``None`` where the record begins or ends above it.
    first, last : int
        First and last sample of it.
    """

    start: float | None
    end: float | None
    first: int
    last: int


def even_step(time: Array) -> float:
    """Return the step of an even record in s.

    Raises
    ------
    InvalidParameterError
        If times do not rise evenly.
    """
    if len(time) < 3:
        raise InvalidParameterError("time", "have at least 3 samples", len(time))
    steps = np.diff(time)
    step = float(time[-1] - time[0]) / (len(time) - 1)
    if not steps.min() > 0.0 or steps.max() > 1.5 * step:
        worst = int(np.argmin(steps)) if not steps.min() > 0.0 else int(np.argmax(steps))
        rule = f"rise in even steps of {step:.6g} s, also after sample {worst}"
        raise InvalidParameterError("time", rule, float(steps[worst]), "cut the record at the gap, or resample it")
    return step


def rest(channels: Array, peak: int, size: float, samples: int) -> Rest:
    """Return the quiet part of a record: the window of least variance before its peak.

    Parameters
    ----------
    channels : ndarray, shape (n, channels)
        As measured.
    peak : int
        Sample of the peak.
    size : float
        Size of it.
    samples : int
        Length of the window.
    """
    channels_before = channels[:peak]
    nothing = Rest(np.zeros(channels.shape[1]), 0.0, False)
    if samples < 1 or len(channels_before) < samples:
        return nothing
    # About a value near those of the window, so that squares of large offsets do not cancel.
    centered = channels_before - np.median(channels_before, axis=0)
    sums, squares = (_windows(each, samples) for each in (centered, centered**2))
    variance = (squares / samples - (sums / samples) ** 2).sum(axis=1)
    begin = int(np.argmin(variance))
    window = channels_before[begin : begin + samples]
    offset = np.median(window, axis=0)
    noise = float(np.sqrt(((window - offset) ** 2).mean(axis=0).sum()))
    return nothing if noise > _NOTICEABLE_REST * size else Rest(offset, noise, True)


def _windows(values: Array, samples: int) -> Array:
    """Return sums of windows of so many samples along the first axis."""
    summed = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return np.asarray(summed[samples:] - summed[:-samples])


def threshold(peak: float, noise: float) -> float:
    """Return the level above which a contact counts: 5 % of the peak, or three times the noise."""
    return max(_THRESHOLD * peak, _DEVIATIONS * noise)


def parts(time: Array, values: Array, level: float, bridged: float) -> list[Part]:
    """Return the parts of a record above a level, over dips of so many s; crossings are linear."""
    above = np.concatenate([[False], values > level, [False]])
    begins, ends = np.flatnonzero(above[1:] & ~above[:-1]), np.flatnonzero(above[:-1] & ~above[1:]) - 1
    found: list[Part] = []
    for first, last in zip(begins.tolist(), ends.tolist(), strict=True):
        part = Part(_crossing(time, values, level, first, -1), _crossing(time, values, level, last, 1), first, last)
        before = found[-1] if found else None
        # A dip has two crossings: only the ends of a record have none.
        if before and before.end is not None and part.start is not None and part.start - before.end <= bridged:
            found[-1] = before._replace(end=part.end, last=last)
        else:
            found.append(part)
    return found


def _crossing(time: Array, values: Array, level: float, inside: int, way: int) -> float | None:
    """Return when a record crosses a level between a sample and the next one outside."""
    outside = inside + way
    if not 0 <= outside < len(values):
        return None
    share = (values[inside] - level) / (values[inside] - values[outside])
    return float(time[inside] + share * (time[outside] - time[inside]))


def integral(time: Array, values: Array, part: Part, level: float) -> float:
    """Return the integral of a record over a part of it, linear between samples."""
    inside = slice(part.first, part.last + 1)
    instants, signal = time[inside], values[inside]
    if part.start is not None:
        instants, signal = np.insert(instants, 0, part.start), np.insert(signal, 0, level)
    if part.end is not None:
        instants, signal = np.append(instants, part.end), np.append(signal, level)
    return float(np.trapezoid(signal, instants))


def full(time: Array, values: Array, full_scale: float | None) -> bool:
    """Return whether a channel was full: a flat top at its largest value, or its full scale.

    Parameters
    ----------
    time, values : ndarray, shape (n,)
        As measured.
    full_scale : float or None
        Of the channel, in its unit.
    """
    upward = np.ascontiguousarray(values if values.max() >= -values.min() else -values)
    if full_scale is not None and upward.max() >= FULL_SCALE * full_scale:
        return True
    return SignalShape.of(time, upward, (time[0], time[0])).flat > 0


def rest_doubts(found: Rest, peak: float, unit: str, window: float, resting: str) -> Iterator[ResultWarning]:
    """Give what is doubtful about the rest of a record with a peak in its unit."""
    if not found.known:
        message = (
            f"no {1e3 * window:g} ms before the peak are quiet to {_NOTICEABLE_REST:.0%} of it: no offset was taken "
            "off, and noise is not known; record some time before the contact"
        )
        yield ResultWarning("no_quiet_part", "record", message)
    largest = float(np.abs(found.offset).max())
    if largest > _NOTICEABLE_REST * peak:
        shown = ", ".join(f"{value:.4g}" for value in found.offset)
        message = f"an offset of {shown} {unit} was taken off{resting}"
        yield ResultWarning("offset_removed", "record", message, safe_side=True)


def shape_doubts(time: Array, signal: Array, unit: str, window: float) -> Iterator[ResultWarning]:
    """Give what makes the loads of a turned signal without offset too small: a level that drifts, few true samples."""
    shape = SignalShape.of(time, signal, (time[0], time[0]), window)
    for doubt in measurement_doubts("values", unit, shape):
        if doubt.code in _OF_SHAPE and not doubt.safe_side:
            yield doubt


def largest_of(values: Array, part: Part) -> tuple[int, float]:
    """Return where a part is largest, and how large."""
    place = part.first + int(np.argmax(values[part.first : part.last + 1]))
    return place, float(values[place])


def window_samples(window: float, step: float) -> int:
    """Return how many samples a window of so many s has."""
    return round(window / step) if math.isfinite(window / step) else 0
