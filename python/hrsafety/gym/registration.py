"""Environments that Gymnasium knows by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium

from hrsafety.gym import worlds
from hrsafety.gym.single import CrowdEnv
from hrsafety.gym.vector import CrowdVectorEnv

__all__ = ["IDS", "register"]

_TASKS: dict[str, Callable[..., worlds.Task]] = {
    "CircleCrossing": worlds.circle_crossing,
    "Corridor": worlds.corridor,
    "Crossing": worlds.crossing,
    "Bottleneck": worlds.bottleneck,
}
IDS = tuple(f"hrsafety/{name}-v0" for name in _TASKS)
"""Names of the registered environments."""


def _split(task: Callable[..., worlds.Task], options: dict[str, Any]) -> worlds.Task:
    """Return the task, made of the options that are its own, which are taken out."""
    names = set(task.__kwdefaults__ or {}) - {"people"} | {"walkers"}
    own = {name: options.pop(name) for name in names & set(options)}
    if "walkers" in own:
        own["people"] = own.pop("walkers")
    return task(**own)


def make(name: str, **options: Any) -> CrowdEnv:
    """Return a registered environment; ``walkers`` is the number of people in its world.

    Parameters
    ----------
    name : str
        Which task, for example ``"CircleCrossing"``.
    **options
        Of the task and of `CrowdEnv`.

    Returns
    -------
    CrowdEnv
        The environment.
    """
    return CrowdEnv(_split(_TASKS[name], options), **options)


def make_vector(name: str, num_envs: int = 1, **options: Any) -> CrowdVectorEnv:
    """Return a registered environment many times; see `make`.

    Parameters
    ----------
    name : str
        Which task.
    num_envs : int
        How many.
    **options
        Of the task and of `CrowdVectorEnv`.

    Returns
    -------
    CrowdVectorEnv
        The environments.
    """
    return CrowdVectorEnv(_split(_TASKS[name], options), num_envs=num_envs, **options)


def register() -> None:
    """Register all environments, once.

    Examples
    --------
    >>> from hrsafety import gym
    >>> gym.register()
    >>> gym.IDS[0]
    'hrsafety/CircleCrossing-v0'
    """
    for name, each in zip(_TASKS, IDS, strict=True):
        if each not in gymnasium.registry:
            gymnasium.register(
                id=each,
                entry_point="hrsafety.gym.registration:make",
                vector_entry_point="hrsafety.gym.registration:make_vector",
                kwargs={"name": name},
            )
