"""Loads of measured impacts: what a record may have without another answer, and what has to be doubted."""

from __future__ import annotations

import math
import warnings

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hrsafety import impact
from hrsafety.plausibility import unsafe_doubts

Array = npt.NDArray[np.float64]

RATE = 20_000.0
SHAPES = {
    "half_sine": lambda x: np.sin(np.pi * x),
    "haversine": lambda x: np.sin(np.pi * x) ** 2,
    "early": lambda x: 6.75 * x * (1.0 - x) ** 2,
}
shapes = st.sampled_from(sorted(SHAPES))
peaks = st.floats(15.0, 150.0)
durations = st.floats(0.003, 0.03)
begins = st.floats(0.02, 0.05)

pytestmark = pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")


def record(shape: str, peak: float, duration: float, begin: float, rate: float = RATE) -> tuple[Array, Array]:
    time = np.arange(round(0.15 * rate)) / rate
    share = np.clip((time - begin) / duration, 0.0, 1.0)
    values = np.where((share > 0.0) & (share < 1.0), peak * SHAPES[shape](share), 0.0)
    return time, values


def doubts(found: impact.ImpactMetrics) -> set[str]:
    """Codes of doubts on the unsafe side, apart from those of units: long and hard pulses are drawn, too."""
    return {each.code for each in unsafe_doubts(found.warnings)} - {"implausible"}


def loads(found: impact.ImpactMetrics) -> list[float]:
    return [found.peak_head_acceleration_g, found.hic15, found.hic36, found.mean_head_acceleration_g]


@given(shape=shapes, peak=peaks, duration=durations, begin=begins, shift=st.floats(-100.0, 100.0))
def test_time_has_no_beginning(shape: str, peak: float, duration: float, begin: float, shift: float) -> None:
    time, values = record(shape, peak, duration, begin)
    first, later = impact.recorded_metrics(time, values), impact.recorded_metrics(time + shift, values)
    assert loads(later) == pytest.approx(loads(first), rel=1e-6)
    assert later.impact_duration == pytest.approx(first.impact_duration, rel=1e-6)
    assert doubts(first) == doubts(later) == set()


@given(
    shape=shapes,
    peak=peaks,
    duration=durations,
    begin=begins,
    noise=st.floats(0.0, 0.02),
    undershoot=st.floats(0.0, 0.1),
    seed=st.integers(0, 100),
)
def test_what_is_small_elsewhere_changes_nothing(
    shape: str, peak: float, duration: float, begin: float, noise: float, undershoot: float, seed: int
) -> None:
    time, values = record(shape, peak, duration, begin)
    clean = impact.recorded_metrics(time, values)
    quiet = np.random.default_rng(seed).normal(0.0, noise * peak, len(time)) * (values == 0.0)
    ends = begin - 0.4 * duration, begin + duration
    around = sum(record("haversine", undershoot * peak, 0.4 * duration, at)[1] for at in ends)
    found = impact.recorded_metrics(time, values + quiet - around * (values == 0.0))
    assert loads(found)[:3] == pytest.approx(loads(clean)[:3], rel=1e-3)
    # Samples of noise beside flat ends of the pulse may belong to it.
    assert found.impact_duration == pytest.approx(clean.impact_duration, abs=0.15 * duration + 5.0 / RATE)
    assert found.mean_head_acceleration_g == pytest.approx(clean.mean_head_acceleration_g, rel=0.1)
    # Where half of what comes before is undershoot, it may be an offset.
    assert doubts(found) <= ({"offset"} if begin < 2.0 * 0.4 * duration else set())


@given(shape=shapes, peak=peaks, duration=durations, begin=begins, force=st.booleans())
def test_a_turned_sign_is_always_doubted(shape: str, peak: float, duration: float, begin: float, force: bool) -> None:
    time, values = record(shape, peak, duration, begin)
    found = impact.recorded_metrics(time, values if force else -values, contact_force=-40.0 * values)
    assert "negative_axis" in doubts(found)


@given(
    first=st.tuples(shapes, peaks, st.floats(0.003, 0.02)),
    second=st.tuples(shapes, peaks, st.floats(0.003, 0.02)),
    gap=st.floats(0.001, 0.04),
)
def test_the_harder_of_two_hits_counts_or_is_named(
    first: tuple[str, float, float], second: tuple[str, float, float], gap: float
) -> None:
    begin = 0.02
    one = record(*first, begin)
    two = record(*second, begin + first[2] + gap)
    time, alone = one[0], [impact.recorded_metrics(time, values) for time, values in (one, two)]
    both = impact.recorded_metrics(time, one[1] + two[1])
    assert both.peak_head_acceleration_g >= max(each.peak_head_acceleration_g for each in alone) * (1.0 - 1e-9)
    for name in ("hic15", "hic36"):
        most = max(getattr(each, name) for each in alone)
        assert getattr(both, name) >= most * (1.0 - 2e-3) or "outside_period" in doubts(both)


@given(shape=shapes, peak=peaks, duration=durations, begin=begins, every=st.integers(1, 40))
def test_fewer_samples_lose_little_or_are_doubted(
    shape: str, peak: float, duration: float, begin: float, every: int
) -> None:
    time, values = record(shape, peak, duration, begin)
    fine = impact.recorded_metrics(time, values)
    coarse = impact.recorded_metrics(time[::every], values[::every])
    assert coarse.hic15 >= 0.9 * fine.hic15 or "coarse_sampling" in doubts(coarse)


@given(shape=shapes, peak=peaks, duration=durations, begin=begins, level=st.floats(0.3, 0.95))
def test_a_clipped_channel_is_always_doubted(
    shape: str, peak: float, duration: float, begin: float, level: float
) -> None:
    time, values = record(shape, peak, duration, begin)
    clipped = np.minimum(values, level * peak)
    if np.sum(values >= level * peak) >= 3:
        assert "saturated" in doubts(impact.recorded_metrics(time, clipped))


@given(
    shape=shapes,
    peak=peaks,
    duration=durations,
    begin=st.floats(0.0011, 0.05),
    share=st.floats(-0.6, -0.06),
)
def test_an_offset_below_zero_is_always_doubted(
    shape: str, peak: float, duration: float, begin: float, share: float
) -> None:
    time, values = record(shape, peak, duration, begin)
    assert doubts(impact.recorded_metrics(time, values + share * peak)) & {"offset", "negative_axis"}


@given(shape=shapes, peak=peaks, duration=durations, begin=begins, digits=st.integers(0, 3))
def test_rounded_values_are_no_saturation(shape: str, peak: float, duration: float, begin: float, digits: int) -> None:
    assume(10.0**-digits <= 0.01 * peak)  # coarser digits cannot be told from a clipped channel
    time, values = record(shape, peak, duration, begin)
    assert "saturated" not in doubts(impact.recorded_metrics(time, values.round(digits)))


@given(values=st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=40), step=st.floats(1e-5, 5e-3))
def test_no_record_is_within_limits_that_its_samples_exceed(values: list[float], step: float) -> None:
    time = np.arange(len(values)) * step
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = impact.recorded_metrics(time, values)
    limit = 0.5 * max(map(abs, values)) or 1.0
    verdict = impact.FoamLimits(peak_head_acceleration_g=limit, max_compression=None).verdict(found)
    if max(map(abs, values)) > limit:
        assert verdict != "within_limits"
    assert not math.isnan(found.hic15)
