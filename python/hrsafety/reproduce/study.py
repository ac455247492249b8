"""Evidence for the default of the stabilizing force: off, capped and full side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal, NamedTuple

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._records import dataclass
from hrsafety.navigation.metrics import Paired, Share, compare_paired, wilson
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.reproduce.measured import GAIN_SETS
from hrsafety.reproduce.names import GAIN_LABELS
from hrsafety.reproduce.ranking import BASELINE, Outcomes, Ranking, rank

__all__ = ["MODES", "SIDES", "Aggregate", "Key", "LawComparisons", "compare"]

MODES: Mapping[str, Mapping[str, Any]] = {
    BASELINE: {"stabilizing": "off"},
    "capped, 10 N": {"stabilizing": "capped", "stabilizing_force_cap": 10.0},
    "capped, 0.1 m|V|/T_s": {"stabilizing": "capped", "stabilizing_momentum_cap": 0.1},
    "full": {"stabilizing": "full"},
}
"""Compared modes: name to the parameters of `hrsafety.navigation.VirtualForceField`."""
SIDES: Mapping[str, float | None] = {"decided afresh": None, "kept beyond 3 rad": 3.0}
"""Rules for the side of a detour: name to ``side_hysteresis`` in rad; the first is the default."""

CONFIGURATIONS = ("c1", "c2", "c3", "c4")
WITH_PEOPLE = ("c2", "c4")
NOISE_SEEDS = 200
NOISE_SCALE = 0.025
# Gaussian error with the mean error of 4 mm that the source's camera had.
CAMERA_SCALE = 0.0032
CROWD_SEEDS = 500
CROWD_SIZES = (3, 12)


class Key(NamedTuple):
    """Key of a run: experiment, rule for the side, gain set, mode."""

    experiment: str
    side: str
    gains: str
    mode: str


class _Experiment(NamedTuple):
    """Scenarios under a name; some are shown but do not enter the ranking."""

    name: str
    places: list[nav.Scenario]
    ranked: bool


@dataclass(frozen=True, kw_only=True, slots=True)
class Aggregate:
    """Results of one mode in one experiment.

    Attributes
    ----------
    key : Key
        Which.
    contacts_moving, contacts_standing, contacts, arrivals : Share
        Runs in which the moving robot, the standing robot or either touched something, and
        runs that reached the goal (after a contact too).
    median_arrival_time : float
        In s, over the runs that arrived.
    mean_score : float
        Mean of H; 0 after a contact or without arrival.
    clearance_low, clearance_median : float
        5 % quantile and median of the least clearance of a run, in m; negative is overlap.
    descent_share : float
        Mean share of the control periods over which the Lyapunov function did not grow.
    min_distances : tuple of float
        Least distance d to each obstacle in m, where the experiment is a single run.
    against_off : Paired
        Runs with a contact in this mode only, and with the force off only.
    """

    key: Key
    contacts_moving: Share
    contacts_standing: Share
    contacts: Share
    arrivals: Share
    median_arrival_time: float
    mean_score: float
    clearance_low: float
    clearance_median: float
    descent_share: float
    min_distances: tuple[float, ...]
    against_off: Paired


@dataclass(frozen=True, kw_only=True, slots=True)
class LawComparisons:
    """All comparisons.

    Attributes
    ----------
    aggregates : tuple of Aggregate
        One for each experiment, rule for the side, gain set and mode.
    rankings : tuple of Ranking
        For both gain sets together and each alone, for each rule for the side; first the one
        that decides.
    runs : dict of Key to Outcomes
        All runs.
    """

    aggregates: tuple[Aggregate, ...]
    rankings: tuple[Ranking, ...]
    runs: dict[Key, Outcomes]

    @property
    def recommended(self) -> str:
        """Mode recommended by both gain sets together, with the default rule for the side."""
        return self.rankings[0].recommended


def compare(progress: Callable[[str], object] | None = None) -> LawComparisons:
    """Run every mode in every experiment, with common random numbers, and rank the modes.

    The experiments: configurations c1 to c4 as they are; the same with 200 seeds of
    measurement noise (uniform, +-0.025 m, sampled each control period, velocities by backward
    difference) of the moving obstacles, and of robot and moving obstacles; 500 crowds each of 3
    and 12 walking people. They decide by `hrsafety.reproduce.ranking.rank`. Shown beside them
    are c1 to c4 with the milder noise of a camera, and all of it with the side of a detour kept.
    """
    runs: dict[Key, Outcomes] = {}
    ranked: list[str] = []
    for experiment in _experiments():
        if progress is not None:
            laws = len(SIDES) * len(GAIN_SETS) * len(MODES)
            progress(f"stabilizing: {experiment.name}, {len(experiment.places)} scenarios x {laws} laws")
        runs |= _run(experiment)
        ranked += [experiment.name] if experiment.ranked else []
    aggregates = tuple(_aggregate(key, runs) for key in runs)
    return LawComparisons(aggregates=aggregates, rankings=tuple(_rankings(runs, ranked)), runs=runs)


def _experiments() -> Iterator[_Experiment]:
    plain = {name: scenarios.configuration(name) for name in CONFIGURATIONS}
    for name, scenario in plain.items():
        yield _Experiment(name, [scenario], ranked=False)
    uniform = f"noise +-{NOISE_SCALE} m"
    for name in WITH_PEOPLE:
        yield _noisy(f"{name}, {uniform}, people", plain[name], "uniform", NOISE_SCALE, "obstacles")
    for name, scenario in plain.items():
        yield _noisy(f"{name}, {uniform}, people and robot", scenario, "uniform", NOISE_SCALE, "both")
    for name, scenario in plain.items():
        camera = _noisy(f"{name}, camera noise, people and robot", scenario, "gaussian", CAMERA_SCALE, "both")
        yield camera._replace(ranked=False)
    for people in CROWD_SIZES:
        crowds = [scenarios.random_crowd(people, seed=seed) for seed in range(CROWD_SEEDS)]
        yield _Experiment(f"crowds of {people}", crowds, ranked=True)


def _noisy(
    name: str,
    scenario: nav.Scenario,
    distribution: Literal["uniform", "gaussian"],
    scale: float,
    of: Literal["obstacles", "both"],
) -> _Experiment:
    noise = nav.Measurement(scale=scale, distribution=distribution, of=of)
    places = [replace(scenario, measurement=noise, seed=seed) for seed in range(NOISE_SEEDS)]
    return _Experiment(name, places, ranked=True)


def _run(experiment: _Experiment) -> dict[Key, Outcomes]:
    """Run all rules for the side, gain sets and modes; return them in this order."""
    count = len(experiment.places)
    runs: dict[Key, Outcomes] = {}
    for side, angle in SIDES.items():
        for mode, options in MODES.items():
            law = nav.VirtualForceField(**options, side_hysteresis=angle)
            summary = nav.simulate_batch(experiment.places, law, np.array(list(GAIN_SETS.values())), descent=True)
            for index, gains in enumerate(GAIN_SETS):
                rows = slice(index * count, (index + 1) * count)
                runs[Key(experiment.name, side, gains, mode)] = _outcomes(summary, rows)
    ordered = [(side, gains, mode) for side in SIDES for gains in GAIN_SETS for mode in MODES]
    return {key: runs[key] for key in (Key(experiment.name, *names) for names in ordered)}


def _outcomes(summary: RunTable, rows: slice) -> Outcomes:
    return Outcomes(
        outcome=summary.outcome[rows],
        moving=summary.contacts_moving[rows] > 0,
        standing=summary.contacts_standing[rows] > 0,
        arrived=np.isfinite(summary.arrival_time[rows]),
        time=summary.arrival_time[rows],
        score=summary.performance_total[rows],
        clearance=summary.min_clearance[rows],
        descent=summary.descent_share[rows],
        distance=summary.min_distance[rows],
    )


def _aggregate(key: Key, runs: Mapping[Key, Outcomes]) -> Aggregate:
    own = runs[key]
    count = len(own.arrived)
    times = own.time[own.arrived]
    low, median = np.quantile(own.clearance, (0.05, 0.5)).tolist()
    single = own.distance[0][np.isfinite(own.distance[0])] if count == 1 else np.empty(0)
    return Aggregate(
        key=key,
        contacts_moving=wilson(int(own.moving.sum()), count),
        contacts_standing=wilson(int(own.standing.sum()), count),
        contacts=wilson(int(own.contact.sum()), count),
        arrivals=wilson(int(own.arrived.sum()), count),
        median_arrival_time=float(np.median(times)) if len(times) else math.nan,
        mean_score=float(own.score.mean()),
        clearance_low=low,
        clearance_median=median,
        descent_share=float(np.nanmean(own.descent)) if np.isfinite(own.descent).any() else math.nan,
        min_distances=tuple(single.tolist()),
        against_off=compare_paired(own.contact, runs[key._replace(mode=BASELINE)].contact),
    )


def _rankings(runs: Mapping[Key, Outcomes], ranked: Sequence[str]) -> Iterator[Ranking]:
    """Rank the modes for each rule for the side: both gain sets together, then each alone."""
    for side in SIDES:
        by_gains = {
            gains: {
                f"{experiment}, {GAIN_LABELS[gains]}": {
                    mode: runs[Key(experiment, side, gains, mode)] for mode in MODES
                }
                for experiment in ranked
            }
            for gains in GAIN_SETS
        }
        together = {name: modes for experiments in by_gains.values() for name, modes in experiments.items()}
        yield rank(together, gains="both gain sets", side=side)
        for gains, experiments in by_gains.items():
            yield rank(experiments, gains=GAIN_LABELS[gains], side=side)
