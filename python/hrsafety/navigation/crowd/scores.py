"""Metrics of robots in worlds of people."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety._arguments import Array, instance
from hrsafety.navigation.crowd.agents import middle_of
from hrsafety.navigation.crowd.episodes import episodes_in
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.scores import WorldMetrics, evaluate_world

__all__ = ["episodes_of", "world_metrics"]


def _goals(run: WorldRun) -> Array:
    """Return where routes end, of lines the middles; of people without one their places, NaN of those from sources."""
    goals = np.full((len(run.obstacle_radius), 2), np.nan)
    for index, person in enumerate(run.scenario.people):
        goals[index] = middle_of(person.route[-1]) if person.route else person.start
    return goals


def _arrivals(run: WorldRun, people: int) -> Array:
    """Return instants and places at which the people of the world arrived, and so many rows."""
    rows = np.full((people, 3), np.nan)
    count = len(run.scenario.people)
    rows[:count] = np.column_stack([run.person_arrival_time, run.person_arrival_position])[:count]
    return rows


def _beside(run: WorldRun, without: WorldRun) -> dict[str, Any]:
    """Return the people of the world without its robots.

    Those from sources are not told apart: whom a robot kept out came later, with another number.
    """
    people, count = len(run.obstacle_radius), len(run.scenario.people)
    alone = np.full((len(without.time), people, 2), np.nan)
    alone[:, :count] = without.obstacle_position[:, :count]
    return {
        "people_without": alone,
        "person_goals": _goals(run),
        "person_arrivals": _arrivals(run, people),
        "person_arrivals_without": _arrivals(without, people),
    }


def episodes_of(run: WorldRun, without: WorldRun | None = None) -> list[Episode]:
    """Return what each robot of a world met, to be scored.

    Parameters
    ----------
    run : Trajectory
        The run of a world.
    without : Trajectory or None
        The same world without its robots, from which delays and detours of people follow.

    Returns
    -------
    list of Episode
        One for each robot. Other robots are no people.

    Raises
    ------
    InvalidParameterError
        If an argument is no run of a world.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> world = scenarios.circle_crossing(2, law=nav.OptimalReciprocalCollisionAvoidance())
    >>> episode, = nav.crowd.episodes_of(nav.simulate(world))
    >>> nav.metrics.evaluate(episode).arrived
    True
    """
    instance("run", run, WorldRun)
    if without is not None:
        instance("without", without, WorldRun)
    beside = {} if without is None else _beside(run, without)
    return episodes_in(
        run.scenario,
        run.robot_position,
        run.obstacle_position,
        run.obstacle_radius,
        robot_heading=run.robot_heading,
        warnings=run.warnings,
        **beside,
    )


def world_metrics(run: WorldRun) -> WorldMetrics:
    """Return the metrics of a world as a whole: throughput, deadlocks, speeds, times.

    Parameters
    ----------
    run : Trajectory
        The run of a world.

    Returns
    -------
    WorldMetrics
        A value for each of `WORLD_METRICS`.

    Raises
    ------
    InvalidParameterError
        If ``run`` is no run of a world.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.bottleneck(10, time_limit=20))
    >>> nav.crowd.world_metrics(run).throughput > 0.3
    True
    """
    world = instance("run", run, WorldRun).scenario
    found = evaluate_world(
        run.obstacle_position,
        person_goals=_goals(run),
        person_arrival_time=run.person_arrival_time,
        step=world.step,
        time_limit=world.time_limit,
        robots=run.robot_position if world.robots else (),
        robot_radius=[robot.body.radius for robot in world.robots],
        period=world.period,
        simulated=True,
    )
    return WorldMetrics(found.to_dict(), run.warnings)
