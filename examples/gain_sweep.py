"""Sweep two gains over three configurations and print the best sets.

Run it with ``python examples/gain_sweep.py [FOLDER]``. With a folder, chunks are written there
as they finish, and a second call resumes where the first one stopped.
"""

from __future__ import annotations

import sys

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios, sweep

NAMES = ("c1", "c2", "c3")
BEST = 5


def main(folder: str | None = None) -> None:
    """Score 16 x 16 gain sets; the score of a set is its mean H."""
    design = sweep.Grid(
        [
            sweep.Axis(name="attractive_gain", low=1.0, high=8.5, points=16),
            sweep.Axis(name="detour_gain", low=10.0, high=310.0, points=16),
        ]
    )
    study = sweep.NavigationStudy(
        scenarios={name: scenarios.configuration(name) for name in NAMES},
        law=nav.VirtualForceField(repulsive_gain=20.0, gain_ratio=0.68),
    )
    result = sweep.run(design, study, out=folder)

    # A grid comes back in its own shape: attractive gain, detour gain, scenario.
    score = result["performance_total"].reshape(result.shape())
    mean = score.mean(axis=2)
    arrived = int((result["outcome"] == "arrived").sum())
    print(f"{len(result)} runs, {arrived} arrived without a contact")
    print("  K_1    K_5   mean    " + "    ".join(f"{name:>2}" for name in NAMES))
    print("  N/m  N/m^2      H    " + "    ".join(" H" for _ in NAMES))
    attractive, detour = (axis.levels() for axis in result.axes)
    for place in np.argsort(-mean, axis=None, kind="stable")[:BEST]:
        row, column = np.unravel_index(place, mean.shape)
        parts = "  ".join(f"{value:.3f}" for value in score[row, column])
        print(f"{attractive[row]:5.1f} {detour[column]:6.1f}  {mean[row, column]:5.3f}  {parts}")


if __name__ == "__main__":
    main(*sys.argv[1:2])
