"""Worlds of people and robots, one or many."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from hrsafety import _hrsafety
from hrsafety._arguments import callback, instance, sequence, thread_count
from hrsafety.navigation.crowd.trajectories import CrowdTrajectories, Divergence
from hrsafety.navigation.crowd.world import World
from hrsafety.plausibility import telling

__all__ = ["simulate_crowd", "simulate_crowds"]


@telling()
def simulate_crowd(world: World) -> CrowdTrajectories:
    """Return everything that happens in a world of people and robots.

    Parameters
    ----------
    world : World
        The world.

    Returns
    -------
    CrowdTrajectories
        The same bits for the same world. Where a state is no longer finite the world ends, and
        ``diverged`` says when and for whom.

    Raises
    ------
    InvalidParameterError
        If a law cannot work in the world, or a record of it would not fit into memory.

    Examples
    --------
    A robot and a person who sees it meet head-on:

    >>> from hrsafety import navigation as nav
    >>> person = nav.crowd.Person(start=(6, 0.1), route=[(0, 0.1)], desired_speed=1.2)
    >>> law = nav.OptimalReciprocalCollisionAvoidance()
    >>> robot = nav.crowd.CrowdRobot(start=(0, 0), goal=(6, 0), law=law)
    >>> run = nav.crowd.simulate_crowd(nav.crowd.World(people=[person], robots=[robot]))
    >>> run.outcomes
    ('arrived',)
    """
    return simulate_crowds([world], threads=1)[0]


def simulate_crowds(
    worlds: Iterable[World],
    *,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> list[CrowdTrajectories]:
    """Return everything that happens in many worlds, which are spread over threads.

    Parameters
    ----------
    worlds : iterable of World
        The worlds.
    threads : int or None
        Number of threads, at most 1024; ``None``: one for each core. Worlds with a law in Python run one
        after the other.
    progress : callable or None
        Progress callback ``(done, total)``.

    Returns
    -------
    list of CrowdTrajectories
        In the order of the worlds, with the same bits for any number of threads.

    Raises
    ------
    InvalidParameterError
        As `simulate_crowd`; the message names the world by its index.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> people = [nav.crowd.Person(start=(0, y), route=[(5, y)]) for y in (0.0, 1.0)]
    >>> worlds = [nav.crowd.World(people=people, seed=seed) for seed in range(3)]
    >>> [run.position.shape[1] for run in nav.crowd.simulate_crowds(worlds)]
    [2, 2, 2]
    """
    given = sequence("worlds", "be a sequence of World", worlds)
    checked = [instance(f"worlds[{index}]", world, World) for index, world in enumerate(given)]
    natives = [world._native for world in checked]
    found = _hrsafety.crowd_simulate(natives, threads=thread_count(threads), progress=callback("progress", progress))
    return [_trajectories(world, fields) for world, fields in zip(checked, found, strict=True)]


def _trajectories(world: World, fields: dict[str, Any]) -> CrowdTrajectories:
    diverged = fields.pop("diverged")
    return CrowdTrajectories(world=world, diverged=None if diverged is None else Divergence(*diverged), **fields)
