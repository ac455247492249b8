"""The standard scenes of social navigation: draws, occlusion, tasks, certificates."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import arena, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[str, Any]:
    """Return the scenes and certificates of the specification."""
    data: dict[str, Any] = json.loads((shared / "spec" / "arena_cases.json").read_text(encoding="utf-8"))
    return data


def test_scenes_are_those_of_the_cases(cases: dict[str, Any]) -> None:
    assert {case["name"] for case in cases["scenes"]} == set(scenarios.SOCIAL)
    for case in cases["scenes"]:
        _compare(case)


def test_certificates_are_those_of_the_cases(cases: dict[str, Any]) -> None:
    for name, expected in cases["certificate"].items():
        found = arena.certify_many([scenarios.social(name, seed) for seed in range(4)])
        assert [each.arrival_time for each in found] == pytest.approx(expected[:4], abs=1e-9)


def test_a_certified_way_keeps_off_people_and_walls() -> None:
    world = scenarios.social("perpendicular_traffic", 3)
    found = arena.certify(world)
    way = found.path
    assert np.hypot(*np.diff(way, axis=0).T).max() <= 0.16 + 1e-12
    assert np.hypot(*(way[-1] - world.robots[0].goal)) <= 0.3
    alone = nav.simulate(replace(world, robots=[]))
    step = round(0.2 / world.step)
    places = alone.obstacle_position[::step][: len(way)]
    gaps = np.hypot(*np.moveaxis(places[1:] - way[1:, None], -1, 0))
    assert gaps.min() >= 0.55 - 1e-9


def test_a_closed_room_is_not_certified() -> None:
    person = nav.Person(start=(5, 5))
    walls = [[(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]]
    robot = nav.Robot(start=(0, 0), goal=(5, 0))
    found = arena.certify(nav.World(robots=[robot], people=[person], walls=walls, time_limit=20.0))
    assert not found.solvable
    assert np.isnan(found.arrival_time)


def test_walls_hide_people() -> None:
    told: list[bool] = []

    class Watch:
        def velocity(self, situation: nav.Situation) -> tuple[float, float]:
            told.append(bool(situation.obstacle_present[0]))
            return 0.0, 0.0

    person = nav.Person(start=(0, 2), route=[(6, 2)], desired_speed=1.0)
    robot = nav.Robot(start=(0, 0), goal=(9, 0), law=Watch(), occlusion=True)
    world = nav.World(people=[person], robots=[robot], walls=[[(-2, 1), (1.5, 1)]], time_limit=6.0)
    run = nav.simulate(world)
    place = run.obstacle_position[: len(told), 0]
    hidden = place[:, 0] / 2 <= 1.5
    assert told == (~hidden).tolist()
    assert 10 < sum(told) < len(told) - 10


@pytest.mark.parametrize("name", ["following_human", "leading_human", "accompanying_peer"])
def test_a_law_keeps_its_place_beside_a_person(name: str) -> None:
    law = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.05)
    world = scenarios.social(name, 1, law=law)
    assert arena.task_error(nav.simulate(world)) < 0.75
    robot = replace(world.robots[0], task=None)
    assert arena.task_error(nav.simulate(replace(world, robots=[robot])), world.robots[0].task) > 0.75


def test_a_task_needs_a_person_and_a_known_word() -> None:
    with pytest.raises(InvalidParameterError, match="task"):
        nav.Robot(start=(0, 0), goal=(9, 0), task="above")  # type: ignore[arg-type]
    with pytest.raises(InvalidParameterError, match=r"robots\[0\].task"):
        nav.World(robots=[nav.Robot(start=(0, 0), goal=(9, 0), task="behind")])
    with pytest.raises(InvalidParameterError, match="frontal_approach"):
        scenarios.social("frontal", 0)
    with pytest.raises(InvalidParameterError, match="seed"):
        scenarios.social("frontal_approach", -1)


def test_people_do_not_react_where_told() -> None:
    assert {person.awareness for person in scenarios.social("crowd_navigation", 5, reacting=False).people} == {0.0}


def _compare(case: dict[str, Any]) -> None:
    world = scenarios.social(case["name"], case["seed"])
    robot = world.robots[0]
    for name in ("start", "goal"):
        assert getattr(robot, name) == pytest.approx(case[name], rel=5e-12, abs=1e-15)
    assert world.time_limit == case["limit"]
    assert robot.occlusion == case.get("occlusion", False)
    assert robot.task == case.get("task")
    assert len(world.walls) == len(case["walls"])
    for wall, expected in zip(world.walls, case["walls"], strict=True):
        np.testing.assert_allclose(wall, expected, rtol=5e-12, atol=1e-15)
    for person, expected in zip(world.people, case["people"], strict=True):
        assert person.start == pytest.approx(expected["start"], rel=5e-12, abs=1e-15)
        assert np.array(person.route).ravel() == pytest.approx(np.ravel(expected["route"]), rel=5e-12, abs=1e-15)
        assert person.desired_speed == pytest.approx(expected["speed"], rel=5e-12)
        assert (person.at_end, person.radius) == (expected["at_end"], expected["radius"])
        assert person.group == expected.get("group")
        assert person.arrival_radius == expected.get("arrival", 0.3)
        assert person.awareness == (0.0 if expected.get("insists") else 1.0)
        assert (person.recording is None) == ("track" not in expected)
        if person.recording is not None:
            for given, wanted in zip(person.recording, expected["track"], strict=True):
                np.testing.assert_allclose(given, wanted, rtol=5e-12, atol=1e-14)
