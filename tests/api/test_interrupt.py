"""Ctrl-C while a batch runs."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

# There is work for several seconds, so the signal always arrives while it runs: a robot without
# forces waits for its time limit in each of the long runs; the short runs arrive.
BATCH = """
import sys, time
import numpy as np
from hrsafety import navigation as nav
scene = nav.Scenario(
    start=(3.9, 0.6), goal=(0.0, 0.6), time_limit=60.0, rest_time=60.0,
    obstacles=[nav.Human(start=(0.0, y), velocity=(0.01, 0.0)) for y in (-5.0, 5.0, 8.0)],
)
gains = np.tile({gains}, (400_000, 1))
report = {report}
print("started", flush=True)
try:
    nav.simulate_batch([scene], nav.VirtualForceField(), gains, {options}, progress=report)
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
else:
    print("finished", flush=True)
"""

# Time that the batch is given to get going, in s.
WARM_UP = 0.7

# The promise is 0.2 s; the limit leaves room for a loaded machine and for the end of the
# interpreter, in s.
LIMIT = 2.0


@pytest.mark.skipif(sys.platform == "win32", reason="the signal cannot be sent to one process on Windows")
@pytest.mark.parametrize("report", ["None", "lambda done, total: None"])
@pytest.mark.parametrize(
    ("gains", "options"),
    [("(0.0, 0.0, 0.0, 0.0)", "threads=2"), ("(3.0, 20.0, 17.0, 0.25)", "threads=1, lanes=1")],
    ids=["long runs", "short runs"],
)
def test_running_batch_answers_ctrl_c(
    gains: str, options: str, report: str, capsys: pytest.CaptureFixture[str]
) -> None:
    program = BATCH.replace("{report}", report).replace("{gains}", gains).replace("{options}", options)
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "started\n"
    time.sleep(WARM_UP)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    try:
        output, errors = process.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        pytest.fail(f"the process did not end within {LIMIT} s of the signal")
    words = output.split()
    assert words[:1] == ["interrupted"], (output, errors)
    assert process.returncode == 0, errors
    with capsys.disabled():
        print(f" [Ctrl-C answered in {1e3 * (float(words[1]) - sent):.0f} ms]", end="")
