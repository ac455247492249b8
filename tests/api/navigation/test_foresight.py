"""Foresight under the shield: shown decisions, suites, robots with two wheels, and what is recorded of it."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import benchmark, entry
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws import Foresight, SafeNavigation, Shield, Yielding

CASES = json.loads((Path(__file__).parents[2] / "golden" / "foresight_cases.json").read_text())["cases"]
FIELD = nav.VirtualForceField()
LATE = nav.Measurement(scale=0.025, latency=0.1, of="obstacles")


@pytest.mark.parametrize("case", CASES)
def test_controller_gives_the_shown_commands(case: dict) -> None:
    robot, period = case["robot"], case["robot"]["control_period"]
    body = nav.HolonomicRobot(
        radius=robot["radius"], max_speed=robot["max_speed"], max_acceleration=robot["max_acceleration"]
    )
    shield = Shield(
        person_speed=case["person_speed"],
        latency=case["latency"],
        position_error=case["position_error"],
        margin=case["margin"],
        position_tracking=0.0,
        velocity_tracking=(0.0, 0.0),
    )
    law = SafeNavigation(FIELD, shield=shield, foresight=Foresight())
    people, sizes = len(case["steps"][0]["people"]), case["steps"][0]["people"][0][4]
    controller = nav.Controller(
        law, body, case["goal"], start=(0.0, 0.0), people=people, person_radius=sizes, control_period=period
    )
    for number, step in enumerate(case["steps"]):
        seen = {index: person[:4] for index, person in enumerate(step["people"])}
        told = controller.update(number * period, step["position"], step["velocity"], people=seen)
        assert told.velocity == pytest.approx(step["command"], abs=1e-9)


def test_late_and_noisy_crowds_are_passed() -> None:
    words = ["field+shield+yielding", "field+shield+foresight"]
    found = benchmark("crowd", words, cases=40, seed=30000, noise=0.025, latency=0.1)
    today, ahead = (found.success(word).value for word in words)
    assert ahead >= 0.97 > today
    assert found.at_fault(words[1]).value == 0.0


def test_two_wheels_pass_a_late_and_noisy_crowd() -> None:
    robot = nav.DifferentialDriveRobot()
    drawn = scenarios.random_traffic_batch(range(40000, 40012), obstacles=12)
    scenes = [replace(scene, robot=robot, measurement=LATE) for scene in drawn]
    shield = Shield(latency=0.1, position_error=0.0354)
    law = SafeNavigation(FIELD, shield=shield, foresight=Foresight())
    table = nav.simulate_many(scenes, [law], stop_on_contact=True)
    assert (table.outcome == "arrived").sum() >= 11
    assert not table.contacts_at_fault.any()


def test_two_wheels_turn_to_a_goal_behind_them() -> None:
    scene = nav.Scenario(
        robot=nav.DifferentialDriveRobot(), start=(0.0, 0.0), goal=(-4.0, 0.5), heading=0.0, time_limit=20.0
    )
    run = nav.simulate(scene, SafeNavigation(FIELD, shield=Shield(), foresight=Foresight()))
    assert run.outcome == "arrived"
    assert abs(math.remainder(float(run.heading[-1]) - math.pi, 2.0 * math.pi)) < 1.0


@pytest.mark.parametrize("others", [[(3.4, 2.4), (3.4, 1.4)], [(3.0, 2.3), (4.0, 1.7)]])
def test_two_wheels_go_around_people_who_stand_in_their_way(others: list[tuple[float, float]]) -> None:
    walls = [[(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0), (0.0, 0.0)]]
    people = [nav.Person(start=place, route=[place], desired_speed=1.0) for place in others]
    law = SafeNavigation(
        FIELD,
        map=nav.StaticMap.from_polylines(walls),
        guide=nav.Guide(),
        shield=Shield(person_speed=1.6, margin=0.02, wall_margin=0.02),
        foresight=Foresight(),
    )
    body = nav.DifferentialDriveRobot(radius=0.25, max_speed=0.6, max_acceleration=3.0)
    robot = nav.Robot(body, start=(0.6, 2.0), goal=(7.4, 1.9), law=law)
    run = nav.simulate(nav.World(robots=[robot], people=people, walls=walls, time_limit=40.0))
    assert run.outcome == "arrived"
    assert not run.contacts_at_fault


def test_threads_and_batches_change_no_bit() -> None:
    law = SafeNavigation(FIELD, shield=Shield(latency=0.1, position_error=0.0354), foresight=Foresight())
    scenes = [replace(each, measurement=LATE) for each in scenarios.random_traffic_batch(range(6), obstacles=6)]
    tables = [nav.simulate_many(scenes, [law], threads=threads) for threads in (1, 2)]
    assert np.array_equal(tables[0].min_clearance, tables[1].min_clearance)
    alone = [nav.simulate(scene, law).min_clearance.min() for scene in scenes]
    assert np.array_equal(tables[0].min_clearance, alone)


def test_it_goes_around_a_dead_end_with_a_guide() -> None:
    trap = nav.StaticMap.from_polylines([[(1.0, 1.5), (3.0, 1.5), (3.0, -1.5), (1.0, -1.5)]])
    scene = nav.Scenario(start=(2.0, 0.0), goal=(5.0, 0.0), time_limit=40.0)
    law = SafeNavigation(FIELD, map=trap, guide=nav.Guide(), shield=Shield(), foresight=Foresight())
    run = nav.simulate(scene, law)
    assert run.outcome == "arrived"
    assert run.wall_contacts == 0


def test_decisions_record_what_is_expected() -> None:
    law = SafeNavigation(FIELD, shield=Shield(), foresight=Foresight(stages=10))
    scene = scenarios.random_traffic(4, seed=3)
    made = nav.metrics.record_safety(scene, law).decisions[5]
    assert made.foreseen_time == pytest.approx(0.4 * np.arange(11))
    assert made.foreseen_people.shape == (len(scene.obstacles), 11, 2)
    assert len(made.foreseen_way) == 11
    assert np.hypot(*np.diff(made.foreseen_way, axis=0).T).max() < 0.7 * 0.4 * 1.4
    moved = made.foreseen_people[:, 1] - made.foreseen_people[:, 0]
    assert np.allclose(moved, 0.4 * np.array([each.velocity for each in scene.obstacles]))
    without = nav.metrics.record_safety(scene, SafeNavigation(FIELD, shield=Shield())).decisions[5]
    assert not len(without.foreseen_way)
    assert without.foreseen_people.shape == (len(scene.obstacles), 0, 2)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("stages", (1, 51, 2.5, -1, "x")),
        *((name, (0.0, -1.0, math.inf, math.nan)) for name in ("step", "risk_weight", "comfort", "acceleration")),
        *((name, (-1.0, math.inf, math.nan)) for name in ("clearance", "comfort_weight", "change_weight", "spread")),
    ],
)
def test_numbers_that_are_not_allowed_are_refused(name: str, values: tuple[object, ...]) -> None:
    for value in values:
        with pytest.raises(InvalidParameterError, match=name):
            Foresight(**{name: value})  # type: ignore[arg-type]  # on purpose


def test_yielding_beside_it_is_refused() -> None:
    with pytest.raises(InvalidParameterError, match="yielding"):
        SafeNavigation(FIELD, yielding=Yielding(), foresight=Foresight())
    with pytest.raises(InvalidParameterError, match="foresight"):
        SafeNavigation(FIELD, foresight=Yielding())  # type: ignore[arg-type]  # on purpose
    with pytest.raises(InvalidParameterError, match="not both"):
        entry("field+yielding+foresight")
    law = SafeNavigation(FIELD, foresight=Foresight(), preferred_speed=1e-3)
    with pytest.raises(InvalidParameterError, match="preferred_speed"):
        nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(3.0, 0.0)), law)


def test_who_has_no_velocity_is_estimated_from_places() -> None:
    law = SafeNavigation(FIELD, shield=Shield(person_speed=1.0), foresight=Foresight())
    sideways = []
    for told in (True, False):
        controller = nav.Controller(law, nav.HolonomicRobot(), (8.0, 0.0), start=(0.0, 0.0))
        place, speed = np.zeros(2), np.zeros(2)
        for number in range(25):
            time = 0.06 * number
            person = (5.0 - time, 0.02, -1.0, 0.0) if told else (5.0 - time, 0.02, None, None)
            command = controller.update(time, place, speed, people={"a": person})
            place = place + 0.03 * (speed + np.array(command.velocity))
            speed = np.array(command.velocity)
        sideways.append(place[1])
    assert sideways[1] == pytest.approx(sideways[0], abs=0.05)
    assert abs(sideways[1]) > 0.1


def test_it_is_replaced_like_any_other_part() -> None:
    law = SafeNavigation(FIELD, foresight=Foresight())
    changed = law.replaced(foresight=Foresight(stages=8))
    assert (changed.foresight, changed.law) == (Foresight(stages=8), FIELD)
    assert law.replaced(foresight=None).foresight is None
