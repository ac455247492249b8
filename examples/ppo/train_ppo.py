"""Train a robot by PPO among people who do not see it: about three minutes on one core.

``pip install ".[gym]" stable-baselines3`` in the source tree, then ``python train_ppo.py weights.npz`` and
``python learned_law.py weights.npz --cases 500``.
"""

# ruff: noqa: ARG002  # arguments of methods that VecEnv asks for
from __future__ import annotations

import argparse
import time
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
import torch
from learned_law import PEOPLE, SIZE, direction, inputs_of, turned_back
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnv

import hrsafety.gym  # noqa: F401  # registers the environments

COUNT, LENGTH = 512, 64  # environments, and steps of each between two updates
FIRST_SEED = 1_000_000  # of training; the cases of the benchmark are seeds 0 to 499
CONTACT = -0.75  # reward beside CrowdNav's -0.25: a contact is worth no haste


class NativeEnvironments(VecEnv):
    """The native vector environment as stable-baselines3 wants it, with the inputs and axes of the learned law."""

    def __init__(self, seed: int) -> None:
        """Make the environments."""
        options = {"visible": False, "progress": 0.1, "step_reward": -0.01, "metrics": False}
        name = "hrsafety/CircleCrossing-v0"
        self.envs = gymnasium.make_vec(name, num_envs=COUNT, autoreset_mode="SameStep", **options)
        self.first = FIRST_SEED * (seed + 1)
        self.outcomes: dict[str, int] = {}
        inputs = gymnasium.spaces.Box(-np.inf, np.inf, (SIZE,), np.float32)
        super().__init__(COUNT, inputs, gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32))

    def reset(self) -> npt.NDArray[np.float32]:
        """Start the first episodes."""
        return self.look(self.envs.reset(seed=self.first)[0])

    def look(self, seen: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """Return the inputs of the network, and remember where the goals are."""
        self.axis = direction(seen[:, :2].astype(np.float64))
        return self.inputs(seen)

    @staticmethod
    def inputs(seen: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """Return the inputs of the network."""
        rows = seen.astype(np.float64)
        return inputs_of(rows[:, :5], rows[:, 6:].reshape(-1, PEOPLE, 5)).astype(np.float32)

    def step_async(self, actions: npt.NDArray[np.float32]) -> None:
        """Keep the actions, in axes of the world."""
        self.actions = turned_back(actions.astype(np.float64), self.axis)

    def step_wait(self) -> tuple[Any, ...]:
        """Step all environments by one call."""
        seen, rewards, terminated, truncated, infos = self.envs.step(self.actions)
        told: list[dict[str, Any]] = [{} for _ in range(COUNT)]
        ended = np.flatnonzero(terminated | truncated)
        if len(ended):
            outcomes = infos["final_info"]["outcome"]
            rewards = rewards + np.where(outcomes == "collided", CONTACT, 0.0)
            last = self.inputs(np.stack(list(infos["final_obs"][ended])))
            for row, index in zip(last, ended, strict=True):
                told[index] = {"terminal_observation": row, "TimeLimit.truncated": bool(truncated[index])}
                self.outcomes[outcomes[index]] = self.outcomes.get(outcomes[index], 0) + 1
        return self.look(seen), rewards.astype(np.float32), terminated | truncated, told

    def close(self) -> None:
        """Nothing is open."""

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Return what an environment has: only a render mode is asked for, and there is none."""
        return [getattr(self.envs, attr_name)] * COUNT

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Refuse: these environments have nothing to set."""
        raise AttributeError(attr_name)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **options: Any) -> list[Any]:
        """Refuse: these environments have no methods of their own."""
        raise AttributeError(method_name)

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Return that nothing is wrapped."""
        return [False] * COUNT


def train(path: str, *, steps: int, seed: int) -> None:
    """Train a policy and keep its weights."""
    torch.set_num_threads(1)
    envs = NativeEnvironments(seed)
    widths = {"pi": [128, 128], "vf": [128, 128]}
    settings: dict[str, Any] = {"n_steps": LENGTH, "batch_size": 4096, "n_epochs": 5, "gamma": 0.99, "gae_lambda": 0.95}
    model = PPO(
        "MlpPolicy",
        envs,
        learning_rate=lambda left: 1e-3 * left,
        policy_kwargs={"net_arch": widths, "log_std_init": -0.5},
        device="cpu",
        seed=seed,
        **settings,
    )

    def report(names: dict[str, Any], _: dict[str, Any]) -> bool:
        done = names["self"].num_timesteps
        if done % (10 * LENGTH * COUNT) == 0:
            total = sum(envs.outcomes.values())
            shares = ", ".join(f"{name} {count / total:.3f}" for name, count in sorted(envs.outcomes.items()))
            print(f"{done:>9} steps: {shares}", flush=True)
            envs.outcomes = {}
        return True

    used = time.process_time()
    model.learn(steps, callback=report)
    print(f"{time.process_time() - used:.0f} s of processor time")
    network = model.policy
    layers = [each for each in network.mlp_extractor.policy_net if hasattr(each, "weight")] + [network.action_net]
    kept = {f"weight_{k}": layer.weight.detach().numpy() for k, layer in enumerate(layers)}
    kept |= {f"bias_{k}": layer.bias.detach().numpy() for k, layer in enumerate(layers)}
    np.savez(path, **kept)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("weights", help="file to write (.npz)")
    parser.add_argument("--steps", type=int, default=6_000_000, help="steps of training")
    parser.add_argument("--seed", type=int, default=0, help="seed of training")
    given = parser.parse_args()
    train(given.weights, steps=given.steps, seed=given.seed)


if __name__ == "__main__":
    main()
