"""Rows of the experiments beside noisy runs, and the times of section 7.5.5."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hrsafety import navigation as nav
from hrsafety.reproduce.built.runs import SEEDS, experiment, score
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.sheets import Sheet

__all__ = ["experiment_cell", "multiple_obstacles"]

SHEET = Sheet("built")
# Section 7.5.5: obstacle, when the robot comes into its active region and when it leaves it, in s.
_ENCOUNTERS = {"person": (0, 0.9, 5.7), "disc": (1, 3.0, 5.3), "robot": (2, 3.1, 9.0)}


def experiment_cell(table: str, row: str, column: str, *, printed: float, unit: str) -> PrintedValue:
    """Return a cell of an experiment beside the noisy runs, without verdict."""
    found = experiment(table)
    words = {"number": table, "row": row, "column": column, "unit": unit}
    more = SHEET.text(f"more_{column[0]}") if column[0] in "LH" else ""
    counts = {"arrived": found.success.count, "runs": SEEDS}
    return SHEET.listed("experiment", found.values[column], printed=printed, more=more, **counts, **words)


def multiple_obstacles() -> Iterator[PrintedValue]:
    """Yield what section 7.5.5 says about a person, a disc and a robot at once."""
    run = score("multiple_obstacles").trajectory
    least = ", ".join(f"{word} {run.min_distance[index]:.2f} m" for word, (index, _, _) in _ENCOUNTERS.items())
    holds = run.outcome == "arrived" and _outside_critical(run)
    yield SHEET.claim("outcome", holds=holds, outcome=run.outcome, least=least)
    yield SHEET.listed("time", run.arrival_time, printed=15.0, column="T_arrive")
    for word, (index, enters, leaves) in _ENCOUNTERS.items():
        first, last = _inside(run, index)
        yield SHEET.listed("time", first, printed=enters, column=f"meets {word}")
        yield SHEET.listed("time", last, printed=leaves, column=f"leaves {word}")


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
