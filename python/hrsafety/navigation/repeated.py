"""The same scenario with many seeds: how far runs spread, how many arrive, how many touch."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, checked_seed, count, flag, number, sequence
from hrsafety._bounds import MOST_SEEDS
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.batch import check_threads
from hrsafety.navigation.built import _checked
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.run_warnings import of_run
from hrsafety.navigation.scenario import Scenario
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, each, with_units

__all__ = ["Band", "Repeated", "repeat"]

# Stations of a band of paths along the straight way.
_STATIONS = 201


class Band(NamedTuple):
    """Where a share of the runs lies.

    Attributes
    ----------
    abscissa : ndarray, shape (k,)
        Time in s; for paths the progress along the straight way from start to goal, in m.
    low, middle, high : ndarray, shape (k,)
        Lower bound, median and upper bound, in m; NaN where no run is.
    runs : ndarray of int, shape (k,)
        Number of runs there: a run counts until it ends.
    """

    abscissa: Array
    low: Array
    middle: Array
    high: Array
    runs: npt.NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Repeated(Table):
    """Runs of one scenario with n seeds, k instants, m obstacles.

    The histories hold a row for every control period and one for the end of the run, and NaN
    after it.

    Attributes
    ----------
    scenario : Scenario
        What was simulated, but for the seed.
    law : Law
        The law that drove the robot.
    seed : ndarray of int, shape (n,)
        The seeds.
    outcome : ndarray of str, shape (n,)
        ``"arrived"``, ``"collided"``, ``"timed_out"`` or ``"stopped"``.
    arrival_time, end_time : ndarray, shape (n,)
        First entry into the tolerance circle (NaN without) and end of the run, in s.
    energy, path_length : ndarray, shape (n,)
        In J and m.
    min_distance : ndarray, shape (n, m)
        Least distance d to each obstacle in m.
    contact_time, contact_speed : ndarray, shape (n, m)
        First contact with each obstacle in s and the robot's speed then in m/s; NaN without.
    time : ndarray, shape (n, k)
        Instants in s.
    position : ndarray, shape (n, k, 2)
        True positions of the robot in m.
    distance : ndarray, shape (n, k, m)
        Distances d in m.
    """

    scenario: Scenario
    law: Law
    seed: npt.NDArray[np.uint64]
    outcome: npt.NDArray[np.str_]
    arrival_time: Array
    end_time: Array
    energy: Array
    path_length: Array
    min_distance: Array
    contact_time: Array
    contact_speed: Array
    time: Array
    position: Array
    distance: Array

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the runs may not mean what they seem to: the warnings of the scenario that matter for the law."""
        return of_run(self.scenario, self.law)

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.seed)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each run.

        Returns
        -------
        dict of str to ndarray
            Units are in the names, obstacles are numbered; the histories are not in it.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> runs = nav.metrics.repeat(scenarios.configuration("c1"), nav.VirtualForceField(), seeds=2)
        >>> list(runs.columns())[:3]
        ['seed', 'outcome', 'arrival_time_s']
        """
        units = {"seed": "", "outcome": "", "arrival_time": "s", "end_time": "s", "energy": "J", "path_length": "m"}
        found = with_units(self, units) | each("min_distance_{}", self.min_distance, "m")
        found |= each("contact_time_{}", self.contact_time, "s")
        return found | each("contact_speed_{}", self.contact_speed, "m/s")

    @property
    def success(self) -> Share:
        """Share of the runs that arrived without a contact, with its 95 % Wilson interval."""
        return wilson(int((self.outcome == "arrived").sum()), len(self))

    @property
    def contact(self) -> Share:
        """Share of the runs with a contact, with its 95 % Wilson interval."""
        return wilson(int((self.outcome == "collided").sum()), len(self))

    @property
    def goal_distance(self) -> Array:
        """Distance e to the goal in m, shape (n, k)."""
        away: Array = np.hypot(*np.moveaxis(self.position - np.asarray(self.scenario.goal), -1, 0))
        return away

    def goal_band(self, share: float = 0.9) -> Band:
        """Return where a share of the runs lies: distance e to the goal over time.

        Parameters
        ----------
        share : float
            Share between the bounds, above 0 and at most 1; 1 for the extremes.

        Returns
        -------
        Band
            e in m over time in s.

        Raises
        ------
        InvalidParameterError
            If the share is not above 0 and at most 1.
        """
        return self._over_time(self.goal_distance, share)

    def distance_band(self, obstacle: int, share: float = 0.9) -> Band:
        """Return where a share of the runs lies: distance d to an obstacle over time.

        Parameters
        ----------
        obstacle : int
            Index of the obstacle.
        share : float
            As for `goal_band`.

        Returns
        -------
        Band
            d in m over time in s.

        Raises
        ------
        InvalidParameterError
            If there is no such obstacle, or the share is not above 0 and at most 1.
        """
        if count("obstacle", obstacle, least=0) >= self.distance.shape[2]:
            raise InvalidParameterError("obstacle", f"be an integer below {self.distance.shape[2]}", obstacle)
        return self._over_time(self.distance[:, :, obstacle], share)

    def path_band(self, share: float = 0.9) -> Band:
        """Return where a share of the paths lies beside the straight way.

        The offset of a path, positive to the left, is taken where the robot passes a station
        for the first time.

        Parameters
        ----------
        share : float
            As for `goal_band`.

        Returns
        -------
        Band
            Offset in m over the progress along the straight way in m.

        Raises
        ------
        InvalidParameterError
            If the share is not above 0 and at most 1.
        """
        start, goal = np.asarray(self.scenario.start), np.asarray(self.scenario.goal)
        length = math.dist(start, goal)
        along = (goal - start) / length
        progress = (self.position - start) @ along
        offset = (self.position - start) @ np.array([-along[1], along[0]])
        # The first passage of a station is the passage by the furthest progress so far.
        reached = np.fmax.accumulate(progress, axis=1)
        stations = np.linspace(0.0, length, _STATIONS)
        rows = np.full((len(self), _STATIONS), np.nan)
        for run, (ahead, aside) in enumerate(zip(reached, offset, strict=True)):
            inside = np.isfinite(aside)
            first = np.concatenate(([True], np.diff(ahead[inside]) > 0.0))
            rows[run] = np.interp(stations, ahead[inside][first], aside[inside][first], right=np.nan)
        return _band(stations, rows, share)

    def _over_time(self, values: Array, share: float) -> Band:
        period = self.scenario.control_period
        grid: Array = period * np.arange(math.floor(float(self.end_time.max()) / period) + 1, dtype=np.float64)
        rows = np.full((len(self), len(grid)), np.nan)
        for run, (times, row) in enumerate(zip(self.time, values, strict=True)):
            inside = np.isfinite(times)
            rows[run] = np.interp(grid, times[inside], row[inside], right=np.nan)
        return _band(grid, rows, share)


def _band(abscissa: Array, rows: Array, share: float) -> Band:
    """Return bounds and median of the columns, over the runs that are there."""
    inside = number("share", share)
    if not 0.0 < inside <= 1.0:
        raise InvalidParameterError("share", "be above 0 and at most 1", share)
    runs = np.isfinite(rows).sum(axis=0)
    bounds = np.full((3, len(abscissa)), np.nan)
    there = runs > 0
    tail = 0.5 * (1.0 - inside)
    bounds[:, there] = np.nanquantile(rows[:, there], [tail, 0.5, 1.0 - tail], axis=0)
    low, middle, high = bounds
    return Band(abscissa, low, middle, high, runs)


def repeat(
    scenario: Scenario,
    law: AnyLaw,
    *,
    seeds: int | Iterable[int] = 100,
    built: AsBuilt | None = None,
    step: float = 0.01,
    stop_on_contact: bool = False,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Repeated:
    """Run a scenario with many seeds, on all cores.

    Everything but the seed of the noise stays the same. A scenario that measures exactly, with
    a law that draws no random numbers, gives the same run each time.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, measurement; its own seed is not used.
    law : Law, callable or object
        What drives the robot; see `PythonLaw` for laws of your own, which run on one thread.
    seeds : int or iterable of int
        The seeds, or their number: then 0, 1, 2 and so on.
    built : AsBuilt or None
        How the robot is built; ``AsBuilt()`` when ``None``.
    step, stop_on_contact
        As for `simulate_built`.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit of the result.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.

    Returns
    -------
    Repeated
        Runs in the order of the seeds, with bands and shares.

    Raises
    ------
    InvalidParameterError
        If there is no seed, one is not an integer from 0 to 2**64 - 1, or another argument is not
        valid.
    SimulationError
        If the state of a run became non-finite.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> noisy = replace(scenarios.configuration("c1"), measurement=nav.Measurement(of="robot"))
    >>> runs = nav.metrics.repeat(noisy, nav.VirtualForceField(), seeds=20)
    >>> len(runs), runs.success.runs
    (20, 20)
    """
    law, built = _checked(scenario, law, built)
    given = _seeds(seeds)
    check_threads(threads)
    fields = _hrsafety.built_repeat(
        scenario._native,
        law._native,
        built._native,
        given,
        step=number("step", step),
        stop_on_contact=flag("stop_on_contact", stop_on_contact),
        threads=threads,
        progress=callback("progress", progress),
    )
    return Repeated(scenario=scenario, law=law, seed=np.array(given, dtype=np.uint64), **fields)


def _seeds(seeds: int | Iterable[int]) -> list[int]:
    """Return the seeds as a list of integers, at least one."""
    if isinstance(seeds, (int, np.integer)):
        return list(range(count("seeds", seeds, most=MOST_SEEDS)))
    rule = "be a positive integer or hold integers from 0 to 2**64 - 1"
    # A range may be longer than memory.
    given = sequence("seeds", rule, itertools.islice(seeds, MOST_SEEDS + 1) if isinstance(seeds, range) else seeds)
    if len(given) > MOST_SEEDS:
        raise InvalidParameterError("seeds", f"hold at most {MOST_SEEDS} seeds", Shown("more"))
    checked = [checked_seed(f"seeds[{index}]", seed) for index, seed in enumerate(given)]
    if not checked:
        raise InvalidParameterError("seeds", "hold at least one seed", Shown("an empty list"))
    return checked
