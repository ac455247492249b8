"""Channel filters for measured signals (needs SciPy: ``pip install scipy``)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.impact.criteria.doubts import issued
from hrsafety.plausibility import ResultWarning

__all__ = ["CHANNEL_CLASSES", "channel_corner", "channel_filter"]

#: Channel frequency classes of SAE J211, in Hz.
CHANNEL_CLASSES = (60, 180, 600, 1000)

# Corner of each two-pole pass over the class: both passes together are then 3 dB down at 5/3 of the class.
_CORNER = 2.0775
# Padding at both ends: at least 10 ms and 20 time constants of a pass, so that its start is forgotten.
_PADDING = 0.01
_TIME_CONSTANTS = 20.0
# Sampling may wander by this share of its step.
_UNEVEN = 1e-3
# Times may be off an even grid by this share of the step, as rounded ones are.
_ROUNDED = 0.25
# Samples per second for each Hz of a class, at least.
_SAMPLES_PER_CLASS = 8.0
# Window of the criterion by which a pulse is judged, in s, and the share of it that has to pass.
_WINDOW = 0.015
_PASSED = 0.95


def channel_corner(channel_class: int) -> float:
    """Return the corner frequency of the two-pole filter of a channel class.

    Parameters
    ----------
    channel_class : int
        60, 180, 600 or 1000.

    Returns
    -------
    float
        2.0775 times the class, in Hz.

    Raises
    ------
    InvalidParameterError
        If the class is none of the four.

    Examples
    --------
    >>> from hrsafety.impact.criteria import filters
    >>> round(filters.channel_corner(180), 2)
    373.95
    """
    whole = isinstance(channel_class, (int, float, np.integer, np.floating)) and not isinstance(channel_class, bool)
    if not whole or channel_class not in CHANNEL_CLASSES:
        raise InvalidParameterError("channel_class", "be 60, 180, 600 or 1000", channel_class)
    return _CORNER * float(channel_class)


def channel_filter(time: npt.ArrayLike, signal: npt.ArrayLike, channel_class: int) -> Array:
    """Return a signal without the frequencies above a channel class of SAE J211.

    A two-pole Butterworth filter runs forwards and backwards, which makes four poles without
    phase shift. With w_d = 2 pi 2.0775 CFC and w_a = tan(w_d T / 2), each pass is
    b = w_a^2 (1, 2, 1) / (1 + sqrt(2) w_a + w_a^2). Both ends are continued by point reflection
    before the passes: a signal that runs on keeps its slope there, and noise in the very first and
    last sample stays, so a record should begin before the impact and end after it. A class that
    takes more than a twentieth of the head injury criterion of the strongest pulse is issued as a
    `HrsafetyWarning`: the pulse is too short for it.

    Parameters
    ----------
    time : array_like of shape (n,)
        Sample times in s, evenly spaced but for their rounding: within a quarter of a step of an even grid.
    signal : array_like of shape (n,)
        Samples, in any unit.
    channel_class : int
        60, 180, 600 or 1000; head accelerations use 1000, head compressions 180.

    Returns
    -------
    ndarray of shape (n,)
        Filtered samples, in the same unit.

    Raises
    ------
    InvalidParameterError
        If the class is none of the four, samples are not finite, uneven or fewer than four, or the
        sampling is too slow for the class: less than 8 samples per second for each Hz of it.
    ShapeError
        If the arrays are not one-dimensional and of one length.
    ImportError
        If SciPy is not installed.

    Examples
    --------
    Slow signals pass, ringing at 3 kHz does not:

    >>> import numpy as np
    >>> from hrsafety.impact.criteria import filters
    >>> time = np.arange(2000) * 1e-4
    >>> slow, ringing = np.sin(2 * np.pi * 10 * time), 0.5 * np.sin(2 * np.pi * 3000 * time)
    >>> left = filters.channel_filter(time, slow + ringing, 180) - slow
    >>> bool(np.abs(left[100:-100]).max() < 1e-4)
    True
    """
    channel_corner(channel_class)
    instants, samples = columns(time=time, signal=signal)
    filtered = _filtered(instants, samples, channel_class)
    issued(tuple(filtered_pulse(instants, samples, channel_class, filtered)))
    return filtered


def filtered_pulse(
    time: Array, signal: Array, channel_class: int, filtered: Array | None = None
) -> Iterator[ResultWarning]:
    """Give the doubt that a channel class takes away part of the strongest pulse of a signal.

    The pulse is judged by its head injury criterion, in which noise of high frequency averages out. Without the
    ``filtered`` signal the given one has been through the class and goes once more: what lies below it passes again.
    """
    corner = channel_corner(channel_class)
    after = _filtered(time, signal, channel_class) if filtered is None else filtered
    scale = float(max(signal.max(), signal.min(), key=abs)) or 1.0
    before, passed = (_hrsafety.hic(time, each / scale, _WINDOW, True)[0] for each in (signal, after))
    if passed >= _PASSED * before:
        return
    wider = [each for each in CHANNEL_CLASSES if each > channel_class]
    remedy = f"use class {wider[0]} or a wider one" if wider else "measure with a channel that is not filtered"
    message = (
        f"{'a second pass through ' if filtered is None else ''}class {channel_class} (corner {corner:g} Hz) leaves "
        f"{passed / before:.0%} of the head injury criterion of the signal: the pulse is too short for it, and loads "
        f"are too low; {remedy}"
    )
    yield ResultWarning("filtered_pulse", "channel_class", message)


def _filtered(instants: Array, samples: Array, channel_class: int) -> Array:
    """Return a signal through the filter of a channel class, which its samples allow."""
    if len(instants) < 4:
        raise InvalidParameterError("time", "have at least 4 samples", len(instants))
    for name, values in (("time", instants), ("signal", samples)):
        if not np.isfinite(values).all():
            raise InvalidParameterError(name, "be finite", float(values[~np.isfinite(values)][0]))
    rate = _sampling_rate(instants)
    least = _SAMPLES_PER_CLASS * channel_class
    if rate * (1.0 + _UNEVEN) < least:
        usable = [each for each in CHANNEL_CLASSES if rate * (1.0 + _UNEVEN) >= _SAMPLES_PER_CLASS * each]
        raise InvalidParameterError(
            "time",
            f"be sampled at more than {least:g} Hz for class {channel_class}",
            Shown(f"{rate:g} Hz"),
            f"class {usable[-1]} can be used at this rate" if usable else "no class can be used at this rate",
        )
    return through_class(samples, rate, channel_class)


def through_class(samples: Array, rate: float, channel_class: int) -> Array:
    """Return a signal of even samples, so many per second, through the filter of a channel class."""
    corner = channel_corner(channel_class)
    scipy_signal = _scipy_signal()
    # The bilinear transform with the frequency bent back, as the tangent of the standard's formula does.
    numerator, denominator = scipy_signal.butter(2, corner / (0.5 * rate))
    padding = max(_PADDING, _TIME_CONSTANTS / (2.0 * math.pi * corner))
    padded = min(math.ceil(padding * rate), len(samples) - 1)
    filtered = scipy_signal.filtfilt(numerator, denominator, samples, padtype="odd", padlen=padded)
    return np.ascontiguousarray(filtered, dtype=np.float64)


def _sampling_rate(time: Array) -> float:
    """Return the frequency of even samples in Hz."""
    steps = np.diff(time)
    step = (time[-1] - time[0]) / (len(time) - 1)
    if not (steps > 0.0).all():
        raise InvalidParameterError(
            "time",
            "rise from sample to sample",
            float(time[1:][steps <= 0.0][0]),
            "times that were rounded to one another are numpy.arange(n) / rate",
        )
    if np.abs(steps - step).max() > _UNEVEN * step:
        # Rounded times stay near an even grid, however many there are; a clock that wanders, or a gap, does not.
        count = np.arange(len(time)) - 0.5 * (len(time) - 1)
        middle = time - time.mean()
        step = float((count @ middle) / (count @ count))
        away = np.abs(middle - step * count)
        if away.max() > _ROUNDED * step:
            worst = int(np.abs(steps - step).argmax())
            raise InvalidParameterError(
                "time",
                f"be evenly spaced, to {_ROUNDED:.0%} of the step of {step:.6g} s, also between samples {worst} and "
                f"{worst + 1}",
                float(steps[worst]),
                "resample first: even = np.linspace(time[0], time[-1], len(time)); signal = np.interp(even, time, "
                "signal); a gap has to be cut out",
            )
    return float(1.0 / step)


def _scipy_signal() -> Any:
    try:
        from scipy import signal
    except ImportError as error:
        raise ImportError("channel filters need SciPy: pip install scipy") from error
    return signal
