"""Robots as built: simulated time per second of processor time, one thread."""

from __future__ import annotations

import dataclasses
import math
import time
from typing import Any

import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

LAW = nav.VirtualForceField(stabilizing="off")
SEEDS = 40
CAMERA = nav.sensing.Vision(error=nav.sensing.PositionNoise(distribution="gaussian", scale=0.0032))
TWO_WHEELS = dataclasses.replace(scenarios.configuration("n4"), robot=nav.DifferentialDriveRobot(), heading=math.pi)
CASES = {
    "point mass, c4": (scenarios.configuration("c4"), nav.robots.AsBuilt()),
    "omni-wheels, c4": (scenarios.configuration("c4"), nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS)),
    "two ideal wheels, n4": (TWO_WHEELS, nav.robots.AsBuilt()),
    "two wheels, n4": (TWO_WHEELS, nav.robots.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS)),
    "two wheels and camera, n4": (
        TWO_WHEELS,
        nav.robots.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS, robot_vision=CAMERA, obstacle_vision=CAMERA),
    ),
}


@pytest.mark.benchmark(group="robots as built", timer=time.process_time)
@pytest.mark.parametrize("case", CASES)
def test_repeated_runs(benchmark: Any, case: str) -> None:
    scenario, built = CASES[case]
    runs = benchmark(nav.simulate_many, scenario, LAW, seeds=SEEDS, built=built, paths=True, threads=1)
    benchmark.extra_info["times_real_time"] = round(float(runs.end_time.sum()) / benchmark.stats.stats.min)
    assert (runs.outcome == "arrived").mean() > 0.5
