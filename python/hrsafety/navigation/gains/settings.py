"""Settings of a search for gains: what it depends on, checked once."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import (
    Array,
    Parameters,
    checked_seed,
    count,
    flag,
    instance,
    numbers,
    positive,
    sequence,
    word,
)
from hrsafety._bounds import MOST_LOCAL_STARTS, MOST_POINTS, MOST_REFINEMENTS, MOST_SEEDS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.batch import check_scenarios
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.metrics import METRICS, check_metric
from hrsafety.navigation.laws.force_laws import Law, VirtualForceField
from hrsafety.navigation.laws.planners import RapidlyExploringRandomTree
from hrsafety.navigation.laws.python_law import law_with_gains
from hrsafety.navigation.performance import check_weights
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.trajectory import Integrator

__all__ = ["Constraint", "GainConstraint", "Method", "Objective", "Robustness", "SearchSettings"]

Method = Literal["grid", "differential_evolution", "cma_es", "front"]
Robustness = Literal["mean", "lower_bound"]
Judge = Callable[[RunTable], npt.ArrayLike]
Objective = str | Judge
Bounds = Mapping[str, tuple[float, float]] | npt.ArrayLike
Grid = Mapping[str, int] | Sequence[int]

# Grid of Zeng (2011), appendix C.2, for the law that it is about.
SOURCE_GRID = {"attractive_gain": 11, "repulsive_gain": 21, "detour_gain": 21, "gain_ratio": 16}
# About as many points for the other laws.
USUAL_POINTS = math.prod(SOURCE_GRID.values())


@dataclass(frozen=True, kw_only=True, slots=True)
class GainConstraint(Parameters):
    """Bound on a metric that gain sets have to keep.

    Parameters
    ----------
    metric : str
        ``"arrival_time"`` in s, ``"energy"`` in J, ``"path_length"`` or ``"min_clearance"`` in
        m, ``"performance"`` or one of its parts ``"performance_arrival_time"``,
        ``"performance_avoidance"``, ``"performance_energy_saving"``.
    at_least, at_most : float or None
        Bounds; at least one is given.
    scenario : int or None
        Index of the scenario; ``None``: in every one, so the worst counts.

    Raises
    ------
    InvalidParameterError
        If the metric is unknown, no bound is given, a bound is not finite, or they cross.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.gains.GainConstraint(metric="min_clearance", at_least=0.15)
    GainConstraint(metric='min_clearance', at_least=0.15, at_most=None, scenario=None)
    """

    metric: str
    at_least: float | None = None
    at_most: float | None = None
    scenario: int | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        check_metric("metric", self.metric)
        if self.at_least is None and self.at_most is None:
            raise InvalidParameterError("at_least", "be given, or at_most", None)
        for name in ("at_least", "at_most"):
            value = getattr(self, name)
            if value is not None:
                self._as_numbers(name)
                if not math.isfinite(getattr(self, name)):
                    raise InvalidParameterError(name, "be finite or None", value)
        if self.at_least is not None and self.at_most is not None and self.at_least > self.at_most:
            raise InvalidParameterError("at_least", f"not be above at_most = {self.at_most}", self.at_least)
        if self.scenario is not None:
            self._set(scenario=count("scenario", self.scenario, least=0))


Constraint = GainConstraint | Judge


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SearchSettings:
    """Settings of a search for gains: equal settings, equal bits.

    Attributes
    ----------
    scenarios : tuple of Scenario
        Where; their time limits are already shortened.
    law : Law
        Mode and side rules; its gains are not used.
    bounds : ndarray, shape (4, 2)
        Least and largest K_1, K_3, K_5, b.
    grid : tuple of int
        Values of each gain.
    refinements, survivors, local_starts : int
        As for `optimize_gains`.
    method : {"grid", "differential_evolution", "cma_es", "front"}
        How the search goes.
    objectives : tuple
        One objective, or several for a front: names of metrics or callables.
    weights : tuple of float
        Weights of time, distance and energy in H.
    constraints : tuple of GainConstraint or callable
        What has to hold.
    require_arrival : bool
        Whether every scenario has to be arrived in without a contact.
    cap_ratios : bool
        Whether T*/T and L*/L above 1 count as 1.
    seeds : int
        Number of noise seeds; 0: the scenarios with their own seeds.
    seed : int
        Seed that the noise seeds and the random numbers of the search come from.
    robustness : {"mean", "lower_bound"}
        What is maximized over the seeds.
    evaluations : int or None
        Budget of the global methods; ``None`` for grids.
    integrator, step, hold
        As for `simulate`.
    """

    scenarios: tuple[Scenario, ...]
    law: Law
    bounds: Array
    grid: tuple[int, ...]
    refinements: int
    survivors: int
    local_starts: int
    method: Method
    objectives: tuple[Objective, ...]
    weights: tuple[float, float, float]
    constraints: tuple[Constraint, ...]
    require_arrival: bool
    cap_ratios: bool
    seeds: int
    seed: int
    robustness: Robustness
    evaluations: int | None
    integrator: Integrator
    step: float
    hold: bool


def check_law(law: Law | None) -> Law:
    """Return the law; without one the field of the published tables, without stabilizing force."""
    if law is None:
        return VirtualForceField(stabilizing="off")
    return law_with_gains(law)


def limited_scenarios(scenarios: Sequence[Any], time_limit: float | None) -> tuple[Scenario, ...]:
    """Return the scenarios with time limits that are no longer than the given one."""
    from dataclasses import replace

    scenes = checked_places(scenarios)
    if time_limit is None:
        return tuple(scenes)
    limit = positive("time_limit", time_limit)
    return tuple(scene if scene.time_limit <= limit else replace(scene, time_limit=limit) for scene in scenes)


def checked_places(places: Sequence[Any]) -> Sequence[Any]:
    """Return scenarios of point masses, or worlds, each with a robot.

    Parameters
    ----------
    places : sequence of Scenario or of World
        As given.

    Returns
    -------
    sequence
        At least one, all of one kind.
    """
    if not isinstance(places, Sequence) or not places or not isinstance(places[0], World):
        return check_scenarios(places)
    for index, world in enumerate(places):
        if not instance(f"scenarios[{index}]", world, World).robots:
            rule = "hold a robot for the law to drive"
            raise InvalidParameterError(f"scenarios[{index}].robots", rule, Shown("none"))
    return places


def check_bounds(bounds: Bounds | None, law: Law) -> Array:
    """Return least and largest value of each gain, (gains, 2); what is not given is that of the law."""
    names = law.GAIN_NAMES
    if bounds is None or isinstance(bounds, Mapping):
        given = named("bounds", bounds, law.GAIN_BOUNDS, names)
        rows = [numbers(f"bounds[{name!r}]", value, "be a pair of numbers") for name, value in given.items()]
        for name, row in zip(names, rows, strict=True):
            if row.shape != (2,):
                raise ShapeError(f"bounds[{name!r}]", "(2,)", row.shape)
        array = np.stack(rows)
    else:
        array = numbers("bounds", bounds, "be a mapping or an array of numbers")
        if array.shape != (len(names), 2):
            raise ShapeError("bounds", f"({len(names)}, 2)", array.shape)
    for name, (low, high) in zip(names, array.tolist(), strict=True):
        if not 0.0 <= low <= high < math.inf:
            raise InvalidParameterError(f"bounds[{name!r}]", "be finite, not negative and in order", (low, high))
    return array


def _usual_grid(law: Law) -> dict[str, int]:
    """Return the grid of the source, or one of about as many points over the gains that may vary."""
    if isinstance(law, VirtualForceField):
        return SOURCE_GRID
    varying = [name for name in law.GAIN_NAMES if law.GAIN_BOUNDS[name][0] < law.GAIN_BOUNDS[name][1]]
    values = max(2, int(USUAL_POINTS ** (1.0 / len(varying))))
    return {name: values if name in varying else 1 for name in law.GAIN_NAMES}


def check_grid(grid: Grid | None, law: Law) -> tuple[int, ...]:
    """Return the number of values of each gain; what is not given is the usual number."""
    names = law.GAIN_NAMES
    if grid is None or isinstance(grid, Mapping):
        given = list(named("grid", grid, _usual_grid(law), names).values())
    else:
        given = sequence("grid", f"be a mapping or {len(names)} integers", grid)
        if len(given) != len(names):
            raise ShapeError("grid", f"({len(names)},)", (len(given),))
    shape = tuple(count(f"grid[{name!r}]", value, most=MOST_POINTS) for name, value in zip(names, given, strict=True))
    if math.prod(shape) > MOST_POINTS:
        raise InvalidParameterError("grid", f"have at most {MOST_POINTS} points", math.prod(shape))
    return shape


def named(
    argument: str, given: Mapping[str, Any] | None, source: Mapping[str, Any], names: Sequence[str]
) -> dict[str, Any]:
    """Return a value for each gain by name, the missing ones as the source has them."""
    own = {} if given is None else given
    for key in own:
        if key not in names:
            raise InvalidParameterError(argument, f"have keys among {', '.join(names)}", key)
    for name in names:
        if name not in own and name not in source:
            raise InvalidParameterError(argument, f"say something of {name}, which the source does not search", given)
    return {name: own[name] if name in own else source[name] for name in names}


def check_objective(name: str, objective: object) -> Objective:
    """Return an objective: the name of a metric, or a callable."""
    if callable(objective):
        return objective
    if not isinstance(objective, str) or objective not in METRICS:
        shown = ", ".join(f'"{metric}"' for metric in METRICS)
        raise InvalidParameterError(name, f"be callable or one of {shown}", objective)
    return objective


def check_constraints(constraints: Sequence[Constraint], scenarios: int) -> tuple[Constraint, ...]:
    """Return the constraints; their scenarios must exist."""
    entries = sequence("constraints", "be a sequence of GainConstraint or callables", constraints)
    for index, entry in enumerate(entries):
        name = f"constraints[{index}]"
        if not isinstance(entry, GainConstraint) and not callable(entry):
            raise InvalidParameterError(name, "be a GainConstraint or callable", entry)
        if isinstance(entry, GainConstraint) and entry.scenario is not None and entry.scenario >= scenarios:
            raise InvalidParameterError(f"{name}.scenario", f"be below {scenarios}", entry.scenario)
    return tuple(entries)


def check_clearance(
    objectives: Mapping[str, Objective], constraints: Sequence[Constraint], scenarios: Sequence[Scenario]
) -> None:
    """Refuse a clearance where there is nothing to be clear of."""
    free = [index for index, scene in enumerate(scenarios) if isinstance(scene, Scenario) and not scene.obstacles]
    rule = "not be a clearance in a scenario without obstacles"
    for name, objective in objectives.items():
        if objective == "min_clearance" and free:
            raise InvalidParameterError(name, rule, objective)
    for index, entry in enumerate(constraints):
        if not isinstance(entry, GainConstraint) or entry.metric != "min_clearance":
            continue
        if free if entry.scenario is None else entry.scenario in free:
            raise InvalidParameterError(f"constraints[{index}]", rule, entry)


def check_seeds(seeds: int | None, robustness: str, scenarios: Sequence[Scenario], law: Law) -> int:
    """Return the number of noise seeds; 0 for ``None``."""
    word("robustness", robustness, ("mean", "lower_bound"))
    if seeds is None:
        if robustness != "mean":
            raise InvalidParameterError("robustness", 'be "mean" without seeds', robustness)
        return 0
    # A lower bound needs a spread.
    number = count("seeds", seeds, least=2 if robustness == "lower_bound" else 1, most=MOST_SEEDS)
    drawn = any(isinstance(scene, World) or scene.measurement is not None for scene in scenarios)
    if not drawn and not isinstance(law, RapidlyExploringRandomTree):
        raise InvalidParameterError("seeds", "be None where nothing is measured and the law draws nothing", seeds)
    return number


def search_settings(
    scenarios: Sequence[Any],
    law: Law | None,
    *,
    bounds: Bounds | None,
    grid: Grid | None,
    refinements: int,
    survivors: int,
    local_starts: int,
    method: Method,
    objectives: Mapping[str, object],
    weights: Sequence[float],
    constraints: Sequence[Constraint],
    require_arrival: bool,
    cap_ratios: bool,
    seeds: int | None,
    seed: int,
    robustness: Robustness,
    evaluations: int | None,
    integrator: Integrator,
    step: float,
    hold: bool,
    time_limit: float | None,
) -> SearchSettings:
    """Return checked settings; the names in errors are those of the public arguments."""
    scenes = limited_scenarios(scenarios, time_limit)
    wanted = {name: check_objective(name, entry) for name, entry in objectives.items()}
    searched = check_law(law)
    limits = check_constraints(constraints, len(scenes))
    check_clearance(wanted, limits, scenes)
    return SearchSettings(
        scenarios=scenes,
        law=searched,
        bounds=check_bounds(bounds, searched),
        grid=check_grid(grid, searched),
        refinements=count("refinements", refinements, least=0, most=MOST_REFINEMENTS),
        survivors=count("survivors", survivors, most=MOST_POINTS),
        local_starts=count("local_starts", local_starts, least=0, most=MOST_LOCAL_STARTS),
        method=method,
        objectives=tuple(wanted.values()),
        weights=check_weights(weights),
        constraints=limits,
        require_arrival=flag("require_arrival", require_arrival),
        cap_ratios=flag("cap_ratios", cap_ratios),
        seeds=check_seeds(seeds, robustness, scenes, searched),
        seed=checked_seed("seed", seed),
        robustness=robustness,
        evaluations=evaluations,
        integrator=integrator,
        step=positive("step", step),
        hold=flag("hold", hold),
    )
