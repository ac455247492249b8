"""The function of the gains that a search maximizes, built from its settings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.confidence import student_quantile
from hrsafety.navigation.gains.scoring import judged, over_seeds
from hrsafety.navigation.gains.settings import GainConstraint, Judge, SearchSettings
from hrsafety.navigation.gains.worlds import WorldScorer
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.tables.runs import table_of_batch

__all__ = ["Scorer", "gain_problem", "lower_bound_factor", "noise_seeds", "with_gains"]

# Probability with which the mean over all seeds lies above the lower bound.
LOWER_BOUND_LEVEL = 0.95


def noise_seeds(settings: SearchSettings, count: int, *, fresh: bool = False) -> list[int]:
    """Return seeds of the noise: those of the search, or others that the search has not seen."""
    sequence = np.random.SeedSequence([settings.seed, int(fresh)])
    return [int(seed) for seed in sequence.generate_state(count, np.uint64)]


def lower_bound_factor(settings: SearchSettings) -> float | None:
    """Return how many standard errors the lower bound lies below the mean; ``None`` for the mean."""
    if settings.robustness == "mean":
        return None
    return student_quantile(LOWER_BOUND_LEVEL, settings.seeds - 1)


class Scorer:
    """Turns the batches of all seeds into the values and margins of the callables.

    Parameters
    ----------
    objectives, constraints : mapping of str to callable
        Each takes a `RunTable` of n gain sets and returns n numbers; the key names it in
        errors.
    factor : float or None
        As `lower_bound_factor`.
    scenarios : sequence of Scenario
        Where the gain sets are run.
    law : Law
        Whose gains are searched.
    seeds : sequence of int
        Noise seeds, one for each batch; none if there is one batch with the scenarios' own.
    motion_step : float
        Of the runs, in s.
    """

    def __init__(
        self,
        objectives: Mapping[str, Judge],
        constraints: Mapping[str, Judge],
        factor: float | None,
        scenarios: Sequence[Scenario],
        law: Law,
        seeds: Sequence[int],
        motion_step: float,
    ) -> None:
        self.objectives = objectives
        self.constraints = constraints
        self.factor = factor
        self.scenarios = scenarios
        self.law = law
        self.seeds = seeds
        self.motion_step = motion_step

    def __call__(self, tables: Sequence[Mapping[str, Any]]) -> tuple[Array, Array]:
        """Return values (n, objectives) and margins (n, constraints) of the batches of all seeds."""
        seeds: Sequence[int | None] = self.seeds or [None]
        batches = [
            table_of_batch(self.scenarios, self.law, columns, motion_step=self.motion_step, seed=seed)
            for columns, seed in zip(tables, seeds, strict=True)
        ]
        rows = int(batches[0].gain_index[-1]) + 1
        values, margins = np.empty((rows, len(self.objectives))), np.empty((rows, len(self.constraints)))
        for index, (name, objective) in enumerate(self.objectives.items()):
            values[:, index] = over_seeds(judged(name, objective, batches, rows), self.factor)
        for index, (name, constraint) in enumerate(self.constraints.items()):
            margins[:, index] = judged(name, constraint, batches, rows).min(axis=0)
        return values, margins


def gain_problem(
    settings: SearchSettings, *, seeds: Sequence[int] | None = None, lanes: int | None = None
) -> _hrsafety.GainProblem:
    """Return the native problem of the settings.

    Parameters
    ----------
    settings : SearchSettings
        Objectives, constraints, scenarios.
    seeds : sequence of int or None
        Noise seeds instead of those of the settings; the plain mean is taken over them.
    lanes : int or None
        As for `simulate_batch`.
    """
    factor = lower_bound_factor(settings) if seeds is None else None
    if seeds is None:
        seeds = noise_seeds(settings, settings.seeds) if settings.seeds else []
    if isinstance(settings.scenarios[0], World):
        return _of_worlds(settings, WorldScorer(settings, seeds, factor))
    metrics = [entry if isinstance(entry, str) else None for entry in settings.objectives]
    objectives = {
        f"objectives[{index}]": entry for index, entry in enumerate(settings.objectives) if not isinstance(entry, str)
    }
    bounded = [entry for entry in settings.constraints if isinstance(entry, GainConstraint)]
    constraints = {
        f"constraints[{index}]": entry
        for index, entry in enumerate(settings.constraints)
        if not isinstance(entry, GainConstraint)
    }
    if settings.method != "front" and objectives:
        objectives = {"objective": next(iter(objectives.values()))}
    called = Scorer(objectives, constraints, factor, settings.scenarios, settings.law, seeds, settings.step)
    return _hrsafety.GainProblem(
        scenarios=[scenario._native for scenario in settings.scenarios],
        law=settings.law._native,
        weights=settings.weights,
        integrator=settings.integrator,
        step=settings.step,
        hold=settings.hold,
        seeds=list(seeds),
        lower_bound_factor=factor,
        objectives=metrics,
        constraints=[(entry.metric, entry.at_least, entry.at_most, entry.scenario) for entry in bounded],
        require_arrival=settings.require_arrival,
        cap_ratios=settings.cap_ratios,
        scorer=called if objectives or constraints else None,
        scorer_constraints=len(constraints),
        whole=False,
        lanes=lanes,
    )


def _of_worlds(settings: SearchSettings, scorer: WorldScorer) -> _hrsafety.GainProblem:
    """Return the native problem of settings whose runs are made and scored by a function."""
    return _hrsafety.GainProblem(
        scenarios=[],
        law=settings.law._native,
        weights=settings.weights,
        integrator=settings.integrator,
        step=settings.step,
        hold=settings.hold,
        seeds=[],
        lower_bound_factor=None,
        objectives=[None] * len(settings.objectives),
        constraints=[],
        require_arrival=False,
        cap_ratios=settings.cap_ratios,
        scorer=scorer,
        scorer_constraints=scorer.constraints,
        whole=True,
        lanes=None,
    )


def with_gains(law: Law, gains: Array) -> Law:
    """Return the law with other gains, given in the order of ``GAIN_NAMES``."""
    fields: dict[str, Any] = dict(zip(law.GAIN_NAMES, gains.tolist(), strict=True))
    return law.replaced(**fields)
