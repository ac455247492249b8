"""How the runs change when one gain changes, Zeng (2011), appendix C.3."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, vector
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.batch import simulate_batch
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.settings import checked_places
from hrsafety.navigation.gains.worlds import doubts_of, runs_of_sets
from hrsafety.navigation.laws.force_laws import Law, VirtualForceField
from hrsafety.navigation.laws.python_law import law_with_gains
from hrsafety.navigation.performance import check_weights
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.simulation import refuse_in_worlds
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.trajectory import Integrator
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import ResultWarning, telling
from hrsafety.tables import Columns, Table

__all__ = ["GainSensitivity", "gain_sensitivity"]

# The source also lists -100 %, where no run succeeds.
CHANGES_PERCENT = (-50.0, -20.0, -10.0, -5.0, -2.0, 0.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class GainSensitivity(Table):
    """Runs and scores with one gain changed at a time: g gains, c changes, s scenarios.

    Row i of each array belongs to gain i; the other gains stay as the law has them. With the
    gains of Table C.1 and the configurations c1, c2, c3 these are Tables C.2 to C.9.

    Attributes
    ----------
    law : Law
        The law whose gains were changed.
    scenarios : tuple of Scenario
        Where.
    weights : tuple of float
        Weights of time, distance and energy in H.
    gain_names : tuple of str
        Names of the g = 4 gains.
    changes_percent : ndarray, shape (c,)
        Changes in percent of the law's gain.
    gains : ndarray, shape (g, c, 4)
        Gain sets.
    outcome : ndarray of str, shape (g, c, s)
        How each run ended, as in `Trajectory`.
    arrival_time, energy : ndarray, shape (g, c, s)
        In s, NaN without arrival, and in J.
    min_distance : ndarray, shape (g, c, s, obstacles)
        Least distance to each obstacle in m; NaN beyond the obstacles of a scenario.
    min_clearance : ndarray, shape (g, c, s)
        Least distance of the surfaces in m.
    performance : ndarray, shape (g, c, s)
        H.
    mean_performance : ndarray, shape (g, c)
        Mean of H over the scenarios.
    reference_performance : ndarray, shape (s,)
        H with the gains of the law.
    relative_sensitivity : ndarray, shape (g, c)
        ``(1 - H/H_ref) / (1 - K/K_ref)`` of the mean, (C.3.1) to (C.3.4), with its sign; NaN
        without change, and where a run touched an obstacle or did not arrive.
    """

    law: Law
    scenarios: tuple[Scenario, ...]
    weights: tuple[float, float, float]
    gain_names: tuple[str, ...]
    changes_percent: Annotated[Array, "percent"]
    gains: Array
    outcome: npt.NDArray[np.str_]
    arrival_time: Annotated[Array, "s"]
    energy: Annotated[Array, "J"]
    min_distance: Annotated[Array, "m"]
    min_clearance: Annotated[Array, "m"]
    performance: Array
    mean_performance: Array
    reference_performance: Array
    relative_sensitivity: Array

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the numbers may not mean what they seem to: the first warning of each kind, and how many follow."""
        return doubts_of(self.scenarios, self.law)

    def largest_sensitivity(self) -> Array:
        """Return the largest magnitude of the relative sensitivity to each gain.

        Returns
        -------
        ndarray, shape (g,)
            NaN for a gain without any.
        """
        return _over_changes(np.max, self.relative_sensitivity)

    def average_sensitivity(self) -> Array:
        """Return the mean magnitude of the relative sensitivity to each gain.

        Returns
        -------
        ndarray, shape (g,)
            NaN for a gain without any.
        """
        return _over_changes(np.mean, self.relative_sensitivity)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, one row for each (gain, change).

        Returns
        -------
        dict of str to ndarray
            Scenarios and obstacles are split into one column each, for example
            ``arrival_time_1`` and ``min_distance_2_0``; an obstacle that a scenario does not
            have gets no column.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> table = nav.gain_sensitivity([scenarios.configuration("c1")], changes=(-10, 10)).columns()
        >>> table["gain"].tolist()[:3], table["change_percent"].tolist()[:3]
        (['attractive_gain', 'attractive_gain', 'repulsive_gain'], [-10.0, 10.0, -10.0])
        """
        shape = self.mean_performance.shape
        table: Columns = {
            "gain": np.repeat(np.array(self.gain_names), shape[1]),
            "change_percent": np.tile(self.changes_percent, shape[0]),
        }
        table |= {name: self.gains[:, :, i].ravel() for i, name in enumerate(self.gain_names)}
        for index, scenario in enumerate(self.scenarios):
            for name in ("outcome", "arrival_time", "energy", "min_clearance", "performance"):
                table[f"{name}_{index}"] = getattr(self, name)[:, :, index].ravel()
            for obstacle in range(0 if isinstance(scenario, World) else len(scenario.obstacles)):
                table[f"min_distance_{index}_{obstacle}"] = self.min_distance[:, :, index, obstacle].ravel()
        table["mean_performance"] = self.mean_performance.ravel()
        table["relative_sensitivity"] = self.relative_sensitivity.ravel()
        return table


def _over_changes(statistic: Callable[[Array], np.floating], sensitivity: Array) -> Array:
    kept = [np.abs(row[np.isfinite(row)]) for row in sensitivity]
    return np.array([statistic(row) if row.size else np.nan for row in kept])


@telling(of_scenarios)
def gain_sensitivity(
    scenarios: Sequence[Scenario] | Sequence[World],
    law: Law | None = None,
    changes: npt.ArrayLike = CHANGES_PERCENT,
    *,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> GainSensitivity:
    """Change each gain on its own and run every scenario, Zeng (2011), appendix C.3.

    Parameters
    ----------
    scenarios : sequence of Scenario or of World
        Where; worlds of one robot, which take no ``integrator``, ``step`` and ``hold``.
    law : Law or None
        The law and the gains that are changed; ``None``: the default law.
    changes : array_like, shape (c,)
        Changes of a gain in percent, -100 or more; the default is that of the source without
        -100.
    weights : sequence of float
        Weights of time, distance and energy in H.
    integrator, step, hold
        As for `simulate`.
    threads, progress
        As for `simulate_batch`.

    Returns
    -------
    GainSensitivity
        Times, energies, distances, H and relative sensitivities.

    Raises
    ------
    InvalidParameterError
        If there is no scenario or no change, a change is below -100 or not finite, or an
        option is out of range.
    ShapeError
        If changes is not one-dimensional.
    SimulationError
        If the state of a run became non-finite.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> table = nav.gain_sensitivity(
    ...     [scenarios.configuration(name) for name in ("c1", "c2", "c3")],
    ...     nav.VirtualForceField(
    ...         attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
    ...     ),
    ... )
    >>> table.performance.shape, round(float(table.reference_performance.mean()), 4)
    ((4, 12, 3), 0.6641)
    """
    scenes = checked_places(scenarios)
    law = VirtualForceField() if law is None else law
    law = law_with_gains(law)
    percent = _changes(changes)
    reference = np.array(law.gains)
    gains = np.tile(reference, (len(reference), len(percent), 1))
    for index in range(len(reference)):
        gains[index, :, index] *= 1.0 + percent / 100.0
    sets = np.vstack([reference, gains.reshape(-1, len(reference))])
    if isinstance(scenes[0], World):
        refuse_in_worlds({"integrator": integrator, "step": step, "hold": hold})
        table = runs_of_sets(scenes, law, sets, check_weights(weights), threads=threads, progress=progress)
        return _collect(scenes, law, weights, percent, gains, table)
    table = simulate_batch(
        scenes,
        law,
        sets,
        weights=weights,
        integrator=integrator,
        step=step,
        hold=hold,
        threads=threads,
        progress=progress,
    )
    return _collect(scenes, law, weights, percent, gains, table)


def _changes(changes: npt.ArrayLike) -> Array:
    percent = vector("changes", changes)
    if not percent.size:
        raise InvalidParameterError("changes", "hold at least one change", Shown("an empty list"))
    for index, change in enumerate(percent.tolist()):
        if not -100.0 <= change < np.inf:
            raise InvalidParameterError(f"changes[{index}]", "be finite and at least -100", change)
    return percent


def _collect(
    scenes: Sequence[Scenario],
    law: Law,
    weights: Sequence[float],
    percent: Array,
    gains: Array,
    table: RunTable,
) -> GainSensitivity:
    """Return the rows of a batch, of which the first gain set is that of the law, by gain and change."""
    own, shape = len(scenes), (*gains.shape[:2], len(scenes))
    if len(table) != own * (1 + int(np.prod(gains.shape[:2]))):
        raise InvalidParameterError("scenarios", "have one robot each", Shown("a world of several robots"))
    least = np.empty((len(table), 0)) if table.min_distance is None else table.min_distance
    performance = table.performance_total[own:].reshape(shape)
    outcome = table.outcome[own:].reshape(shape)
    reference = table.performance_total[:own]
    mean = performance.mean(axis=2)
    succeeded = (outcome == "arrived").all(axis=2) & bool((table.outcome[:own] == "arrived").all())
    return GainSensitivity(
        law=law,
        scenarios=tuple(scenes),
        weights=(float(weights[0]), float(weights[1]), float(weights[2])),
        gain_names=law.GAIN_NAMES,
        changes_percent=percent,
        gains=gains,
        outcome=outcome,
        arrival_time=table.arrival_time[own:].reshape(shape),
        energy=table.energy[own:].reshape(shape),
        min_distance=least[own:].reshape(*shape, least.shape[1]),
        min_clearance=table.min_clearance[own:].reshape(shape),
        performance=performance,
        mean_performance=mean,
        reference_performance=reference,
        relative_sensitivity=_relative(mean, float(reference.mean()), percent, np.array(law.gains), succeeded),
    )


def _relative(mean: Array, reference: float, percent: Array, gains: Array, succeeded: npt.NDArray[np.bool_]) -> Array:
    """Return ``(1 - H/H_ref) / (1 - K/K_ref)``, (C.3.1) to (C.3.4), where it is defined."""
    defined = succeeded & (percent != 0.0) & (gains[:, None] > 0.0) & (reference > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (mean / reference - 1.0) / (percent / 100.0)
    return np.where(defined, ratio, np.nan)
