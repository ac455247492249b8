"""Safety filters against the checked cases."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import entry
from hrsafety.errors import InvalidParameterError

KINDS: dict[str, tuple[type[nav.laws.SafetyFilter], dict[str, str]]] = {
    "cbf": (nav.laws.Barrier, {}),
    "cbf_unicycle": (nav.laws.BarrierUnicycle, {}),
    "collision_cone": (nav.laws.CollisionCone, {}),
    "vo_clamp": (nav.laws.VelocityClamp, {"tau": "horizon"}),
    "rss": (nav.laws.ResponsibilityRule, {}),
    "approach": (nav.laws.ApproachMonitor, {}),
}
TOLERANCE = 1e-9
TINY = float(np.finfo(float).tiny)  # the centers of a person and the robot are not nearer
UNICYCLE = 2e-9  # some slacks of the cases lie 1e-9 below the exact ones


CASES: dict[str, Any] = json.loads((Path(__file__).parent / "filter_cases.json").read_text(encoding="utf-8"))


def decided(kind: str, case: dict[str, Any]) -> nav.laws.FilterDecision:
    """Return the decision of a filter in the state of a case."""
    made, names = KINDS[kind]
    state, turn_rate = case["state"], 0.0
    wanted = state.get("wanted")
    if kind == "approach":
        x, y, turn_rate = state["command"]
        sin, cos = math.sin(state["heading"]), math.cos(state["heading"])
        wanted = cos * x - sin * y, sin * x + cos * y
    rule = made(**{names.get(name, name): value for name, value in case["parameters"].items()})
    return rule.decide(
        wanted,
        velocity=state.get("V", (0.0, 0.0)),
        people=state["people"],
        points=state.get("points", ()),
        position=state["p"],
        heading=state["heading"],
        turn_rate=turn_rate,
        radius=state["radius"],
        max_speed=state["vmax"],
        max_acceleration=state.get("amax"),
        max_turn_rate=state["wmax"],
        control_period=state["T"],
    )


@pytest.mark.parametrize("kind", KINDS)
def test_filters_agree_with_the_cases(kind: str) -> None:
    for case in CASES[kind]:
        found, expected = decided(kind, case), case["expected"]
        tolerance = UNICYCLE if kind == "cbf_unicycle" else TOLERANCE
        if kind == "approach":
            assert found.share == pytest.approx(expected["share"], abs=tolerance)
            continue
        assert found.status == expected["status"]
        velocity = expected.get("u", [expected.get("v"), expected.get("w")])
        np.testing.assert_allclose(found.velocity, velocity, rtol=0.0, atol=tolerance)
        assert found.slack == pytest.approx(expected.get("slack", 0.0), abs=tolerance)
        assert found.share == pytest.approx(expected.get("share", 1.0), abs=tolerance)


def _places(size: float) -> st.SearchStrategy[float]:
    return st.floats(-size, size).map(lambda value: round(value, 3))


@settings(max_examples=150, deadline=None)
@given(
    st.tuples(_places(1.2), _places(1.2)),
    st.lists(st.tuples(_places(3), _places(3), _places(1.5), _places(1.5), st.just(0.25)), max_size=12),
    st.tuples(_places(0.7), _places(0.7)),
    st.booleans(),
)
def test_no_grid_point_is_nearer_or_violates_less(
    wanted: tuple[float, float], people: list[tuple[float, ...]], velocity: tuple[float, float], bounded: bool
) -> None:
    most = 3.0 if bounded else None
    found = nav.laws.Barrier().decide(wanted, velocity=velocity, people=people, max_acceleration=most)
    grid = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, 81)] * 2), axis=-1).reshape(-1, 2)
    grid = grid[np.hypot(*grid.T) <= 1.0]
    if bounded:
        grid = grid[np.hypot(*(grid - velocity).T) <= 0.3]
    least = np.zeros(len(grid))
    own = 0.0
    for x, y, vx, vy, radius in people:
        place, speed = np.array([x, y]), np.array([vx, vy])
        distance = math.hypot(x, y)
        normal = -place / distance if distance > 0.0 else np.array([1.0, 0.0])
        bound = normal @ speed - (distance**2 - (0.25 + radius) ** 2) / (2.0 * max(distance, TINY))
        least = np.maximum(least, bound - grid @ normal)
        own = max(own, bound - normal @ found.velocity)
    assert np.hypot(*found.velocity) <= 1.0 + 1e-9
    if found.status == "infeasible":
        assert own == pytest.approx(found.slack, rel=1e-9, abs=1e-9)
        assert found.slack <= least.min(initial=np.inf) + 1e-9 * max(1.0, found.slack)
        return
    assert own <= 1e-9
    allowed = grid[least <= 0.0]
    if len(allowed):
        assert np.hypot(*(found.velocity - wanted)) <= np.hypot(*(allowed - wanted).T).min() + 1e-9


def test_a_filter_stands_in_the_place_of_a_shield() -> None:
    person = nav.Human(start=(6.0, 0.05), velocity=(-1.0, 0.0), radius=0.25)
    robot = nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=3.0)
    scene = nav.Scenario(robot=robot, start=(0, 0), goal=(6, 0), obstacles=[person], control_period=0.1)

    class Straight:
        def velocity(self, situation: nav.Situation) -> tuple[float, float]:
            return 0.0 * situation.time + 1.0, 0.0

    with pytest.raises(InvalidParameterError, match="filter"):
        nav.SafeNavigation(Straight(), filter=nav.laws.Barrier(), shield=nav.Shield())
    alone = nav.simulate(scene, Straight())
    filtered = nav.simulate(scene, nav.SafeNavigation(Straight(), filter=nav.laws.Barrier(margin=0.05)))
    assert alone.contacts_toward == 1
    assert filtered.contacts_toward == 0
    assert filtered.min_clearance[0] > 0.0
    with pytest.raises(InvalidParameterError, match="filter"):
        nav.simulate(scene, nav.SafeNavigation(Straight(), filter=nav.laws.BarrierUnicycle()))


def test_what_a_filter_does_not_know_is_said() -> None:
    law = nav.SafeNavigation(nav.OptimalReciprocalCollisionAvoidance(), filter=nav.laws.VelocityClamp())
    world = scenarios.social("frontal_approach", 0, law=law)
    assert "filter_assumes_less" in {each.code for each in world.warnings}
    open_floor = scenarios.social("circular_crossing", 0, law=law)
    assert "filter_assumes_less" not in {each.code for each in open_floor.warnings}


def test_bad_arguments_of_filters_are_named() -> None:
    for made, name in ((nav.laws.Barrier, "rate"), (nav.laws.BarrierUnicycle, "ahead")):
        with pytest.raises(InvalidParameterError, match=name):
            made(**{name: 0.0})
    with pytest.raises(InvalidParameterError, match="margin"):
        nav.laws.CollisionCone(margin=-0.1)
    with pytest.raises(InvalidParameterError, match="simulation_time_step"):
        nav.laws.ApproachMonitor(simulation_time_step=1e-9)
    with pytest.raises(InvalidParameterError, match="people"):
        nav.laws.Barrier().decide((1, 0), velocity=(0, 0), people=[(1, 0, float("nan"), 0, 0.2)])


def test_a_rule_that_nothing_obeys_is_doubted() -> None:
    near = [(0.55, 0.0, -1.5, 0.0, 0.25)]
    found = nav.laws.Barrier().decide((1.0, 0.0), velocity=(0.9, 0.0), people=near, max_acceleration=3.0)
    assert found.status == "infeasible"
    assert [each.code for each in found.warnings] == ["filter_infeasible"]
    assert not found.warnings[0].safe_side
    assert not nav.laws.Barrier().decide((1.0, 0.0), velocity=(0.9, 0.0), people=[]).warnings


def test_a_record_counts_what_is_infeasible() -> None:
    law = nav.SafeNavigation(entry("straight").law, filter=nav.laws.Barrier(rate=5.0))
    robot = nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=1.0)
    person = nav.Human(start=(4.0, 0.0), velocity=(-1.6, 0.0), radius=0.25)
    scene = nav.Scenario(robot=robot, start=(0, 0), goal=(6, 0), obstacles=[person], control_period=0.1)
    record = nav.metrics.record_safety(scene, law)
    assert record.shares["infeasible"] > 0.0
    assert sum(record.shares.values()) == pytest.approx(1.0)
    assert record.warnings[0].code == "filter_infeasible"
    assert "infeasible" in repr(record)


def test_a_robot_with_two_wheels_keeps_off() -> None:
    law = nav.SafeNavigation(entry("straight").law, filter=nav.laws.BarrierUnicycle(margin=0.1))
    person = nav.Human(start=(4.0, 0.3), velocity=(-0.6, 0.0), radius=0.25)
    robot = nav.DifferentialDriveRobot(radius=0.25, max_speed=1.0)
    scene = nav.Scenario(
        robot=robot, start=(0, 0), goal=(6, 0), obstacles=[person], control_period=0.1, time_limit=20.0
    )
    run = nav.simulate(scene, law)
    assert run.contacts_toward == 0
    assert run.outcome == "arrived"
    with pytest.raises(InvalidParameterError, match="BarrierUnicycle"):
        nav.simulate(scene, nav.SafeNavigation(entry("straight").law, filter=nav.laws.Barrier()))


@pytest.mark.parametrize("turned", [0.0, 0.3, -0.8])
@pytest.mark.parametrize("wheels", [False, True])
def test_a_barrier_keeps_off_a_wall_along_which_the_robot_slides(turned: float, wheels: bool) -> None:
    # A force law sees a wall from 0.3 m on; the barrier looks as far as it needs.
    middle, along = np.array([3.0, 0.2]), 2.5 * np.array([-np.sin(turned), np.cos(turned)])
    wall = nav.StaticMap.from_polylines([[tuple(middle - along), tuple(middle + along)]])
    robot, rule = (
        (nav.DifferentialDriveRobot(radius=0.25, max_speed=1.0), nav.laws.BarrierUnicycle())
        if wheels
        else (nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=3.0), nav.laws.Barrier())
    )
    law = nav.SafeNavigation(entry("straight").law, map=wall, filter=rule)
    scene = nav.Scenario(robot=robot, start=(0, 0), goal=(8, 0), control_period=0.1, time_limit=15.0)
    run = nav.simulate(scene, law)
    nearest = min(wall.clearance(tuple(place)) for place in run.position)
    assert nearest > robot.radius
    assert nearest < robot.radius + 0.25


def test_a_controller_tells_of_its_filter() -> None:
    law = nav.SafeNavigation(entry("straight").law, filter=nav.laws.CollisionCone())
    controller = nav.Controller(law, nav.HolonomicRobot(radius=0.25), goal=(6.0, 0.0), people=1, control_period=0.1)
    assert {each.code for each in controller.warnings} == {"filter_assumes_less"}
    touched = controller.update(0.0, (0.0, 0.0), (0.5, 0.0), people={"Ada": (0.5, 0.0, 0.0, 0.0)})
    assert touched.status == "infeasible"
    with pytest.raises(InvalidParameterError, match="velocity"):
        controller.update(0.1, (0.0, 0.0), (0.5, 0.0), people={"Ada": (0.5, 0.0, None, None)})


def test_words_put_filters_around_laws() -> None:
    found = entry("orca+guide+collision_cone(rate=2,margin=0.1)")
    assert found.filter == nav.laws.CollisionCone(rate=2.0, margin=0.1)
    built = found.built(person_speed=1.6)
    assert isinstance(built, nav.SafeNavigation)
    assert built.shield is None
    assert built.filter == found.filter
    for word in ("orca+shield+barrier", "orca+barrier+collision_cone", "orca+barrier(gain=1)", "orca+barier"):
        with pytest.raises(InvalidParameterError, match="laws"):
            entry(word)
