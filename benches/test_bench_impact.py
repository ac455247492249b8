"""Impacts on one core: single calls, the batch path, a foam map, and the same peaks from peers.

Every batch bench records the largest relative deviation of each field from the independent
evaluation in float (`reference.impact_metrics`, itself checked in 50 digits), beside evaluations per
second of processor time, taken in turn with the package so that a busy machine hurts both alike.
Nothing here asserts a time; accuracy is asserted.
"""

from __future__ import annotations

import importlib.util
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import peer_impact_numba
import peer_impact_steps
from hrsafety import impact
from reference.impact_metrics import METRICS, metrics
from reference.impact_mpmath import Parameters

PEAKS = peer_impact_numba.PEAKS
COUNT = 60_000
MAP = 1000
CHECKED = 64
ROUNDS = 3
EXACT = 1e-9  # relative, every field of the package
SAMPLED = 2e-4  # relative: peaks of 501 samples over 0.1 s
COLUMNS = Parameters._fields[:8]


# Ranges of M_r, C_r, K_r, M_h, C_h, K_h, K_c, C_c and the closing speed.
RANGES = {
    # Manipulators, heads and foams of the tables and far around them.
    "designs": [
        (5.0, 60.0),
        (50.0, 300.0),
        (8e3, 4e4),
        (4.4, 5.3),
        (46.0, 130.0),
        (3e3, 5e3),
        (8e3, 6e4),
        (20.0, 150.0),
        (0.25, 1.25),
    ],
    # Also light arms that bounce, heads without a neck, dashpots that push more than springs.
    "every kind": [
        (1.0, 60.0),
        (0.0, 600.0),
        (1e3, 4e4),
        (3.0, 7.0),
        (0.0, 200.0),
        (0.0, 8e3),
        (2e3, 8e4),
        (0.0, 400.0),
        (0.1, 3.0),
    ],
}


def random_rows(kind: str) -> np.ndarray:
    """Return independent uniform draws; the first row of the designs is the nominal impact."""
    source = np.random.default_rng(8)
    rows = np.column_stack([source.uniform(low, high, COUNT) for low, high in RANGES[kind]])
    if kind == "designs":
        rows[0] = [9.6, 250.0, 20e3, 4.4, 0.0, 4e3, 24.25e3, 71.9, 1.25]
    return rows


def map_rows() -> np.ndarray:
    """Return foams over stiffness and damping on one manipulator, damping running fastest."""
    side = math.isqrt(COUNT)
    rows = np.tile([9.6, 250.0, 20e3, 4.4, 46.0, 3e3, 0.0, 0.0, 1.25], (side * side, 1))
    rows[:, 6] = np.repeat(np.linspace(5e3, 80e3, side), side)
    rows[:, 7] = np.tile(np.linspace(0.0, 200.0, side), side)
    return rows


# The package takes columns, the peers take rows: each gets them as they lie best.
SETS = {
    "map": np.asfortranarray(map_rows()),
    "designs": np.asfortranarray(random_rows("designs")),
    "every kind": np.asfortranarray(random_rows("every kind")),
}
ROWS = SETS["designs"]


def package(rows: np.ndarray, fields: str, lanes: int | None = None) -> impact.ImpactMetricsBatch:
    columns = dict(zip(COLUMNS, rows.T[:8], strict=True))
    return impact.metrics_batch(**columns, closing_speed=rows[:, 8], fields=fields, threads=1, lanes=lanes)


def package_peaks(rows: np.ndarray) -> np.ndarray:
    table = package(rows, "peaks")
    return np.column_stack([getattr(table, name) for name in PEAKS])


@pytest.fixture(scope="module")
def plain() -> dict[str, np.ndarray]:
    """Return every metric of the first rows by the independent evaluation."""
    found = [metrics(Parameters(*row, row[8]), exact=False) for row in ROWS[:CHECKED].tolist()]
    return {name: np.array([each[name] for each in found]) for name in METRICS}


def deviations(found: dict[str, np.ndarray], plain: dict[str, np.ndarray]) -> dict[str, float]:
    """Return the largest relative deviation of each field on the checked rows."""
    result = {}
    for name, values in found.items():
        both = values[:CHECKED], plain[name]
        same = (both[0] == both[1]) | (np.isnan(both[0]) & np.isnan(both[1]))  # infinite periods too
        with np.errstate(invalid="ignore"):
            off = np.abs(values[:CHECKED] - plain[name]) / np.abs(plain[name])
        result[name] = float(np.where(same, 0.0, off).max())
    return result


def rates(*contestants: tuple[Callable[[np.ndarray], object], np.ndarray]) -> list[float]:
    """Return evaluations per second of processor time, least time of rounds in turn."""
    best = [math.inf] * len(contestants)
    for _ in range(ROUNDS):
        for i, (work, rows) in enumerate(contestants):
            begin = time.process_time()
            work(rows)
            best[i] = min(best[i], time.process_time() - begin)
    return [len(rows) / seconds for (_, rows), seconds in zip(contestants, best, strict=True)]


def searched_deviations(rows: np.ndarray, table: impact.ImpactMetricsBatch, names: tuple[str, ...]) -> dict[str, float]:
    """Return the largest relative deviation of each field from the independent evaluation on some rows."""
    chosen = np.linspace(0, len(rows) - 1, CHECKED, dtype=int)
    found = [metrics(Parameters(*row, row[8]), exact=False) for row in rows[chosen].tolist()]
    exact = {name: np.array([each[name] for each in found]) for name in names}
    return deviations({name: getattr(table, name)[chosen] for name in names}, exact)


@pytest.mark.benchmark(group="impacts, one core")
@pytest.mark.parametrize("fields", ["all", "peaks"])
@pytest.mark.parametrize("kind", SETS)
def test_batch_of_impacts(benchmark: Any, kind: str, fields: str) -> None:
    rows = SETS[kind]
    table = package(rows, fields)
    off = searched_deviations(rows, table, METRICS if fields == "all" else PEAKS)
    assert max(off.values()) <= EXACT, off
    benchmark.pedantic(package, args=(rows, fields), rounds=ROUNDS, iterations=1)
    (rate,) = rates((lambda rows: package(rows, fields), rows))
    benchmark.extra_info |= {f"deviation {name}": float(f"{value:.1e}") for name, value in off.items()}
    benchmark.extra_info["million_evaluations_per_s"] = round(rate / 1e6, 3)


@pytest.mark.benchmark(group="impacts, one core, by vectors")
@pytest.mark.parametrize("lanes", [1, 4, 8])
def test_batch_by_lanes(benchmark: Any, lanes: int) -> None:
    """All criteria one after the other, in vectors of 256 bits and in the widest."""
    contestants = [(lambda rows: package(rows, "all", lanes), rows) for rows in SETS.values()]
    benchmark.pedantic(package, args=(ROWS, "all", lanes), rounds=ROUNDS, iterations=1)
    for kind, rate in zip(SETS, rates(*contestants), strict=True):
        benchmark.extra_info[f"million_evaluations_per_s, {kind}"] = round(rate / 1e6, 3)


PEERS = {
    "numba": (peer_impact_numba.peaks, 20_000, EXACT),
    "python-control": (peer_impact_steps.with_control, 64, SAMPLED),
    "solve_ivp": (peer_impact_steps.with_solve_ivp, 64, SAMPLED),
}


@pytest.mark.benchmark(group="peaks of impacts, one core, peers")
@pytest.mark.parametrize("name", PEERS)
def test_same_peaks_from_a_peer(benchmark: Any, plain: dict[str, np.ndarray], name: str) -> None:
    if name == "python-control" and importlib.util.find_spec("control") is None:
        pytest.skip("python-control is not installed")
    work, count, accuracy = PEERS[name]
    rows = np.ascontiguousarray(ROWS[:count])
    table = work(rows[:CHECKED])  # compiles numba outside the timed part
    off = deviations(dict(zip(PEAKS, table.T, strict=True)), plain)
    assert max(off.values()) <= accuracy, off
    benchmark.pedantic(work, args=(rows,), rounds=2, iterations=1)
    own, of_package = rates((work, rows), (package_peaks, ROWS))
    benchmark.extra_info |= {f"deviation {field}": float(f"{value:.1e}") for field, value in off.items()}
    benchmark.extra_info["evaluations_per_s"] = round(own)
    benchmark.extra_info["package_speed_ratio"] = round(of_package / own, 1)


@pytest.mark.benchmark(group="foam map, one core")
def test_map_of_a_million_foams(benchmark: Any) -> None:
    stiffness, damping = np.linspace(5e3, 80e3, MAP)[:, None], np.linspace(0.0, 200.0, MAP)

    def work() -> impact.ImpactMetricsBatch:
        return impact.metrics_batch(
            manipulator=impact.MANIPULATOR_1,
            head=impact.Head.minimum(),
            closing_speed=1.25,
            foam_stiffness=stiffness,
            foam_damping=damping,
            fields="peaks",
            threads=1,
        )

    found = benchmark.pedantic(work, rounds=3, iterations=1, warmup_rounds=1)
    begin = time.process_time()
    work()
    benchmark.extra_info["processor_time_s"] = round(time.process_time() - begin, 3)
    assert found.shape == (MAP, MAP)
    m, head = impact.MANIPULATOR_1, impact.Head.minimum()
    for i, j in ((0, 0), (0, MAP - 1), (MAP // 2, MAP // 3), (MAP - 1, MAP - 1)):
        foam = (float(stiffness[i, 0]), float(damping[j]))
        p = Parameters(m.mass, m.damping, m.stiffness, head.mass, head.damping, head.stiffness, *foam, 1.25, 1.25)
        exact = metrics(p, exact=False)
        for name in PEAKS:
            assert getattr(found, name)[i, j] == pytest.approx(exact[name], rel=EXACT), name


@pytest.mark.benchmark(group="one call")
def test_one_call_of_metrics(benchmark: Any) -> None:
    parts = (impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum())
    found = benchmark(impact.metrics, *parts, closing_speed=1.25)
    assert found.status == "released"


@pytest.mark.benchmark(group="one call")
def test_head_injury_criterion_of_2000_samples(benchmark: Any) -> None:
    t = np.arange(2000) * 1e-4
    acceleration = 80.0 * np.exp(-(((t - 0.08) / 0.006) ** 2)) - 15.0 * np.exp(-(((t - 0.11) / 0.01) ** 2))
    acceleration += np.random.default_rng(1).normal(0.0, 0.5, len(t))
    found = benchmark(impact.hic, t, acceleration, 0.015)
    assert found.value == pytest.approx(brute_force(t, acceleration, 0.015), rel=1e-12)


def brute_force(t: np.ndarray, acceleration: np.ndarray, window: float) -> float:
    """Return the criterion over all pairs of samples, trapezoid sums."""
    speed = np.concatenate([[0.0], np.cumsum(0.5 * (acceleration[1:] + acceleration[:-1]) * np.diff(t))])
    best = 0.0
    for i in range(len(t) - 1):
        last = int(np.searchsorted(t, t[i] + window * (1.0 + 1e-9), side="right"))
        gain, apart = np.maximum(speed[i + 1 : last] - speed[i], 0.0), t[i + 1 : last] - t[i]
        best = max(best, float((gain**2.5 / apart**1.5).max()))
    return best
