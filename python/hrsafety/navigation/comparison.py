"""Any laws in the same scenarios with the same seeds: who arrives, who touches, what it costs."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, get_args, overload

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, instance, word
from hrsafety._bounds import MOST_REPEATS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Mean, Share, mean_interval, wilson
from hrsafety.navigation.batch import simulate_batch
from hrsafety.navigation.crowd.comparison import CrowdComparison
from hrsafety.navigation.crowd.table import CrowdTable
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.python_law import AnyLaw
from hrsafety.navigation.many import simulate_many
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.run_arguments import Progress, Seeds
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.tables.pairs import PairedRuns
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.trajectory import Integrator
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling
from hrsafety.tables import Columns

__all__ = ["Comparison", "Metric", "Standing", "compare", "step_cost"]

Metric = Literal["arrival_time", "min_clearance", "energy", "path_length", "performance_total"]
METRICS: tuple[str, ...] = get_args(Metric)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class Standing:
    """What one law did over all episodes.

    Attributes
    ----------
    law : str
        Its name.
    success, contact : Share
        Share of the episodes in which it arrived without a contact, and with a contact, with
        95 % Wilson intervals.
    obstacle_contact, wall_contact : Share
        Share with a contact with an obstacle, and with a map.
    moving_contact, toward_contact, away_contact : Share
        Share with a contact while the robot itself was moving; with one toward which it moved, and with one that
        came from behind or from the side, as ``contacts_toward`` and ``contacts_away`` of a `RunTable`.
    at_fault : Share
        Share with a contact at fault.
    arrival_time, energy, path_length : Mean
        Over the episodes with success, in s, J and m, with 95 % bootstrap intervals.
    min_clearance, performance_total : Mean
        Over all episodes, in m and from 0 to 1.
    """

    law: str
    success: Share
    contact: Share
    obstacle_contact: Share
    wall_contact: Share
    moving_contact: Share
    toward_contact: Share
    away_contact: Share
    at_fault: Share
    arrival_time: Annotated[Mean, "s"]
    energy: Annotated[Mean, "J"]
    path_length: Annotated[Mean, "m"]
    min_clearance: Annotated[Mean, "m"]
    performance_total: Mean


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Comparison(PairedRuns[RunTable]):
    """Runs of several laws in the same episodes, a scenario and a seed each: rows are laws, columns episodes.

    Attributes
    ----------
    runs : RunTable
        All runs, one a row, as `simulate_many` returned them.
    laws, scenario_names : sequence of str
        Names of the laws and of the scenarios.
    scenario : ndarray of int, shape (episodes,)
        Index of each episode's scenario.
    seed : ndarray of int, shape (episodes,)
        Seed of each episode.
    outcome : ndarray of str, shape (laws, episodes)
        ``"arrived"``, ``"collided"``, ``"timed_out"`` or ``"stopped"``.
    arrival_time, energy, path_length, min_clearance : ndarray, shape (laws, episodes)
        In s (NaN without arrival), J, m and m.
    min_distance : ndarray, shape (laws, episodes, obstacles)
        Least distance to each obstacle in m, NaN beyond an episode's obstacles.
    moving_contacts : ndarray of int, shape (laws, episodes)
        Number of obstacles touched while the robot was moving.
    performance_total : ndarray, shape (laws, episodes)
        H.
    """

    runs: RunTable

    @property
    def arrival_time(self) -> Array:
        """First entry into the tolerance circle in s."""
        return self._by_law(self.runs.arrival_time)

    @property
    def energy(self) -> Array:
        """Electrical loss in J."""
        return self._by_law(self.runs.energy)

    @property
    def path_length(self) -> Array:
        """Path length in m."""
        return self._by_law(self.runs.path_length)

    @property
    def min_clearance(self) -> Array:
        """Least distance of the surfaces in m."""
        return self._by_law(self.runs.min_clearance)

    @property
    def min_distance(self) -> Array:
        """Least distance to each obstacle in m."""
        return self._by_law(self.runs.min_distance)

    @property
    def moving_contacts(self) -> npt.NDArray[np.int64]:
        """Number of obstacles touched while the robot was moving."""
        return self._by_law(self.runs.contacts_moving)

    @property
    def performance_total(self) -> Array:
        """Criterion H."""
        return self._by_law(self.runs.performance_total)

    def columns(self) -> Columns:
        """Return the columns of the runs by name, a row for each law and episode.

        Returns
        -------
        dict of str to ndarray
            Laws by name, the episodes of a law in a row; units are in the names.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> laws = {"field": nav.VirtualForceField(), "no detour": nav.VirtualForceField(detour_gain=0.0)}
        >>> nav.compare({"c1": scenarios.configuration("c1")}, laws).columns()["law"].tolist()
        ['field', 'no detour']
        """
        return self.runs.columns()

    def standing(self, law: str) -> Standing:
        """Return what one law did over all episodes.

        Parameters
        ----------
        law : str
            Its name.

        Returns
        -------
        Standing
            Shares and means with intervals.

        Raises
        ------
        InvalidParameterError
            If there is no such law.
        """
        row = self._row("law", law)
        arrived = self.outcome[row] == "arrived"
        runs, table = len(arrived), self.runs

        def share(counts: npt.NDArray[np.int64]) -> Share:
            return wilson(int((self._by_law(counts)[row] > 0).sum()), runs)

        def successful(values: Array) -> Mean:
            return mean_interval(values[row][arrived])

        return Standing(
            law=law,
            success=wilson(int(arrived.sum()), runs),
            contact=wilson(int((self.outcome[row] == "collided").sum()), runs),
            obstacle_contact=share(table.contacts_moving + table.contacts_standing - table.wall_contacts),
            wall_contact=share(table.wall_contacts),
            moving_contact=share(table.contacts_moving),
            toward_contact=share(table.contacts_toward),
            away_contact=share(table.contacts_away),
            at_fault=share(table.contacts_at_fault),
            arrival_time=successful(self.arrival_time),
            energy=successful(self.energy),
            path_length=successful(self.path_length),
            min_clearance=mean_interval(self.min_clearance[row][np.isfinite(self.min_clearance[row])]),
            performance_total=mean_interval(self.performance_total[row]),
        )

    def standings(self) -> list[Standing]:
        """Return the standing of every law, in the order given."""
        return [self.standing(law) for law in self.laws]

    def difference(self, first: str, second: str, metric: Metric = "performance_total") -> Mean:
        """Return the mean difference of two laws, episode by episode.

        Parameters
        ----------
        first, second : str
            Names of the laws; the difference is first minus second.
        metric : {"arrival_time", "min_clearance", "energy", "path_length", "performance_total"}
            What is compared. Time, energy and length are compared in the episodes in which
            both laws arrived without a contact, the others in all.

        Returns
        -------
        Mean
            Mean of the differences with its 95 % bootstrap interval.

        Raises
        ------
        InvalidParameterError
            If there is no such law or metric.
        """
        word("metric", metric, METRICS)
        successful = metric in ("arrival_time", "energy", "path_length")
        return self._difference(first, second, getattr(self, metric), successful=successful)


@overload
def compare(
    scenarios: Scenario | Sequence[Scenario] | Mapping[str, Scenario],
    laws: AnyLaw | Sequence[AnyLaw] | Mapping[str, AnyLaw],
    *,
    seeds: Seeds | None = ...,
    built: AsBuilt | None = ...,
    weights: Sequence[float] = ...,
    integrator: Integrator = ...,
    step: float = ...,
    hold: bool = ...,
    stop_on_contact: bool = ...,
    threads: int | None = ...,
    progress: Progress | None = ...,
) -> Comparison: ...


@overload
def compare(
    scenarios: World | Sequence[World] | Mapping[str, World],
    laws: AnyLaw | Sequence[AnyLaw] | Mapping[str, AnyLaw],
    *,
    seeds: Seeds | None = ...,
    people_alone: bool = ...,
    threads: int | None = ...,
    progress: Progress | None = ...,
) -> CrowdComparison: ...


@telling(of_scenarios)
def compare(
    scenarios: Scenario | Sequence[Scenario] | Mapping[str, Scenario] | World | Sequence[World] | Mapping[str, World],
    laws: AnyLaw | Sequence[AnyLaw] | Mapping[str, AnyLaw],
    *,
    seeds: Seeds | None = None,
    built: AsBuilt | None = None,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    stop_on_contact: bool = False,
    people_alone: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Comparison | CrowdComparison:
    """Run every law in the same scenarios with the same seeds, and compare them episode by episode.

    Parameters
    ----------
    scenarios : Scenario or World, sequence of them, or mapping of str to them
        Where, scenarios or worlds of people that react; without names they are numbered.
    laws : law, sequence of laws, or mapping of str to law
        The laws, by the names under which they appear, those of the package and laws of your own
        (`PythonLaw`); without names they are called by their class.
    seeds : int, iterable of int, or None
        Seeds for noise and for planners that draw, or their number; each scenario is run with each of
        them, with its own when ``None``.
    built, weights, integrator, step, hold, stop_on_contact, people_alone
        As for `simulate_many`.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit of the result.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.

    Returns
    -------
    Comparison or CrowdComparison
        Every run; shares with intervals, and differences of the same episodes. Of worlds with the social
        metrics.

    Raises
    ------
    InvalidParameterError
        If there is no law, no scenario or no seed, or one is not valid.
    SimulationError
        If the state of a run became non-finite.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> result = nav.compare(
    ...     {"c1": scenarios.configuration("c1")},
    ...     {"field": nav.VirtualForceField(), "without detour": nav.VirtualForceField(detour_gain=0.0)},
    ... )
    >>> result.outcome[:, 0].tolist()
    ['arrived', 'arrived']
    """
    runs: RunTable | CrowdTable = simulate_many(  # type: ignore[call-overload, misc]  # either kind
        scenarios,
        laws,
        seeds=seeds,
        built=built,
        weights=weights,
        integrator=integrator,
        step=step,
        hold=hold,
        stop_on_contact=stop_on_contact,
        people_alone=people_alone,
        threads=threads,
        progress=progress,
    )
    return CrowdComparison(runs=runs) if isinstance(runs, CrowdTable) else Comparison(runs=runs)


def step_cost(law: AnyLaw, scenario: Scenario, *, repeats: int = 5) -> float:
    """Return the processor time of one control step of a law, in s: the least of some runs.

    Parameters
    ----------
    law : law
        The law.
    scenario : Scenario
        Where.
    repeats : int
        Number of timed runs on one thread.

    Returns
    -------
    float
        Time of a control step with its motion steps, in s. A measurement: it differs from
        machine to machine.

    Raises
    ------
    InvalidParameterError
        If law or scenario is not one, or repeats is not a positive integer.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.metrics.step_cost(nav.Masoud(), scenarios.configuration("c1"), repeats=1) > 0.0
    True
    """
    instance("scenario", scenario, Scenario)
    best = np.inf
    for _ in range(count("repeats", repeats, most=MOST_REPEATS)):
        start = time.process_time_ns()
        table = simulate_batch([scenario], law, threads=1)
        # One thread does the work, and what waits costs nothing: the time of the process counts.
        best = min(best, (time.process_time_ns() - start) / 1e9 / int(table.force_evaluations[0]))
    return best
