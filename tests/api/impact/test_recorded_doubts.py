"""Measured accelerations: the impact period lies around the peak, and what is doubtful reaches the verdict."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from hrsafety import InvalidParameterError, impact
from hrsafety.impact.criteria import filters
from hrsafety.plausibility import HrsafetyWarning, unsafe_doubts

Array = npt.NDArray[np.float64]

RATE = 10_000.0
LIMITS = impact.FoamLimits(peak_head_acceleration_g=80.0, hic15=1000.0, max_compression=None)


def pulse(
    peak: float = 60.0, duration: float = 0.01, *, begin: float = 0.03, total: float = 0.1, rate: float = RATE
) -> tuple[Array, Array]:
    time = np.arange(round(total * rate) + 1) / rate
    inside = (time > begin) & (time < begin + duration)
    return time, np.where(inside, peak * np.sin(np.pi * (time - begin) / duration), 0.0)


def codes(found: object) -> set[str]:
    return {each.code for each in found.warnings}  # type: ignore[attr-defined]  # every result has them


def doubted(call: Callable[[], object], code: str) -> object:
    """Run a call that has to issue a doubt, and return what it gives."""
    with pytest.warns(HrsafetyWarning):
        found = call()
    assert code in {each.code for each in unsafe_doubts(found.warnings)}  # type: ignore[attr-defined]
    return found


def judged_not(time: Array, signal: Array, code: str, **given: object) -> impact.ImpactMetrics:
    found = doubted(lambda: impact.recorded_metrics(time, signal, **given), code)  # type: ignore[arg-type]
    assert isinstance(found, impact.ImpactMetrics)
    assert LIMITS.verdict(found) == "not_checked"
    return found


def test_a_clean_record_is_judged_without_a_doubt() -> None:
    time, signal = pulse()
    found = impact.recorded_metrics(time, signal)
    assert found.warnings == impact.hic(time, signal).warnings == impact.criteria.clip_3ms(time, signal).warnings == ()
    assert found.hic15 == pytest.approx(impact.criteria.hic_of_pulse("half_sine", 60.0, 0.01), rel=1e-3)
    assert found.impact_duration == pytest.approx(0.01, rel=1e-6)
    assert LIMITS.verdict(found) == "within_limits"
    assert impact.FoamLimits(hic15=50.0).verdict(found) == "exceeds"
    # What was not measured is not kept.
    assert impact.FoamLimits(peak_head_acceleration_g=80.0, peak_contact_force=5e3).verdict(found) == "not_checked"


def test_noise_or_a_small_hit_before_the_pulse_does_not_end_it() -> None:
    time, signal = pulse()
    noise = np.random.default_rng(1).normal(0.0, 0.5, len(time))
    for found in (
        impact.recorded_metrics(time, signal + noise),
        impact.recorded_metrics(time, signal + pulse(5.0, 0.006, begin=0.005)[1]),
        # A filtered record: undershoot before and after.
        impact.recorded_metrics(time, signal - pulse(2.0, 0.004, begin=0.026)[1] - pulse(3.0, 0.006, begin=0.04)[1]),
    ):
        assert found.status == "released"
        assert found.hic15 == pytest.approx(115.6, rel=0.03)
        assert found.impact_duration == pytest.approx(0.01, abs=3e-4)
        assert found.warnings == ()


def test_a_second_hit_is_not_dropped() -> None:
    time, first = pulse(30.0)
    harder = impact.recorded_metrics(time, first + pulse(60.0, begin=0.06)[1])
    assert harder.peak_head_acceleration_g == pytest.approx(60.0)
    assert harder.hic15 == pytest.approx(115.6, rel=1e-2)
    # Lower but longer: its criterion is larger than that of the part around the peak.
    found = judged_not(time, pulse(60.0, 0.004, begin=0.01)[1] + pulse(50.0, 0.02, begin=0.05)[1], "outside_period")
    assert found.peak_head_acceleration_g == pytest.approx(60.0, rel=1e-3)
    assert {"hic15", "hic36", "clip_3ms_g"} <= {each.subject for each in found.warnings}


def test_loads_outside_the_period_are_named() -> None:
    time, signal = pulse()
    force = 3000.0 * np.maximum(np.sin(np.pi * (time - 0.03) / 0.01), 0.0) * (time < 0.04) * (time > 0.03)
    assert impact.recorded_metrics(time, signal, contact_force=force).warnings == ()
    judged_not(time, signal, "outside_period", contact_force=force + 4000.0 * (time > 0.07))
    judged_not(time, signal, "outside_period", start=0.036)


def test_signs_are_not_turned_in_silence() -> None:
    time, signal = pulse()
    force = 50.0 * signal
    for call in (
        lambda: impact.hic(time, -signal),
        lambda: impact.criteria.clip_3ms(time, -signal),
        lambda: impact.criteria.average_3ms(time, -signal),
        lambda: impact.recorded_metrics(time, -signal, contact_force=-force),
    ):
        doubted(call, "negative_axis")
    judged_not(time, signal, "negative_axis", contact_force=-force)
    # A short peak is positive, the push is negative.
    both = pulse(70.0, 0.002, begin=0.01)[1] - signal
    judged_not(time, both, "negative_axis")
    doubted(lambda: impact.hic(time, both), "negative_axis")
    judged_not(time, np.zeros_like(time), "no_push")


@pytest.mark.parametrize("offset", [-5.0, -2.0])
@pytest.mark.parametrize("begin", [0.03, 0.004])
def test_an_offset_is_told(offset: float, begin: float) -> None:
    time, signal = pulse(26.0, begin=begin)
    judged_not(time, signal + offset, "offset")
    doubted(lambda: impact.hic(time, signal + offset), "offset")


def test_an_offset_that_makes_loads_larger_is_on_the_safe_side() -> None:
    time, signal = pulse()
    found = impact.recorded_metrics(time, signal + 3.0)
    assert "offset" in codes(found)
    assert not unsafe_doubts(found.warnings) or found.status == "no_release"


def test_a_flat_top_is_saturation() -> None:
    time, signal = pulse()
    judged_not(time, np.minimum(signal, 50.0), "saturated")
    judged_not(time, np.minimum(signal + np.random.default_rng(2).normal(0.0, 0.3, len(time)), 45.0), "saturated")
    # A smooth top that is rounded to a digit is none.
    for digits in (0, 1, 2):
        assert impact.recorded_metrics(time, signal.round(digits)).warnings == ()


def test_steps_too_long_for_the_pulse_are_doubted() -> None:
    for duration, coarse in ((0.003, True), (0.02, False)):
        time, signal = pulse(60.0, duration, rate=1000.0, begin=0.0304)
        found = impact.recorded_metrics if coarse else None
        if found is None:
            assert impact.recorded_metrics(time, signal).warnings == ()
            assert impact.hic(time, signal).warnings == ()
            continue
        judged_not(time, signal, "coarse_sampling")
        doubted(lambda time=time, signal=signal: impact.hic(time, signal), "coarse_sampling")
        doubted(lambda time=time, signal=signal: impact.criteria.clip_3ms(time, signal), "coarse_sampling")
    # Windows between samples of 4 ms end before the 15 ms do.
    long = np.arange(0.0, 0.4, 0.004)
    slow = np.where((long > 0.05) & (long < 0.35), 60.0 * np.sin(np.pi * (long - 0.05) / 0.3), 0.0)
    doubted(lambda: impact.hic(long, slow), "coarse_sampling")


def test_a_record_that_begins_or_ends_within_the_push_is_told() -> None:
    time, signal = pulse()
    judged_not(time[time >= 0.0335], signal[time >= 0.0335], "starts_inside")
    judged_not(time[time <= 0.0365], signal[time <= 0.0365], "ends_inside")


def test_a_class_below_the_pulse_is_told() -> None:
    time, short = pulse(60.0, 0.003)
    with pytest.warns(HrsafetyWarning, match=r"class 60 .*too short for it.*use class 180"):
        filtered = filters.channel_filter(time, short, 60)
    judged_not(time, filtered, "filtered_pulse", channel_class=60)
    _, long = pulse(30.0, 0.03)
    found = impact.recorded_metrics(time, filters.channel_filter(time, long, 60), channel_class=60)
    assert found.warnings == ()
    passed = filters.channel_filter(time, short, 1000)
    assert impact.recorded_metrics(time, passed, channel_class=1000).warnings == ()


def test_times_that_were_rounded_are_even() -> None:
    time = np.arange(4800) / 24_000.0
    signal = 60.0 * np.exp(-(((time - 0.1) / 0.006) ** 2))
    exact = filters.channel_filter(time, signal, 1000)
    for digits in (6, 5):
        rounded = filters.channel_filter(time.round(digits), signal, 1000)
        assert np.abs(rounded - exact).max() < 0.01
    with pytest.raises(InvalidParameterError, match=r"evenly spaced.*np\.interp"):
        filters.channel_filter(np.delete(time, 100), np.delete(signal, 100), 1000)
    wander = time + 2e-4 * np.sin(20.0 * time)
    with pytest.raises(InvalidParameterError, match=r"evenly spaced"):
        filters.channel_filter(wander, signal, 1000)


def test_sampling_below_eight_classes_is_refused_with_what_can_be_used() -> None:
    time, signal = pulse(rate=1000.0)
    with pytest.raises(InvalidParameterError, match=r"more than 1440 Hz for class 180.*class 60 can be used"):
        filters.channel_filter(time, signal, 180)
    with pytest.raises(InvalidParameterError, match=r"no class can be used"):
        filters.channel_filter(time[::4], signal[::4], 60)


def test_verdict_wants_loads() -> None:
    with pytest.raises(InvalidParameterError, match="loads"):
        LIMITS.verdict(3.0)  # type: ignore[arg-type]  # refused
    never = impact.metrics(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.25, horizon=0.01)
    assert never.status == "no_release"
    assert LIMITS.verdict(never) == "not_checked"
