"""Runs that make appendix C again: one gain changed at a time, and the search for the best gains."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._records import dataclass
from hrsafety.reproduce.measured import GAIN_SETS, MeasuredRun, kind_of

__all__ = ["CHANGES_PERCENT", "CONFIGURATIONS", "GAIN_TABLES", "GainRuns", "gain_runs"]

CONFIGURATIONS = ("c1", "c2", "c3")
"""Configurations of appendix C."""
CHANGES_PERCENT = (-50.0, -20.0, -10.0, -5.0, -2.0, 0.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
"""Changes of one gain at a time in Tables C.2 to C.9; they have the gain at zero in words."""
GAIN_TABLES: Mapping[str, tuple[str, str]] = {
    "K_1": ("C.2", "C.3"),
    "K_3": ("C.4", "C.5"),
    "K_5": ("C.6", "C.7"),
    "b": ("C.8", "C.9"),
}
"""Gain to its table of T, L, d and its table of scores, in the order of the gain sets."""

Array = npt.NDArray[np.float64]
GAIN_AT_ZERO = -100.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class GainRuns:
    """Results that the tables and claims of appendix C are compared with.

    Attributes
    ----------
    changed : GainSensitivity
        The printed optimum with one gain changed by `CHANGES_PERCENT`.
    zero : GainSensitivity
        The same with one gain at zero.
    nominal_time, nominal_energy : ndarray, shape (4, changes)
        T* in s and L* in J of each gain set of ``changed``, without obstacles.
    search : GainSearch
        The search of appendix C.2 with its settings.
    flatness : Flatness
        The mean H along each gain through what it found.
    """

    changed: nav.gains.GainSensitivity
    zero: nav.gains.GainSensitivity
    nominal_time: Array
    nominal_energy: Array
    search: nav.GainSearch
    flatness: nav.gains.Flatness

    def measured(self, gain: int, change: int) -> list[MeasuredRun]:
        """Return the runs of one gain set under the names of the tables, one for each configuration."""
        nominal = (float(self.nominal_time[gain, change]), float(self.nominal_energy[gain, change]))
        return _measured(self.changed, gain, change, nominal)

    def at_zero(self, gain: int) -> list[MeasuredRun]:
        """Return the runs with one gain at zero, one for each configuration, without T* and L*."""
        return _measured(self.zero, gain, 0, (math.nan, math.nan))


def _measured(
    table: nav.gains.GainSensitivity, gain: int, change: int, nominal: tuple[float, float]
) -> list[MeasuredRun]:
    """Return one row of a sensitivity under the names of the tables."""
    rows = []
    for place, scenario in enumerate(table.scenarios):
        cell = (gain, change, place)
        time = float(table.arrival_time[cell])
        values = {"T_arrive": time, "L_energy": float(table.energy[cell]), "H": float(table.performance[cell])}
        for obstacle, distance in zip(scenario.obstacles, table.min_distance[cell].tolist(), strict=False):
            values[f"d_{kind_of(obstacle)}_min"] = distance
        rows.append(
            MeasuredRun(
                values=values,
                arrived=math.isfinite(time),
                contact=str(table.outcome[cell]) == "collided",
                nominal_time=nominal[0],
                nominal_energy=nominal[1],
                scenario=scenario,
            )
        )
    return rows


@cache
def gain_runs() -> GainRuns:
    """Run everything that appendix C is compared with, once in a process."""
    places = [scenarios.configuration(name) for name in CONFIGURATIONS]
    attraction, repulsion, detour, ratio = GAIN_SETS["new_vff_optimised"]
    law = nav.VirtualForceField(
        attractive_gain=attraction,
        repulsive_gain=repulsion,
        detour_gain=detour,
        gain_ratio=ratio,
        stabilizing="off",
    )
    changed = nav.gain_sensitivity(places, law, CHANGES_PERCENT)
    # All three share start and goal, hence the run without obstacles.
    free = nav.simulate_batch([replace(places[0], obstacles=())], law, changed.gains.reshape(-1, len(law.gains)))
    search = nav.optimize_gains(places, law)
    return GainRuns(
        changed=changed,
        zero=nav.gain_sensitivity(places, law, (GAIN_AT_ZERO,)),
        nominal_time=free.arrival_time.reshape(changed.mean_performance.shape),
        nominal_energy=free.energy.reshape(changed.mean_performance.shape),
        search=search,
        flatness=search.flatness(),
    )
