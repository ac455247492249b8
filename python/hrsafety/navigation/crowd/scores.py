"""Metrics of robots in worlds of people."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety._arguments import Array, instance
from hrsafety.navigation.crowd.agents import middle_of
from hrsafety.navigation.crowd.episodes import episodes_in
from hrsafety.navigation.crowd.simulation import simulate_crowds
from hrsafety.navigation.crowd.trajectories import CrowdTrajectories
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.scores import MetricTable, WorldMetrics, evaluate_world, table_of
from hrsafety.plausibility import gathered, telling

__all__ = ["crowd_batch", "episodes_of", "world_metrics"]


def _goals(run: CrowdTrajectories) -> Array:
    """Return where routes end, of lines the middles; of people without one their places, NaN of those from sources."""
    goals = np.full((len(run.radius), 2), np.nan)
    for index, person in enumerate(run.world.people):
        goals[index] = middle_of(person.route[-1]) if person.route else person.start
    return goals


def _arrivals(run: CrowdTrajectories, people: int) -> Array:
    """Return instants and places at which the people of the world arrived, and so many rows."""
    rows = np.full((people, 3), np.nan)
    count = len(run.world.people)
    rows[:count] = np.column_stack([run.person_arrival_time, run.person_arrival_position])[:count]
    return rows


def _beside(run: CrowdTrajectories, without: CrowdTrajectories) -> dict[str, Any]:
    """Return the people of the world without its robots.

    Those from sources are not told apart: whom a robot kept out came later, with another number.
    """
    people, count = len(run.radius), len(run.world.people)
    alone = np.full((len(without.time), people, 2), np.nan)
    alone[:, :count] = without.position[:, :count]
    return {
        "people_without": alone,
        "person_goals": _goals(run),
        "person_arrivals": _arrivals(run, people),
        "person_arrivals_without": _arrivals(without, people),
    }


def episodes_of(run: CrowdTrajectories, without: CrowdTrajectories | None = None) -> list[Episode]:
    """Return what each robot of a world met, to be scored.

    Parameters
    ----------
    run : CrowdTrajectories
        What happened.
    without : CrowdTrajectories or None
        The same world without its robots, from which delays and detours of people follow.

    Returns
    -------
    list of Episode
        One for each robot. Other robots are no people.

    Raises
    ------
    InvalidParameterError
        If an argument is no run of a crowd.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> world = scenarios.circle_crossing(2, law=nav.OptimalReciprocalCollisionAvoidance())
    >>> episode, = nav.crowd.episodes_of(nav.crowd.simulate_crowd(world))
    >>> nav.metrics.evaluate(episode).arrived
    True
    """
    instance("run", run, CrowdTrajectories)
    if without is not None:
        instance("without", without, CrowdTrajectories)
    beside = {} if without is None else _beside(run, without)
    return episodes_in(run.world, run.robot_position, run.position, run.radius, warnings=run.warnings, **beside)


@telling()
def crowd_batch(
    worlds: Iterable[World],
    *,
    threads: int | None = None,
    people_alone: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> MetricTable:
    """Return the metrics of every robot in many worlds.

    Parameters
    ----------
    worlds : iterable of World
        The worlds; those without robots have no row.
    threads : int or None
        Number of threads; all cores when ``None``. The results do not depend on it.
    people_alone : bool
        Whether the same worlds are run without robots, too: delay and detour of people need it.
    progress : callable or None
        Progress callback ``(done, total)``.

    Returns
    -------
    MetricTable
        A row for each robot, in the order of worlds and robots.

    Raises
    ------
    InvalidParameterError
        As `simulate_crowds`.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> law = nav.OptimalReciprocalCollisionAvoidance()
    >>> table = nav.crowd.crowd_batch([scenarios.circle_crossing(case, law=law) for case in range(4)])
    >>> table.arrived.tolist()
    [True, True, True, True]
    """
    given = list(worlds)
    runs = simulate_crowds(given, threads=threads, progress=progress)
    alone: list[CrowdTrajectories | None] = [None] * len(given)
    if people_alone:
        alone = list(simulate_crowds([replace(world, robots=()) for world in given], threads=threads))
    episodes = [each for run, other in zip(runs, alone, strict=True) for each in episodes_of(run, other)]
    named = ((f"worlds[{index}]", run.warnings) for index, run in enumerate(runs))
    names = [f"worlds[{index}]" for index, run in enumerate(runs) for _ in run.world.robots]
    return table_of(episodes, gathered(named, "worlds"), names=names, threads=threads)


def world_metrics(run: CrowdTrajectories) -> WorldMetrics:
    """Return the metrics of a world as a whole: throughput, deadlocks, speeds, times.

    Parameters
    ----------
    run : CrowdTrajectories
        What happened.

    Returns
    -------
    WorldMetrics
        A value for each of `WORLD_METRICS`.

    Raises
    ------
    InvalidParameterError
        If ``run`` is no run of a crowd.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.crowd.simulate_crowd(scenarios.bottleneck(10, time_limit=20))
    >>> nav.crowd.world_metrics(run).throughput > 0.3
    True
    """
    world = instance("run", run, CrowdTrajectories).world
    found = evaluate_world(
        run.position,
        person_goals=_goals(run),
        person_arrival_time=run.person_arrival_time,
        step=world.step,
        time_limit=world.time_limit,
        robots=run.robot_position if world.robots else (),
        robot_radius=[robot.robot.radius for robot in world.robots],
        period=world.period,
        simulated=True,
    )
    return WorldMetrics(found.to_dict(), run.warnings)
