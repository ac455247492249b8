"""Evidence for the default of the stabilizing force: off, capped and full side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.reproduce.measured import GAIN_SETS
from hrsafety.reproduce.statistics import Paired, Share, compare_paired, wilson

__all__ = ["MODES", "Aggregate", "Outcomes", "Ranking", "Study", "compare"]

MODES: Mapping[str, Mapping[str, Any]] = {
    "off": {"stabilizing": "off"},
    "capped, 10 N": {"stabilizing": "capped", "stabilizing_force_cap": 10.0},
    "capped, 0.1 m|V|/T_s": {"stabilizing": "capped", "stabilizing_momentum_cap": 0.1},
    "full": {"stabilizing": "full"},
}
"""Compared modes: name to the parameters of `hrsafety.navigation.VirtualForceField`."""

CONFIGURATIONS = ("c1", "c2", "c3", "c4")
NOISE_SEEDS = 200
NOISE_SCALE = 0.025
CROWD_SEEDS = 500
CROWD_SIZES = (3, 12)
# Differences of fewer runs than chance gives once in twenty are no differences.
SIGNIFICANCE = 0.05


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Runs of one mode, in the order of the scenarios.

    Attributes
    ----------
    outcome : ndarray of str, shape (n,)
        How they ended.
    moving, standing, arrived : ndarray of bool, shape (n,)
        Whether the moving robot touched anything, the standing robot did, the goal was reached.
    time, score, clearance, descent : ndarray, shape (n,)
        Arrival time in s, H, least clearance in m, share of periods with V not growing.
    distance : ndarray, shape (n, m)
        Least distance to each obstacle in m.
    """

    outcome: npt.NDArray[np.str_]
    moving: npt.NDArray[np.bool_]
    standing: npt.NDArray[np.bool_]
    arrived: npt.NDArray[np.bool_]
    time: npt.NDArray[np.float64]
    score: npt.NDArray[np.float64]
    clearance: npt.NDArray[np.float64]
    descent: npt.NDArray[np.float64]
    distance: npt.NDArray[np.float64]

    @property
    def contact(self) -> npt.NDArray[np.bool_]:
        """Whether anything was touched, shape (n,)."""
        return self.moving | self.standing


@dataclass(frozen=True, kw_only=True, slots=True)
class Aggregate:
    """What one mode did in one experiment.

    Attributes
    ----------
    experiment, gains, mode : str
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

    experiment: str
    gains: str
    mode: str
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
class Ranking:
    """The modes in the order of merit, and how it was found.

    Attributes
    ----------
    recommended : str
        Mode with the fewest contacts; among those that chance cannot tell from it, the one
        with most arrivals; among those again, the one with the highest mean score.
    steps : tuple of str
        One sentence for each of the three steps.
    """

    recommended: str
    steps: tuple[str, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class Study:
    """All comparisons.

    Attributes
    ----------
    aggregates : tuple of Aggregate
        One for each experiment, gain set and mode.
    rankings : dict of str to Ranking
        For each gain set, and for both together (``"both gain sets"``).
    runs : dict of str to dict
        Runs of each experiment, by gain set and mode.
    """

    aggregates: tuple[Aggregate, ...]
    rankings: dict[str, Ranking]
    runs: dict[str, dict[str, dict[str, Outcomes]]]

    @property
    def recommended(self) -> str:
        """Mode that all runs together recommend."""
        return self.rankings["both gain sets"].recommended


def compare(progress: Callable[[str], object] | None = None) -> Study:
    """Run every mode in every experiment, with common random numbers, and rank the modes.

    The experiments are the configurations c1 to c4 as they are; the same with 200 seeds of
    measurement noise (uniform, +-0.025 m, sampled each control period, velocities by backward
    difference) of the moving obstacles, and of robot and obstacles; and 500 crowds each of 3
    and 12 walking people. The ranking is over all runs with noise or crowds.

    Parameters
    ----------
    progress : callable or None
        Called with a line of text when an experiment begins.

    Returns
    -------
    Study
        Aggregates and recommended mode.
    """
    aggregates: list[Aggregate] = []
    runs: dict[str, dict[str, dict[str, Outcomes]]] = {}
    pooled: dict[str, dict[str, list[Outcomes]]] = {name: {mode: [] for mode in MODES} for name in GAIN_SETS}
    for experiment, places in _experiments():
        if progress is not None:
            progress(f"stabilizing: {experiment}, {len(places)} runs x {len(GAIN_SETS)} gain sets x {len(MODES)} modes")
        outcomes = runs[experiment] = _run(places)
        for name, modes in outcomes.items():
            aggregates += [_aggregate(experiment, name, mode, modes) for mode in MODES]
            if len(places) > 1:
                for mode, outcome in modes.items():
                    pooled[name][mode].append(outcome)
    joined = {name: {mode: _joined(parts) for mode, parts in modes.items()} for name, modes in pooled.items()}
    rankings = {name: _rank(modes) for name, modes in joined.items()}
    both = {mode: _joined([modes[mode] for modes in joined.values()]) for mode in MODES}
    rankings["both gain sets"] = _rank(both)
    return Study(aggregates=tuple(aggregates), rankings=rankings, runs=runs)


def _experiments() -> list[tuple[str, list[nav.Scenario]]]:
    """Return the experiments: name and scenarios."""
    plain = {name: scenarios.configuration(name) for name in CONFIGURATIONS}
    experiments = [(name, [scenario]) for name, scenario in plain.items()]
    for name, of, words in (
        *((name, "obstacles", "noisy people") for name in ("c2", "c4")),
        *((name, "both", "noisy people and robot") for name in CONFIGURATIONS),
    ):
        noise = nav.Measurement(scale=NOISE_SCALE, distribution="uniform", of=of)  # type: ignore[arg-type]  # literals above
        seeds = [replace(plain[name], measurement=noise, seed=seed) for seed in range(NOISE_SEEDS)]
        experiments.append((f"{name}, {words}", seeds))
    for people in CROWD_SIZES:
        crowds = [scenarios.random_crowd(people, seed=seed) for seed in range(CROWD_SEEDS)]
        experiments.append((f"crowds of {people}", crowds))
    return experiments


def _run(places: Sequence[nav.Scenario]) -> dict[str, dict[str, Outcomes]]:
    """Run all gain sets and modes; return outcomes by gain set and mode."""
    outcomes: dict[str, dict[str, Outcomes]] = {name: {} for name in GAIN_SETS}
    for mode, options in MODES.items():
        law = nav.VirtualForceField(**options)
        summary = nav.simulate_batch(places, law, np.array(list(GAIN_SETS.values())), descent=True)
        for index, name in enumerate(GAIN_SETS):
            rows = slice(index * len(places), (index + 1) * len(places))
            outcomes[name][mode] = Outcomes(
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
    return outcomes


def _aggregate(experiment: str, gains: str, mode: str, modes: Mapping[str, Outcomes]) -> Aggregate:
    own = modes[mode]
    runs = len(own.arrived)
    times = own.time[own.arrived]
    low, median = np.quantile(own.clearance, (0.05, 0.5)).tolist()
    single = own.distance[0][np.isfinite(own.distance[0])] if runs == 1 else np.empty(0)
    return Aggregate(
        experiment=experiment,
        gains=gains,
        mode=mode,
        contacts_moving=wilson(int(own.moving.sum()), runs),
        contacts_standing=wilson(int(own.standing.sum()), runs),
        contacts=wilson(int(own.contact.sum()), runs),
        arrivals=wilson(int(own.arrived.sum()), runs),
        median_arrival_time=float(np.median(times)) if len(times) else math.nan,
        mean_score=float(own.score.mean()),
        clearance_low=low,
        clearance_median=median,
        descent_share=float(np.nanmean(own.descent)) if np.isfinite(own.descent).any() else math.nan,
        min_distances=tuple(single.tolist()),
        against_off=compare_paired(own.contact, modes["off"].contact),
    )


def _joined(parts: Sequence[Outcomes]) -> Outcomes:
    """Return the outcomes of several experiments, end to end; distances are not carried."""
    names = ("outcome", "moving", "standing", "arrived", "time", "score", "clearance", "descent")
    columns = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    return Outcomes(**columns, distance=np.empty((0, 0)))


def _rank(modes: Mapping[str, Outcomes]) -> Ranking:
    """Order the modes: fewest contacts, then most arrivals, then highest mean score."""
    left, first = _not_worse(modes, list(MODES), {mode: own.contact for mode, own in modes.items()}, "a contact")
    left, second = _not_worse(modes, left, {mode: ~own.arrived for mode, own in modes.items()}, "no arrival")
    scores = {mode: float(modes[mode].score.mean()) for mode in left}
    best = max(scores, key=lambda mode: scores[mode])
    listed = ", ".join(f"{mode} {score:.3f}" for mode, score in scores.items())
    return Ranking(recommended=best, steps=(first, second, f"Mean H: {listed}. Highest: {best}."))


def _not_worse(
    modes: Mapping[str, Outcomes], names: Sequence[str], bad: Mapping[str, npt.NDArray[np.bool_]], what: str
) -> tuple[list[str], str]:
    """Return the modes that chance cannot tell from the one with the fewest bad runs."""
    counts = {name: int(bad[name].sum()) for name in names}
    best = min(counts, key=lambda name: counts[name])
    p_values = {name: compare_paired(bad[name], bad[best]).p_value for name in names if name != best}
    # Holm: the smallest p value must pass the hardest test; the first that fails ends it.
    worse: set[str] = set()
    for rank, name in enumerate(sorted(p_values, key=lambda name: p_values[name])):
        if p_values[name] * (len(p_values) - rank) >= SIGNIFICANCE:
            break
        worse.add(name)
    left = [name for name in names if name not in worse]
    runs = len(modes[best].arrived)
    listed = ", ".join(
        f"{name} {count}" + ("" if name == best else f" (p = {p_values[name]:.2g})") for name, count in counts.items()
    )
    return left, f"Runs of {runs} with {what}: {listed}. Not worse than {best} beyond chance: {', '.join(left)}."
