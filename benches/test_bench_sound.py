"""Delays from samples against SciPy, as a ratio with accuracy beside; fixes and bursts per second.

Package and SciPy are timed in turn, so that a busy machine hurts both alike, and the least of many
repeats counts. Nothing here asserts a time; accuracy is asserted.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import signal as scipy_signal

from hrsafety import reactive

ROW = reactive.MicrophoneArray()
BURST = reactive.Burst()
RATE = 100e3
PLACE = {"range": 2.0, "bearing": 0.5}
LIMITS = (120, 240)
NOISE = 0.05
REPEATS = 15
TRUE_LAGS = [float(each) * RATE for each in ROW.delays(**PLACE)]
# In samples: noise of 4096 samples, a parabola through the peak.
NEAR = 0.2
AGREEMENT = 1e-6  # in samples, package against SciPy with the same parabola


def recording(window: int) -> reactive.SoundRecording:
    """Return so many samples from within the burst, or 46000 from its beginning."""
    lead = -0.02 if window < 40_000 else 0.0
    return reactive.record_burst(BURST, ROW, **PLACE, noise=NOISE, lead=lead, samples=window)


def with_scipy(samples: np.ndarray) -> list[float]:
    """Return the lags of M2 and M3 in samples by SciPy, with mean products and the same parabola."""
    first = samples[0] - samples[0].mean()
    found = []
    for other, limit in zip(samples[1:], LIMITS, strict=True):
        products = scipy_signal.correlate(other - other.mean(), first, mode="full", method="fft")
        lags = scipy_signal.correlation_lags(len(other), len(first), mode="full")
        middle = len(first) - 1
        near = slice(middle - limit, middle + limit + 1)
        values = products[near] / (len(first) - np.abs(lags[near]))
        best = int(values.argmax())
        before, at, after = values[best - 1 : best + 2]
        found.append(float(lags[near][best] + 0.5 * (before - after) / (before - 2.0 * at + after)))
    return found


def with_package(heard: reactive.SoundRecording, method: str) -> list[float]:
    found = reactive.estimate_delays(heard, ROW, method=method)  # type: ignore[arg-type]  # a word of the table
    return [found.delay_12 * RATE, found.delay_13 * RATE]


def least_times(*works: Callable[[], object]) -> list[float]:
    """Return the least time of each piece of work, taken in turn, in s."""
    times = [math.inf] * len(works)
    for _ in range(REPEATS):
        for index, work in enumerate(works):
            begin = time.perf_counter()
            work()
            times[index] = min(times[index], time.perf_counter() - begin)
    return times


@pytest.mark.benchmark(group="delays of three channels")
@pytest.mark.parametrize("method", ["cross_correlation", "mean_square", "phase"])
@pytest.mark.parametrize("window", [4096, 46_000])
def test_delays_against_scipy(benchmark: Any, window: int, method: str) -> None:
    heard = recording(window)
    own, peer = with_package(heard, method), with_scipy(heard.samples)
    if method == "cross_correlation":
        assert own == pytest.approx(peer, abs=AGREEMENT)
    if method != "phase":
        assert own == pytest.approx(TRUE_LAGS, abs=NEAR)
    benchmark.pedantic(with_package, args=(heard, method), rounds=5, iterations=3)
    mine, theirs = least_times(lambda: with_package(heard, method), lambda: with_scipy(heard.samples))
    benchmark.extra_info |= {
        "scipy_over_package": round(theirs / mine, 2),
        "package_ms": round(1e3 * mine, 3),
        "off_in_samples": [float(f"{a - b:.1e}") for a, b in zip(own, TRUE_LAGS, strict=True)],
        "scipy_off_in_samples": [float(f"{a - b:.1e}") for a, b in zip(peer, TRUE_LAGS, strict=True)],
    }


@pytest.mark.benchmark(group="many fixes, one core")
def test_million_fixes(benchmark: Any) -> None:
    distance = np.random.default_rng(1).uniform(0.5, 4.0, 1_000_000)
    bearing = np.random.default_rng(2).uniform(-1.0, 1.0, 1_000_000)
    delay_12, delay_13 = ROW.delays(range=distance, bearing=bearing)

    def work() -> reactive.Fixes:
        return reactive.locate_batch(ROW, delay_12=delay_12, delay_13=delay_13, threads=1)

    found = benchmark.pedantic(work, rounds=3, iterations=1, warmup_rounds=1)
    (least,) = least_times(work)
    benchmark.extra_info |= {
        "million_fixes_per_s": round(1e-6 * len(distance) / least, 2),
        "largest_error_m": float(f"{np.abs(found.range - distance).max():.1e}"),
    }
    assert np.abs(found.range - distance).max() <= 1e-12
    assert np.abs(found.bearing - bearing).max() <= 1e-12


@pytest.mark.benchmark(group="full waveforms, one core")
@pytest.mark.parametrize("samples", [4096, None])
def test_bursts_heard_and_located(benchmark: Any, samples: int | None) -> None:
    lead = -0.02 if samples else 0.005

    def work() -> reactive.Fixes:
        return reactive.localize_bursts(
            BURST, ROW, **PLACE, runs=20, noise=NOISE, lead=lead, samples=samples, threads=1
        )

    found = benchmark.pedantic(work, rounds=3, iterations=1, warmup_rounds=1)
    (least,) = least_times(work)
    benchmark.extra_info["bursts_per_s"] = round(20 / least)
    assert np.abs(found.range - PLACE["range"]).max() < 0.2
