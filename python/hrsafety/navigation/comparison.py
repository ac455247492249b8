"""Any laws in the same scenarios with the same seeds: who arrives, who touches, what it costs."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, instance, word
from hrsafety._bounds import MOST_REPEATS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Mean, Share, mean_interval, wilson
from hrsafety.navigation.batch import simulate_batch
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
_OF_SUCCESS = ("arrival_time", "energy", "path_length")
"""Metrics without a fair value in a run that did not arrive."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class Standing:
    """Results of one law over all episodes.

    Attributes
    ----------
    law : str
        Its name.
    success, contact, diverged : Share
        Share of the episodes in which it arrived without a contact, in which it had one, however they ended, and in
        which the world diverged before the robot arrived, with 95 % Wilson intervals.
    obstacle_contact, wall_contact : Share
        Share with a contact with an obstacle or a person, and with a map or a wall.
    moving_contact, toward_contact, away_contact : Share
        Share with a contact while the robot itself was moving; with one toward which it moved, and with one that
        came from behind or from the side, as ``contacts_toward`` and ``contacts_away`` of a `RunTable`.
    at_fault : Share
        Share with a contact at fault; every one with a wall is.
    robot_contact : Share
        Share of the episodes in whose world robots touched each other, whichever; these are no contacts of
        the shares above.
    arrival_time, energy, path_length : Mean
        Over the episodes with success, in s, J and m, with 95 % bootstrap intervals; energy is not known of worlds.
    min_clearance, performance_total : Mean
        Over all episodes, in m and from 0 to 1; the performance is not known of worlds.
    discomfort_time, person_delay : Mean
        Over the episodes of worlds in which they are known, in s: for the delay, people were simulated without robots,
        too.
    """

    law: str
    success: Share
    contact: Share
    diverged: Share
    obstacle_contact: Share
    wall_contact: Share
    moving_contact: Share
    toward_contact: Share
    away_contact: Share
    at_fault: Share
    robot_contact: Share
    arrival_time: Annotated[Mean, "s"]
    energy: Annotated[Mean, "J"]
    path_length: Annotated[Mean, "m"]
    min_clearance: Annotated[Mean, "m"]
    performance_total: Mean
    discomfort_time: Annotated[Mean, "s"]
    person_delay: Annotated[Mean, "s"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Comparison(PairedRuns):
    """Runs of several laws in the same episodes, a scenario and a seed each: rows are laws, columns episodes.

    An episode of a world is a robot of it.

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
        ``"arrived"``, ``"collided"``, ``"timed_out"``, ``"stopped"`` or ``"diverged"``.
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
        return self.metric("arrival_time")

    @property
    def energy(self) -> Array:
        """Electrical loss in J."""
        return self.metric("energy")

    @property
    def path_length(self) -> Array:
        """Path length in m."""
        return self.metric("path_length")

    @property
    def min_clearance(self) -> Array:
        """Least distance of the surfaces in m."""
        return self.metric("min_clearance")

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
        return self.metric("performance_total")

    def metric(self, name: str) -> Array:
        """Return a metric of every episode.

        Parameters
        ----------
        name : str
            ``"arrival_time"``, ``"min_clearance"``, ``"energy"``, ``"path_length"``, ``"performance_total"``, and of
            worlds one of ``nav.metrics.METRICS``.

        Returns
        -------
        ndarray, shape (laws, episodes)
            Its values; NaN where a run has none.

        Raises
        ------
        InvalidParameterError
            If there is no such metric.
        """
        word("metric", name, (*METRICS, *self.runs.values))
        return self._by_law(self.runs.values[name] if name in self.runs.values else getattr(self.runs, name))

    def _known(self) -> tuple[str, ...]:
        """Return the metrics that the runs have."""
        own = (name for name in METRICS if getattr(self.runs, name) is not None)
        return tuple(dict.fromkeys((*own, *self.runs.values)))

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

    def _shown(self) -> tuple[list[str], list[list[str]], str]:
        """Return header, cells and title of the shares, a law a row."""
        header = ["law", "arrived, no contact", "contact", "contact at fault", "arrival_time_s"]
        counted = (self.outcome == "arrived", self._touched(), self._by_law(self.runs.contacts_at_fault > 0))
        rows = []
        for row, law in enumerate(self.laws):
            shares = [wilson(int(flags[row].sum()), len(self.seed)) for flags in counted]
            times = self.arrival_time[row][counted[0][row]]
            words = [f"{each.value:.1%} ({each.low:.1%} to {each.high:.1%})" for each in shares]
            rows.append([law, *words, f"{times.mean():.2f}" if len(times) else ""])
        title = f"Comparison: {len(self.laws)} laws in {len(self.seed)} episodes, shares with 95 % intervals"
        return header, rows, title

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
        table = self.runs

        def share(flags: npt.NDArray[Any]) -> Share:
            return wilson(int(self._by_law(flags > 0)[row].sum()), len(arrived))

        def mean(name: str) -> Mean:
            values = self.metric(name)[row] if name in self._known() else np.full(len(arrived), np.nan)
            return mean_interval(values[np.isfinite(values) & (arrived if name in _OF_SUCCESS else True)])

        among_robots = table.values.get("robot_contacts", np.zeros(len(table), dtype=np.int64))
        return Standing(
            law=law,
            success=share(table.outcome == "arrived"),
            contact=share(table.touched),
            diverged=share(table.outcome == "diverged"),
            obstacle_contact=share(table.contacts_moving + table.contacts_standing - table.wall_contacts),
            wall_contact=share(table.wall_contacts),
            moving_contact=share(table.contacts_moving),
            toward_contact=share(table.contacts_toward),
            away_contact=share(table.contacts_away),
            at_fault=share(table.contacts_at_fault),
            robot_contact=share(among_robots),
            **{name: mean(name) for name in (*METRICS, "discomfort_time", "person_delay")},
        )

    def standings(self) -> list[Standing]:
        """Return the standing of every law, in the order given."""
        return [self.standing(law) for law in self.laws]

    def difference(self, first: str, second: str, metric: str | None = None) -> Mean:
        """Return the mean difference of two laws, episode by episode.

        Parameters
        ----------
        first, second : str
            Names of the laws; the difference is first minus second.
        metric : str or None
            As of `metric`. Time, energy and length are compared in the episodes in which both laws arrived without a
            contact, the others in all in which they are finite. ``None``: the performance, in worlds the time.

        Returns
        -------
        Mean
            Mean of the differences with its 95 % bootstrap interval.

        Raises
        ------
        InvalidParameterError
            If there is no such law or metric.
        """
        name = ("arrival_time" if self.runs.values else "performance_total") if metric is None else metric
        word("metric", name, self._known())
        return self._difference(first, second, self.metric(name).astype(np.float64), successful=name in _OF_SUCCESS)


@telling(of_scenarios)
def compare(
    scenarios: Scenario | World | Sequence[Scenario | World] | Mapping[str, Scenario | World],
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
) -> Comparison:
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
    Comparison
        Every run; shares with intervals, and differences of the same episodes.

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
    runs = simulate_many(
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
    return Comparison(runs=runs)


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
