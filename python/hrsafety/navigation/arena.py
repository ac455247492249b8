"""Any laws in the same scenarios with the same seeds: who arrives, who touches, what it costs."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, callback, checked_seed, count, instance, sequence, word
from hrsafety._bounds import MOST_REPEATS
from hrsafety._statistics import Mean, Paired, Share, compare_paired, mean_interval, wilson
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.batch import simulate_batch
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.run_warnings import of_runs
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Integrator
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, each, with_units

__all__ = ["ArenaResult", "Metric", "Standing", "arena", "step_cost"]

Metric = Literal["arrival_time", "min_clearance", "energy", "path_length", "performance_total"]
METRICS: tuple[str, ...] = get_args(Metric)


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
    moving_contact : Share
        Share with a contact while the robot itself was moving.
    arrival_time, energy, path_length : Mean
        Over the episodes with success, in s, J and m, with 95 % bootstrap intervals.
    min_clearance, performance_total : Mean
        Over all episodes, in m and from 0 to 1.
    """

    law: str
    success: Share
    contact: Share
    moving_contact: Share
    arrival_time: Mean
    energy: Mean
    path_length: Mean
    min_clearance: Mean
    performance_total: Mean


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ArenaResult(Table):
    """Runs of several laws in the same episodes: rows are laws, columns episodes.

    Attributes
    ----------
    laws : tuple of str
        Names of the laws.
    scenario : ndarray of int, shape (episodes,)
        Index of each episode's scenario.
    seed : ndarray of int, shape (episodes,)
        Seed of each episode.
    scenario_names : tuple of str
        Names of the scenarios.
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

    laws: tuple[str, ...]
    scenario: npt.NDArray[np.int64]
    seed: npt.NDArray[np.uint64]
    scenario_names: tuple[str, ...]
    outcome: npt.NDArray[np.str_]
    arrival_time: Array
    energy: Array
    path_length: Array
    min_clearance: Array
    min_distance: Array
    moving_contacts: npt.NDArray[np.int64]
    performance_total: Array
    _ran: tuple[tuple[Scenario, ...], tuple[Law, ...]] | None = field(default=None, repr=False)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why episodes may not mean what they seem to: the first warning of each kind, and how many follow."""
        if self._ran is None:
            return ()
        scenes, laws = self._ran
        return of_runs(scenes, [f"scenarios[{name!r}]" for name in self.scenario_names], laws)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each law and episode.

        Returns
        -------
        dict of str to ndarray
            Laws by name, the episodes of a law in a row; units are in the names.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> laws = {"field": nav.VirtualForceField(), "no detour": nav.VirtualForceField(detour_gain=0.0)}
        >>> nav.arena(laws, {"c1": scenarios.configuration("c1")}).columns()["law"].tolist()
        ['field', 'no detour']
        """
        laws, episodes = self.outcome.shape
        names = np.array(self.scenario_names)[self.scenario]
        found: Columns = {"law": np.repeat(np.array(self.laws), episodes), "scenario": np.tile(names, laws)}
        found |= {"seed": np.tile(self.seed, laws), "outcome": self.outcome.ravel()}
        units = {"arrival_time": "s", "energy": "J", "path_length": "m", "min_clearance": "m"}
        units |= {"moving_contacts": "", "performance_total": ""}
        found |= {name: values.ravel() for name, values in with_units(self, units).items()}
        obstacles = self.min_distance.shape[2]
        return found | each("min_distance_{}", self.min_distance.reshape(-1, obstacles), "m")

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
        runs = len(arrived)

        def successful(values: Array) -> Mean:
            return mean_interval(values[row][arrived])

        return Standing(
            law=law,
            success=wilson(int(arrived.sum()), runs),
            contact=wilson(int((self.outcome[row] == "collided").sum()), runs),
            moving_contact=wilson(int((self.moving_contacts[row] > 0).sum()), runs),
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
        rows = [self._row("first", first), self._row("second", second)]
        one, other = getattr(self, metric)[rows]
        used = np.isfinite(one) & np.isfinite(other)
        if metric in ("arrival_time", "energy", "path_length"):
            used &= (self.outcome[rows] == "arrived").all(axis=0)
        return mean_interval(one[used] - other[used])

    def contacts_compared(self, first: str, second: str) -> Paired:
        """Compare the contacts of two laws in the same episodes by the exact McNemar test.

        Parameters
        ----------
        first, second : str
            Names of the laws.

        Returns
        -------
        Paired
            Episodes in which just one of them touched something, and the p value.

        Raises
        ------
        InvalidParameterError
            If there is no such law.
        """
        touched = self.outcome == "collided"
        return compare_paired(touched[self._row("first", first)], touched[self._row("second", second)])

    def _row(self, argument: str, law: str) -> int:
        word(argument, law, self.laws)
        return self.laws.index(law)


def arena(
    laws: Mapping[str, AnyLaw],
    scenarios: Mapping[str, Scenario] | Sequence[Scenario],
    *,
    seeds: Sequence[int] | None = None,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> ArenaResult:
    """Run every law in every scenario with every seed.

    Parameters
    ----------
    laws : mapping of str to law
        The laws by the names under which they appear, those of the package and laws of your own
        (`PythonLaw`).
    scenarios : mapping of str to Scenario, or sequence of Scenario
        Where; without names they are numbered.
    seeds : sequence of int or None
        Seeds for noise and for planners that draw; each scenario is run with each of them.
        ``None``: with the scenario's own.
    weights, integrator, step, hold
        As for `simulate_batch`.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit of the result.
    progress : callable or None
        Called with (laws done, laws in all).

    Returns
    -------
    ArenaResult
        Every run, comparable episode by episode.

    Raises
    ------
    InvalidParameterError
        If there is no law, no scenario or no seed, or one is not valid.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> result = nav.arena(
    ...     {"field": nav.VirtualForceField(), "without detour": nav.VirtualForceField(detour_gain=0.0)},
    ...     {"c1": scenarios.configuration("c1")},
    ... )
    >>> result.outcome[:, 0].tolist()
    ['arrived', 'arrived']
    """
    if not isinstance(laws, Mapping) or not laws:
        raise InvalidParameterError("laws", "be a mapping of names to laws that is not empty", laws)
    for name in laws:
        instance("laws", name, str)
    wrapped = {name: as_law(law, f"laws[{name!r}]") for name, law in laws.items()}
    callback("progress", progress)
    names, episodes, index = _episodes(scenarios, seeds)
    tables = []
    for done, law in enumerate(wrapped.values(), start=1):
        tables.append(
            simulate_batch(episodes, law, weights=weights, integrator=integrator, step=step, hold=hold, threads=threads)
        )
        if progress is not None:
            progress(done, len(laws))
    return ArenaResult(
        laws=tuple(laws),
        scenario=index,
        seed=np.array([episode.seed for episode in episodes], dtype=np.uint64),
        scenario_names=names,
        outcome=np.stack([table.outcome for table in tables]),
        arrival_time=np.stack([table.arrival_time for table in tables]),
        energy=np.stack([table.energy for table in tables]),
        path_length=np.stack([table.path_length for table in tables]),
        min_clearance=np.stack([table.min_clearance for table in tables]),
        min_distance=np.stack([table.min_distance for table in tables]),
        moving_contacts=np.stack([table.contacts_moving for table in tables]),
        performance_total=np.stack([table.performance_total for table in tables]),
        _ran=(tuple(episodes[k] for k in np.unique(index, return_index=True)[1]), tuple(wrapped.values())),
    )


def _episodes(
    scenarios: Mapping[str, Scenario] | Sequence[Scenario], seeds: Sequence[int] | None
) -> tuple[tuple[str, ...], list[Scenario], npt.NDArray[np.int64]]:
    """Return names, every scenario with every seed, and which scenario each of them is."""
    if isinstance(scenarios, Mapping):
        named = dict(scenarios)
    else:
        listed = sequence("scenarios", "be a mapping of names to scenarios or a sequence of Scenario", scenarios)
        named = {str(k): each for k, each in enumerate(listed)}
    if not named:
        raise InvalidParameterError("scenarios", "hold at least one scenario", scenarios)
    for name, scenario in named.items():
        instance(f"scenarios[{name!r}]", scenario, Scenario)
    if seeds is None:
        return tuple(named), list(named.values()), np.arange(len(named))
    given = sequence("seeds", "be a sequence of integers or None", seeds)
    drawn = [checked_seed(f"seeds[{k}]", seed) for k, seed in enumerate(given)]
    if not drawn:
        raise InvalidParameterError("seeds", "hold at least one seed, or be None", seeds)
    episodes = [replace(scenario, seed=seed) for scenario in named.values() for seed in drawn]
    return tuple(named), episodes, np.repeat(np.arange(len(named)), len(drawn))


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
        # The work is done by a thread of its own: the time of the process counts.
        best = min(best, (time.process_time_ns() - start) / 1e9 / int(table.force_evaluations[0]))
    return best
