"""Repeated measurements of sounds: fixes scattered by jitter or by the noise of full waveforms."""

from __future__ import annotations

from collections.abc import Callable

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, callback, checked_seed, count, instance, not_negative
from hrsafety._bounds import MOST_RUNS
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.sound.bursts import Burst, Converter, hearing
from hrsafety.reactive.sound.delays import DelayMethod, delay_options
from hrsafety.reactive.sound.fixes import QUARTER_SAMPLE, Fixes, checked_threads, locate_batch
from hrsafety.reactive.sound.microphones import MicrophoneArray, check_finite, same_shape

__all__ = ["jittered_fixes", "localize_bursts"]


def jittered_fixes(
    array: MicrophoneArray,
    *,
    range: npt.ArrayLike,
    bearing: npt.ArrayLike,
    runs: int = 100,
    arrival_deviation: float = QUARTER_SAMPLE,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Fixes:
    """Return repeated fixes of sources whose arrivals jitter, independent and Gaussian.

    Parameters
    ----------
    array : MicrophoneArray
        The microphones.
    range, bearing : array_like
        Where the sources are, in m from M2 and rad; they broadcast.
    runs : int
        Measurements of each source.
    arrival_deviation : float
        Standard deviation of each of the three arrivals, in s. The default is a quarter of a sample
        at 100 kHz.
    seed : int
        Seed, 0 <= seed < 2**64.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of drawn measurements.

    Returns
    -------
    Fixes
        Of the broadcast shape with one more axis, the runs.

    Raises
    ------
    InvalidParameterError
        If a range is not positive, or another value out of range.
    ShapeError
        If range and bearing do not broadcast.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    The range scatters by about 0.12 m at 3 m:

    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> fixes = reactive.sound.jittered_fixes(reactive.MicrophoneArray(), range=3.0, bearing=0.0, runs=20000)
    >>> round(float(np.std(fixes.range)), 2)
    0.12
    """
    own, (distance, angle), repeats = _checked_sources(array, range, bearing, runs)
    found = _hrsafety.jittered_sound_delays(
        own._native,
        list(zip(distance.ravel().tolist(), angle.ravel().tolist(), strict=True)),
        arrival_deviation=not_negative("arrival_deviation", arrival_deviation),
        runs=repeats,
        seed=checked_seed("seed", seed),
        threads=checked_threads(threads),
        progress=callback("progress", progress),
    )
    return _located(own, found["delay_12"], found["delay_13"], (*distance.shape, repeats), arrival_deviation, threads)


def localize_bursts(
    burst: Burst,
    array: MicrophoneArray,
    *,
    range: npt.ArrayLike,
    bearing: npt.ArrayLike,
    runs: int = 100,
    converter: Converter | None = None,
    noise: float = 0.01,
    observer_speed: float = 0.0,
    source_speed: float = 0.0,
    lead: float = 0.005,
    samples: int | None = None,
    method: DelayMethod = "cross_correlation",
    between_samples: bool = True,
    band: Pair | None = None,
    arrival_deviation: float = QUARTER_SAMPLE,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Fixes:
    """Return repeated fixes of sources from full waveforms: the burst is heard, converted, compared.

    Each run has fresh noise at every microphone; the burst is the same.

    Parameters
    ----------
    burst : Burst
        The sound.
    array : MicrophoneArray
        The microphones.
    range, bearing : array_like
        Where the sources are, in m from M2 and rad; they broadcast.
    runs : int
        Measurements of each source.
    converter, noise, observer_speed, source_speed, lead, samples
        As for `record_burst`. A negative lead with 4096 samples is a window within the burst.
    method, between_samples, band
        As for `estimate_delays`; whole records are compared.
    arrival_deviation : float
        For the covariance of each fix, as for `locate`, in s.
    seed : int
        Seed of the noise, 0 <= seed < 2**64.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of measurements.

    Returns
    -------
    Fixes
        Of the broadcast shape with one more axis, the runs.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, a record is not longer than the lags, or the converter too slow.
    ShapeError
        If range and bearing do not broadcast.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> fixes = reactive.localize_bursts(
    ...     reactive.Burst(), reactive.MicrophoneArray(), range=[1.0, 3.0], bearing=0.0, runs=20,
    ...     lead=-0.02, samples=4096)
    >>> fixes.shape, bool((np.abs(fixes.range.mean(axis=1) - [1.0, 3.0]) < 0.05).all())
    ((2, 20), True)
    """
    own, (distance, angle), repeats = _checked_sources(array, range, bearing, runs)
    device = instance("converter", converter, Converter) if converter is not None else Converter()
    places = [
        hearing(r, b, observer_speed, source_speed, noise, lead, samples)
        for r, b in zip(distance.ravel().tolist(), angle.ravel().tolist(), strict=True)
    ]
    found = _hrsafety.burst_trial_delays(
        instance("burst", burst, Burst)._native,
        own._native,
        device._native,
        places,
        delay_options(method, between_samples, band, None, None),
        runs=repeats,
        seed=checked_seed("seed", seed),
        threads=checked_threads(threads),
        progress=callback("progress", progress),
    )
    return _located(own, found["delay_12"], found["delay_13"], (*distance.shape, repeats), arrival_deviation, threads)


def _located(
    array: MicrophoneArray,
    delay_12: Array,
    delay_13: Array,
    shape: tuple[int, ...],
    arrival_deviation: float,
    threads: int | None,
) -> Fixes:
    """Return the fixes of delays that the core gave one after the other."""
    return locate_batch(
        array,
        delay_12=delay_12.reshape(shape),
        delay_13=delay_13.reshape(shape),
        arrival_deviation=arrival_deviation,
        threads=threads,
    )


def _checked_sources(
    array: MicrophoneArray, range: npt.ArrayLike, bearing: npt.ArrayLike, runs: int
) -> tuple[MicrophoneArray, tuple[Array, ...], int]:
    own = instance("array", array, MicrophoneArray)
    sources = same_shape(range=range, bearing=bearing)
    check_finite("range", sources[0])
    check_finite("bearing", sources[1])
    if (sources[0] <= 0.0).any():
        worst = float(sources[0].min())
        raise InvalidParameterError("range", "be finite and positive", worst)
    repeats = count("runs", runs, most=MOST_RUNS)
    if repeats * max(1, sources[0].size) > MOST_RUNS:
        raise InvalidParameterError("runs", f"be at most {MOST_RUNS} for all sources together", runs)
    return own, sources, repeats
