"""The search for gains of appendix C.2 as a whole, and its grids beside numba.

The peer runs the very grids of the package, coarse steps, on one thread; the package does the same
on one thread for the ratio, and the whole search with 0.01 s steps on all cores. Each bench
records how far the scores are apart. Nothing here asserts a time.
"""

from __future__ import annotations

import functools
import itertools
import time
from typing import Any

import numpy as np
import pytest

import peer_gains_numba
from hrsafety import navigation as nav
from hrsafety import scenarios
from peer_numba import Array

SCENES = [scenarios.configuration(name) for name in ("c1", "c2", "c3")]
LAW = nav.VirtualForceField(stabilizing="off")
SOURCE = (4.3, 20.3, 240.7, 0.68)
EQUAL = 1e-6  # of H; a run that touches or misses by a rounding is counted apart
GROUP = "the grids of C.2, 310,464 gain sets in three configurations"


def mean_scores(gains: Array, step: float) -> Array:
    """Return the mean H of gain sets."""
    table = nav.simulate_batch(SCENES, LAW, gains, step=step, stop_on_contact=True)
    mean: Array = table.performance_total.reshape(len(gains), -1).mean(axis=1)
    return mean


def grids_of_the_package(step: float, threads: int | None) -> nav.GainSearch:
    return nav.optimize_gains(SCENES, step=step, local_starts=0, threads=threads)


def grids_of_numba(rounds: tuple[nav.gains.SearchStage, ...]) -> list[Array]:
    return [peer_gains_numba.scores(each.axes) for each in rounds]


@functools.cache
def coarse() -> tuple[nav.GainSearch, list[Array], float, float]:
    """Return the grids of both with coarse steps on one thread, and their processor times in s."""
    short = tuple(np.linspace(low, high, 2) for low, high in ((0.0, 50.0), (0.0, 200.0), (0.0, 500.0), (0.0, 3.0)))
    peer_gains_numba.scores(short)  # compiles
    begin = time.process_time()
    own = grids_of_the_package(0.06, 1)
    middle = time.process_time()
    peer = grids_of_numba(own.grids)
    return own, peer, middle - begin, time.process_time() - middle


def deviations(search: nav.GainSearch, peer: list[Array]) -> Array:
    """Return by how much the scores differ on every seventh point of each grid."""
    found = []
    for each, scores in zip(search.grids, peer, strict=True):
        points = np.array(list(itertools.product(*each.axes)))[::7]
        found.append(np.abs(mean_scores(points, 0.06) - scores[::7]))
    return np.concatenate(found)


@pytest.mark.benchmark(group=GROUP)
@pytest.mark.parametrize(("step", "threads"), [(0.01, None), (0.01, 1), (0.06, None), (0.06, 1)])
def test_grids_of_the_package(benchmark: Any, step: float, threads: int | None) -> None:
    search = benchmark.pedantic(grids_of_the_package, args=(step, threads), rounds=2, iterations=1)
    assert search.evaluations == 4 * 77616
    benchmark.extra_info["best_value"] = round(search.best_value, 5)
    benchmark.extra_info["failures"] = search.failures
    benchmark.extra_info["episodes_per_s"] = round(search.episodes / benchmark.stats.stats.min)


@pytest.mark.benchmark(group=GROUP)
def test_grids_of_numba_with_coarse_steps(benchmark: Any) -> None:
    search, peer, own_time, peer_time = coarse()
    apart = deviations(search, peer)
    benchmark.pedantic(grids_of_numba, args=(search.grids[:1],), rounds=1, iterations=1)
    assert (apart < EQUAL).mean() > 0.999
    assert abs(max(scores.max() for scores in peer) - search.best_value) < EQUAL
    benchmark.extra_info["timed"] = "the first grid of four"
    benchmark.extra_info["seconds_of_four_grids"] = round(peer_time, 2)
    benchmark.extra_info["package_seconds_of_four_grids"] = round(own_time, 2)
    benchmark.extra_info["package_speed_ratio"] = round(peer_time / own_time, 1)
    benchmark.extra_info["median_dH"] = float(np.median(apart))
    benchmark.extra_info["share_within_1e-6"] = float((apart < EQUAL).mean())


@pytest.mark.benchmark(group="the whole of C.2: grids and 20 local searches")
@pytest.mark.parametrize("threads", [None, 1])
def test_whole_procedure(benchmark: Any, threads: int | None) -> None:
    search = benchmark.pedantic(
        functools.partial(nav.optimize_gains, threads=threads), args=(SCENES,), rounds=3, iterations=1
    )
    own = nav.simulate_batch(SCENES, LAW, [search.best.gains, SOURCE]).performance_total.reshape(2, -1).mean(axis=1)
    assert abs(own[0] - search.best_value) < 1e-12
    assert search.best_value > max(entry.best_value for entry in search.grids) - 1e-15
    benchmark.extra_info["best_value"] = round(search.best_value, 5)
    benchmark.extra_info["above_the_source"] = round(float(own[0] - own[1]), 5)
    benchmark.extra_info["gain_sets"] = search.evaluations
    benchmark.extra_info["episodes_per_s"] = round(search.episodes / benchmark.stats.stats.min)


@pytest.mark.benchmark(group="the optimum of C.2 without grids")
def test_auto(benchmark: Any) -> None:
    """What `method="auto"` reaches with ten seeds, on all cores, with the time limit of the comparison by grids."""

    def search(seed: int) -> tuple[float, float]:
        begin = time.perf_counter()
        found = nav.optimize_gains(SCENES, method="auto", seed=seed, time_limit=10.0)
        return found.best_value, time.perf_counter() - begin

    benchmark.pedantic(search, (0,), rounds=3, iterations=1)
    begin = time.process_time()
    values, seconds = zip(*map(search, range(10)), strict=True)
    benchmark.extra_info["processor_s_of_a_search"] = round((time.process_time() - begin) / 10, 2)
    benchmark.extra_info["seconds"] = [round(min(seconds), 2), round(max(seconds), 2)]
    benchmark.extra_info["best_values"] = [round(min(values), 5), round(max(values), 5)]


@pytest.mark.benchmark(group="tables C.2 to C.9")
def test_tables_of_the_sensitivity(benchmark: Any) -> None:
    law = nav.VirtualForceField(**dict(zip(LAW.GAIN_NAMES, SOURCE, strict=True)), stabilizing="off")
    table = benchmark(nav.gain_sensitivity, SCENES, law)
    assert table.performance.shape == (4, 12, 3)
