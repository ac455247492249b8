"""Own pictures of sensing: the floor as the calibrated camera measures it, velocities of a person."""

from __future__ import annotations

import numpy as np

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.reproduce.built import camera_tables
from hrsafety.reproduce.figures import captioned

__all__ = ["make"]

STEP, END = 0.01, 7.0  # s
WORST = nav.sensing.PositionNoise(scale=0.025, distribution="uniform")
DEVIATION = WORST.scale / np.sqrt(3.0)
SPEED, WALKED = 1.0, 3.4  # m/s and m, of the person of configuration 2


def make() -> list[Picture]:
    """Draw errors of the calibrated camera and estimated velocities."""
    noise = camera_tables.NOISES[-1]
    time = np.arange(0.0, END + 0.5 * STEP, STEP)
    walking = time < WALKED / SPEED
    velocity = np.column_stack([np.where(walking, SPEED, 0.0), np.zeros_like(time)])
    path = np.column_stack([0.6 + np.minimum(SPEED * time, WALKED), np.full_like(time, 0.6)])
    estimators: dict[str, nav.sensing.Differences | nav.sensing.Kalman] = {
        "differences": nav.sensing.Differences(),
        "Kalman filter": nav.sensing.Kalman(position_deviation=DEVIATION),
    }
    seen = [
        nav.sensing.observe(nav.sensing.Vision(error=WORST, estimator=each), time, path) for each in estimators.values()
    ]
    return [
        captioned("camera-errors", plotting.robots.calibration_errors(camera_tables.study(noise)), noise=noise),
        captioned(
            "camera-velocities", plotting.robots.velocity_estimates(time, velocity, seen, labels=list(estimators))
        ),
    ]
