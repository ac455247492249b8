"""Copies of environments go on with the same bits, and worlds of episodes may be drawn."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

import hrsafety.gym
from hrsafety import InvalidParameterError
from hrsafety import navigation as nav


def drawn_world(generator: np.random.Generator) -> nav.World:
    """Return a hall with a robot that starts anywhere at its left side."""
    robot = nav.Robot(
        nav.HolonomicRobot(radius=0.3, max_speed=1.0),
        start=(0.0, float(generator.uniform(-2.0, 2.0))),
        goal=(6.0, 0.0),
        control_period=0.25,
    )
    people = [nav.Person(start=(3.0, float(generator.uniform(-2.0, 2.0))), route=[(0.0, 3.0)])]
    return nav.World(people=people, robots=[robot], time_limit=20.0)


def driven(env: Any, steps: int, seed: int) -> list[Any]:
    """Return observations and rewards of some random steps."""
    generator, found = np.random.default_rng(seed), []
    for _ in range(steps):
        observation, reward, terminated, truncated, _ = env.step(generator.uniform(-1.0, 1.0, 2))
        found.append((observation.tolist(), reward))
        if terminated or truncated:
            found.append(env.reset()[0].tolist())
    return found


@settings(max_examples=20, deadline=None)
@given(
    world=some.sampled_from([hrsafety.gym.circle_crossing(people=3), hrsafety.gym.bottleneck(people=4), drawn_world]),
    episodes=some.integers(0, 3),
    steps=some.integers(0, 30),
    way=some.sampled_from([copy.deepcopy, copy.copy, lambda env: pickle.loads(pickle.dumps(env))]),
)
def test_a_copy_goes_on_with_the_same_bits(world: Any, episodes: int, steps: int, way: Any) -> None:
    env = hrsafety.gym.CrowdEnv(world, lidar=8)
    env.reset(seed=7)
    for episode in range(episodes):
        driven(env, 3, episode)
        env.reset()
    driven(env, steps, 11)
    other = way(env)
    # Each goes its own way from here: what one does, the other does not notice.
    expected = driven(env, 60, 12)
    assert driven(other, 60, 12) == expected


def test_a_copy_before_the_first_episode_and_of_a_registered_environment() -> None:
    env = gymnasium.make("hrsafety/CircleCrossing-v0")
    other = copy.deepcopy(env)
    assert np.array_equal(env.reset(seed=3)[0], other.reset(seed=3)[0])
    assert other.unwrapped.spec == env.unwrapped.spec


def test_drawn_worlds_differ_between_episodes_and_repeat_with_the_seed() -> None:
    env = hrsafety.gym.CrowdEnv(drawn_world)
    first = [env.reset(seed=5)[0].tolist(), *(env.reset()[0].tolist() for _ in range(3))]
    again = [env.reset(seed=5)[0].tolist(), *(env.reset()[0].tolist() for _ in range(3))]
    assert first == again
    assert len({tuple(each) for each in first}) == 4
    with pytest.raises(InvalidParameterError, match="must be a World, Scenario"):
        hrsafety.gym.CrowdEnv(lambda _: None)
