"""Doubts about the measurement of a sampled signal: sign, rest, flat tops, sampling."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple, Self

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety.plausibility import ResultWarning, issue, unsafe_doubts

__all__ = ["SignalShape", "cut_off", "issued", "measurement_doubts", "mirrored_doubt"]

REST = 0.01
"""Time over which an acceleration is examined for its rest, in s."""
FORCE_REST = 0.02
"""Time over which a force is, in s."""

# A rest away from zero by this share of the peak: HIC goes with the power 2.5 of the acceleration.
_OFFSET = 0.02
# The same where it makes loads smaller: 1 % of the peak takes 3 % of the HIC of a half sine.
_LOWERED = 0.01
# Medians of noise stay within this many times its rms over the square root of the samples.
_MEDIAN_ERRORS = 5.0
# A level after the push that is lower than before it by this share of the peak: the channel has drifted.
_DRIFT = 0.05
# The same where less than five samples tell it.
_OFFSET_OF_FEW = 0.05
_FEW = 5
# Samples in the width at half of the peak, at least: a half sine loses less than 5 % of its HIC then.
_SAMPLES_OF_WIDTH = 6.0
# A record begins or ends within the push above this share of its peak: damped foams alone begin with a third of it.
_INSIDE = 0.5
# Parts of the other sign that are larger than this share are no rebound.
_MIRRORED = 1.0 + 1e-9


class SignalShape(NamedTuple):
    """Features of a signal.

    Attributes
    ----------
    least, most : float
        Extremes.
    width, step : float
        Time above half of the largest value, and the longest step in it, in s; NaN unless that is positive.
    longest_step : float
        Of the whole record, in s.
    rest, noise : float
        Median of the quietest samples before the push and the rms about it; NaN without any.
    rest_samples : int
        How many these are.
    flat : int
        Equal neighboring samples at the largest value; 0 if they are no flat top.
    area : float
        Of the push around the window, in the unit of the signal times s.
    levels : tuple of float
        The rest extended to the peak along its slope; the level at the end of the record, NaN unless that is quiet and
        after the push; and the length of the straight lines of which the push is made, in s, 0 if it is not.
    """

    least: float
    most: float
    width: float
    step: float
    longest_step: float
    rest: float
    noise: float
    rest_samples: int
    flat: int
    area: float
    levels: tuple[float, float, float]

    @classmethod
    def of(cls, time: Array, values: Array, window: tuple[float, float], rest: float = REST) -> Self:
        """Return the features of a signal; the rest is looked for over ``rest`` seconds."""
        return cls._make(_hrsafety.signal_shape(time, values, rest, window))

    @property
    def peak(self) -> float:
        """Largest absolute value."""
        return max(self.most, -self.least)

    @property
    def sampled(self) -> float:
        """Longest time between true samples of the peak, in s."""
        return max(self.step, self.levels[2])

    @property
    def is_sound(self) -> bool:
        """Whether nothing is doubtful: nearly always, and quickly told."""
        level, after, _ = self.levels
        return (
            self.most > 0.0
            and -self.least <= self.most
            and self.flat == 0
            and self.width >= _SAMPLES_OF_WIDTH * self.sampled
            and not abs(self.rest) > _LOWERED * self.most
            and not level < -_LOWERED * self.most
            and not after < -_LOWERED * self.most
        )


def cut_off(
    name: str, unit: str, time: Array, values: Array, shape: SignalShape, start: float | None = None
) -> Iterator[ResultWarning]:
    """Give the doubt that a record, or what of it is judged, does not hold the whole push.

    A first contact that is told may be a step up, but what comes before it may not be as high already.
    """
    least = _INSIDE * shape.most
    if start is None:
        if values[0] > least > 0.0:
            yield ResultWarning("starts_inside", name, _cut(name, unit, "begins", values[0], shape))
    else:
        before = values[: np.searchsorted(time, start, side="right")]
        if before[-1] > least > 0.0:
            message = (
                f"{name} is at {before[-1]:g} {unit} already before start ({start:g} s), more than half of its largest "
                f"value of {shape.most:g} {unit}: the first contact is earlier"
            )
            yield ResultWarning("starts_inside", "start", message)
    if values[-1] > least > 0.0:
        yield ResultWarning("ends_inside", name, _cut(name, unit, "ends", values[-1], shape))


def _cut(name: str, unit: str, end: str, value: float, shape: SignalShape) -> str:
    """Return that a record begins or ends within the push."""
    return (
        f"{name} {end} at {value:g} {unit}, more than half of its largest value of {shape.most:g} {unit}: the record "
        f"{end} within the push, and what is beyond is not in the loads; record longer"
    )


def measurement_doubts(name: str, unit: str, shape: SignalShape) -> Iterator[ResultWarning]:
    """Give what is doubtful about how a signal was measured whose loads are its positive values."""
    most = shape.most
    if shape.is_sound:
        return
    if -shape.least > most:
        yield negative_axis(name, f"{name} goes down to {shape.least:g} {unit} and up to {most:g} {unit} only")
    elif most <= 0.0:
        message = f"{name} is never positive: nothing was hit, or the channel is dead; nothing is judged"
        yield ResultWarning("no_push", name, message)
    yield from _offset(name, unit, shape)
    if shape.flat:
        message = (
            f"{name} stays at its largest value of {most:g} {unit} for {shape.flat} samples: the channel is saturated, "
            "and the true loads are larger, or its digits are too coarse to tell; measure with another range"
        )
        yield ResultWarning("saturated", name, message)
    if shape.width < _SAMPLES_OF_WIDTH * shape.sampled:
        steps = f"time has steps of {shape.step:g} s where {name} is"
        if shape.sampled > shape.step:
            steps = f"{name} is made of straight lines of {shape.sampled:g} s between its true samples, and is"
        message = (
            f"{steps} above half of its peak for {shape.width:g} s: with less than {_SAMPLES_OF_WIDTH:g} steps "
            "the peak and the criteria are too low; sample faster, or filter single peaks of noise"
        )
        yield ResultWarning("coarse_sampling", "time", message)


def negative_axis(name: str, what: str) -> ResultWarning:
    """Return the doubt about a signal whose larger part does not count because it is negative."""
    message = f"{what}: only positive values are judged; turn the sign if the axis points the other way"
    return ResultWarning("negative_axis", name, message)


def mirrored_doubt(
    name: str, criterion: str, value: float, bound: float, mirrored: Callable[[], float]
) -> Iterator[ResultWarning]:
    """Give the doubt that a criterion is larger for the signal with the other sign.

    ``bound`` is what that could be at most; only where it is larger, ``mirrored`` is computed.
    """
    if bound > value * _MIRRORED and (other := mirrored()) > value * _MIRRORED:
        yield negative_axis(name, f"{criterion} is {value:.4g} for {name} and {other:.4g} with the other sign")


def _offset(name: str, unit: str, shape: SignalShape) -> Iterator[ResultWarning]:
    peak, positive = shape.peak, shape.most == shape.peak
    level, after, _ = shape.levels
    few = _OFFSET_OF_FEW if shape.rest_samples < _FEW else 0.0
    lowest = min(shape.rest, level)
    # What is subtracted from a positive pulse makes every load smaller.
    error = _MEDIAN_ERRORS * shape.noise / max(shape.rest_samples, 1) ** 0.5
    if positive and lowest < -max(max(_LOWERED, few) * peak, error):
        where = f"rests at {shape.rest:g} {unit} before its peak of {peak:g} {unit}"
        if level < shape.rest:
            where = f"drifts to {level:g} {unit} at its peak of {peak:g} {unit}"
        yield _offset_doubt(name, where)
    # A rise that begins at zero has a median of 1.7 times its rms about it.
    elif abs(shape.rest) > max(max(_OFFSET, few) * peak, 2.0 * shape.noise):
        safe = shape.rest > 0.0 and positive
        # A level that wanders may be the foot of the pulse.
        if not safe or shape.noise <= _OFFSET * peak:
            yield _offset_doubt(name, f"rests at {shape.rest:g} {unit} before its peak of {peak:g} {unit}", safe)
    elif positive and after < (0.0 if shape.rest != shape.rest else shape.rest) - _DRIFT * peak:
        yield _offset_doubt(name, f"stays at {after:g} {unit} after its peak of {peak:g} {unit}")


def _offset_doubt(name: str, where: str, safe: bool = False) -> ResultWarning:
    message = (
        f"{name} {where}: an offset or a drift of the channel, or gravity, which every criterion contains; subtract "
        "the mean of a part at rest"
    )
    return ResultWarning("offset", name, message, safe_side=safe)


def issued(found: tuple[ResultWarning, ...], stacklevel: int = 3) -> tuple[ResultWarning, ...]:
    """Return doubts after those on the unsafe side were issued through `warnings.warn` too.

    ``stacklevel`` 3 points at who calls the function that calls this one.
    """
    for doubt in unsafe_doubts(found):
        if doubt.code != "implausible":
            issue(doubt.message, stacklevel=stacklevel)
    return found
