"""Memory of runs of robots: peak of a process that makes ten million gain sets, or a million recorded control periods.

Each number is the peak of a process less that of one that makes a ten-thousandth of it.
"""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import pytest

HEAD = """
import resource, sys
import numpy as np
from hrsafety import navigation as nav, scenarios
n, law = int(sys.argv[1]), nav.VirtualForceField()
scene = scenarios.configuration("c1")
"""
TAIL = "\nprint(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
WORK: dict[str, tuple[str, int]] = {
    # An axis of n values beside the defaults: only a part of the sets is in memory at a time.
    "10^7 gain sets": (
        "from dataclasses import replace\n"
        "brief = replace(scene, time_limit=2.0)\n"
        "gains = {'attractive_gain': np.linspace(5.0, 20.0, n)}\n"
        "best = max(float(part.performance_total.max())\n"
        "           for part in nav.gains.stream_batch([brief], law, gains, step=0.06))",
        10**7,
    ),
    "10^6 recorded periods": (
        "start, goal = (0.0, 0.0), (1e6, 0.0)\n"
        "long = nav.Scenario(start=start, goal=goal, time_limit=0.06 * n, rest_time=1e9)\n"
        "run = nav.simulate(long, law, step=0.06, record=())\n"
        "assert len(run.time) >= n",
        10**6,
    ),
}


def peak(work: str, size: int) -> int:
    """Return the peak memory of a process in bytes."""
    done = subprocess.run(
        [sys.executable, "-c", HEAD + work + TAIL, str(size)], capture_output=True, text=True, check=True
    )
    return int(done.stdout.split()[-1])


@pytest.mark.parametrize("kind", WORK)
@pytest.mark.benchmark(group="memory of runs")
def test_memory(benchmark: Any, kind: str) -> None:
    work, size = WORK[kind]
    taken = peak(work, size) - peak(work, size // 10_000)
    benchmark.extra_info["MB"] = round(taken / 1e6, 1)
    benchmark.pedantic(lambda: None, rounds=1)
    print(f"{kind}: {taken / 1e6:.0f} MB")
