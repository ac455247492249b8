"""Which mode of the stabilizing force to use: a rule, applied to paired runs."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from hrsafety._records import dataclass
from hrsafety.navigation.metrics import compare_paired

__all__ = ["BASELINE", "Outcomes", "Ranking", "rank"]

BASELINE = "off"
"""The mode that the others must not be worse than."""
# Differences that chance alone gives once in twenty comparisons are no differences.
SIGNIFICANCE = 0.05

Name = TypeVar("Name", bound=Hashable)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
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
class Ranking:
    """The mode to use, and how it was found.

    Attributes
    ----------
    gains, side : str
        Which laws were compared: gain set, and rule for the side of a detour.
    recommended : str
        The mode that all four steps leave.
    pooled_only : str
        The mode that is left without the first step.
    steps : tuple of str
        One sentence for each step.
    """

    gains: str
    side: str
    recommended: str
    pooled_only: str
    steps: tuple[str, ...]


def rank(experiments: Mapping[str, Mapping[str, Outcomes]], *, gains: str, side: str) -> Ranking:
    """Choose a mode: harmless everywhere, then fewest contacts, most arrivals, highest score.

    1. A mode is out if in any experiment it has significantly more runs with a contact than
       the baseline (exact McNemar test, Holm-corrected over all modes and experiments).
    2. Over all runs together, modes stay that chance cannot tell from the one with the fewest
       runs with a contact.
    3. The same for runs without arrival.
    4. The highest mean score decides.
    """
    names = list(next(iter(experiments.values())))
    contact = {mode: _joined(experiments, mode, "contact") for mode in names}
    astray = {mode: ~_joined(experiments, mode, "arrived") for mode in names}
    score = {mode: float(np.mean(_joined(experiments, mode, "score"))) for mode in names}
    harmless, first = _harmless(experiments, names)
    recommended, later = _best(harmless, contact, astray, score)
    pooled_only, _ = _best(names, contact, astray, score)
    return Ranking(gains=gains, side=side, recommended=recommended, pooled_only=pooled_only, steps=(first, *later))


def _joined(experiments: Mapping[str, Mapping[str, Outcomes]], mode: str, column: str) -> npt.NDArray[np.bool_]:
    """Return one column of a mode over all experiments, end to end."""
    return np.concatenate([getattr(modes[mode], column) for modes in experiments.values()])


def _significant(p_values: Mapping[Name, float]) -> set[Name]:
    """Return what is significant after Holm: the smallest p value must pass the hardest test."""
    found: set[Name] = set()
    for position, name in enumerate(sorted(p_values, key=lambda name: p_values[name])):
        if p_values[name] * (len(p_values) - position) >= SIGNIFICANCE:
            break
        found.add(name)
    return found


def _harmless(experiments: Mapping[str, Mapping[str, Outcomes]], names: Sequence[str]) -> tuple[list[str], str]:
    """Return the modes that are nowhere worse than the baseline, and the sentence about them."""
    p_values: dict[tuple[str, str], float] = {}
    counts: dict[tuple[str, str], str] = {}
    for experiment, modes in experiments.items():
        for mode in names:
            paired = compare_paired(modes[mode].contact, modes[BASELINE].contact)
            if mode != BASELINE:
                p_values[mode, experiment] = paired.p_value if paired.only_first > paired.only_second else 1.0
                counts[mode, experiment] = f"{modes[mode].contact.sum()} against {modes[BASELINE].contact.sum()}"
    worse = _significant(p_values)
    harmless = [mode for mode in names if not any(mode == other for other, _ in worse)]
    listed = [
        f"{mode} in {experiment} ({counts[mode, experiment]})"
        for mode, experiment in p_values
        if (mode, experiment) in worse
    ]
    found = "; ".join(listed) if listed else "no mode anywhere"
    return harmless, f"Significantly more runs with a contact than {BASELINE}: {found}. Left: {'; '.join(harmless)}."


def _best(
    names: Sequence[str],
    contact: Mapping[str, npt.NDArray[np.bool_]],
    astray: Mapping[str, npt.NDArray[np.bool_]],
    score: Mapping[str, float],
) -> tuple[str, tuple[str, str, str]]:
    """Return the best of some modes over all runs together, and the three sentences about it."""
    left, first = _not_worse(names, contact, "with a contact")
    left, second = _not_worse(left, astray, "without arrival")
    best = max(left, key=lambda mode: score[mode])
    listed = "; ".join(f"{mode} {score[mode]:.3f}" for mode in left)
    return best, (first, second, f"Mean H: {listed}. Highest: {best}.")


def _not_worse(names: Sequence[str], bad: Mapping[str, npt.NDArray[np.bool_]], what: str) -> tuple[list[str], str]:
    """Return the modes that chance cannot tell from the one with the fewest bad runs."""
    counts = {name: int(bad[name].sum()) for name in names}
    best = min(counts, key=lambda name: counts[name])
    p_values = {name: compare_paired(bad[name], bad[best]).p_value for name in names if name != best}
    worse = _significant(p_values)
    left = [name for name in names if name not in worse]
    listed = "; ".join(
        f"{name} {count}" + ("" if name == best else f" (p = {p_values[name]:.2g})") for name, count in counts.items()
    )
    return left, f"Runs {what}, of {len(bad[best])}: {listed}. Left: {'; '.join(left)}."
