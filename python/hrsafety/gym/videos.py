"""Videos of episodes, with the rays and the ways of everybody; no program for videos is needed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

from hrsafety.errors import InvalidParameterError
from hrsafety.gym.environments import Frame
from hrsafety.gym.pictures import picture
from hrsafety.gym.single import CrowdEnv
from hrsafety.plotting.movies import checked_target, write

__all__ = ["video"]

JUMP = 1.0  # m between two steps, as at the edge of a floor that repeats itself: no line is drawn there


def video(
    env: gymnasium.Env[Any, Any],
    policy: Callable[[Any], npt.ArrayLike],
    path: str | os.PathLike[str],
    *,
    seed: int | None = None,
    frames_per_second: float | None = None,
) -> dict[str, Any]:
    """Run an episode and write it as a GIF with Pillow, or as an MP4 with ffmpeg.

    Parameters
    ----------
    env : CrowdEnv
        Also within wrappers: the policy sees what they show.
    policy : callable
        ``policy(observation)`` returns an action.
    path : path-like
        The file, ending in ``.gif`` or ``.mp4``; written when the episode has ended.
    seed : int or None
        Of the episode.
    frames_per_second : float or None
        Pictures in a second; ``None``: one for each control period, as fast as it happens.

    Returns
    -------
    dict
        ``info`` of the last step.

    Raises
    ------
    InvalidParameterError
        If the environment is of another kind or the file cannot be written.
    MissingExtraError
        If Pillow, matplotlib or ffmpeg is missing.

    Examples
    --------
    >>> import gymnasium, hrsafety.gym
    >>> env = gymnasium.make("hrsafety/CircleCrossing-v0", lidar=16, walkers=2)
    >>> info = hrsafety.gym.video(env, lambda seen: seen[:2].clip(-1.0, 1.0), "episode.gif", seed=1)
    >>> info["outcome"]
    'arrived'
    """
    base = getattr(env, "unwrapped", None)
    if not isinstance(base, CrowdEnv):
        raise InvalidParameterError("env", "be a CrowdEnv, in wrappers or not", type(env).__name__)
    if not callable(policy):
        raise InvalidParameterError("policy", "be callable", policy)
    target: Path = checked_target(path)
    info: dict[str, Any] = {}
    ways: list[list[tuple[float, float]]] = []

    def frames() -> Iterator[Frame]:
        observation, told = env.reset(seed=seed)
        ended = False
        while True:
            info.clear()
            info.update(told)
            yield _frame(base, ways)
            if ended:
                return
            observation, _, terminated, truncated, told = env.step(policy(observation))
            ended = terminated or truncated

    world = base._all.task.world
    period = world.robots[0].control_period or world.step
    write(target, frames(), 1.0 / period if frames_per_second is None else frames_per_second)
    return info


def _frame(env: CrowdEnv, ways: list[list[tuple[float, float]]]) -> Frame:
    """Return the picture of now, and remember where everybody is."""
    everything = env._all
    (place, _), people, _ = everything.places(0)
    for number, here in enumerate([place, *(where for where, _ in people)]):
        if number == len(ways):
            ways.append([])
        ways[number].append(here)
    paths = []
    for way in ways:
        line = np.asarray(way, dtype=np.float64)
        # A line stops where somebody leaves one edge and comes in at the other.
        line[1:][np.hypot(*np.diff(line, axis=0).T) > JUMP] = np.nan
        paths.append(line)
    rays = None
    if everything.lidar:
        ranges = everything.observations[0, -everything.lidar :].astype(np.float64)
        angles = 2.0 * np.pi * np.arange(everything.lidar) / everything.lidar
        if everything.frame == "goal":
            way = np.asarray(everything.task.world.robots[0].goal) - place
            angles = angles + np.arctan2(way[1], way[0])
        rays = np.asarray(place) + ranges[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return picture(everything, 0, paths=paths, rays=rays)
