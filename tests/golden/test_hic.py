"""Criteria of sampled signals against all windows one by one, formulas and the standard's filter."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import scipy.signal

from hrsafety import impact
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.impact.criteria import filters

# Random and coarse signals are doubtful, which is tested beside the units; here only the numbers count.
pytestmark = pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")

# Only the order of the sums differs.
BRUTE_FORCE = 1e-12
# Formulas of pulses, with windows whose ends are free.
FORMULA = 1e-9
# Sample times are rounded; a window may be longer by this share of it.
SLACK = 1e-9

WINDOWS = (0.015, 0.036)


def every_window(time: np.ndarray, value: np.ndarray, window: float) -> float:
    """Largest criterion over all pairs of samples, by the definition."""
    steps = 0.5 * (value[1:] + value[:-1]) * np.diff(time)
    best = 0.0
    for start in range(len(time) - 1):
        length = time[start + 1 :] - time[start]
        mean = np.maximum(np.cumsum(steps[start:]) / length, 0.0)
        fits = length <= window * (1.0 + SLACK)
        best = max(best, float((length * mean**2.5)[fits].max(initial=0.0)))
    return best


def random_signals(generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Pulses, ringing and noise of either sign, evenly or unevenly sampled."""
    samples = int(generator.integers(2, 500))
    even = generator.random() < 0.5
    steps = np.full(samples, 1e-4) if even else generator.uniform(1e-5, 1e-3, samples)
    time = generator.uniform(-5.0, 5.0) + np.cumsum(steps)
    center, width = generator.choice(time), generator.uniform(1e-3, 3e-2)
    pulse = np.exp(-(((time - center) / width) ** 2)) * generator.choice([0.0, 1.0])
    noise = generator.normal(0.0, generator.choice([0.0, 0.01, 0.3]) + 1e-3, samples)
    offset = generator.choice([0.0, -0.2, 0.5])
    return time, 100.0 * (pulse + noise + offset)


@pytest.mark.parametrize("window", WINDOWS)
def test_samples_equal_every_window_of_random_signals(window: float) -> None:
    generator = np.random.default_rng(1)
    for _ in range(300):
        time, value = random_signals(generator)
        found = impact.hic(time, value, window)
        assert found.value == pytest.approx(every_window(time, value, window), rel=BRUTE_FORCE, abs=1e-300)
        assert 0.0 <= found.end - found.start <= window * (1.0 + 2.0 * SLACK)


@pytest.mark.parametrize("window", WINDOWS)
def test_free_ends_are_the_limit_of_finer_samples(window: float) -> None:
    generator = np.random.default_rng(2)
    for _ in range(40):
        time, value = random_signals(generator)
        time, value = time[:60], value[:60]
        found = impact.hic(time, value, window, interpolate=True)
        fine = np.unique(np.concatenate([np.linspace(a, b, 25) for a, b in itertools.pairwise(time)]))
        on_grid = impact.hic(fine, np.interp(fine, time, value), window)
        # Windows on the grid may be longer by the slack, and miss the best by less than a step.
        assert on_grid.value <= found.value * (1.0 + 1e-8)
        assert found.value <= on_grid.value * (1.0 + 0.02) + 1e-12
        window_mean = np.trapezoid(
            np.interp(x := np.union1d(time, [found.start, found.end]), time, value)[
                inside := (x >= found.start) & (x <= found.end)
            ],
            x[inside],
        )
        if found.value > 0.0:
            length = found.end - found.start
            assert found.value == pytest.approx(length * (window_mean / length) ** 2.5, rel=1e-9)


def test_a_half_sine_of_5_ms_and_100_g_gives_207_3() -> None:
    time = np.linspace(0.0, 0.005, 2001)
    value = 100.0 * np.sin(np.pi * time / 0.005)
    assert impact.hic(time, value).value == pytest.approx(207.3, abs=0.05)
    free = impact.hic(time, value, interpolate=True)
    assert free.value == pytest.approx(207.3, abs=0.05)
    # Samples as ends and free ends are 6e-7 apart at this spacing.
    assert 1e-7 < 1.0 - impact.hic(time, value).value / free.value < 1e-6


@pytest.mark.parametrize("window", [*WINDOWS, 0.004])
@pytest.mark.parametrize("duration", [0.005, 0.02, 0.1])
def test_half_sines_reach_their_formula(window: float, duration: float) -> None:
    # Chords lie below the sine by (pi / n)^2 / 12 of it.
    time = np.linspace(0.0, duration, 100_001)
    value = 80.0 * np.sin(np.pi * time / duration)
    found = impact.hic(time, value, window, interpolate=True)
    assert found.value == pytest.approx(impact.criteria.hic_of_pulse("half_sine", 80.0, duration, window), rel=FORMULA)


@pytest.mark.parametrize("window", [*WINDOWS, 0.004])
@pytest.mark.parametrize("peak_at", [0.1, 0.5, 0.8])
def test_triangles_reach_their_formula(window: float, peak_at: float) -> None:
    for inner in (0, 7, 400):
        time = np.union1d(np.linspace(0.0, 0.03, inner + 2), [0.03 * peak_at])
        value = np.interp(time, [0.0, 0.03 * peak_at, 0.03], [0.0, 60.0, 0.0])
        found = impact.hic(time, value, window, interpolate=True)
        assert found.value == pytest.approx(impact.criteria.hic_of_pulse("triangle", 60.0, 0.03, window), rel=FORMULA)


@pytest.mark.parametrize("window", [*WINDOWS, 0.004])
def test_squares_reach_their_formula(window: float) -> None:
    for samples in (2, 50, 5000):
        time = np.linspace(1.0, 1.03, samples)
        found = impact.hic(time, np.full(samples, 60.0), window, interpolate=True)
        assert found.value == pytest.approx(impact.criteria.hic_of_pulse("square", 60.0, 0.03, window), rel=FORMULA)


def test_signals_without_a_positive_mean_count_0() -> None:
    time = np.linspace(0.0, 0.1, 1001)
    assert impact.hic(time, -np.ones(1001)) == (0.0, 0.0, 0.0)


def test_the_cost_grows_with_the_samples_and_not_with_their_square() -> None:
    """Pairs that fit in the window grow 100 times from 10 kHz to 100 kHz; the time must not."""
    from time import perf_counter

    def best_time(samples: int) -> float:
        time = np.linspace(0.0, 0.2, samples)
        value = 80.0 * np.exp(-(((time - 0.08) / 0.01) ** 2)) + np.sin(700.0 * time)
        durations = []
        for _ in range(7):
            start = perf_counter()
            impact.hic(time, value)
            durations.append(perf_counter() - start)
        return min(durations)

    assert best_time(200_000) < 30.0 * best_time(20_000)


def test_moving_average_and_clip_of_a_triangle() -> None:
    time, value = [0.0, 0.006, 0.012], [0.0, 60.0, 0.0]
    assert impact.criteria.average_3ms(time, value).value == pytest.approx(52.5, rel=BRUTE_FORCE)
    assert impact.criteria.clip_3ms(time, value).value == pytest.approx(45.0, rel=BRUTE_FORCE)


def test_sampled_criteria_follow_the_continuous_ones() -> None:
    """The response of the nominal impact, sampled at 1 MHz, gives its own criteria."""
    foam = impact.Foam(stiffness=24.25e3, damping=71.9)
    parts = impact.MANIPULATOR_1, foam, impact.Head.apparatus()
    exact = impact.metrics(*parts, closing_speed=1.25)
    response = impact.simulate(*parts, closing_speed=1.25, duration=exact.impact_duration, step=1e-6)
    time, level = response.time, response.head_acceleration / 9.80665
    assert impact.hic(time, level, interpolate=True).value == pytest.approx(exact.hic15, rel=1e-8)
    assert impact.hic(time, level, 0.036, interpolate=True).value == pytest.approx(exact.hic36, rel=1e-6)
    assert impact.criteria.average_3ms(time, level).value == pytest.approx(exact.average_3ms_g, rel=1e-8)
    assert impact.criteria.clip_3ms(time, level).value == pytest.approx(exact.clip_3ms_g, rel=1e-8)


def coefficients(channel_class: int, step: float) -> tuple[list[float], list[float]]:
    """The two-pole filter as the standard writes it."""
    tangent = np.tan(np.pi * channel_class * 2.0775 * step)
    square = tangent**2
    scale = 1.0 + np.sqrt(2.0) * tangent + square
    numerator = [square / scale, 2.0 * square / scale, square / scale]
    return numerator, [1.0, 2.0 * (square - 1.0) / scale, (1.0 - np.sqrt(2.0) * tangent + square) / scale]


@pytest.mark.parametrize("channel_class", filters.CHANNEL_CLASSES)
def test_channel_filters_are_those_of_the_standard(channel_class: int) -> None:
    step = 1e-4
    generator = np.random.default_rng(3)
    signal = np.concatenate([np.zeros(600), generator.normal(size=800), np.zeros(600)])
    numerator, denominator = coefficients(channel_class, step)
    # By hand: forwards, then backwards; the signal rests at both ends, so no padding is needed.
    forwards = scipy.signal.lfilter(numerator, denominator, signal)
    both = scipy.signal.lfilter(numerator, denominator, forwards[::-1])[::-1]
    found = filters.channel_filter(np.arange(2000) * step, signal, channel_class)
    np.testing.assert_allclose(found, both, atol=1e-10)


@pytest.mark.parametrize("channel_class", filters.CHANNEL_CLASSES)
def test_channel_filters_are_3_db_down_at_five_thirds_of_their_class(channel_class: int) -> None:
    step = 1e-5
    time = np.arange(100_000) * step
    tone = np.sin(2.0 * np.pi * channel_class * 5.0 / 3.0 * time)
    found = filters.channel_filter(time, tone, channel_class)[30_000:-30_000]
    decibels = 20.0 * np.log10(np.abs(found).max())
    assert decibels == pytest.approx(-3.0, abs=0.05)
    # No shift in time: the filtered tone stays in phase.
    phase = np.angle(np.sum(found * np.exp(-2j * np.pi * channel_class * 5.0 / 3.0 * time[30_000:-30_000])))
    assert phase == pytest.approx(-np.pi / 2.0, abs=1e-3)


def test_slopes_go_through_the_channel_filter_up_to_the_ends() -> None:
    time = np.arange(400) * 1e-4
    ramp = 3.0 + 40.0 * time
    np.testing.assert_allclose(filters.channel_filter(time, ramp, 60), ramp, atol=1e-9)


def test_bad_signals_are_named() -> None:
    time, value = np.arange(5.0), np.ones(5)
    with pytest.raises(InvalidParameterError, match="time must rise"):
        impact.hic(time[::-1], value)
    with pytest.raises(ShapeError):
        impact.hic(time, value[:3])
    with pytest.raises(InvalidParameterError, match="must be finite"):
        impact.hic(time, [1.0, np.nan, 1.0, 1.0, 1.0])
    with pytest.raises(InvalidParameterError, match="at least 2"):
        impact.hic([0.0], [1.0])
    with pytest.raises(InvalidParameterError, match="window"):
        impact.hic(time, value, 0.0)
    with pytest.raises(InvalidParameterError, match="channel_class"):
        filters.channel_filter(time, value, 100)
    with pytest.raises(InvalidParameterError, match="evenly"):
        filters.channel_filter(time**2, value, 60)
    with pytest.raises(InvalidParameterError, match="sampled at more than"):
        filters.channel_filter(time, value, 60)
    with pytest.raises(InvalidParameterError, match="finite"):
        filters.channel_filter(time * 1e-4, value * np.inf, 60)
    with pytest.raises(InvalidParameterError, match="at least 4"):
        filters.channel_filter(time[:3], value[:3], 60)
