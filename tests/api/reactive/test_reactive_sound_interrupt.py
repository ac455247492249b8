"""Ctrl-C while sounds are heard, compared and located."""

from __future__ import annotations

import numpy as np
import pytest

from api.interrupting import check_work_is_interrupted, needs_signals
from hrsafety import reactive

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
    "jitter": ("", "reactive.sound.jittered_fixes(row, **places, runs=10**8, threads=1)"),
    "one long record": (
        'burst = reactive.Burst(kind="sweep", duration=500.0)',
        "reactive.record_burst(burst, row, **places, noise=0.1)",
    ),
    "transforms of a long record": (
        "heard = reactive.SoundRecording(samples=np.random.default_rng(1).normal(size=(3, 2**20)), sample_rate=48e3)",
        "[reactive.estimate_delays(heard, row) for _ in range(100)]",
    ),
    "phases of a long record": (
        "heard = reactive.SoundRecording(samples=np.random.default_rng(1).normal(size=(3, 2**20)), sample_rate=48e3)",
        '[reactive.likeness(heard, row, method="phase") for _ in range(100)]',
    ),
    "smallest skirt": ("", "reactive.smallest_skirt(0.01, layouts=100_000)"),
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


def test_fixes_are_moved_and_not_copied() -> None:
    """Copies of columns of many rows would keep a signal waiting."""
    row = reactive.MicrophoneArray()
    delay_12, delay_13 = row.delays(range=np.linspace(1.0, 3.0, 9000), bearing=0.3)
    fixes = reactive.locate_batch(row, delay_12=delay_12, delay_13=delay_13, threads=2)
    for column in (fixes.range, fixes.bearing, fixes.covariance, fixes.curvature):
        owner: object = column
        while isinstance(owner, np.ndarray) and owner.base is not None:
            owner = owner.base
        assert not isinstance(owner, np.ndarray)
    for place in (0, 4095, 4096, 8999):
        one = reactive.locate(row, delay_12=delay_12[place], delay_13=delay_13[place])
        assert np.array_equal(one.covariance, fixes.covariance[place])
        assert one.covariance[0, 1] == one.covariance[1, 0] != 0.0
        assert (one.range, one.curvature) == (fixes.range[place], fixes.curvature[place])
