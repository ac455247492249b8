"""The search for gains, Zeng (2011), appendix C.2, and searches of other kinds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from dataclasses import replace
from os import PathLike
from typing import Any, Literal

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, count, word
from hrsafety._bounds import MOST_EVALUATIONS
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.batch import check_threads, simulate_batch
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.checkpoint import Checkpoint
from hrsafety.navigation.gains.confidence import Confidence, confidence_of
from hrsafety.navigation.gains.problem import gain_problem, noise_seeds, with_gains
from hrsafety.navigation.gains.results import GainSearch, SearchStage
from hrsafety.navigation.gains.settings import (
    Bounds,
    Constraint,
    Grid,
    Method,
    Objective,
    Robustness,
    SearchSettings,
    search_settings,
)
from hrsafety.navigation.gains.worlds import WorldScorer
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Integrator
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling

__all__ = ["found_of", "optimize_gains"]

# Fresh seeds that the best set of a search over seeds is judged by, at least.
FRESH_SEEDS = 100
# A global search shares its budget among populations of its own, so that all cores and lanes have
# work; a population with fewer evaluations would not get far.
ISLANDS, EVALUATIONS_OF_AN_ISLAND = 32, 500
METHODS = ("grid", "auto", "differential_evolution", "cma_es")
# Gain sets for each free gain of a search that is told nothing else: in the scenes of the source 6,000 instead of
# these 10,000 are enough for the optimum of the grids with each of ten seeds.
EVALUATIONS_OF_A_GAIN = 2500

Progress = Callable[[str, int, int, float], object]


@telling(of_scenarios)
def optimize_gains(
    scenarios: Sequence[Scenario] | Sequence[World],
    law: Law | None = None,
    *,
    bounds: Bounds | None = None,
    grid: Grid | None = None,
    refinements: int = 3,
    survivors: int = 500,
    local_starts: int = 20,
    method: Method | Literal["auto"] = "grid",
    objective: Objective = "performance",
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    constraints: Sequence[Constraint] = (),
    require_arrival: bool = True,
    cap_ratios: bool = True,
    seeds: int | None = None,
    seed: int = 0,
    robustness: Robustness = "mean",
    evaluations: int | None = None,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    time_limit: float | None = None,
    checkpoint: str | PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> GainSearch:
    """Search for the best gains of a law in given scenarios.

    The defaults are the procedure of Zeng (2011), appendix C.2: a grid of 11 x 21 x 21 x 16
    gain sets over K_1 in [0, 50] N/m, K_3 in [0, 200] N/m, K_5 in [0, 500] N/m^2 and b in
    [0, 3] s; three more grids, each over the box around the 500 best points of the one before;
    local searches from the 20 best points of all.

    Parameters
    ----------
    scenarios : sequence of Scenario or of World
        Where; the objective is the mean over them. In worlds the law drives every robot; they have a step of their own,
        and take no ``integrator``, ``step`` and ``hold``.
    law : Law or None
        Mode of the stabilizing force and side rules; its gains are not used. ``None``: without
        stabilizing force, as the published tables were made.
    bounds : mapping, array_like of shape (4, 2), or None
        Least and largest value of each gain, by name or in the order of
        ``GAIN_NAMES`` of the law; equal ones hold a gain. What is not named is that of
        the source.
    grid : mapping, sequence of int, or None
        Number of values of each gain, by name or in order.
    refinements : int
        Number of grids after the first.
    survivors : int
        Best points of a grid that the next grid is drawn around.
    local_starts : int
        Number of local searches; 0 for none.
    method : {"grid", "auto", "differential_evolution", "cma_es"}
        Grids and local searches as in the source, or a global search with random numbers. ``"auto"`` is
        ``"cma_es"`` with 2500 gain sets for each free gain unless ``evaluations`` says otherwise: for the
        scenes of the source as good as the grids, with a thirtieth of the gain sets.
    objective : str or callable
        What is maximized: ``"performance"`` (H) or a part of it,
        ``"performance_arrival_time"``, ``"performance_avoidance"``,
        ``"performance_energy_saving"``; or what is maximized with its sign changed,
        ``"arrival_time"``, ``"energy"``, ``"path_length"``; the mean over the scenarios. For
        ``"min_clearance"`` it is the least over them. A callable takes the `RunTable` of n
        gain sets in all scenarios and returns n values; its runs end at the first contact.
    weights : sequence of float
        Weights of time, distance and energy in H.
    constraints : sequence of GainConstraint or callable
        What has to hold; a callable takes the `RunTable` of n gain sets and returns n
        margins, negative where it does not hold. A gain set that misses constraints by less
        is better than one that misses them by more, whatever the objective. One that is missed
        by no more than 1e-6 of its unit counts as kept.
    require_arrival : bool
        Whether every scenario has to be arrived in without a contact, with every seed: one more
        constraint, which each run that fails misses by 1. Without it a gain set may fail where
        that costs the objective less than it gains elsewhere.
    cap_ratios : bool
        Whether T*/T and L*/L above 1 count as 1 in H and its parts, as objectives and in
        constraints: gains with which the robot dawdles even without obstacles are not paid for it.
        H as printed everywhere else has no such cap; a callable sees that.
    seeds : int or None
        Number of seeds, of the noise and of a law that draws, that every scenario is run with;
        a callable is called for each seed, a constraint must hold for all. ``None``: the
        scenarios' own seeds.
    seed : int
        Seed that the noise seeds and the random numbers of a global search come from.
    robustness : {"mean", "lower_bound"}
        Whether the mean over the seeds is maximized, or its lower 95 % confidence bound by
        Student's t distribution.
    evaluations : int or None
        Gain sets that a global method may evaluate; ``None``: as many as the grids have, or what
        ``"auto"`` takes.
    integrator, step, hold
        As for `simulate`.
    time_limit : float or None
        Longest simulated time in s where a scenario's own is longer.
    checkpoint : path or None
        File that the state is written to every few seconds, at Ctrl-C and at the end. If it
        exists the search resumes from there, bit for bit as if it had not been interrupted.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit of the result.
    progress : callable or None
        Called with (stage, done, total, best value) up to twenty times a second; the stages
        are ``"grid 1"``, ``"grid 2"``, ..., ``"local"``, or ``"global"``; the value is
        ``-inf`` until a gain set keeps the constraints.

    Returns
    -------
    GainSearch
        Best law, its value, and how it was found. After Ctrl-C the best so far, with
        ``interrupted`` set. If no gain set keeps the constraints, ``status`` says so, and asking
        for ``best`` raises an `InfeasibleError` with what would mend it.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, a callable does not return n numbers, or the checkpoint
        is of other settings.
    ShapeError
        If bounds or grid has the wrong shape.
    SimulationError
        If the state of a run became non-finite.
    KeyboardInterrupt
        If Ctrl-C came before anything was evaluated.

    Notes
    -----
    A gain set that touches an obstacle or does not arrive has H = 0 in that scenario, as in
    the source, and is worst of all with the other metrics; ``failures`` counts them. In the mean
    that alone would not keep it away: with an attraction near zero, T*/T and L*/L of one
    scenario can exceed 1 by more than two others lose. Hence ``require_arrival`` and
    ``cap_ratios``, which change nothing in the published procedure.

    The local searches are those of COBYLA (Powell 1994): linear models on a simplex, for bounds
    and constraints without derivatives.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> search = nav.optimize_gains(
    ...     [scenarios.configuration("c1")], grid=(4, 4, 4, 4), refinements=1, survivors=10, local_starts=2
    ... )
    >>> search.feasible, [stage.name for stage in search.history], search.history[0].evaluations
    (True, ['grid 1', 'grid 2', 'local 1', 'local 2'], 256)
    """
    word("method", method, METHODS)
    settings = search_settings(
        scenarios,
        law,
        bounds=bounds,
        grid=grid,
        refinements=refinements,
        survivors=survivors,
        local_starts=local_starts,
        method="cma_es" if method == "auto" else method,
        objectives={"objective": objective},
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
    if method == "auto" and evaluations is None:
        low, high = settings.bounds.T
        evaluations = EVALUATIONS_OF_A_GAIN * max(1, int(np.count_nonzero(low < high)))
    settings = replace(settings, evaluations=_budget(settings, evaluations))
    return _result(settings, found_of(settings, checkpoint, threads, progress), threads)


def _budget(settings: SearchSettings, evaluations: int | None) -> int | None:
    """Return the number of gain sets of a global search; ``None`` for grids."""
    if settings.method == "grid":
        if evaluations is not None:
            raise InvalidParameterError("evaluations", 'be None with method="grid"', evaluations)
        return None
    if evaluations is None:
        return int(np.prod(settings.grid)) * (settings.refinements + 1)
    return count("evaluations", evaluations, most=MOST_EVALUATIONS)


def found_of(
    settings: SearchSettings, checkpoint: str | PathLike[str] | None, threads: int | None, progress: Progress | None
) -> dict[str, Any]:
    """Return what the core finds by the method of the settings, resumed from a checkpoint if there is one."""
    check_threads(threads)
    callback("progress", progress)
    file = None if checkpoint is None else Checkpoint(checkpoint, settings)
    with nullcontext() if file is None else file.alone():
        lower, upper = settings.bounds.T.tolist()
        problem = gain_problem(settings)
        grid: dict[str, Any] = {"shape": list(settings.grid), "refinements": settings.refinements}
        work: dict[str, Any] = {
            "threads": threads,
            "state": None if file is None else file.load(),
            "save": None if file is None else file.save,
            "progress": progress,
        }
        if settings.method == "front":
            return dict(_hrsafety.gain_front(problem, lower, upper, **grid, **work))
        if settings.evaluations is None:
            starts, survivors = settings.local_starts, settings.survivors
            more: dict[str, Any] = {"survivors": survivors, "keep": max(survivors, starts), "local_starts": starts}
            return dict(_hrsafety.search_gains(problem, lower, upper, **grid, **more, **work))
        islands = max(1, min(ISLANDS, settings.evaluations // EVALUATIONS_OF_AN_ISLAND))
        more = {"method": settings.method, "evaluations": settings.evaluations, "islands": islands}
        return dict(_hrsafety.search_gains_globally(problem, lower, upper, **more, seed=settings.seed, **work))


def _result(settings: SearchSettings, found: dict[str, Any], threads: int | None) -> GainSearch:
    best = found["best"]
    history = tuple(_stages(found))
    law = with_gains(settings.law, best["gains"])
    top, top_values = _top(found)
    valid = best["violation"] == 0.0 and best["value"] > -np.inf
    return GainSearch(
        nearest=law,
        best_value=best["value"],
        best_performance=_performance(settings, law, threads),
        violation=best["violation"],
        feasible=best["violation"] == 0.0 and not best["failed"],
        evaluations=found["evaluations"],
        episodes=found["evaluations"] * len(settings.scenarios) * max(settings.seeds, 1),
        failures=found["failures"],
        history=history,
        convergence=_convergence(found, history),
        top=top,
        top_values=top_values,
        confidence=None if found["interrupted"] or not valid else _confidence(settings, best["gains"], threads),
        interrupted=found["interrupted"],
        settings=settings,
    )


def _top(found: dict[str, Any]) -> tuple[Array, Array]:
    """Return the best points before local searches that keep the constraints, and their values."""
    best = found["best"]
    if "top" not in found:
        kept = np.array([best["violation"] == 0.0])
        return best["gains"][None, :][kept], np.array([best["value"]])[kept]
    kept = found["top_violation"] == 0.0
    return found["top"][kept], found["top_values"][kept]


def _stages(found: dict[str, Any]) -> Iterator[SearchStage]:
    """Yield grids and local searches."""
    for index, each in enumerate(found.get("rounds", ()), start=1):
        yield SearchStage(name=f"grid {index}", status="complete", **{**each, "axes": tuple(each["axes"])})
    for index, each in enumerate(found.get("local", ()), start=1):
        named = {"gains": "best_gains", "value": "best_value"}
        yield SearchStage(name=f"local {index}", **{named.get(name, name): value for name, value in each.items()})


def _convergence(found: dict[str, Any], history: Sequence[SearchStage]) -> Array:
    """Return evaluations and best value: after each grid and local search, or where a global one became better."""
    if "history" in found:
        best = found["best"]
        end = [[found["evaluations"], best["value"] if best["violation"] == 0.0 else -np.inf]]
        return np.vstack([found["history"], end])
    if not history:
        return np.empty((0, 2))
    counts = np.cumsum([each.evaluations for each in history], dtype=np.float64)
    feasible = [each.best_value if each.violation == 0.0 else -np.inf for each in history]
    return np.column_stack([counts, np.maximum.accumulate(feasible)])


def _performance(settings: SearchSettings, law: Law, threads: int | None) -> Array:
    """Return H in each scenario, the mean over the seeds of the search."""
    seeds = noise_seeds(settings, settings.seeds) if settings.seeds else [None]
    if isinstance(settings.scenarios[0], World):
        own = np.array(law.gains)[None, :]
        scorer = WorldScorer(settings, [], None)
        runs = [scorer.table(own, each) for each in seeds]
        scores = np.stack([each.performance_total for each in runs]).mean(axis=0)
        where = runs[0].scenario_index
        return np.array([scores[where == index].mean() for index in range(len(settings.scenarios))])
    scenes = [scene if seed is None else replace(scene, seed=seed) for seed in seeds for scene in settings.scenarios]
    table = simulate_batch(
        scenes,
        law,
        weights=settings.weights,
        integrator=settings.integrator,
        step=settings.step,
        hold=settings.hold,
        stop_on_contact=True,
        threads=threads,
    )
    mean: Array = table.performance_total.reshape(len(seeds), -1).mean(axis=0)
    return mean


def _confidence(settings: SearchSettings, gains: Array, threads: int | None) -> Confidence | None:
    """Return what fresh seeds say about a gain set; ``None`` without seeds."""
    if not settings.seeds:
        return None
    point = np.ascontiguousarray(gains[None, :])
    fresh = noise_seeds(settings, max(FRESH_SEEDS, settings.seeds), fresh=True)
    values = [
        float(gain_problem(settings, seeds=[seed]).evaluate(point, threads=threads)["values"][0, 0]) for seed in fresh
    ]
    return confidence_of(np.array(values))
