"""Gain sets in worlds of people who react: runs that are made and scored here, for the same searches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.navigation.crowd.simulation import driven
from hrsafety.navigation.crowd.study import WorldStudy
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.metrics import is_maximized, metric_values
from hrsafety.navigation.gains.scoring import judged, over_seeds
from hrsafety.navigation.gains.settings import GainConstraint, Judge, SearchSettings
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning, gathered

__all__ = ["WorldScorer", "doubts_of", "runs_of_sets"]


def doubts_of(places: Sequence[Any], law: Law, *step: float) -> tuple[ResultWarning, ...]:
    """Return the doubts about scenarios or worlds whose robots are under a law, the first of each kind.

    Parameters
    ----------
    places : sequence of Scenario or of World
        All of one kind.
    law : Law
        Law of every robot.
    *step : float
        Motion step of runs in scenarios in s.

    Returns
    -------
    tuple of ResultWarning
        Each names its place.
    """
    if not isinstance(places[0], World):
        return run_warnings.of_scenes(places, [law], *step)
    named = ((f"scenarios[{index}]", driven(world, law).warnings) for index, world in enumerate(places))
    return gathered(named, "scenarios")


def runs_of_sets(
    worlds: Sequence[World],
    law: Law,
    points: Array,
    weights: tuple[float, float, float],
    *,
    seed: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> RunTable:
    """Return the runs of gain sets in worlds, a row for each robot, the worlds fastest, then robots.

    Parameters
    ----------
    worlds : sequence of World
        The worlds.
    law : Law
        Whose gains are replaced.
    points : ndarray, shape (n, gains)
        The gain sets.
    weights : tuple of float
        Weights of H.
    seed : int or None
        Of all worlds; their own when ``None``.
    threads, progress
        As for `simulate_many`.

    Returns
    -------
    RunTable
        With H and its parts.
    """
    named = {str(index): world for index, world in enumerate(worlds)}
    study = WorldStudy(named, {"law": law}, [points], None if seed is None else [seed], False, weights)
    found = study.run(threads, progress)
    order = np.lexsort((found.robot, found.scenario_index, found.gain_index))
    return replace(found, **found._kept(order))


class WorldScorer:
    """Values and margins of gain sets in worlds.

    Parameters
    ----------
    settings : SearchSettings
        Worlds, law, objectives and constraints.
    seeds : sequence of int
        Seeds of the worlds; their own where there are none.
    factor : float or None
        How many standard errors the lower bound over the seeds lies below the mean; ``None`` for the mean.
    """

    def __init__(self, settings: SearchSettings, seeds: Sequence[int], factor: float | None) -> None:
        self.settings, self.factor = settings, factor
        self.worlds: Sequence[Any] = settings.scenarios
        self.seeds: list[int | None] = [*seeds] or [None]

    @property
    def constraints(self) -> int:
        """Number of constraints, that of arrivals included."""
        return len(self.settings.constraints) + int(self.settings.require_arrival)

    def table(self, points: Array, seed: int | None) -> RunTable:
        """Return the runs of gain sets in all worlds with a seed, the worlds fastest, then robots.

        Parameters
        ----------
        points : ndarray, shape (n, gains)
            The gain sets.
        seed : int or None
            Of all worlds; their own when ``None``.

        Returns
        -------
        RunTable
            A row for each robot.
        """
        return runs_of_sets(self.worlds, self.settings.law, points, self.settings.weights, seed=seed)

    def __call__(self, points: Array) -> tuple[Array, Array, list[int]]:
        """Return values (n, objectives), margins (n, constraints) and failed runs (n,) of gain sets."""
        count = len(points)
        batches = [self.table(np.ascontiguousarray(points), seed) for seed in self.seeds]
        failed = np.stack([_by_set(each.outcome != "arrived", count) for each in batches]).sum(axis=(0, 2))
        wanted, several = self.settings.objectives, self.settings.method == "front"
        values = np.empty((count, len(wanted)))
        for index, each in enumerate(wanted):
            name = f"objectives[{index}]" if several else "objective"
            values[:, index] = over_seeds(self._of_seeds(name, each, batches, count), self.factor)
        margins = np.empty((count, self.constraints))
        for index, limit in enumerate(self.settings.constraints):
            margins[:, index] = self._margin(f"constraints[{index}]", limit, batches, count)
        if self.settings.require_arrival:
            margins[:, -1] = np.where(failed > 0, -failed, 1)
        return values, margins, failed.tolist()

    def _of_seeds(self, name: str, objective: object, batches: Sequence[RunTable], count: int) -> Array:
        """Return an objective as maximized, (seeds, n)."""
        if callable(objective):
            return judged(name, objective, batches, count)
        metric = str(objective)
        found = np.stack([_by_set(self._metric(each, metric), count) for each in batches])
        lost = np.stack([_by_set(each.outcome != "arrived", count) for each in batches])
        # A run that failed has H = 0, and no fair value of anything else.
        signed = found if is_maximized(metric) else -found
        worst = 0.0 if metric == "performance" else -np.inf
        signed = np.where(lost | np.isnan(signed), worst, signed)
        values: Array = signed.min(axis=2) if metric == "min_clearance" else signed.mean(axis=2)
        return values

    def _metric(self, table: RunTable, metric: str) -> Array:
        """Return a metric of every run; ratios above 1 count as 1 where they are capped."""
        if not self.settings.cap_ratios or not metric.startswith("performance"):
            return metric_values(table, metric)
        parts = [
            np.minimum(table.performance_arrival_time, 1.0),
            table.performance_avoidance,
            np.minimum(table.performance_energy_saving, 1.0),
        ]
        if metric == "performance":
            capped: Array = np.asarray(self.settings.weights) @ np.stack(parts)
            total: Array = np.where(table.performance_total > 0.0, capped, 0.0)
            return total
        part: Array = parts[("arrival_time", "avoidance", "energy_saving").index(metric.removeprefix("performance_"))]
        return part

    def _margin(self, name: str, limit: GainConstraint | Judge, batches: Sequence[RunTable], count: int) -> Array:
        """Return the margin of a constraint, the least over seeds and worlds; NaN where a run has no value."""
        if not isinstance(limit, GainConstraint):
            worst: Array = judged(name, limit, batches, count).min(axis=0)
            return worst
        found = np.stack([_by_set(self._metric(each, limit.metric), count) for each in batches])
        if limit.scenario is not None:
            found = found[:, :, batches[0].scenario_index[: found.shape[2]] == limit.scenario]
        low = np.inf if limit.at_least is None else found - limit.at_least
        high = np.inf if limit.at_most is None else limit.at_most - found
        least: Array = np.minimum(low, high).min(axis=(0, 2))
        return least


def _by_set(values: npt.NDArray[np.generic], count: int) -> npt.NDArray[np.generic]:
    """Return rows of a table by gain set, (n, rows of each)."""
    return values.reshape(count, -1)
