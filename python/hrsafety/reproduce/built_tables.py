"""Rows of the experiments beside noisy runs, and the times of section 7.5.5."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hrsafety import navigation as nav
from hrsafety.reproduce.built_runs import SEEDS, experiment, score
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.impact_cells import claim, listed

__all__ = ["MULTIPLE", "experiment_cell", "multiple_obstacles"]

MULTIPLE = "Section 7.5.5"
"""Table of the cells of the scene with three obstacles."""
_NOISY = (
    "The experiment happened once; beside it stands the median of {arrived} of {runs} simulations that arrived "
    "without a contact, with wheel controllers, encoders and a camera with a mean error of 4 mm. {more}"
)
_MORE = {
    "L": "Slip, cables, and friction that varies, are not modeled; the winding resistance is a calibration.",
    "H": "H of these medians.",
}
# Section 7.5.5: obstacle, when the robot comes into its active region and when it leaves it, in s.
_ENCOUNTERS = {"person": (0, 0.9, 5.7), "disc": (1, 3.0, 5.3), "robot": (2, 3.1, 9.0)}
_EARLIER = (
    "Neither start nor goal are printed, nor where the robot looks at first; with those that fit the first encounter "
    "the robot here turns sooner and passes the obstacles on a shorter way."
)


def experiment_cell(table: str, row: str, column: str, *, printed: float, unit: str) -> Cell:
    """Return a cell of an experiment beside the noisy runs."""
    found = experiment(table)
    reason = _NOISY.format(arrived=found.success.count, runs=SEEDS, more=_MORE.get(column[0], "")).strip()
    return listed(table, row, column, printed=printed, measured=found.values[column], unit=unit, reason=reason)


def multiple_obstacles() -> Iterator[Cell]:
    """Yield what section 7.5.5 says about a person, a disc and a robot at once."""
    run = score("multiple_obstacles").trajectory
    least = ", ".join(f"{word} {run.min_distance[index]:.2f} m" for word, (index, _, _) in _ENCOUNTERS.items())
    yield claim(
        MULTIPLE,
        "nonholonomic",
        "outcome",
        printed="avoids all three, stays outside every critical region, reaches the goal",
        measured=f"{run.outcome}; least d: {least}",
        holds=run.outcome == "arrived" and _outside_critical(run),
    )
    place = {"table": MULTIPLE, "row": "nonholonomic"}
    arrival = run.arrival_time
    yield listed(**place, column="T_arrive", printed=15.0, measured=arrival, unit="s", reason=_EARLIER)
    for word, (index, enters, leaves) in _ENCOUNTERS.items():
        first, last = _inside(run, index)
        yield listed(**place, column=f"meets {word}", printed=enters, measured=first, unit="s", reason=_EARLIER)
        yield listed(**place, column=f"leaves {word}", printed=leaves, measured=last, unit="s", reason=_EARLIER)


def _outside_critical(run: nav.Trajectory) -> bool:
    pairs = zip(run.min_distance.tolist(), run.scenario.obstacles, strict=True)
    return all(least > getattr(obstacle, "critical_radius", np.inf) for least, obstacle in pairs)


def _inside(run: nav.Trajectory, index: int) -> tuple[float | str, float | str]:
    """Return when the robot enters the active region of an obstacle and when it leaves it for good."""
    active = getattr(run.scenario.obstacles[index], "active_radius", 0.0)
    inside = np.flatnonzero(run.distance[:, index] < active)
    if not len(inside):
        return "never", "never"
    return float(run.time[inside[0]]), float(run.time[inside[-1]])
