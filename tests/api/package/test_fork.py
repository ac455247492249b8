"""Children of a fork: their batches end, with the same bits, after the parent has used its threads."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="there is no fork on this system")

IMPORTS = """
import os, sys
import numpy as np
from hrsafety import impact, navigation as nav, reactive, scenarios
scenes = [scenarios.configuration(name) for name in ("c1", "c2")]
law = nav.VirtualForceField()
"""

# Expressions whose values are equal only bit for bit; `threads` is set around them.
JOBS = {
    "simulate_batch": (
        "nav.simulate_batch(scenes, law, np.tile((3.0, 20.0, 17.0, 0.25), (40, 1)), threads=threads).energy.tobytes()"
    ),
    "metrics_batch": (
        "impact.metrics_batch(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum(),"
        " closing_speed=np.linspace(0.1, 2.0, 20_000), threads=threads).hic15.tobytes()"
    ),
    "skirt_test": "reactive.skirt_test(reactive.UltrasonicSkirt(), threads=threads).contact_time.tobytes()",
    "optimize_gains": (
        "nav.optimize_gains(scenes, grid=(3, 3, 3, 3), refinements=1, local_starts=2, survivors=9,"
        " threads=threads).best.gains"
    ),
    "locate_batch": (
        "reactive.locate_batch(reactive.MicrophoneArray(), delay_12=np.linspace(-1e-4, 1e-4, 5_000),"
        " delay_13=np.linspace(-2e-4, 2e-4, 5_000), threads=threads).range.tobytes()"
    ),
}

# The child ends by `_exit` with its verdict; it is given some seconds, and killed if it hangs.
PROGRAM = """
import signal
def work(threads):
    return {job}
expected = {{threads: work(threads) for threads in (None, 2, 1)}}
assert len(set(expected.values())) == 1, "the number of threads changes bits"
child = os.fork()
if child == 0:
    signal.alarm(30)
    same = all(work(threads) == expected[threads] for threads in (None, 2, 1, 2))
    if os.fork() == 0:
        signal.alarm(30)
        os._exit(0 if work(None) == expected[None] else 4)
    _, status = os.wait()
    os._exit(3 if not same else os.waitstatus_to_exitcode(status))
_, status = os.waitpid(child, 0)
assert work(None) == expected[None]
sys.exit(os.waitstatus_to_exitcode(status))
"""


@pytest.mark.parametrize("job", JOBS)
def test_child_of_a_fork_ends_its_batches_with_the_same_bits(job: str) -> None:
    program = IMPORTS + PROGRAM.format(job=JOBS[job])
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_process_pool_of_forks_ends(tmp_path_factory: pytest.TempPathFactory) -> None:
    program = IMPORTS + (
        "import multiprocessing\n"
        "def work(count):\n"
        "    return nav.simulate_batch(scenes, law, np.tile((3.0, 20.0, 17.0, 0.25), (count, 1))).energy.sum()\n"
        "own = [work(count) for count in (1, 2, 3)]\n"
        "with multiprocessing.get_context('fork').Pool(2) as pool:\n"
        "    assert pool.map_async(work, (1, 2, 3)).get(60) == own\n"
    )
    folder = tmp_path_factory.mktemp("fork")
    command = [sys.executable, "-W", "ignore", "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
