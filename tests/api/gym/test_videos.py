"""Videos of episodes."""

from __future__ import annotations

from pathlib import Path

import gymnasium
import numpy as np
import pytest
from PIL import Image

from hrsafety import InvalidParameterError, gym
from hrsafety import navigation as nav


def to_goal(observation: np.ndarray) -> np.ndarray:
    return 0.5 * observation[:2].clip(-2.0, 2.0)


@pytest.mark.parametrize("frame", ["world", "goal"])
def test_a_video_has_a_picture_of_every_step(frame: str, tmp_path: Path) -> None:
    robot = nav.Robot(nav.HolonomicRobot(max_speed=1.0), start=(0.0, 0.0), goal=(1.0, 0.5), control_period=0.25)
    world = nav.World(people=[nav.Person(start=(2.0, 2.0), route=[(0.0, 2.0)])], robots=[robot], time_limit=3.0)
    env = gym.CrowdEnv(world, lidar=12, frame=frame)
    info = gym.video(env, to_goal, tmp_path / "episode.gif", seed=1)
    steps, ended, observation = 0, False, env.reset(seed=1)[0]
    while not ended:
        observation, _, *ends, last = env.step(to_goal(observation))
        steps, ended = steps + 1, any(ends)
    assert info["outcome"] == last["outcome"]
    with Image.open(tmp_path / "episode.gif") as pictures:
        lasting = 0
        for index in range(pictures.n_frames):
            pictures.seek(index)
            lasting += pictures.info["duration"]
    # Pictures that do not differ are one in the file; the last one is held.
    assert lasting >= 250 * steps


def test_what_is_no_episode_is_refused(tmp_path: Path) -> None:
    env = gymnasium.make("hrsafety/CircleCrossing-v0")
    with pytest.raises(InvalidParameterError, match=r"end in \.gif or \.mp4"):
        gym.video(env, to_goal, tmp_path / "episode.avi")
    with pytest.raises(InvalidParameterError, match="be a CrowdEnv"):
        gym.video(object(), to_goal, tmp_path / "episode.gif")  # type: ignore[arg-type]  # on purpose
    with pytest.raises(InvalidParameterError, match="policy must be callable"):
        gym.video(env, "best", tmp_path / "episode.gif")  # type: ignore[arg-type]  # on purpose
