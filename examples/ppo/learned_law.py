"""A policy that was learned by PPO as a law, beside reciprocal avoidance, each bare and under a shield.

``python learned_law.py`` takes the weights beside it, which ``train_ppo.py`` made; ``--cases 500`` runs the whole
benchmark, no case of which was trained on. It needs numpy only.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety import scenarios

Array = npt.NDArray[np.float64]

PEOPLE = 5  # that are seen, the nearest first
SIZE = 4 + 8 * PEOPLE  # numbers that the network is given
FAR, AHEAD = 4.0, 4.0  # scales of its inputs, in m and s
WEIGHTS = Path(__file__).with_suffix(".npz")


def direction(to_goal: Array) -> Array:
    """Return unit vectors to goals, shape (..., 2)."""
    length = np.linalg.norm(to_goal, axis=-1, keepdims=True)
    return np.where(length > 0.0, to_goal / np.maximum(length, 1e-12), [1.0, 0.0])


def turned(vectors: Array, axis: Array) -> Array:
    """Return vectors (..., 2) in axes whose x axis has the direction of a unit vector."""
    along = (vectors * axis).sum(-1)
    return np.stack([along, vectors[..., 1] * axis[..., 0] - vectors[..., 0] * axis[..., 1]], axis=-1)


def turned_back(vectors: Array, axis: Array) -> Array:
    """Return vectors of such axes in those of the world."""
    return turned(vectors, axis * [1.0, -1.0])


def inputs_of(own: Array, people: Array) -> Array:
    """Return what the network is given, shape (n, SIZE), in axes that point to the goal.

    Parameters
    ----------
    own : ndarray, shape (n, 5)
        Of the robot: way to the goal, velocity, greatest speed, as an observation begins.
    people : ndarray, shape (n, PEOPLE, 5)
        Way to each person, velocity relative to the robot, gap; zeros where there is nobody.
    """
    to_goal, velocity, fastest = own[:, :2], own[:, 2:4], own[:, 4:5]
    axis, distance = direction(to_goal), np.linalg.norm(to_goal, axis=-1)
    robot = np.column_stack([distance / FAR - 1.0, np.minimum(distance, 1.0), turned(velocity, axis) / fastest])
    offset, gap = turned(people[..., :2], axis[:, None]), people[..., 4]
    walking = turned(people[..., 2:4] + velocity[:, None], axis[:, None])
    # How near a person comes, and when, if the robot heads for its goal.
    relative = walking - fastest[..., None] * [1.0, 0.0]
    squared = np.maximum((relative**2).sum(-1), 1e-6)
    until = np.clip(-(offset * relative).sum(-1) / squared, 0.0, AHEAD)
    touching = np.linalg.norm(offset, axis=-1) - gap
    nearest = np.linalg.norm(offset + relative * until[..., None], axis=-1) - touching
    rest = np.stack([np.exp(-gap), until / AHEAD, np.exp(-nearest), np.ones_like(gap)], axis=-1)
    each = np.concatenate([offset / FAR, walking / fastest[..., None], rest], axis=-1)
    each = np.where((people != 0.0).any(-1)[..., None], each, 0.0)
    return np.concatenate([robot, each.reshape(len(own), -1)], axis=1)


class LearnedLaw:
    """Weights as a law: any object with ``velocity(situation)`` is one."""

    name = "learned"

    def __init__(self, layers: list[tuple[Array, Array]]) -> None:
        """Take weights and biases, layer by layer."""
        self.layers = layers

    @classmethod
    def load(cls, path: str | Path) -> LearnedLaw:
        """Return the law of a file."""
        with np.load(path) as kept:
            count = len(kept.files) // 2
            return cls([(kept[f"weight_{k}"].astype(float), kept[f"bias_{k}"].astype(float)) for k in range(count)])

    def shares(self, inputs: Array) -> Array:
        """Return shares of the greatest speed, shape (n, 2), in axes that point to the goal."""
        for weight, bias in self.layers[:-1]:
            inputs = np.tanh(inputs @ weight.T + bias)
        weight, bias = self.layers[-1]
        wanted = np.clip(inputs @ weight.T + bias, -1.0, 1.0)
        return wanted / np.maximum(np.linalg.norm(wanted, axis=-1, keepdims=True), 1.0)

    def velocity(self, seen: nav.laws.Situation) -> Array:
        """Return the velocity in m/s to have at the next sample."""
        there = seen.obstacle_present
        offset = seen.obstacle_position[there] - seen.position
        distance = np.linalg.norm(offset, axis=1)
        gap = distance - seen.robot.radius - seen.obstacle_radius[there]
        rows = np.column_stack([offset, seen.obstacle_velocity[there] - seen.velocity, gap])
        nearest = np.argsort(distance, kind="stable")[:PEOPLE]
        people = np.zeros((1, PEOPLE, 5))
        people[0, : len(nearest)] = rows[nearest]
        to_goal, fastest = seen.goal - seen.position, seen.robot.max_speed
        own = np.concatenate([to_goal, seen.velocity, [fastest]])
        return fastest * turned_back(self.shares(inputs_of(own[None], people)), direction(to_goal))[0]


def compare(path: str | Path, *, first: int = 0, cases: int = 500) -> None:
    """Print how laws do in cases of the benchmark in which people do not see the robot."""
    shield = nav.Shield(person_speed=1.0)
    bare: dict[str, Any] = {"reciprocal": nav.OptimalReciprocalCollisionAvoidance(), "learned": LearnedLaw.load(path)}
    laws = bare | {f"{name}, shield": nav.SafeNavigation(law, shield=shield) for name, law in bare.items()}
    words = ("success, 95 % interval", "contact", "moved toward whom it touched")
    print(f"{'law':20}" + "".join(f" {each:38}" for each in words) + " time (s)")
    worlds = [scenarios.circle_crossing(case, visible=False) for case in range(first, first + cases)]
    for name, law in laws.items():
        table = nav.simulate_many(worlds, law)
        fault = nav.metrics.wilson(int((table.contacts_at_fault > 0).sum()), cases)
        shares = "".join(f" {each!s:38}" for each in (table.success, table.contact, fault))
        print(f"{name:20}{shares} {table.arrival_time[table.arrived].mean():.2f}", flush=True)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("weights", nargs="?", default=WEIGHTS, help="file of weights (.npz)")
    parser.add_argument("--cases", type=int, default=50, help="number of cases")
    parser.add_argument("--first", type=int, default=0, help="the first one")
    given = parser.parse_args()
    compare(given.weights, first=given.first, cases=given.cases)


if __name__ == "__main__":
    main()
