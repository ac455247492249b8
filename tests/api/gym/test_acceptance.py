"""Every registered environment, with every kind of observation and every autoreset mode, as Gymnasium asks for it."""

from __future__ import annotations

import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers.vector import RecordEpisodeStatistics

from api.trees import same
from hrsafety import gym

KINDS: list[dict[str, Any]] = [
    {"lidar": 8},
    {"observation": "dict"},
    {"observation": "dict", "lidar": 8, "frame": "goal", "people": 3},
    {"people": 0, "lidar": 8},
    {"action": "acceleration", "visible": False},
    {"action": "unicycle", "lidar": 4, "progress": 0.1, "step_reward": -0.01},
]
FEW: dict[str, dict[str, Any]] = {
    "CircleCrossing": {"walkers": 3},
    "Corridor": {"walkers": 4},
    "Crossing": {"rate": 0.5},
    "Bottleneck": {"walkers": 6},
}


def few(name: str) -> dict[str, Any]:
    """Return options that keep a world small."""
    return FEW[name.split("/")[1].split("-")[0]]


@pytest.mark.parametrize("kind", KINDS, ids=str)
@pytest.mark.parametrize("name", gym.IDS)
def test_every_kind_of_every_environment_passes_the_checks_without_a_warning(name: str, kind: dict[str, Any]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name, **few(name), **kind).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", gym.IDS)
def test_pictures_pass_the_checks_without_a_warning(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name, render_mode="rgb_array", **few(name)).unwrapped)


@pytest.mark.parametrize("name", gym.IDS)
def test_an_episode_through_the_wrappers_of_gymnasium_warns_of_nothing(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(name, **few(name))  # with its passive checker and order enforcing
        env.action_space.seed(0)
        env.reset(seed=0)
        ended = False
        while not ended:
            _, reward, terminated, truncated, info = env.step(env.action_space.sample())
            ended = terminated or truncated
        assert np.isfinite(reward)
        assert info["outcome"] in {"arrived", "collided", "timed_out"}


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize("kind", [{"lidar": 8}, {"observation": "dict", "lidar": 4, "frame": "goal"}], ids=str)
@pytest.mark.parametrize("name", gym.IDS)
def test_every_vector_environment_is_single_ones_side_by_side(
    name: str, kind: dict[str, Any], mode: AutoresetMode
) -> None:
    count, options = 3, few(name) | kind
    many = gymnasium.make_vec(name, num_envs=count, autoreset_mode=mode, **options)
    each = SyncVectorEnv([lambda: gymnasium.make(name, **options) for _ in range(count)], autoreset_mode=mode)
    assert many.metadata["autoreset_mode"] is mode
    assert many.single_observation_space == each.single_observation_space
    assert many.observation_space == each.observation_space
    assert many.action_space == each.action_space
    same(many.reset(seed=4), each.reset(seed=4))
    generator = np.random.default_rng(0)
    ends = 0
    for step in range(260):
        actions = generator.uniform(-1.0, 1.0, (count, 2)).astype(np.float32)
        found = many.step(actions)
        if step % 10 == 0 or (found[2] | found[3]).any():
            assert found[0] in many.observation_space
        same(found, each.step(actions))
        ended = found[2] | found[3]
        ends += int(ended.sum())
        if mode is AutoresetMode.DISABLED and ended.any():
            same(many.reset(options={"reset_mask": ended}), each.reset(options={"reset_mask": ended}))
    assert ends >= count


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize("name", gym.IDS)
def test_statistics_of_episodes_are_counted(name: str, mode: AutoresetMode) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        envs = RecordEpisodeStatistics(gymnasium.make_vec(name, num_envs=4, autoreset_mode=mode, **few(name)))
        envs.action_space.seed(1)
        envs.reset(seed=1)
        for _ in range(260):
            envs.step(envs.action_space.sample())
        assert envs.episode_count >= 4
        assert all(length > 0 for length in envs.length_queue)


@pytest.mark.parametrize("name", gym.IDS)
def test_a_vector_of_pictures_has_one_of_each(name: str) -> None:
    envs = gymnasium.make_vec(name, num_envs=2, render_mode="rgb_array", **few(name))
    envs.reset(seed=0)
    pictures = envs.render()
    assert pictures is not None
    one, other = pictures
    assert isinstance(one, np.ndarray)
    assert one.shape == other.shape
    envs.close()
