"""Steps per second of 1,024 environments for learners on one core, with rewards, observations and new episodes.

Processor time, the best of several rounds. Beside it stands a loop over pyrvo that moves five people and a robot in
each of as many simulators, and computes neither observations nor rewards.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import pyrvo  # type: ignore[import-untyped]  # it has no type information
import pytest

from hrsafety import gym
from hrsafety import navigation as nav

ENVIRONMENTS, STEPS, ROUNDS = 1024, 20, 5
PEERS = 64
KINDS: dict[str, dict[str, Any]] = {
    "reciprocal": {"metrics": False},
    "reciprocal, with metrics": {},
    "Moussaid, five motion steps in a step": {"metrics": False, "model": nav.crowd.Moussaid()},
}
MODEL_STEP = 0.05  # largest step of the model of Moussaid in s


def fastest(work: Callable[[], object]) -> float:
    """Return the least processor time of several rounds in s."""
    spent = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return min(spent)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.benchmark(group="environment steps, one core")
def test_environments(benchmark: Any, kind: str) -> None:
    envs = gymnasium.make_vec(
        "hrsafety/CircleCrossing-v0",
        num_envs=ENVIRONMENTS,
        vectorization_mode="vector_entry_point",
        threads=1,
        **KINDS[kind],
    )
    report(benchmark, kind, envs)


@pytest.mark.benchmark(group="environment steps, one core")
def test_one_motion_step_in_a_step(benchmark: Any) -> None:
    """The robot is commanded at every step of the model, as in a program that has no other step."""
    task = gym.circle_crossing(model=nav.crowd.Moussaid())
    robot = replace(task.world.robots[0], control_period=MODEL_STEP)
    task = replace(task, world=replace(task.world, step=MODEL_STEP, robots=[robot]))
    envs = gym.CrowdVectorEnv(task, num_envs=ENVIRONMENTS, threads=1, metrics=False)
    report(benchmark, "Moussaid, one motion step in a step", envs)


def report(benchmark: Any, kind: str, envs: Any) -> None:
    """Drive all robots toward their goals, and print the steps per second."""
    seen, _ = envs.reset(seed=0)

    def steps() -> None:
        nonlocal seen
        for _ in range(STEPS):
            seen, *_ = envs.step(np.clip(seen[:, :2], -1.0, 1.0))

    rate = ENVIRONMENTS * STEPS / fastest(steps)
    benchmark.extra_info["steps per s"] = rate
    benchmark.pedantic(steps, rounds=1)
    envs.close()
    print(f"{kind}: {rate / 1e6:.3f} M environment steps per s")


@pytest.mark.benchmark(group="environment steps, one core")
def test_loop_over_pyrvo(benchmark: Any) -> None:
    simulators = []
    angles = np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False)
    for _ in range(PEERS):
        simulator = pyrvo.RVOSimulator(0.25, 10.0, 10, 5.0, 5.0, 0.3, 1.0)
        for angle in angles:
            simulator.add_agent((4.0 * np.cos(angle), 4.0 * np.sin(angle)))
        for index, angle in enumerate(angles):
            simulator.set_agent_pref_velocity(index, (-np.cos(angle), -np.sin(angle)))
        simulators.append(simulator)

    def steps() -> None:
        for _ in range(STEPS):
            for simulator in simulators:
                simulator.do_step()

    rate = PEERS * STEPS / fastest(steps)
    benchmark.extra_info["steps per s"] = rate
    benchmark.pedantic(steps, rounds=1)
    print(f"pyrvo: {rate / 1e6:.3f} M steps of worlds per s")
