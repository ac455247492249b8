"""Ctrl-C while sounds are heard, compared and located."""

from __future__ import annotations

import pytest

from api.interrupting import check_work_is_interrupted, needs_signals

ARRAY = """
import numpy as np
from hrsafety import reactive
row, places = reactive.MicrophoneArray(), dict(range=2.0, bearing=0.3)
"""

# Every piece of work takes many seconds, so the signal always arrives while it runs.
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


@needs_signals
@pytest.mark.parametrize("job", JOBS)
def test_running_work_answers_ctrl_c(job: str, capsys: pytest.CaptureFixture[str]) -> None:
    preparation, work = JOBS[job]
    check_work_is_interrupted(ARRAY + preparation, work, capsys)
