"""The derivative of the Lyapunov function against its numerical derivative along the motion.

The identity holds for discs in any motion as long as no side changes. It cannot hold

* where a side switches: psi jumps. States whose side or region changes within the stencil of the
  numerical derivative are left out and counted;
* on the face of a rectangle: D keeps its direction while the robot moves along the face, so the
  motion of the contact point enters alpha but not beta. At a corner it holds, a corner is a point.
"""

from __future__ import annotations

import math
import random
from typing import NamedTuple

import numpy as np
import pytest

from hrsafety import navigation as nav
from reference import as_package
from reference import plain_field as pf
from reference.random_states import State, random_gains, random_state

STATES = 3200
GAP = 0.1  # m: least d - r3
IDENTITY = 1e-6  # of max(1, |dV/dt|) at the 99 % quantile: the specification's acceptance
SWITCHING_SHARE = 0.01  # largest share of states that may be left out
BEGIN = 0.05  # s: time of the state, so that the stencil can look back
VELOCITY_CHANGE = 3e-4
"""m/s over one stencil step: balances the truncation of the fourth-order difference, which falls
as its fourth power, and the rounding of V, which grows as its inverse."""
ROUNDING = 1e-12  # of the terms that cancel in the derivative


class Sample(NamedTuple):
    """Reported and numerical derivative at one state."""

    reported: nav.Lyapunov
    numerical: float
    switches: bool
    terms: nav.laws.ForceTerms


def back_dated(body: pf.Round | pf.Box) -> pf.Round | pf.Box:
    """Return the body at time 0 that is where ``body`` is at ``BEGIN``."""
    if isinstance(body, pf.Box):
        return body
    velocity = pf.minus(body.velocity, pf.times(BEGIN, body.acceleration))
    path = pf.plus(pf.times(BEGIN, velocity), pf.times(BEGIN**2 / 2.0, body.acceleration))
    return body._replace(center=pf.minus(body.center, path), velocity=velocity)


def sample(law: pf.Law, state: State, mass: float = pf.ROBOT.mass) -> Sample:
    """Compare the derivative with a central difference along the motion under the total force."""
    field = as_package.law(law)
    scenario = as_package.scenario(state.goal, [back_dated(body) for body in state.obstacles])

    def terms(y: np.ndarray, time: float) -> nav.laws.ForceTerms:
        return nav.force_terms(field, scenario, position=y[:2], velocity=y[2:], time=time)

    def rate(y: np.ndarray, time: float) -> np.ndarray:
        return np.concatenate([y[2:], terms(y, time).total / mass])

    def moved(h: float) -> np.ndarray:
        first = rate(begin, BEGIN)
        second = rate(begin + h / 2.0 * first, BEGIN + h / 2.0)
        third = rate(begin + h / 2.0 * second, BEGIN + h / 2.0)
        fourth = rate(begin + h * third, BEGIN + h)
        return begin + h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)

    begin = np.array([*state.position, *state.velocity])
    here = terms(begin, BEGIN)
    h = VELOCITY_CHANGE / (1.0 + float(np.linalg.norm(here.total)) / mass)
    difference, switches = 0.0, False
    for steps, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
        y, time = moved(steps * h), BEGIN + steps * h
        there = terms(y, time)
        switches |= not (np.array_equal(there.side, here.side) and np.array_equal(there.region, here.region))
        difference += weight * nav.lyapunov(field, scenario, position=y[:2], velocity=y[2:], time=time).value
    reported = nav.lyapunov(field, scenario, position=begin[:2], velocity=begin[2:], time=BEGIN)
    return Sample(reported, difference / (12.0 * h), switches, here)


def quantiles(samples: list[Sample]) -> tuple[float, float]:
    """Return the 99 % quantile of the scaled difference, and the share of states left out."""
    kept = [s for s in samples if not s.switches]
    differences = [abs(s.numerical - s.reported.derivative) / max(1.0, abs(s.reported.derivative)) for s in kept]
    return float(np.quantile(differences, 0.99)), 1.0 - len(kept) / len(samples)


@pytest.mark.parametrize(("mode", "states"), [("off", STATES), ("capped", 400), ("full", STATES)])
def test_derivative_is_that_of_the_value_along_the_motion(mode: str, states: int) -> None:
    source = random.Random(557)
    samples, overridden = [], 0
    for _ in range(states):
        state = random_state(source, most_obstacles=3, boxes=False, least_gap=GAP)
        samples.append(sample(pf.Law(random_gains(source), pf.Stabilizing(mode)), state))
        turns = [pf.geometry(body, state.position, state.velocity, state.goal).phi for body in state.obstacles]
        overridden += any(side * phi < 0.0 for side, phi in zip(samples[-1].terms.side, turns, strict=True))
    quantile, left_out = quantiles(samples)
    assert quantile < IDENTITY
    assert left_out < SWITCHING_SHARE
    assert overridden > states // 20, "states where a rule overrides the shortest turn"


def test_full_stabilizing_force_never_lets_the_value_grow() -> None:
    source = random.Random(5512)
    stabilized = 0
    for _ in range(STATES):
        state = random_state(source, least_gap=GAP)
        law = pf.Law(random_gains(source), pf.Stabilizing("full"))
        plain = pf.evaluate(law, pf.ROBOT, state.position, state.velocity, state.goal, state.obstacles)
        scenario = as_package.scenario(state.goal, state.obstacles)
        found = nav.lyapunov(as_package.law(law), scenario, position=state.position, velocity=state.velocity)
        stabilized += found.omega > 0.0
        if math.hypot(*plain.v_l) >= pf.LEAST_V_L:
            assert found.derivative <= ROUNDING * plain.omega_magnitude
    assert stabilized > STATES // 4


def beside_a_box(source: random.Random, corner: bool) -> State:
    """Return the robot in motion beside a rectangle, before a corner or before a face."""
    heading = source.uniform(-math.pi, math.pi)
    away = source.uniform(0.2, math.pi / 2.0 - 0.2) if corner else math.pi / 2.0
    d = source.uniform(0.45, 0.8)
    local = ((0.5 if corner else source.uniform(-0.4, 0.4)) + d * math.cos(away), 0.3 + d * math.sin(away))
    center = (source.uniform(-1.0, 1.0), source.uniform(-1.0, 1.0))
    position = pf.plus(center, pf.turned(local, heading))
    goal = pf.plus(center, pf.turned((source.uniform(2.0, 4.0), source.uniform(1.3, 3.0)), heading))
    velocity = pf.turned((source.uniform(0.2, 0.5), source.uniform(-0.4, 0.4)), heading)
    return State(position, velocity, goal, [pf.Box(center, 1.0, 0.6, heading, 0.3, 0.9)])


def test_derivative_holds_at_a_corner_and_not_on_a_face() -> None:
    source = random.Random(57)
    law = pf.Law(pf.Gains(3.0, 20.0, 17.0, 0.25))
    at_corner, _ = quantiles([sample(law, beside_a_box(source, corner=True)) for _ in range(200)])
    on_face = [sample(law, beside_a_box(source, corner=False)) for _ in range(200)]
    differences = [abs(s.numerical - s.reported.derivative) / max(1.0, abs(s.reported.derivative)) for s in on_face]
    assert at_corner < IDENTITY
    assert np.median(differences) > 1e-3
