"""Symmetry, units and continuity of the force field."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from reference import as_package
from reference import plain_field as pf
from reference.agreement import Worst, norm, scales
from reference.random_states import State, direction, random_gains, random_stabilizing, random_state, vector

GAP = 0.01  # m: least d - r3 of the states here
MARGIN = 1e-6  # rad or m: distance from every switch of a side, far above rounding
SYMMETRY = 1e-11
"""Of the scale of each term. Shifted coordinates of some 10 m carry 1e-14 m, which 1/(d - r3)^3
of the most sensitive term raises by 3/(d - r3) = 300; sums of such terms."""
LEAST_SPEED = 0.35  # m/s: keeps v_L away from zero, where F_L has no limit

seeds = st.integers(0, 2**32 - 1)
angles = st.floats(-math.pi, math.pi)
shifts = st.tuples(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))
factors = st.floats(0.5, 2.0)
steady = settings(derandomize=True, deadline=None, max_examples=200)


def state_and_law(seed: int, *, boxes: bool = True) -> tuple[State, pf.Law]:
    source = random.Random(seed)
    state = random_state(source, boxes=boxes, least_gap=GAP, least_speed=0.05)
    return state, pf.Law(random_gains(source), random_stabilizing(source))


def is_far_from_every_switch(state: State) -> bool:
    """Say whether no rule of the side is about to change its mind."""
    for obstacle in state.obstacles:
        g = pf.geometry(obstacle, state.position, state.velocity, state.goal)
        if g.region == "active" and not MARGIN < abs(g.phi) < math.pi - MARGIN:
            return False
        if isinstance(obstacle, pf.Round) and norm(obstacle.velocity) > 0.0:
            off = [pf.cross(obstacle.velocity, pf.minus(p, obstacle.center)) for p in (state.position, state.goal)]
            if min(map(abs, off)) < MARGIN or abs(norm(obstacle.velocity) - pf.MOVING) < MARGIN:
                return False
    return True


Map = Callable[[pf.Vector], pf.Vector]


def transformed(
    state: State,
    point: Callable[[pf.Vector], pf.Vector],
    free: Callable[[pf.Vector], pf.Vector],
    turn: float,
    hand: int,
) -> State:
    """Return the state in other coordinates: ``point`` maps places, ``free`` maps velocities."""
    obstacles: list[pf.Round | pf.Box] = []
    for body in state.obstacles:
        if isinstance(body, pf.Box):
            obstacles.append(body._replace(center=point(body.center), heading=hand * body.heading + turn))
        else:
            moved = {"velocity": free(body.velocity), "acceleration": free(body.acceleration)}
            obstacles.append(body._replace(center=point(body.center), **moved))
    return State(point(state.position), free(state.velocity), point(state.goal), obstacles)


def terms_at(law: pf.Law, state: State, limits: pf.Limits = pf.ROBOT) -> nav.laws.ForceTerms:
    scenario = as_package.scenario(state.goal, state.obstacles, limits)
    return nav.force_terms(as_package.law(law), scenario, position=state.position, velocity=state.velocity)


def assert_maps(law: pf.Law, state: State, other: State, free: Map, hand: int) -> None:
    """Assert that every term at ``other`` is the image of that at ``state``."""
    plain = pf.evaluate(law, pf.ROBOT, state.position, state.velocity, state.goal, state.obstacles)
    scale, here, there, worst = scales(law, state, plain), terms_at(law, state), terms_at(law, other), Worst()
    assert there.side.tolist() == [hand * side for side in here.side.tolist()]
    assert there.region.tolist() == here.region.tolist()
    worst.see("attractive", there.attractive, free(tuple(here.attractive)), scale.attractive)
    worst.see_each("repulsive", there.repulsive, [free(tuple(f)) for f in here.repulsive], scale.repulsive)
    worst.see_each("detour", there.detour, [free(tuple(f)) for f in here.detour], scale.detour)
    worst.see("stabilizing", there.stabilizing, free(tuple(here.stabilizing)), scale.stabilizing)
    worst.see("total", there.total, free(tuple(here.total)), scale.total)
    worst.see("omega", there.omega, here.omega, scale.omega)
    assert worst.largest() <= SYMMETRY, str(worst)


@steady
@given(seed=seeds, angle=angles, shift=shifts)
def test_forces_turn_and_shift_with_the_world(seed: int, angle: float, shift: pf.Vector) -> None:
    state, law = state_and_law(seed)
    assume(is_far_from_every_switch(state))

    def free(v: pf.Vector) -> pf.Vector:
        return pf.turned(v, angle)

    other = transformed(state, lambda p: pf.plus(free(p), shift), free, angle, 1)
    assert_maps(law, state, other, free, 1)


@steady
@given(seed=seeds)
def test_forces_are_mirrored_with_the_world(seed: int) -> None:
    state, law = state_and_law(seed)
    assume(is_far_from_every_switch(state))

    def mirror(v: pf.Vector) -> pf.Vector:
        return (v[0], -v[1])

    assert_maps(law, state, transformed(state, mirror, mirror, 0.0, -1), mirror, -1)


@steady
@given(seed=seeds, metre=factors, second=factors, kilogram=factors)
def test_forces_do_not_depend_on_the_units(seed: int, metre: float, second: float, kilogram: float) -> None:
    """Lengths, times and masses in other units; only the thresholds of a moving obstacle and of v_L are absolute."""
    state, law = state_and_law(seed)
    assume(is_far_from_every_switch(state))
    law = law._replace(stabilizing=pf.Stabilizing("full"), pass_behind=False)
    speed, newton = metre / second, kilogram * metre / second**2
    k1, k3, k5, b = law.gains
    spring = kilogram / second**2
    other_law = law._replace(gains=pf.Gains(k1 * spring, k3 * spring, k5 * spring / metre, b * second))
    other = State(
        pf.times(metre, state.position),
        pf.times(speed, state.velocity),
        pf.times(metre, state.goal),
        [in_units(obstacle, metre, second) for obstacle in state.obstacles],
    )
    plain = pf.evaluate(law, pf.ROBOT, state.position, state.velocity, state.goal, state.obstacles)
    scale, here, worst = scales(law, state, plain), terms_at(law, state), Worst()
    there = terms_at(other_law, other, pf.ROBOT._replace(mass=kilogram * pf.ROBOT.mass, radius=metre * pf.ROBOT.radius))
    worst.see("total", np.divide(there.total, newton), here.total, scale.total)
    worst.see("omega", there.omega * second / newton**2, here.omega, scale.omega)
    assert worst.largest() <= SYMMETRY, str(worst)


def in_units(body: pf.Round | pf.Box, metre: float, second: float) -> pf.Round | pf.Box:
    radii = {
        "center": pf.times(metre, body.center),
        "critical_radius": metre * body.critical_radius,
        "active_radius": metre * body.active_radius,
    }
    if isinstance(body, pf.Box):
        return body._replace(length=metre * body.length, width=metre * body.width, **radii)
    velocity = pf.times(metre / second, body.velocity)
    return body._replace(velocity=velocity, acceleration=pf.times(metre / second**2, body.acceleration), **radii)


DEPTHS = (1e-3, 1e-5, 1e-7)  # m inside and outside the border of the active region
JUMP = 1e-9  # of the scale of the force: what rounding leaves of a jump


@pytest.mark.parametrize("mode", ["off", "capped", "full"])
@steady
@given(seed=seeds)
def test_forces_are_continuous_where_the_active_region_begins(mode: str, seed: int) -> None:
    """The jump over 2 eps falls as eps: K_1 and F_L are linear in it, repulsion and detour quadratic."""
    source = random.Random(seed)
    state = random_state(source, most_obstacles=3, least_gap=GAP, least_speed=LEAST_SPEED)
    crossed = border(source, state)
    law = pf.Law(random_gains(source), pf.Stabilizing(mode))
    jumps = []
    for depth in DEPTHS:
        inside, outside = (shifted(state, crossed, sign * depth) for sign in (-1.0, 1.0))
        assume(is_far_from_every_switch(inside) and is_far_from_every_switch(outside))
        before, after = terms_at(law, outside), terms_at(law, inside)
        assert (before.region[-1], after.region[-1]) == ("free", "active")
        jumps.append(math.dist(before.total, after.total))
        scale = np.linalg.norm(before.total) + 1.0
    assert jumps[1] <= max(jumps[0] / 20.0, JUMP * scale)
    assert jumps[2] <= max(jumps[1] / 20.0, JUMP * scale)


def border(source: random.Random, state: State) -> pf.Round:
    """Return a moving disc whose active region begins where the robot is."""
    away, r2 = direction(source), source.uniform(0.7, 2.0)
    center = pf.minus(state.position, pf.times(r2, away))
    return pf.Round(center, 0.4, r2, vector(source, 1.0), vector(source, 1.0))


def shifted(state: State, crossed: pf.Round, depth: float) -> State:
    """Return the state with one more obstacle, shifted so that the robot is ``depth`` outside its active region."""
    away = pf.minus(state.position, crossed.center)
    center = pf.minus(crossed.center, pf.times(depth / norm(away), away))
    return state._replace(obstacles=[*state.obstacles, crossed._replace(center=center)])
