"""Print how well the package agrees with the golden states, the second evaluation and V's derivative."""

from __future__ import annotations

import math
import random
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from golden.test_force_states import STATES, plain_state
from golden.test_reference import STATES as RANDOM_STATES
from golden.test_reference import compare
from hrsafety import navigation as nav
from properties.test_lyapunov import GAP, quantiles, sample
from properties.test_lyapunov import STATES as MOVING_STATES
from reference import as_package
from reference import plain_field as pf
from reference.agreement import Worst
from reference.random_states import random_gains, random_stabilizing, random_state


def golden() -> Worst:
    """Compare the golden states, each term relative to its own norm."""
    worst = Worst()
    for state in STATES:
        law, limits, obstacles = plain_state(state)
        scene = as_package.scenario(tuple(state["goal"]), obstacles, limits)
        terms = nav.force_terms(as_package.law(law), scene, position=state["position"], velocity=state["velocity"])
        parts = {"attractive": terms.attractive, "omega": terms.omega, "stabilizing_full": terms.stabilizing}
        for name, found in parts.items():
            worst.see(name, found, state[name], float(np.linalg.norm(state[name])))
        for name, rows in (("repulsive", terms.repulsive), ("detour", terms.detour)):
            worst.see_each(name, list(rows), state[name], [math.hypot(*row) for row in state[name]])
    return worst


def second_evaluation() -> Worst:
    """Compare random states with the second evaluation, at the scale of the parts of each term."""
    source, worst = random.Random(20110), Worst()
    for _ in range(RANDOM_STATES):
        law = pf.Law(random_gains(source), random_stabilizing(source), pass_behind=source.random() < 0.8)
        compare(worst, law, random_state(source))
    return worst


def identity() -> float:
    """Return the 99 % quantile of the scaled difference in the derivative of the Lyapunov function."""
    source = random.Random(557)
    states = [random_state(source, most_obstacles=3, boxes=False, least_gap=GAP) for _ in range(MOVING_STATES)]
    return quantiles([sample(pf.Law(random_gains(source), pf.Stabilizing("off")), state) for state in states])[0]


if __name__ == "__main__":
    print(f"{len(STATES)} golden states: {golden()}")
    print(f"{RANDOM_STATES} random states: {second_evaluation()}")
    print(f"{MOVING_STATES} moving states, derivative of V: 99 % quantile {identity():.1e}")
