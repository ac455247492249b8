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
LAW = nav.VirtualForceField()


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


def import_time_ms(module: str) -> float:
    """Return the median time of an import in a fresh interpreter, in ms; the interpreter's own start is not in it."""
    program = f"import time; t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
    times = []
    for _ in range(IMPORTS):
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        times.append(1e3 * float(done.stdout))
    return statistics.median(times)


@pytest.mark.benchmark(group="import")
def test_import_over_that_of_numpy(benchmark: Any) -> None:
    numpy_ms = import_time_ms("numpy")
    package_ms = benchmark.pedantic(import_time_ms, args=("hrsafety.navigation",), rounds=1)
    benchmark.extra_info["numpy_ms"] = round(numpy_ms, 1)
    benchmark.extra_info["package_over_numpy_ms"] = round(package_ms - numpy_ms, 1)
    assert package_ms > 0.0
