"""Laws of localization: estimators against SciPy, symmetries, shifts, units, covariance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import signal as scipy_signal

from hrsafety import reactive

ROW = reactive.MicrophoneArray()
RATE = 100e3
METHODS = ("cross_correlation", "mean_square", "phase")
FOURIER = 1e-12  # of the largest value: rounding of two transforms
# Of one sample: parabola through a peak of a band up to 8 kHz, and 1/n of edges.
SUB_SAMPLE = 0.02

steady = settings(derandomize=True, deadline=None, max_examples=40)
distances = st.floats(0.3, 6.0)
bearings = st.floats(-1.2, 1.2)


def recorded(channels: list[np.ndarray], rate: float = RATE) -> reactive.SoundRecording:
    return reactive.SoundRecording(samples=np.stack(channels), sample_rate=rate)


def white(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, 0.1, count)


def scipy_lags(first: np.ndarray, other: np.ndarray, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """Return lags and mean products over the overlap by SciPy."""
    one, two = first - first.mean(), other - other.mean()
    products = scipy_signal.correlate(two, one, mode="full", method="fft")
    lags = scipy_signal.correlation_lags(len(two), len(one), mode="full")
    near = np.abs(lags) <= limit
    return lags[near], products[near] / (len(one) - np.abs(lags[near]))


@steady
@given(seed=st.integers(0, 10_000), count=st.integers(241, 6000), noise=st.floats(0.0, 0.5))
def test_correlation_is_that_of_scipy(seed: int, count: int, noise: float) -> None:
    sound = white(count + 300, seed)
    channels = [sound[150 : 150 + count], sound[100 : 100 + count], sound[220 : 220 + count]]
    channels = [each + noise * white(count, seed + place + 1) for place, each in enumerate(channels)]
    heard = recorded(channels)
    curve = reactive.sound.likeness(heard, ROW)
    found = reactive.estimate_delays(heard, ROW, between_samples=False)
    for lags, values, other, lag in (
        (curve.lags_12, curve.values_12, channels[1], found.lag_12),
        (curve.lags_13, curve.values_13, channels[2], found.lag_13),
    ):
        expected_lags, expected = scipy_lags(channels[0], other, int(lags[-1]))
        assert np.array_equal(lags, expected_lags)
        assert np.abs(values - expected).max() <= FOURIER * np.abs(expected).max() * math.log2(count)
        assert lag == expected_lags[expected.argmax()]
    assert found.delay_12 == found.lag_12 / RATE


@steady
@given(seed=st.integers(0, 10_000), count=st.integers(300, 3000))
def test_mean_square_is_energy_less_twice_the_correlation(seed: int, count: int) -> None:
    channels = [white(count, seed + place) for place in range(3)]
    heard = recorded(channels)
    square, product = (
        reactive.sound.likeness(heard, ROW, method=method) for method in ("mean_square", "cross_correlation")
    )
    one, two = (each - each.mean() for each in channels[:2])
    for lag, found, correlation in zip(square.lags_12, square.values_12, product.values_12, strict=True):
        a, b = (one[: count - lag], two[lag:]) if lag >= 0 else (one[-lag:], two[: count + lag])
        assert found == pytest.approx(float(np.mean((a - b) ** 2)), rel=1e-12)
        assert found == pytest.approx(float(np.mean(a * a) + np.mean(b * b)) - 2.0 * correlation, rel=1e-11)


@steady
@given(distance=distances, bearing=bearings, seed=st.integers(0, 1000))
def test_estimators_agree_with_each_other_and_with_geometry(distance: float, bearing: float, seed: int) -> None:
    burst = reactive.Burst(duration=0.08, seed=seed)
    heard = reactive.record_burst(burst, ROW, range=distance, bearing=bearing, noise=0.0)
    expected = [float(each) for each in ROW.delays(range=distance, bearing=bearing)]
    found = [reactive.estimate_delays(heard, ROW, method=method) for method in ("cross_correlation", "mean_square")]
    assert (found[0].lag_12, found[0].lag_13) == (found[1].lag_12, found[1].lag_13)
    for each in found:
        off = (np.array([each.delay_12, each.delay_13]) - expected) * RATE
        assert np.abs(off).max() <= SUB_SAMPLE + 0.03 * distance  # 10 bits: the burst gets small far away


@steady
@given(distance=distances, bearing=bearings)
def test_mirrored_source_has_the_mirrored_delays_and_fix(distance: float, bearing: float) -> None:
    one = reactive.locate(ROW, **delays_of(distance, bearing))
    other = reactive.locate(ROW, **delays_of(distance, -bearing))
    assert other.range == pytest.approx(one.range, rel=1e-11)
    assert other.bearing == pytest.approx(-one.bearing, abs=1e-11)
    mirrored = one.covariance * [[1.0, -1.0], [-1.0, 1.0]]
    assert other.covariance == pytest.approx(mirrored, rel=1e-8, abs=1e-14)


@steady
@given(seed=st.integers(0, 1000), shift=st.integers(1, 150), method=st.sampled_from(METHODS))
def test_delays_do_not_depend_on_when_the_record_begins(seed: int, shift: int, method: Any) -> None:
    sound = white(2600, seed)

    def at(begin: int) -> reactive.Delays:
        cuts = [sound[begin + place : begin + place + 1500] for place in (300, 277, 390)]
        return reactive.estimate_delays(recorded(cuts), ROW, method=method)

    assert (at(0).lag_12, at(0).lag_13) == (at(shift).lag_12, at(shift).lag_13) == (23, -90)


@steady
@given(distance=distances, bearing=bearings, factor=st.floats(0.25, 4.0))
def test_only_the_way_of_sound_counts(distance: float, bearing: float, factor: float) -> None:
    fast = reactive.MicrophoneArray(speed_of_sound=340.0 * factor)
    delays = delays_of(distance, bearing)
    one = reactive.locate(ROW, **delays, arrival_deviation=1e-6)
    shorter = {name: value / factor for name, value in delays.items()}
    other = reactive.locate(fast, **shorter, arrival_deviation=1e-6 / factor)
    assert other.range == pytest.approx(one.range, rel=1e-10)
    assert other.bearing == pytest.approx(one.bearing, abs=1e-10)
    assert other.covariance == pytest.approx(one.covariance, rel=1e-8, abs=1e-16)


@steady
@given(distance=st.floats(0.5, 3.0), bearing=st.floats(-0.9, 0.9))
def test_covariance_is_that_of_many_fixes(distance: float, bearing: float) -> None:
    small = 1e-8  # s: so little that first order is all there is
    truth = reactive.locate(ROW, **delays_of(distance, bearing), arrival_deviation=small)
    fixes = reactive.sound.jittered_fixes(ROW, range=distance, bearing=bearing, runs=4000, arrival_deviation=small)
    found = np.cov(fixes.range, fixes.bearing)
    size = np.sqrt(np.outer(np.diag(truth.covariance), np.diag(truth.covariance)))
    # 4000 runs: 2.2 % of sampling in a variance, five deviations.
    assert np.abs((found - truth.covariance) / size).max() < 0.12


@steady
@given(observer=st.floats(-2.0, 2.0), source=st.floats(-2.0, 2.0), frequency=st.floats(500.0, 5000.0))
def test_tone_is_heard_at_the_frequency_of_doppler(observer: float, source: float, frequency: float) -> None:
    heard = reactive.record_burst(
        reactive.Burst.tone(frequency, duration=0.4),
        ROW,
        range=2.0,
        bearing=0.2,
        converter=reactive.Converter(bits=None),
        observer_speed=observer,
        source_speed=source,
        lead=-0.05,
        samples=30_000,
    )
    expected = frequency * (340.0 + observer) / (340.0 - source)
    assert reactive.sound.doppler_frequency(frequency, observer_speed=observer, source_speed=source) == pytest.approx(
        expected
    )
    for channel in heard.samples:
        # Phase of the analytic signal over time, away from its ends.
        phase = np.unwrap(np.angle(scipy_signal.hilbert(channel)))[3000:-3000]
        slope = np.polyfit(np.arange(len(phase)) / RATE, phase, 1)[0]
        assert slope / (2.0 * np.pi) == pytest.approx(expected, rel=2e-5)


def delays_of(distance: float, bearing: float) -> dict[str, float]:
    delay_12, delay_13 = ROW.delays(range=distance, bearing=bearing)
    return {"delay_12": float(delay_12), "delay_13": float(delay_13)}
