"""Runs of the laws under the published configurations, under the names of the tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._records import dataclass
from hrsafety.navigation.tables.runs import RunTable

__all__ = ["GAIN_SETS", "LAWS", "MeasuredRun", "kind_of", "measure", "measure_laws", "score_of_parts"]

Gains = tuple[float, float, float, float]

GAIN_SETS: Mapping[str, Gains] = {
    "new_vff": (3.0, 20.0, 17.0, 0.25),
    "new_vff_optimised": (4.3, 20.3, 240.7, 0.68),
}
"""K_1, K_3, K_5, b of the rows "New VFF" and "New VFF*" of the tables."""


def _field(gains: Gains) -> nav.VirtualForceField:
    """Return the new field as the tables have it: without the stabilizing force."""
    attractive, repulsive, detour, ratio = gains
    return nav.VirtualForceField(
        attractive_gain=attractive,
        repulsive_gain=repulsive,
        detour_gain=detour,
        gain_ratio=ratio,
        stabilizing="off",
    )


LAWS: Mapping[str, nav.Law] = {name: _field(gains) for name, gains in GAIN_SETS.items()} | {
    "masoud": nav.Masoud(),
    "ge_cui": nav.GeCui(),
}
"""Laws of the rows of the tables, with the printed gains."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MeasuredRun:
    """Result of one run.

    Attributes
    ----------
    values : dict of str to float
        By column name of the tables: ``T_arrive`` in s (NaN without arrival), ``L_energy`` in
        J, ``d_circle_min``, ``d_human_min``, ``d_rectangle_min`` in m, ``H``.
    arrived, contact : bool
        Whether the goal was reached, and whether anything was touched.
    nominal_time, nominal_energy : float
        T* in s and L* in J of the same law without obstacles.
    scenario : Scenario
        Where.
    """

    values: dict[str, float]
    arrived: bool
    contact: bool
    nominal_time: float
    nominal_energy: float
    scenario: nav.Scenario

    @property
    def outcome(self) -> str:
        """Outcome in the words of the published tables."""
        if self.contact:
            return "contact"
        return "arrival, no contact" if self.arrived else "no arrival, no contact"


def measure(names: Sequence[str], gains: Iterable[Gains]) -> list[list[MeasuredRun]]:
    """Run every gain set in every configuration, stabilizing force off, in one batch."""
    places = [scenarios.configuration(name) for name in names]
    sets = np.array(list(gains), dtype=np.float64)
    summary = nav.simulate_batch(places, nav.VirtualForceField(stabilizing="off"), sets)
    rows = [_row(summary, index, places[index % len(places)]) for index in range(len(summary))]
    return [rows[begin : begin + len(places)] for begin in range(0, len(rows), len(places))]


def measure_laws(names: Sequence[str], methods: Iterable[str]) -> dict[str, list[MeasuredRun]]:
    """Run the law of each row of the tables in every configuration."""
    places = [scenarios.configuration(name) for name in names]
    runs = {}
    for method in methods:
        summary = nav.simulate_batch(places, LAWS[method])
        runs[method] = [_row(summary, index, place) for index, place in enumerate(places)]
    return runs


def _row(summary: RunTable, index: int, scenario: nav.Scenario) -> MeasuredRun:
    time = float(summary.arrival_time[index])
    energy = float(summary.energy[index])
    values = {"T_arrive": time, "L_energy": energy, "H": float(summary.performance_total[index])}
    for obstacle, distance in zip(scenario.obstacles, summary.min_distance[index].tolist(), strict=False):
        column = f"d_{kind_of(obstacle)}_min"
        values[column] = min(distance, values.get(column, math.inf))
    return MeasuredRun(
        values=values,
        arrived=math.isfinite(time),
        contact=bool(summary.contacts_moving[index] + summary.contacts_standing[index]),
        nominal_time=float(summary.performance_arrival_time[index]) * time,
        nominal_energy=float(summary.performance_energy_saving[index]) * energy,
        scenario=scenario,
    )


def kind_of(obstacle: nav.Obstacle) -> str:
    """Return the word that the tables have for an obstacle."""
    if isinstance(obstacle, nav.Human):
        return "human"
    return "rectangle" if isinstance(obstacle, nav.Rectangle) else "circle"


def score_of_parts(run: MeasuredRun, *, time: float, energy: float, distances: Mapping[str, float]) -> float:
    """Return the score H that given times, energies and distances would have.

    ``H = (T*/T + mean of min(d_s/d_s*, 1) + L*/L) / 3`` with the T* and L* of the run.
    """
    shares = []
    for obstacle in run.scenario.obstacles:
        size = run.scenario.robot.radius + getattr(obstacle, "radius", 0.0)
        active = getattr(obstacle, "active_radius", None)
        if active is not None:
            shares.append(min((distances[f"d_{kind_of(obstacle)}_min"] - size) / (active - size), 1.0))
    return (run.nominal_time / time + float(np.mean(shares)) + run.nominal_energy / energy) / 3.0
