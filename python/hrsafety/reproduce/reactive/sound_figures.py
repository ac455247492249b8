"""Pictures of the sound part: a burst at three microphones, likeness over lag, scattered fixes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hrsafety import plotting, reactive
from hrsafety.pages import Picture
from hrsafety.reproduce.data import caption
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.reactive.sound_study import BURST, NOISE, ROW

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["make"]

DISTANCE, BEARING = 2.0, math.radians(30.0)
LEAD = 0.005
BAND = (500.0, 8000.0)
SHOWN_RUNS = 200
SOURCES = ((1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (2.0, 30.0), (3.0, 30.0), (2.0, -60.0), (3.0, -60.0))  # m, deg


def make() -> list[Picture]:
    """Draw every picture."""
    return [picture(name, caption, figure) for name, caption, figure in _drawings()]


def _drawings() -> Iterator[tuple[str, str, Figure]]:
    delays = [0.0, *(float(each) for each in ROW.delays(range=DISTANCE, bearing=BEARING))]
    heard = reactive.record_burst(BURST, ROW, range=DISTANCE, bearing=BEARING, noise=0.01, lead=LEAD)
    yield (
        "sound_burst",
        caption("sound_burst"),
        plotting.reactive.sound_burst(
            heard, arrivals=[LEAD + each - min(delays) for each in delays], span=(LEAD - 0.001, LEAD + 0.011)
        ),
    )
    noisy = reactive.record_burst(BURST, ROW, range=DISTANCE, bearing=BEARING, noise=NOISE, lead=-0.02, samples=4096)
    rate = noisy.sample_rate
    yield (
        "sound_likeness",
        caption("sound_likeness", noise=NOISE),
        plotting.reactive.sound_likeness(
            {
                "similarity": reactive.sound.likeness(noisy, ROW, method="mean_square"),
                "cross-correlation": reactive.sound.likeness(noisy, ROW),
                "GCC-PHAT, 0.5 to 8 kHz": reactive.sound.likeness(noisy, ROW, method="phase", band=BAND),
            },
            lags=(delays[1] * rate, delays[2] * rate),
        ),
    )
    distance, bearing = np.array(SOURCES).T
    delay_12, delay_13 = ROW.delays(range=distance, bearing=np.radians(bearing))
    truth = [
        reactive.locate(ROW, delay_12=float(first), delay_13=float(second))
        for first, second in zip(delay_12, delay_13, strict=True)
    ]
    fixes = reactive.sound.jittered_fixes(ROW, range=distance, bearing=np.radians(bearing), runs=SHOWN_RUNS)
    yield (
        "sound_fixes",
        caption("sound_fixes", runs=SHOWN_RUNS),
        plotting.reactive.sound_fixes(fixes, truth, labels=[f"{each:g} m, {angle:g} deg" for each, angle in SOURCES]),
    )
