"""Measurements at the places of Tables 1 and 2: jitter of arrivals, and full waveforms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from hrsafety import reactive
from hrsafety.reproduce.published import published_tables

__all__ = ["BURST", "LEVELS", "NOISE", "ROW", "SoundPlace", "SoundStudy", "measure", "places"]

Array = npt.NDArray[np.float64]

ROW = reactive.MicrophoneArray()
BURST = reactive.Burst()
RUNS = 100  # of each place, as the source
JITTER_RUNS = 20_000
# The source names neither sound nor noise. Levels are shares of full scale, 0.2 being the burst at 1 m.
NOISE = 0.1
LEVELS = (0.02, 0.05, 0.1, 0.2)
# 4096 samples within the burst, from 20 ms after its beginning.
WINDOW = {"lead": -0.02, "samples": 4096}


@dataclass(frozen=True, kw_only=True)
class SoundPlace:
    """One place of the source and what is printed for it.

    Attributes
    ----------
    distance, angle : float
        In m and deg.
    mean_distance, mean_angle, deviation_distance, deviation_angle : float
        Printed, in m and deg.
    """

    distance: float
    angle: float
    mean_distance: float
    mean_angle: float
    deviation_distance: float
    deviation_angle: float

    @property
    def name(self) -> str:
        """Distance and angle in words."""
        return f"{self.distance:g} m, {self.angle:g} deg"


@dataclass(frozen=True, kw_only=True)
class SoundStudy:
    """Fixes of every place.

    Attributes
    ----------
    jitter : Fixes
        A quarter of a sample of independent jitter on each arrival.
    whole_samples : Fixes
        Full waveforms, delays in whole samples as in (6).
    waveforms : dict of float to Fixes
        Full waveforms by level of noise, delays between samples.
    """

    jitter: reactive.Fixes
    whole_samples: reactive.Fixes
    waveforms: dict[float, reactive.Fixes]


@cache
def places() -> tuple[SoundPlace, ...]:
    """Return the twelve places of both tables."""
    tables = published_tables()
    pairs = zip(tables["avi2019:1"]["rows"], tables["avi2019:2"]["rows"], strict=True)
    return tuple(
        SoundPlace(
            distance=float(mean["distance"]),
            angle=float(mean["angle"]),
            mean_distance=mean["measured_distance"],
            mean_angle=mean["measured_angle"],
            deviation_distance=scatter["std_distance"],
            deviation_angle=scatter["std_angle"],
        )
        for mean, scatter in pairs
    )


@cache
def measure(*, runs: int = RUNS) -> SoundStudy:
    """Measure from every place, by jitter and so many times by full waveforms."""
    distance = np.array([place.distance for place in places()])
    bearing = np.radians([place.angle for place in places()])
    return SoundStudy(
        jitter=reactive.sound.jittered_fixes(ROW, range=distance, bearing=bearing, runs=JITTER_RUNS),
        whole_samples=_heard(distance, bearing, NOISE, runs, between_samples=False),
        waveforms={level: _heard(distance, bearing, level, runs) for level in LEVELS},
    )


def _heard(distance: Array, bearing: Array, noise: float, runs: int, *, between_samples: bool = True) -> reactive.Fixes:
    return reactive.localize_bursts(
        BURST,
        ROW,
        range=distance,
        bearing=bearing,
        runs=runs,
        noise=noise,
        lead=WINDOW["lead"],
        samples=math.floor(WINDOW["samples"]),
        between_samples=between_samples,
    )
