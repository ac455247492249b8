"""Gain sets between several objectives."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import sequence
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.gains.metrics import is_maximized
from hrsafety.navigation.gains.results import ParetoFront
from hrsafety.navigation.gains.search import Progress, found_of
from hrsafety.navigation.gains.settings import (
    Bounds,
    Constraint,
    Grid,
    Objective,
    Robustness,
    SearchSettings,
    search_settings,
)
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Integrator

__all__ = ["pareto_front"]


def pareto_front(
    scenarios: Sequence[Scenario],
    law: Law | None = None,
    *,
    objectives: Sequence[Objective] = ("arrival_time", "min_clearance", "energy"),
    bounds: Bounds | None = None,
    grid: Grid | None = None,
    refinements: int = 1,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    constraints: Sequence[Constraint] = (),
    require_arrival: bool = True,
    cap_ratios: bool = True,
    seeds: int | None = None,
    seed: int = 0,
    robustness: Robustness = "mean",
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    time_limit: float | None = None,
    checkpoint: str | PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> ParetoFront:
    """Return the gain sets that no other one beats in every objective.

    Every point of a grid is run; then the neighbors of what is left, at half the distance, and
    so on.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Where.
    law : Law or None
        As for `optimize_gains`.
    objectives : sequence of str or callable
        At least two, as the objective of `optimize_gains`; each metric counts in its own good
        direction, a callable is maximized.
    bounds, grid
        As for `optimize_gains`.
    refinements : int
        Number of rounds after the grid, each at half the distance of neighbors.
    weights, constraints, seeds, seed, robustness, integrator, step, hold, time_limit
        As for `optimize_gains`; sets that miss a constraint are not on the front.
    require_arrival, cap_ratios
        As for `optimize_gains`; unless it is switched off, sets that touch an obstacle or do not
        arrive everywhere are not on the front.
    checkpoint, threads
        As for `optimize_gains`.
    progress : callable or None
        Called with (stage, done, total, best value); the stages are
        ``"front 1"``, ``"front 2"``, ...; the best value stays ``-inf``, as there is not one.

    Returns
    -------
    ParetoFront
        Gain sets and what they reach. After Ctrl-C what was found so far, with ``interrupted``
        set.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, a callable does not return n numbers, or the checkpoint
        is of other settings.
    ShapeError
        If bounds or grid has the wrong shape.
    SimulationError
        If the state of a run became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> front = nav.gains.pareto_front(
    ...     [scenarios.configuration("c2")], objectives=("arrival_time", "min_clearance"), grid=(4, 4, 4, 4)
    ... )
    >>> bool((front.values[:, 1] >= front.values[0, 1]).all())  # slower, but farther away
    True
    """
    entries = sequence("objectives", "be a sequence of names or callables", objectives)
    if len(entries) < 2:
        raise InvalidParameterError("objectives", "hold at least two objectives", entries)
    settings = search_settings(
        scenarios,
        law,
        bounds=bounds,
        grid=grid,
        refinements=refinements,
        survivors=1,
        local_starts=0,
        method="front",
        objectives={f"objectives[{index}]": entry for index, entry in enumerate(entries)},
        weights=weights,
        constraints=constraints,
        require_arrival=require_arrival,
        cap_ratios=cap_ratios,
        seeds=seeds,
        seed=seed,
        robustness=robustness,
        evaluations=None,
        integrator=integrator,
        step=step,
        hold=hold,
        time_limit=time_limit,
    )
    return _result(settings, found_of(settings, checkpoint, threads, progress))


def _result(settings: SearchSettings, found: dict[str, Any]) -> ParetoFront:
    """Return the points of a front, best in the first objective first."""
    names = tuple(
        entry if isinstance(entry, str) else getattr(entry, "__name__", type(entry).__name__)
        for entry in settings.objectives
    )
    maximized = tuple(not isinstance(entry, str) or is_maximized(entry) for entry in settings.objectives)
    points, raised = found["points"], found["values"]
    order = np.lexsort((*raised.T[1:], -raised[:, 0]))
    raised, signs = raised[order], np.where(maximized, 1.0, -1.0)
    worst = raised.min(axis=0) if len(raised) else np.full(len(names), np.nan)
    return ParetoFront(
        objectives=names,
        maximized=maximized,
        gains=points[order],
        values=raised * signs,
        reference=worst * signs,
        hypervolume=_volume(raised),
        evaluations=found["evaluations"],
        episodes=found["evaluations"] * len(settings.scenarios) * max(settings.seeds, 1),
        failures=found["failures"],
        interrupted=found["interrupted"],
        settings=settings,
    )


def _volume(values: np.ndarray) -> float:
    """Return the share of the box around a front that lies below it; 0 where the box has no volume."""
    if not len(values):
        return 0.0
    low, high = values.min(axis=0), values.max(axis=0)
    if not (high > low).all():
        return 0.0
    shares = (values - low) / (high - low)
    return _hrsafety.front_hypervolume(shares.ravel().tolist(), values.shape[1], [0.0] * values.shape[1])
