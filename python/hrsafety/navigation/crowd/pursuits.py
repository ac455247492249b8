"""Episodes of a robot among people who react and one who pursues it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety.navigation.crowd.agents import Person
from hrsafety.navigation.crowd.contacts import touches_of
from hrsafety.navigation.crowd.episodes import episodes_in
from hrsafety.navigation.crowd.pedestrians import CollisionFreeSpeed
from hrsafety.navigation.crowd.simulation import driven, simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.metrics.between import moves_toward, paths_of, until_arrival
from hrsafety.navigation.trajectory import CONTACT_SPEED, DECIDED_OVERLAP
from hrsafety.plausibility import ResultWarning

__all__ = ["falsified"]

AT_ONCE = 64
"""Episodes that are kept at a time."""

Progress = Callable[[int, int], object]


def falsified(
    world: World,
    law: Law,
    person: tuple[float, float, float],
    drawn: tuple[int, int],
    how: tuple[int | None, Progress | None],
) -> Iterator[tuple[dict[str, Any], tuple[ResultWarning, ...]]]:
    """Yield what came of each episode: the fields of a `Pursuit`, and the warnings of the run.

    Parameters
    ----------
    world : World
        One robot among people.
    law : Law
        What drives it.
    person : tuple of float
        Radius of the pursuer in m, his largest speed in m/s, and the least distance of the centers at the start in m.
    drawn : tuple of int
        Number of episodes, and seed of persons, people and noise.
    how : tuple
        Number of threads, and progress callback.

    Yields
    ------
    tuple of dict and tuple
        In the order of the episodes.
    """
    (episodes, seed), (threads, progress) = drawn, how
    placed = driven(world, law)
    seeds = np.random.SeedSequence(seed).generate_state(episodes, np.uint64).tolist()
    for first in range(0, episodes, AT_ONCE):
        part = range(first, min(first + AT_ONCE, episodes))
        worlds = [_pursued(placed, person, (seed, index), seeds[index]) for index in part]
        for run in simulated(worlds, threads=threads):
            yield _fields(run), run.warnings
        if progress is not None:
            progress(part.stop, episodes)


def _pursued(world: World, person: tuple[float, float, float], drawn: tuple[int, int], seed: int) -> World:
    """Return the world with one more person, the last one, who pursues the robot."""
    radius, speed, free = person
    robot, model = world.robots[0], CollisionFreeSpeed()
    native = _hrsafety.CrowdPerson.pursuing(
        model._native, drawn, [robot.start, robot.goal], radius=radius, speed=speed, free=free
    )
    x, y = native.start
    pursuer = Person(start=(x, y), radius=radius, desired_speed=speed, model=model)
    pursuer._set(_native=native)
    # Only the native person pursues.
    return replace(world, people=(*world.people, pursuer), seed=seed)


def _fields(run: WorldRun) -> dict[str, Any]:
    """Return the fields of a `Pursuit`."""
    places = run.robot_position, run.obstacle_position, run.obstacle_radius
    episode = episodes_in(run.scenario, *places, robot_heading=run.robot_heading)[0]
    own, people = until_arrival(episode, run.arrival_time)
    start, way, nearest = paths_of(episode, own, people)
    reach = episode.robot_radius + np.asarray(episode.person_radius)
    velocity = np.diff(own, axis=0) / episode.step
    moving = np.hypot(*velocity.T) > CONTACT_SPEED
    if episode.footprint is None:
        ahead = [np.einsum("ti,tpi->tp", velocity, places) > 0.0 for places in (start[:-1], start[:-1] + way)]
        toward = moving[:, None] & (ahead[0] | ahead[1])
    else:
        toward = moves_toward(episode, start, velocity)
    # Who walks on through the robot is ahead of it at last, whoever came.
    deep = np.logical_or.accumulate(nearest <= reach - DECIDED_OVERLAP, axis=0)
    open_yet = np.vstack([np.ones((1, len(reach)), dtype=bool), ~deep[:-1]])
    gaps = np.where(toward & open_yet & np.isfinite(nearest), nearest - reach, np.inf)
    faulty = touches_of(episode, run.arrival_time).at_fault
    gaps = np.where(faulty | (gaps > 0.0), gaps, np.inf)
    least = float(gaps.min(initial=np.inf))
    # A touch within a step, or a wall, is one whatever its depth.
    if faulty.any() or run.wall_contacts:
        least = min(least, 0.0, run.map_clearance)
    person = len(run.scenario.people) - 1
    rows = slice(None, len(own))
    return {
        "time": run.time[rows],
        "position": own,
        "velocity": run.velocity[rows],
        "person_position": run.obstacle_position[rows, person],
        "least_toward": least,
        "min_clearance": float(min(run.min_clearance.min(initial=np.inf), run.map_clearance)),
        "arrival_time": run.arrival_time,
        "end_time": float(run.time[len(own) - 1]),
        "top_speed": float(np.hypot(*run.velocity[rows].T).max()),
        "contacts_toward": run.contacts_toward,
        "contacts_away": run.contacts_away,
        "contacts_standing": run.contacts_standing,
        "wall_contacts": run.wall_contacts,
    }
