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


PROGRAMS = {
    "numpy": "import numpy",
    "hrsafety": "import numpy, hrsafety",
    "navigation": "import numpy, hrsafety.navigation",
    "first_run": """
import numpy
from hrsafety import navigation as nav
walking = nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0), stop=(4.0, 0.6), max_speed=1.6)
standing = nav.Disc(center=(2.45, 1.4), radius=0.1, active_clearance=0.5, critical_clearance=0.1)
scene = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[walking, standing])
nav.evaluate(scene, nav.VirtualForceField())
""",
    "impact": "import numpy, hrsafety.impact",
    "first_impact": """
import numpy
from hrsafety import impact
impact.metrics(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.0)
""",
}


def processor_times_ms() -> dict[str, float]:
    """Return the median processor time of each program in a fresh interpreter, taken in turn, in ms."""
    times: dict[str, list[float]] = {name: [] for name in PROGRAMS}
    for _ in range(IMPORTS):
        for name, program in PROGRAMS.items():
            code = f"import time; t = time.process_time()\n{program}\nprint(time.process_time() - t)"
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
            times[name].append(1e3 * float(done.stdout))
    return {name: statistics.median(found) for name, found in times.items()}


@pytest.mark.benchmark(group="import")
def test_import_over_that_of_numpy(benchmark: Any) -> None:
    medians = benchmark.pedantic(processor_times_ms, rounds=1)
    benchmark.extra_info["numpy_ms"] = round(medians["numpy"], 1)
    for name in ("hrsafety", "navigation", "first_run", "impact", "first_impact"):
        benchmark.extra_info[f"{name}_over_numpy_ms"] = round(medians[name] - medians["numpy"], 1)
    assert min(medians.values()) > 0.0
