"""Runs of both robots as built, for the rows of chapters 6 and 7 that need them."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._records import dataclass
from hrsafety.navigation.metrics import Share
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.reproduce.measured import LAWS, MeasuredRun, kind_of, score_of_parts

__all__ = ["EXPERIMENTS", "SEEDS", "NoisyRuns", "as_built", "experiment", "repeated", "scene", "score", "two_wheels"]

SEEDS = 200
"""Noisy runs of each experiment."""
LAW = LAWS["new_vff"]
_FACING_THE_GOAL = math.pi  # the source does not say where the robot looks at first

EXPERIMENTS = {
    **{f"6.{number + 1}": f"c{number}" for number in range(1, 5)},
    **{f"7.{number}": f"n{number}" for number in range(1, 5)},
}
"""Configuration of each table that has a row of an experiment."""


def scene(name: str) -> nav.Scenario:
    """Return a configuration with the robot of its chapter: two wheels for chapter 7."""
    scenario = scenarios.configuration(name)
    if name.startswith("c"):
        return scenario
    return replace(scenario, robot=nav.DifferentialDriveRobot(), heading=_FACING_THE_GOAL)


@functools.cache
def score(name: str) -> nav.Performance:
    """Return the run of a configuration with the two-wheel robot, ideal wheels and exact sensing."""
    return nav.evaluate(scene(name), LAW)


def two_wheels(name: str) -> MeasuredRun:
    """Return the numbers of `score` under the names of the tables."""
    result = score(name)
    run, free = result.trajectory, result.nominal
    distances = _by_kind(run.scenario, run.min_distance)
    return MeasuredRun(
        values={"T_arrive": run.arrival_time, "L_energy": run.energy, "H": result.total} | distances,
        arrived=math.isfinite(run.arrival_time),
        contact=run.outcome == "collided",
        nominal_time=free.arrival_time,
        nominal_energy=free.energy,
        scenario=run.scenario,
    )


def as_built(scenario: nav.Scenario) -> nav.robots.AsBuilt:
    """Return the robot of a scenario as the source describes it: wheels, and the camera's mean error."""
    holonomic = isinstance(scenario.robot, nav.HolonomicRobot)
    camera = nav.sensing.Vision(error=nav.sensing.PositionNoise(distribution="gaussian", scale=0.0032))
    return nav.robots.AsBuilt(
        wheels=nav.robots.HOLONOMIC_WHEELS if holonomic else nav.robots.DIFFERENTIAL_WHEELS,
        robot_vision=camera,
        obstacle_vision=camera,
    )


@functools.cache
def repeated(name: str, seeds: int = SEEDS) -> RunTable:
    """Return noisy runs of a configuration with the robot as built."""
    scenario = scene(name)
    return nav.simulate_many(scenario, LAW, seeds=seeds, built=as_built(scenario), paths=True)


@dataclass(frozen=True, kw_only=True, slots=True)
class NoisyRuns:
    """Noisy runs in the place of one experiment.

    Attributes
    ----------
    values : dict of str to float
        Medians over the runs that arrived without a contact, by column name of the tables; H of
        the medians.
    success, contact : Share
        Shares of all runs.
    """

    values: dict[str, float]
    success: Share
    contact: Share


@functools.cache
def experiment(table: str) -> NoisyRuns:
    """Return the noisy runs in the place of the experiment of a table."""
    runs = repeated(EXPERIMENTS[table])
    (scenario,) = runs.scenarios
    free = nav.evaluate(scenario, LAW, built=as_built(scenario)).nominal
    arrived = runs.outcome == "arrived"
    time, energy = float(np.median(runs.arrival_time[arrived])), float(np.median(runs.energy[arrived]))
    distances = _by_kind(scenario, np.median(runs.min_distance[arrived], axis=0))
    parts = MeasuredRun(
        values={},
        arrived=True,
        contact=False,
        nominal_time=free.arrival_time,
        nominal_energy=free.energy,
        scenario=scenario,
    )
    total = score_of_parts(parts, time=time, energy=energy, distances=distances)
    return NoisyRuns(
        values={"T_arrive": time, "L_energy": energy, "H": total} | distances,
        success=runs.success,
        contact=runs.contact,
    )


def _by_kind(scenario: nav.Scenario, least: np.ndarray) -> dict[str, float]:
    """Return least distances by the columns of the tables."""
    pairs = zip(scenario.obstacles, least.tolist(), strict=True)
    return {f"d_{kind_of(obstacle)}_min": distance for obstacle, distance in pairs}
