"""Ctrl-C while sounds are heard, compared and located."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

# Every piece of work takes many seconds, so the signal always arrives while it runs.
PROGRAM = """
import time
import numpy as np
from hrsafety import reactive
row, places = reactive.MicrophoneArray(), dict(range=2.0, bearing=0.3)
{preparation}
print("started", flush=True)
try:
    {work}
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
else:
    print("finished", flush=True)
"""
JOBS = {
    "waveforms": ("", "reactive.localize_bursts(reactive.Burst(), row, **places, runs=10**6, threads=2)"),
    "waveforms, reported": (
        "",
        "reactive.localize_bursts(reactive.Burst(), row, **places, runs=10**6, progress=lambda done, total: None)",
    ),
    "jitter": ("", "reactive.jittered_fixes(row, **places, runs=10**8, threads=1)"),
    "one long record": (
        'burst = reactive.Burst(kind="sweep", duration=500.0)',
        "reactive.record_burst(burst, row, **places, noise=0.1)",
    ),
    "one long comparison": (
        "heard = reactive.SoundRecording(samples=np.random.default_rng(1).normal(size=(3, 2**22)), sample_rate=2e6)",
        'reactive.estimate_delays(heard, row, method="mean_square")',
    ),
}
WARM_UP = 0.7  # s, so that the work is under way
# The promise is 0.2 s; the limit leaves room for a loaded machine and for the end of the
# interpreter, in s.
LIMIT = 2.0


@pytest.mark.skipif(sys.platform == "win32", reason="the signal cannot be sent to one process on Windows")
@pytest.mark.parametrize("job", JOBS)
def test_running_work_answers_ctrl_c(job: str, capsys: pytest.CaptureFixture[str]) -> None:
    preparation, work = JOBS[job]
    program = PROGRAM.format(preparation=preparation, work=work)
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
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
