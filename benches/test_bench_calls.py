"""Costs that a user meets outside the batch path: one run, one evaluation, the import."""

from __future__ import annotations

import statistics
import subprocess
import sys
from typing import Any

import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

IMPORTS = 15
LAW = nav.VirtualForceField(stabilizing="off")


@pytest.mark.benchmark(group="one call")
@pytest.mark.parametrize("name", ["c1", "c4"])
def test_one_simulation_of_a_scenario_already_built(benchmark: Any, name: str) -> None:
    run = benchmark(nav.simulate, scenarios.configuration(name), LAW)
    benchmark.extra_info["arrival_time_s"] = round(run.arrival_time, 4)
    benchmark.extra_info["rows"] = len(run.time)
    assert run.outcome == "arrived"


@pytest.mark.benchmark(group="one call")
def test_one_evaluation_of_the_force_terms(benchmark: Any) -> None:
    scenario = scenarios.configuration("c4")
    terms = benchmark(nav.force_terms, LAW, scenario, position=(2.55, 0.87), velocity=(-0.3, 0.1))
    assert terms.side.shape == (3,)


@pytest.mark.benchmark(group="one call")
def test_one_scenario_built(benchmark: Any) -> None:
    scenario = benchmark(scenarios.configuration, "c4")
    assert len(scenario.obstacles) == 3


def import_times_ms(*modules: str) -> list[float]:
    """Return the median time of each import in a fresh interpreter, taken in turn, in ms."""
    times: list[list[float]] = [[] for _ in modules]
    for _ in range(IMPORTS):
        for module, found in zip(modules, times, strict=True):
            program = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
            done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
            found.append(1e3 * float(done.stdout))
    return [statistics.median(found) for found in times]


@pytest.mark.benchmark(group="import")
def test_import_over_that_of_numpy(benchmark: Any) -> None:
    modules = ("numpy", "hrsafety", "hrsafety.navigation")
    medians = benchmark.pedantic(import_times_ms, args=modules, rounds=1)
    benchmark.extra_info |= {f"{module}_ms": round(ms, 1) for module, ms in zip(modules, medians, strict=True)}
    benchmark.extra_info["over_numpy_ms"] = round(max(medians[1:]) - medians[0], 1)
    assert min(medians) > 0.0
