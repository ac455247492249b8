"""Many runs of configuration 4 over gain sets, on one core: the package, NumPy and numba.

Each bench records how far its runs are from the plain evaluation, and how many force evaluations
the package makes while the contestant makes one (``package_speed_ratio``): processor time, least
of several rounds in turn, so that a busy machine hurts both alike. Nothing here asserts a time.
"""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import peer_numba
import peer_numpy
from hrsafety import navigation as nav
from hrsafety import scenarios
from peer_numpy import Array, Runs
from reference import plain_field as pf
from reference.plain_rollout import roll_out
from reference.plain_settings import NEW, NEW_STAR, setting

COUNT = 1024
CHECKED = 32
ROUNDS = 7
EQUAL = 1e-6  # s, J, m: the contestants do the same work; roundings grow along a run
SCENARIO = scenarios.configuration("c4")
LAW = nav.VirtualForceField(stabilizing="off")


def gain_sets() -> Array:
    """Return the gains of the source and random ones around them, neighbours side by side as in a sweep.

    Sets that do not bring the robot to its goal are left out: the peers have no rule that ends
    the run of a robot at rest.
    """
    generator = np.random.default_rng(3)
    spread = np.array(NEW_STAR) * generator.uniform(0.5, 1.5, (COUNT + COUNT // 4, 4))
    spread = spread[nav.simulate_batch([SCENARIO], LAW, spread).outcome == "arrived"][: COUNT - 2]
    return np.vstack([NEW, NEW_STAR, spread[np.argsort(spread[:, 2])]])


GAINS = gain_sets()


def package(gains: Array, law: nav.VirtualForceField = LAW) -> Runs:
    table = nav.simulate_batch([SCENARIO], law, gains, threads=1)
    return Runs(table.arrival_time, table.energy, table.min_distance, int(table.force_evaluations.sum()))


CONTESTANTS = {"package": package, "numpy": peer_numpy.simulate, "numba": peer_numba.simulate}


@pytest.fixture(scope="module")
def plain() -> Runs:
    """Return the runs of the plain evaluation for the first gain sets and a few spread over the rest."""
    runs = [roll_out(pf.Law(pf.Gains(*gains)), setting("c4")) for gains in GAINS[checked()].tolist()]
    columns = zip(*((run.arrival_time, run.energy, run.min_distance) for run in runs), strict=True)
    return Runs(*map(np.array, columns), sum(run.samples for run in runs))


def checked() -> np.ndarray:
    return np.unique(np.concatenate([[0, 1], np.linspace(2, COUNT - 1, CHECKED - 2).astype(int)]))


def rates(*contestants: Callable[[Array], Runs]) -> list[float]:
    """Return force evaluations per second of processor time, least time of rounds in turn."""
    best = [(math.inf, 0)] * len(contestants)
    for _ in range(ROUNDS):
        for i, work in enumerate(contestants):
            begin = time.process_time()
            evaluations = work(GAINS).force_evaluations
            best[i] = min(best[i], (time.process_time() - begin, evaluations))
    return [evaluations / seconds for seconds, evaluations in best]


def accuracy(runs: Runs, plain: Runs) -> dict[str, float]:
    """Return the largest deviations from the plain evaluation."""
    rows = checked()
    return {
        "max_dT_s": float(np.abs(runs.arrival_time[rows] - plain.arrival_time).max()),
        "max_dE_J": float(np.abs(runs.energy[rows] - plain.energy).max()),
        "max_dd_m": float(np.abs(runs.min_distance[rows] - plain.min_distance).max()),
    }


@pytest.mark.benchmark(group="configuration 4, 1024 gain sets, one core")
@pytest.mark.parametrize("name", CONTESTANTS)
def test_batch_of_configuration_4(benchmark: Any, plain: Runs, name: str) -> None:
    work = CONTESTANTS[name]
    runs = work(GAINS)  # compiles numba outside the timed part
    found = accuracy(runs, plain)
    assert max(found.values()) < EQUAL
    benchmark.pedantic(work, args=(GAINS,), rounds=ROUNDS, iterations=1)
    own, of_package = rates(work, package)
    benchmark.extra_info |= found
    benchmark.extra_info["force_evaluations"] = runs.force_evaluations
    benchmark.extra_info["million_evaluations_per_s"] = round(own / 1e6, 2)
    benchmark.extra_info["package_speed_ratio"] = round(of_package / own, 1)


@pytest.mark.benchmark(group="configuration 4, stabilizing modes, one core")
@pytest.mark.parametrize("mode", ["off", "capped", "full"])
def test_batch_with_the_stabilizing_force(benchmark: Any, mode: nav.laws.StabilizingMode) -> None:
    work = functools.partial(package, law=nav.VirtualForceField(stabilizing=mode))
    runs = benchmark.pedantic(work, args=(GAINS,), rounds=ROUNDS, iterations=1)
    own, off = rates(work, package)
    benchmark.extra_info["arrived"] = int(np.isfinite(runs.arrival_time).sum())
    benchmark.extra_info["million_evaluations_per_s"] = round(own / 1e6, 2)
    benchmark.extra_info["cost_over_off"] = round(off / own, 2)
    assert len(runs.arrival_time) == COUNT
