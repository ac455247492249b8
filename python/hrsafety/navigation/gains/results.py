"""Results of searches for gains."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, positive
from hrsafety._bounds import MOST_POINTS_OF_AXIS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InfeasibleError, InvalidParameterError
from hrsafety.navigation.batch import check_threads
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.confidence import Confidence
from hrsafety.navigation.gains.metrics import METRIC_UNITS
from hrsafety.navigation.gains.problem import gain_problem, with_gains
from hrsafety.navigation.gains.settings import SearchSettings
from hrsafety.navigation.gains.worlds import doubts_of
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["Confidence", "Flatness", "GainSearch", "ParetoFront", "SearchStage", "gain_columns"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SearchStage:
    """One grid or one local search, Zeng (2011), appendix C.2, steps 2 to 5 and step 8.

    Attributes
    ----------
    name : str
        ``"grid 1"``, ``"grid 2"``, ..., ``"local 1"``, ...
    best_gains : ndarray, shape (4,)
        Best gain set of this stage.
    best_value : float
        Objective there; ``-inf`` where it has no value.
    violation : float
        Sum by which constraints are missed there; 0 when all hold.
    evaluations : int
        Number of gain sets, failures included.
    status : str
        Why it ended: a grid ``"complete"``, a local search ``"converged"``, ``"budget_spent"``, ``"interrupted"`` or
        ``"failed"``.
    start : ndarray, shape (4,), or None
        Gain set that a local search began at.
    start_value : float or None
        Objective there.
    failures : int or None
        Gain sets of a grid that touched an obstacle or did not arrive in at least one scenario.
    axes : tuple of ndarray
        Values of K_1, K_3, K_5, b of a grid; every combination was evaluated. Empty for a local search, as what follows
        is ``None``.
    increments : ndarray, shape (4,)
        Distance of neighbouring values of each gain; 0 for a gain that is held.
    survivor_low, survivor_high : ndarray, shape (4,)
        Box around the survivors: the bounds of the next grid. Where they agree in a gain, that
        grid keeps half an increment to either side.
    worst_survivor : float
        Objective at the last of the survivors.
    """

    name: str
    best_gains: Array
    best_value: float
    violation: float
    evaluations: int
    status: str
    start: Array | Any = None
    start_value: float | Any = None
    failures: int | Any = None
    axes: tuple[Array, ...] = ()
    increments: Array | Any = None
    survivor_low: Array | Any = None
    survivor_high: Array | Any = None
    worst_survivor: float | Any = None


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Flatness:
    """How flat the objective is around the best gain set.

    Attributes
    ----------
    gain_names : tuple of str
        Names of the four gains.
    best_gains : ndarray, shape (4,)
        Best gain set.
    best_value : float
        Objective there.
    gains : ndarray, shape (4, n)
        Row i: values of gain i, the other three held at the best set.
    values : ndarray, shape (4, n)
        Objective there; ``-inf`` after a failure where the objective has no value then.
    violation : ndarray, shape (4, n)
        Sum by which constraints are missed there.
    tolerance : float
        Share of the best value that may be lost, for example 0.01.
    low, high : ndarray, shape (4,)
        Ends of the unbroken range of ``gains`` around the best set within the tolerance.
    near_best_share : float
        Share of the best grid points, `GainSearch.top`, within the tolerance of the best value;
        NaN without a grid.
    warnings : tuple of ResultWarning
        Those of the search.
    """

    gain_names: tuple[str, ...]
    best_gains: Array
    best_value: float
    gains: Array
    values: Array
    violation: Array
    tolerance: float
    low: Array
    high: Array
    near_best_share: float
    warnings: tuple[ResultWarning, ...] = ()


# An optimum so near to a bound, as a share of the width between both, lies on it.
_ON_BOUND = 1e-3


def _on_bounds(law: Law, bounds: Array) -> Iterator[ResultWarning]:
    """Warn of gains that lie on a bound of their search; no gain can be below 0."""
    found = []
    for name, gain, (low, high) in zip(law.GAIN_NAMES, law.gains, bounds.tolist(), strict=True):
        near = _ON_BOUND * (high - low)
        unit = f" {law.GAIN_UNITS[name]}" if law.GAIN_UNITS.get(name) else ""
        if low < high and high - gain <= near:
            found.append(f"{name} is {gain:.6g}{unit}, on its largest value {high:g}{unit}")
        elif 0.0 < low < high and gain - low <= near:
            found.append(f"{name} is {gain:.6g}{unit}, on its least value {low:g}{unit}")
    if found:
        words = "; ".join(found)
        message = f"the best gains lie on bounds of the search: {words}; better ones may lie beyond, widen bounds"
        yield ResultWarning("optimum_on_bound", "bounds", message, safe_side=True)


def _is_measured(place: Any) -> bool:
    """Return whether positions are noisy there."""
    robots = place.robots if isinstance(place, World) else [place]
    return any(each.measurement is not None and each.measurement.scale > 0.0 for each in robots)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class _Search(Table):
    """Counts, end and doubts of a search with one objective or several."""

    evaluations: int
    episodes: int
    failures: int
    interrupted: bool
    settings: SearchSettings

    @property
    def valid(self) -> bool:
        """Whether a gain set keeps every constraint."""
        raise NotImplementedError

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the numbers may not mean what they seem to: the first warning of each kind, and how many follow."""
        worlds = isinstance(self.settings.scenarios[0], World)
        of_scenes = doubts_of(self.settings.scenarios, self.settings.law, *([] if worlds else [self.settings.step]))
        return (*of_scenes, *self._of_result())

    def _of_result(self) -> Iterator[ResultWarning]:
        """Yield doubts about what was found."""
        yield from ()

    @property
    def status(self) -> Literal["found", "infeasible", "interrupted"]:
        """How the search ended: ``"interrupted"`` before its end, with or without a best so far."""
        if self.interrupted:
            return "interrupted"
        return "found" if self.valid else "infeasible"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class GainSearch(_Search):
    """Best gains found, and how.

    Attributes
    ----------
    nearest : Law
        Law with the gains that miss the constraints least and, where none is missed, have the
        best objective; mode and side rules are those of the searched law. `best` is this law
        where it keeps every constraint.
    best_value : float
        Objective there, larger is better: a metric that is to be small enters with its sign
        changed.
    best_performance : ndarray, shape (scenarios,)
        H in each scenario as printed, ratios above 1 included; the mean over the seeds with noise.
    violation : float
        Sum by which constraints are missed there; where every scenario has to be arrived in,
        each run that does not arrive or touches an obstacle counts 1.
    feasible : bool
        Whether every constraint holds there and no run failed.
    evaluations : int
        Number of gain sets evaluated, failures included.
    episodes : int
        Number of runs: evaluations times scenarios times seeds. The runs without obstacles
        that give T* and L* are not counted.
    failures : int
        Gain sets that touched an obstacle or did not arrive in at least one scenario.
    history : tuple of SearchStage
        Grids in their order, then local searches, best start first; empty for the other methods.
    convergence : ndarray, shape (reports, 2)
        Gain sets evaluated, and the best value so far.
    top : ndarray, shape (n, 4)
        Best points of all grids that keep the constraints, best first: as many as survive a
        round. The best set alone for the other methods.
    top_values : ndarray, shape (n,)
        Objective there.
    confidence : Confidence or None
        With seeds: what fresh seeds say about the best set.
    interrupted : bool
        Whether the search was stopped before its end.
    settings : SearchSettings
        Everything that is needed to run the same search again.
    """

    nearest: Law
    best_value: float
    best_performance: Array
    violation: float
    feasible: bool
    history: tuple[SearchStage, ...]
    convergence: Array
    top: Array
    top_values: Array
    confidence: Confidence | None

    def _of_result(self) -> Iterator[ResultWarning]:
        """Yield doubts about the best gains: on a bound of the search, or better than they are by luck."""
        if not self.valid:
            return
        yield from _on_bounds(self.nearest, self.settings.bounds)
        if not self.settings.seeds and any(map(_is_measured, self.settings.scenarios)):
            message = (
                "scenarios are measured with noise, and each was run with its own seed alone: the best value is that "
                "of one draw, for which it was chosen, and the mean of fresh draws is worse; give seeds=, whose "
                "confidence says by how much"
            )
            yield ResultWarning("few_runs", "seeds", message)

    @property
    def grids(self) -> tuple[SearchStage, ...]:
        """Stages of the history that are grids."""
        return tuple(each for each in self.history if each.axes)

    @property
    def local(self) -> tuple[SearchStage, ...]:
        """Stages of the history that are local searches, best start first."""
        return tuple(each for each in self.history if not each.axes)

    @property
    def best(self) -> Law:
        """Law with the best gains found; of an interrupted search the best so far.

        Raises
        ------
        InfeasibleError
            If no gain set that was evaluated keeps every constraint; `nearest` is then the one
            that misses them least.
        """
        if not self.valid:
            raise InfeasibleError(self.shortcoming, self.remedy)
        return self.nearest

    @property
    def valid(self) -> bool:
        """Whether a gain set keeps every constraint and has a value: whether there is a `best`."""
        return self.violation == 0.0 and self.best_value > -np.inf

    @property
    def shortcoming(self) -> str:
        """Why there is no `best`, in one clause; empty where there is one."""
        if self.valid:
            return ""
        so_far = " so far" if self.interrupted else ""
        if not self.settings.constraints and self.settings.require_arrival:
            runs = len(self.settings.scenarios) * max(self.settings.seeds, 1)
            return (
                f"no gain set{so_far} arrives without a contact everywhere; "
                f"the nearest fails in {self.violation:.0f} of {runs} runs"
            )
        if self.violation > 0.0:
            return f"no gain set{so_far} keeps all constraints; the nearest misses them by {self.violation:.4g} in all"
        return f"no gain set{so_far} has a value of the objective: it needs runs that arrive"

    @property
    def remedy(self) -> str:
        """Change of the search that would give a `best`; empty where there is one."""
        if self.valid:
            return ""
        if self.interrupted:
            return "let the search run on, with the same checkpoint to resume it"
        return "widen the bounds, make the grid finer, raise the time limit or loosen the constraints"

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each grid and local search.

        Returns
        -------
        dict of str to ndarray
            Stage, gain sets evaluated up to its end, best feasible value until then (``-inf``
            before there is one), then value, violation and gains of the stage itself; of a global
            search a row wherever it became better, and one for its end, without the latter.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> search = nav.optimize_gains(
        ...     [scenarios.configuration("c1")], grid=(4, 4, 4, 4), refinements=1, survivors=10, local_starts=1
        ... )
        >>> search.columns()["stage"].tolist()
        ['grid 1', 'grid 2', 'local 1']
        """
        unknown = np.full(len(self.nearest.gains), np.nan)
        stages = [(each.name, each.best_value, each.violation, each.best_gains) for each in self.history]
        stages = stages or [("global", np.nan, np.nan, unknown)] * len(self.convergence)
        found: Columns = {
            "stage": np.array([each[0] for each in stages], dtype=np.str_),
            "evaluations": self.convergence[:, 0].astype(np.int64),
            "best_value": self.convergence[:, 1],
            "value": np.array([each[1] for each in stages], dtype=np.float64),
            "violation": np.array([each[2] for each in stages], dtype=np.float64),
        }
        return found | gain_columns(self.nearest, np.array([each[3] for each in stages]).reshape(-1, len(unknown)))

    def flatness(self, points: int = 41, *, tolerance: float = 0.01, threads: int | None = None) -> Flatness:
        """Return the objective along each gain through the best set, or the nearest without a best.

        Each gain runs over its whole bounds while the others are held, so a picture shows at
        a glance which of them matter.

        Parameters
        ----------
        points : int
            Values of each gain; the best value itself is added.
        tolerance : float
            Share of the best value that may be lost within ``low`` to ``high``.
        threads : int or None
            As for `optimize_gains`.

        Returns
        -------
        Flatness
            Values along each gain, and the range that is as good.

        Raises
        ------
        InvalidParameterError
            If points is below 2 or the tolerance is not positive and finite.
        """
        count("points", points, least=2, most=MOST_POINTS_OF_AXIS)
        check_threads(threads)
        return _flatness(self, points, positive("tolerance", tolerance), threads)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ParetoFront(_Search):
    """Gain sets that no other one beats in every objective.

    Attributes
    ----------
    objectives : tuple of str
        Names of the metrics.
    maximized : tuple of bool
        Whether large values of each are good.
    gains : ndarray, shape (n, 4)
        K_1, K_3, K_5, b; ordered by the first objective, best first.
    values : ndarray, shape (n, objectives)
        Metrics in their own units: the mean over the scenarios, for a clearance the least.
    reference : ndarray, shape (objectives,)
        Corner that the hypervolume is measured from: the worst value of each on the front.
    hypervolume : float
        Volume between front and reference, each objective divided by its range on the front.
    evaluations, episodes, failures : int
        As in `GainSearch`.
    interrupted : bool
        Whether the search was stopped before its end.
    settings : SearchSettings
        Everything that is needed to run the same search again.
    """

    objectives: tuple[str, ...]
    maximized: tuple[bool, ...]
    gains: Array
    values: Array
    reference: Array
    hypervolume: float

    @property
    def valid(self) -> bool:
        """Whether a gain set keeps every constraint: whether there is one on the front."""
        return len(self.gains) > 0

    def __len__(self) -> int:
        """Return the number of gain sets."""
        return len(self.gains)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each gain set.

        Returns
        -------
        dict of str to ndarray
            Gains, then objectives; units are in the names.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> front = nav.gains.pareto_front([scenarios.configuration("c1")], grid=(3, 3, 3, 3), refinements=0)
        >>> list(front.columns())[2:]
        ['detour_gain_N_per_m2', 'gain_ratio_s', 'arrival_time_s', 'min_clearance_m', 'energy_J']
        """
        found = gain_columns(self.settings.law, self.gains)
        units = (unit_suffix(METRIC_UNITS.get(name, "")) for name in self.objectives)
        named = zip(self.objectives, units, self.values.T, strict=True)
        return found | {f"{name}{unit}": values for name, unit, values in named}

    def law(self, index: int) -> Law:
        """Return the law with the gains of one point of the front.

        Parameters
        ----------
        index : int
            Row of ``gains``.

        Returns
        -------
        Law
            The searched law with these gains.

        Raises
        ------
        InvalidParameterError
            If there is no such row.
        """
        row = count("index", index, least=0)
        if row >= len(self.gains):
            raise InvalidParameterError("index", f"be below {len(self.gains)}", index)
        return with_gains(self.settings.law, self.gains[row])


def gain_columns(law: Law, gains: Array) -> Columns:
    """Return a column for each gain, with its unit in the name."""
    names = [f"{name}{unit_suffix(law.GAIN_UNITS.get(name, ''))}" for name in law.GAIN_NAMES]
    return {name: gains[:, index] for index, name in enumerate(names)}


def _flatness(search: GainSearch, points: int, tolerance: float, threads: int | None) -> Flatness:
    best = np.array(search.nearest.gains)
    axes = [_axis(low, high, points, own) for (low, high), own in zip(search.settings.bounds, best, strict=True)]
    gains = np.stack(axes)
    sets = np.tile(best, (*gains.shape, 1))
    for index in range(len(best)):
        sets[index, :, index] = gains[index]
    found = gain_problem(search.settings).evaluate(sets.reshape(-1, len(best)), threads=threads)
    values = found["values"][:, 0].reshape(gains.shape)
    violation = found["violation"].reshape(gains.shape)
    floor = search.best_value - tolerance * abs(search.best_value)
    good = (values >= floor) & (violation <= search.violation)
    ends = [_unbroken(row, kept, own) for row, kept, own in zip(gains, good, best, strict=True)]
    low, high = np.array(ends).T
    return Flatness(
        gain_names=search.nearest.GAIN_NAMES,
        best_gains=best,
        best_value=search.best_value,
        gains=gains,
        values=values,
        violation=violation,
        tolerance=tolerance,
        low=low,
        high=high,
        near_best_share=float((search.top_values >= floor).mean())
        if search.grids and search.top_values.size
        else np.nan,
        warnings=search.warnings,
    )


def _axis(low: float, high: float, points: int, best: float) -> Array:
    """Return evenly spaced values, and the best one among them."""
    return np.sort(np.append(np.linspace(low, high, points), best))


def _unbroken(values: Array, good: npt.NDArray[np.bool_], best: float) -> tuple[float, float]:
    """Return the ends of the run of good values around the best one."""
    middle = int(np.searchsorted(values, best))
    bad = np.flatnonzero(~good)
    first = bad[bad < middle].max() + 1 if (bad < middle).any() else 0
    last = bad[bad > middle].min() - 1 if (bad > middle).any() else len(values) - 1
    return float(values[first]), float(values[last])
