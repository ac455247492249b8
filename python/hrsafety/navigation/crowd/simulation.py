"""Worlds of people and robots, one or many, simulated by the core."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, NoReturn

from hrsafety import _hrsafety
from hrsafety._arguments import callback, instance, sequence, thread_count
from hrsafety.errors import SimulationError
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import PythonLaw

__all__ = ["OWN_LAWS", "driven", "run_of", "simulated"]


def _own(_: object) -> NoReturn:
    raise SimulationError("every robot of the world had its own law")


OWN_LAWS = PythonLaw(function=_own, name="own")
"""In the list of laws that drive a world: every robot is under its own."""


_NAMES = {name: f"obstacle_{name}" for name in ("position", "velocity", "radius")}


def driven(world: World, law: Law) -> World:
    """Return a world all of whose robots are under a law.

    Parameters
    ----------
    world : World
        The world.
    law : Law
        The law, or `OWN_LAWS`.

    Returns
    -------
    World
        Its copy.
    """
    return world if law is OWN_LAWS else replace(world, robots=[replace(robot, law=law) for robot in world.robots])


def simulated(
    worlds: Iterable[World],
    *,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> list[WorldRun]:
    """Return everything that happens in many worlds, which are spread over threads.

    Parameters
    ----------
    worlds : iterable of World
        The worlds, whose robots have laws of their own.
    threads : int or None
        Number of threads, at most 1024; ``None``: one for each core. Worlds with a law in Python run one
        after the other.
    progress : callable or None
        Progress callback ``(done, total)``.

    Returns
    -------
    list of Trajectory
        In the order of the worlds, with the same bits for any number of threads.

    Raises
    ------
    InvalidParameterError
        If a law cannot work in a world, or records would not fit into memory; the message names the world by its
        index.
    """
    given = sequence("worlds", "be a sequence of World", worlds)
    checked = [instance(f"worlds[{index}]", world, World) for index, world in enumerate(given)]
    natives = [world._native for world in checked]
    found = _hrsafety.crowd_simulate(natives, threads=thread_count(threads), progress=callback("progress", progress))
    return list(map(run_of, checked, found))


def run_of(world: World, recorded: dict[str, Any]) -> WorldRun:
    """Return the run of a world.

    Parameters
    ----------
    world : World
        The world.
    recorded : dict of str to object
        What the core has recorded, by its names.

    Returns
    -------
    Trajectory
        The run.
    """
    return WorldRun(world, {_NAMES.get(name, name): values for name, values in recorded.items()})
