"""The kernels against a second evaluation of the same equations, state by state and run by run."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from reference import as_package
from reference import plain_field as pf
from reference.agreement import Worst, norm, scales
from reference.plain_rollout import Run, Setting, roll_out, walking
from reference.plain_settings import GAIN_SETS, NEW, setting
from reference.random_states import (
    State,
    direction,
    random_disc,
    random_gains,
    random_stabilizing,
    random_state,
    reaches,
    vector,
)

STATES = 6000
STATE_TOLERANCE = 1e-11
"""Of the scale of each term. d carries a rounding of some 5e-16 m; the most sensitive terms go
with (r2 - d)^2/(d - r3)^3, so at 1e-3 m from either border of the active region they carry 2e-12.
Five times that for sums. A difference of larger parts (Omega, and F_L through v_L) is compared at
the scale of its parts."""
RUN_TOLERANCE = 1e-9
"""Relative. Roundings of 1e-16 grow along a run, most where the robot passes closest."""
CONFIGURATIONS = ["c1", "c2", "c3", "c4", "n1", "n2", "n3", "n4", "parallel_human", "unpredictable_human"]


def compare(worst: Worst, law: pf.Law, state: State) -> pf.Evaluation:
    """Compare every term at one state outside all critical regions."""
    plain = pf.evaluate(law, pf.ROBOT, state.position, state.velocity, state.goal, state.obstacles)
    scenario = as_package.scenario(state.goal, state.obstacles)
    where = {"position": state.position, "velocity": state.velocity}
    terms = nav.force_terms(as_package.law(law), scenario, **where)
    reported = nav.lyapunov(as_package.law(law), scenario, **where)
    assert terms.region.tolist() == plain.region
    assert terms.side.tolist() == plain.side
    assert reported.omega == terms.omega
    scale = scales(law, state, plain)
    worst.see("attractive", terms.attractive, plain.attractive, scale.attractive)
    worst.see_each("repulsive", terms.repulsive, plain.repulsive, scale.repulsive)
    worst.see_each("detour", terms.detour, plain.detour, scale.detour)
    worst.see("omega", terms.omega, plain.omega, scale.omega)
    worst.see("stabilizing", terms.stabilizing, plain.stabilizing, scale.stabilizing)
    worst.see("total", terms.total, plain.total, scale.total)
    worst.see("value", reported.value, plain.value, scale.value)
    worst.see("derivative", reported.derivative, plain.derivative, scale.derivative)
    return plain


def test_random_states_agree_in_every_term() -> None:
    source = random.Random(20110)
    worst, active, overridden, rows = Worst(), 0, 0, 0
    while rows < STATES:
        law = pf.Law(random_gains(source), random_stabilizing(source), pass_behind=source.random() < 0.8)
        state = random_state(source)
        plain = compare(worst, law, state)
        rows += 1
        active += sum(region == "active" for region in plain.region) > 1
        views = [pf.geometry(o, state.position, state.velocity, state.goal) for o in state.obstacles]
        overridden += any(side and side != pf.sign(g.phi) for side, g in zip(plain.side, views, strict=True))
    assert worst.largest() <= STATE_TOLERANCE, str(worst)
    assert active > STATES // 3, "states with several active obstacles"
    assert overridden > STATES // 20, "states where a rule overrides the shortest turn"


def test_robot_obstacle_and_goal_in_line_agree_in_every_term() -> None:
    """The robot moves along the line, so that no term asks whether Phi is pi or -pi."""
    source = random.Random(544)
    worst, sides = Worst(), []
    for _ in range(1500):
        law = pf.Law(random_gains(source), random_stabilizing(source))
        along, center = direction(source), (source.uniform(-3.0, 3.0), source.uniform(-3.0, 3.0))
        between = pf.Round(center, 0.4, 0.9 + source.random(), pf.times(source.choice([-0.8, 0.0, 0.8]), along))
        d = source.uniform(between.critical_radius + 0.01, between.active_radius - 0.01)
        position, goal = pf.plus(center, pf.times(d, along)), pf.minus(center, pf.times(4.0, along))
        behind = pf.Round(pf.minus(center, pf.times(0.5, along)), 0.3, 2.5)
        crowd = [random_disc(source, position, 0.05) for _ in range(source.randint(0, 2))]
        obstacles = [between, *([behind] if source.random() < 0.3 else []), *crowd]
        if any(reaches(obstacle, goal) for obstacle in obstacles):
            continue
        velocity = pf.times(source.uniform(-0.7, 0.7), along)
        sides.append(compare(worst, law, State(position, velocity, goal, obstacles)).side[0])
    assert worst.largest() <= STATE_TOLERANCE, str(worst)
    assert min(sides.count(-1), sides.count(1)) > 100, "both sides are decided by the others"


def test_detour_forces_that_cancel_decide_nothing() -> None:
    worst = Worst()
    for turn in np.linspace(-3.0, 3.0, 25):
        others = [pf.Round(pf.turned((0.3, y), turn), 0.23, 0.9) for y in (-0.6, 0.6)]
        obstacles = [pf.Round(pf.turned((-1.0, 0.0), turn), 0.4, 1.5), *others]
        state = State((0.0, 0.0), pf.turned((-0.5, 0.0), turn), pf.turned((-4.0, 0.0), turn), obstacles)
        assert compare(worst, pf.Law(NEW), state).side == [1, 1, -1]
    assert worst.largest() <= STATE_TOLERANCE, str(worst)


def test_centroid_in_line_leaves_the_side_to_the_others() -> None:
    worst, sides = Worst(), set()
    for turn in np.linspace(-3.0, 3.0, 25):
        box = pf.Box((0.0, 0.0), 1.0, 0.6, float(turn), 0.3, 1.2)
        for y in (None, -0.7, 0.7):
            crowd = [] if y is None else [pf.Round(pf.turned((1.4, y), turn), 0.23, 1.2)]
            position, goal = pf.turned((1.1, 0.0), turn), pf.turned((-4.0, 0.0), turn)
            state = State(position, pf.turned((-0.5, 0.0), turn), goal, [box, *crowd])
            sides.add((y, compare(worst, pf.Law(NEW), state).side[0]))
    assert worst.largest() <= STATE_TOLERANCE, str(worst)
    assert len(sides) == 3, "one side for each crowd, whatever the heading"


def test_person_on_the_goal_leaves_finite_terms() -> None:
    source = random.Random(55)
    worst = Worst()
    for _ in range(500):
        goal = (source.uniform(-3.0, 3.0), source.uniform(-3.0, 3.0))
        person = pf.Round(goal, 0.8, 2.1, vector(source, 1.5), vector(source, 1.0))
        position = pf.plus(goal, pf.times(source.uniform(0.81, 2.09), direction(source)))
        state = State(position, vector(source, 0.7), goal, [person])
        plain = compare(worst, pf.Law(random_gains(source), random_stabilizing(source)), state)
        assert math.isfinite(plain.omega)
    assert worst.largest() <= STATE_TOLERANCE, str(worst)


def test_critical_region_of_any_obstacle_leaves_only_the_brake() -> None:
    source = random.Random(6)
    worst = Worst()
    for _ in range(500):
        state = random_state(source, most_obstacles=3)
        center = pf.plus(state.position, vector(source, 0.39))
        inside = pf.Round(center, 0.4, 0.8, vector(source, 1.0))
        velocity = source.choice([state.velocity, (0.0, 0.0), pf.times(3.0, state.velocity)])
        obstacles = [*state.obstacles, inside]
        law = pf.Law(random_gains(source), random_stabilizing(source))
        if any(reaches(obstacle, state.goal) for obstacle in obstacles):
            continue
        plain = pf.evaluate(law, pf.ROBOT, state.position, velocity, state.goal, obstacles)
        scenario = as_package.scenario(state.goal, obstacles)
        terms = nav.force_terms(as_package.law(law), scenario, position=state.position, velocity=velocity)
        assert terms.region.tolist() == plain.region
        assert plain.region[-1] == "critical"
        assert not np.any([*terms.repulsive, *terms.detour, terms.attractive, terms.stabilizing])
        worst.see("total", terms.total, plain.total, norm(plain.total))
    assert worst.largest() <= STATE_TOLERANCE, str(worst)


def variants(gains: pf.Gains) -> dict[str, pf.Law]:
    """Return the laws whose runs are not chaotic; ``full`` is."""
    return {
        "off": pf.Law(gains),
        "ignoring passage behind": pf.Law(gains, pass_behind=False),
        "capped in newtons": pf.Law(gains, pf.Stabilizing("capped", force_cap=10.0)),
        "capped in momentum": pf.Law(gains, pf.Stabilizing("capped", momentum_cap=0.1)),
        "side kept": pf.Law(gains, side_hysteresis=3.0),
    }


def assert_runs_agree(run: nav.Trajectory, plain: Run, label: str) -> None:
    """Compare figures and paths; a run that has stopped ends before the plain one, which waits."""
    assert run.arrival_time == pytest.approx(plain.arrival_time, rel=RUN_TOLERANCE, nan_ok=True), label
    assert run.energy == pytest.approx(plain.energy, rel=RUN_TOLERANCE), label
    assert run.min_distance.tolist() == pytest.approx(plain.min_distance, rel=RUN_TOLERANCE), label
    rows = len(run.time) - 1  # the last row is the arrival, inside a step
    difference = np.abs(run.position[:rows] - np.array(plain.path[:rows]))
    assert difference.max() <= RUN_TOLERANCE * np.abs(run.position).max(), label


@pytest.mark.parametrize("name", CONFIGURATIONS)
@pytest.mark.parametrize("gains", GAIN_SETS)
def test_runs_agree(name: str, gains: str) -> None:
    scenario, plain_scenario = scenarios.configuration(name), setting(name)
    for label, law in variants(GAIN_SETS[gains]).items():
        assert_runs_agree(nav.simulate(scenario, as_package.law(law)), roll_out(law, plain_scenario), label)


WALKERS = {
    "side kept against the shortest turn": ((0.6, 0.7), (1.0, -0.05), 2.5, False),
    "side kept, slow person": ((0.6, 0.7), (0.5, -0.05), 2.5, False),
    "fast person enters the critical region": ((0.0, 0.9), (2.5, -0.125), None, True),
}


@pytest.mark.parametrize("name", WALKERS)
@pytest.mark.parametrize("gains", GAIN_SETS)
def test_runs_past_a_walker_agree(name: str, gains: str) -> None:
    start, velocity, hysteresis, brakes = WALKERS[name]
    radii = {"critical_radius": 0.8, "active_radius": 2.1}
    law = pf.Law(GAIN_SETS[gains], side_hysteresis=hysteresis)
    plain = roll_out(law, Setting((3.9, 0.6), (0.0, 0.6), [walking(start, velocity, math.inf, **radii)]))
    person = nav.Human(start=start, velocity=velocity, **radii)
    run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[person]), as_package.law(law))
    assert_runs_agree(run, plain, name)
    assert (plain.min_distance[0] < radii["critical_radius"]) == brakes
    assert (run.outcome == "collided") == (plain.min_distance[0] <= 0.6)


@pytest.mark.parametrize("name", ["c1", "c2", "c3", "c4"])
def test_runs_without_hold_agree(name: str) -> None:
    law = pf.Law(NEW)
    run = nav.simulate(scenarios.configuration(name), as_package.law(law), hold=False)
    assert_runs_agree(run, roll_out(law, setting(name), hold=False), name)
