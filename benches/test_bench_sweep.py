"""What a sweep costs beyond the batch that it calls: chunks, files on the disk, peak memory.

The batch alone computes the same rows in the same process; its time stands beside that of the sweep
as ``batch_seconds``. The memory is that of a fresh process that does nothing else.
"""

from __future__ import annotations

import itertools
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import impact, sweep

POINTS = 1000
ROUNDS = 3
STUDY = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25})
MEMORY = """
import sys
sys.path.insert(0, sys.argv[1])
import test_bench_sweep as bench
bench.swept(bench.design(sys.argv[2]), sys.argv[3])
print(bench.peak_memory())
"""


def peak_memory() -> float:
    """Return the peak memory of this process in MB.

    What `resource` counts on Linux starts with that of the process that started this one.
    """
    status = Path("/proc/self/status")
    if status.exists():
        return float(status.read_text(encoding="ascii").split("VmHWM:")[1].split()[0]) / 1e3
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def design(kind: str) -> sweep.Design:
    """Return a million foams."""
    ranges: dict[str, Any] = {"foam_stiffness": (5e3, 60e3), "foam_damping": (0.0, 150.0)}
    points = POINTS if kind == "grid" else None
    axes = tuple(sweep.Axis(name=name, low=low, high=high, points=points) for name, (low, high) in ranges.items())
    if kind == "grid":
        return sweep.Grid(axes)
    return (sweep.Sobol if kind == "sobol" else sweep.LatinHypercube)(axes, POINTS**2)


def swept(rows: sweep.Design, folder: Path | str) -> sweep.SweepResult:
    return sweep.run(rows, STUDY, out=folder)


@pytest.mark.parametrize("kind", ["grid", "latin_hypercube", "sobol"])
def test_million_impacts_into_a_folder(benchmark: Any, tmp_path: Path, kind: str) -> None:
    rows, number = design(kind), itertools.count()
    result = benchmark.pedantic(lambda: swept(rows, tmp_path / str(next(number))), rounds=ROUNDS)
    values = rows.rows()
    batch, found = [], None
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        found = impact.metrics_batch(
            manipulator=impact.MANIPULATOR_1,
            head=impact.Head.minimum(),
            closing_speed=1.25,
            foam_stiffness=values[:, 0],
            foam_damping=values[:, 1],
        )
        batch.append(time.perf_counter() - begin)
    assert found is not None
    np.testing.assert_array_equal(result["hic15"], found.hic15)
    command = [sys.executable, "-c", MEMORY, str(Path(__file__).parent), kind, str(tmp_path / "fresh")]
    memory = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    benchmark.extra_info |= {"batch_seconds": min(batch), "memory_MB": float(memory)}
