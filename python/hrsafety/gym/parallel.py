"""Many robots in one world, for PettingZoo, which is imported when they are asked for."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any

from hrsafety.errors import MissingExtraError
from hrsafety.gym.worlds import Task
from hrsafety.navigation.place import Place
from hrsafety.plausibility import telling

if TYPE_CHECKING:
    from hrsafety.gym.many_robots import CrowdParallelEnv

__all__ = ["parallel_env"]


@telling(every=True)
def parallel_env(world: Place | Task, *, render_mode: str | None = None, **options: Any) -> CrowdParallelEnv:
    """Return an environment in which a learner drives all robots of a world that have no law.

    Parameters
    ----------
    world : World, Scenario or Task
        Any world with robots; those that have a law follow it. The driven ones share a control period.
    render_mode : {"rgb_array"} or None
        Whether pictures are asked for.
    **options
        As of `CrowdEnv`, the same for all robots.

    Returns
    -------
    CrowdParallelEnv
        A ``pettingzoo.ParallelEnv`` with the agents ``robot_0``, ``robot_1``, ...

    Raises
    ------
    MissingExtraError
        If PettingZoo is not installed.
    InvalidParameterError
        If a value is out of range, no robot is to be driven, their control periods differ, or their worlds would
        not fit into memory.

    Notes
    -----
    Each robot sees and is rewarded as in a `CrowdEnv` of the same world and seed in which the other robots do
    what is done here. Other robots are seen by the lidar and are no people; ``info["robot_clearance"]`` is the gap
    to the nearest of them in m at the end of the step. A robot whose episode has ended stands.

    Every driven robot has a native world of its own, with the same bits: a step takes time that grows with the
    square of their number. In each of these worlds all robots know of each other, so that memory grows with the
    cube: 0.2 kB times the cube of the robots. More than ten million pairs, some 200 robots, are refused. An
    observation has the nearest ``people`` and the lidar, however many robots there are.

    Examples
    --------
    >>> from hrsafety import gym, scenarios
    >>> env = gym.parallel_env(scenarios.antipodal(6, robots=3), lidar=16)
    >>> observations, infos = env.reset(seed=0)
    >>> {name: seen.shape for name, seen in observations.items()}
    {'robot_0': (47,), 'robot_1': (47,), 'robot_2': (47,)}
    """
    if importlib.util.find_spec("pettingzoo") is None:
        raise MissingExtraError("environments for many robots need PettingZoo: pip install pettingzoo")
    # Imported when it is asked for, as PettingZoo is.
    from hrsafety.gym.many_robots import CrowdParallelEnv

    return CrowdParallelEnv(world, render_mode=render_mode, **options)
