"""People whom the robot does not see: where they can be, what a shield does about them, and what refutes it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark
from hrsafety.benchmarks.hidden import ROBOT, hidden_entry
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.pursuits import hidden_encounters
from hrsafety.plausibility import unsafe_doubts

UNSEEN = nav.laws.Unseen(person_radius=0.3, creep_speed=0.1)
OUTLINE = [(0, 0), (6, 0), (6, 6), (4.2, 6), (4.2, 1.8), (0, 1.8), (0, 0)]
CORNER = nav.StaticMap.from_polylines([OUTLINE], radius=0.05)
SCENE = nav.Scenario(
    robot=ROBOT, start=(0.8, 0.9), goal=(5.1, 5.2), control_period=0.05, time_limit=40.0, rest_time=40.0
)


def law(unseen: nav.laws.Unseen | None = UNSEEN, **shield: Any) -> nav.SafeNavigation:
    return nav.SafeNavigation(
        nav.VirtualForceField(),
        map=CORNER,
        guide=nav.maps.Guide(),
        shield=nav.Shield(unseen=unseen, **{"person_speed": 1.6, **shield}),
    )


def encounters(guarded: nav.SafeNavigation, *, seed: int = 0, most: int = 8) -> tuple[dict[str, Any], float]:
    return hidden_encounters(replace(SCENE, time_limit=12.0), guarded, radius=0.3, speed=1.6, most=most, seed=seed)


@pytest.mark.parametrize(
    "unseen",
    [
        UNSEEN,
        replace(UNSEEN, creep_speed=0.0),
        replace(UNSEEN, range=2.5, beams=500),
        replace(UNSEEN, field_of_view=1.5 * math.pi),
        replace(UNSEEN, cell=0.03, sampling=0.02),
    ],
)
def test_whoever_comes_out_of_hiding_was_reckoned_with_at_every_step(unseen: nav.laws.Unseen) -> None:
    found, _ = encounters(law(unseen), seed=3, most=4)
    assert len(found["margin"]) == 4
    # Tracked or within reach of the belief in every control period, lost and found again or not.
    assert not found["overlooked"].any()
    assert (found["margin"] > 0.0).all()


def test_people_who_are_faster_than_assumed_break_it() -> None:
    found, _ = encounters(law(person_speed=0.4), most=12)
    assert (found["margin"] < 0.0).any()
    assert found["overlooked"].any() or (found["fault_speed"] > 0.1).any()


def test_a_shield_of_seen_people_is_at_fault() -> None:
    found, alone = encounters(law(replace(UNSEEN, creep_speed=9.0)), most=12)
    faulty = found["margin"] < 0.0
    assert faulty.any()
    assert (found["fault_speed"][faulty] > 0.05).all()
    assert alone < 12.0
    _, careful = encounters(law(), most=1)
    assert careful < 1.6 * alone


def test_the_benchmark_runs_places_of_three_kinds() -> None:
    result = benchmark("hidden_people", ["corner(creep=0.1)", "corner(reckon=0)"], cases=4)
    assert result.at_fault("corner(creep=0.1)").value == 0.0
    assert result.at_fault("corner(reckon=0)").value > 0.0
    assert result.mean_arrival("corner(creep=0.1)") < 16.0
    assert result.accepted == {"corner(creep=0.1)": "- / - / 0"}
    assert hidden_entry("rooms").unseen.creep_speed == 0.0
    for word in ("room", "doors(creep=a)", "corner(reckon=2)", "corner(reckon=0,creep=0.1)", "corner(speed=1)"):
        with pytest.raises(InvalidParameterError, match="laws"):
            hidden_entry(word)


def test_hidden_starts_are_searched() -> None:
    found = nav.falsify(SCENE, law(), method="hidden", person_radius=0.3, episodes=5, step=0.01)
    assert not found.broken
    assert found.episodes == len(found.margin) == 5
    assert not unsafe_doubts(found.warnings)
    # Whoever walks through walls says nothing.
    (doubt,) = [
        each for each in nav.falsify(SCENE, law(), person_radius=0.3, episodes=2).warnings if "unseen" in each.subject
    ]
    assert doubt.code == "shield_assumes_less"
    with pytest.raises(InvalidParameterError, match="law"):
        nav.falsify(SCENE, law(None), method="hidden")


def test_ways_that_the_shield_takes_for_impossible_are_doubted() -> None:
    def doubts(*obstacles: nav.Human) -> list[str]:
        run = nav.simulate(replace(SCENE, obstacles=obstacles, time_limit=1.0), law())
        return [each.code for each in unsafe_doubts(run.warnings)]

    walks = {"radius": 0.3}
    assert doubts(nav.Human.from_path([0.0, 4.0], [(5.1, 5.0), (5.1, 1.0)], **walks)) == []
    through = nav.Human.from_path([0.0, 4.0], [(2.0, 2.5), (2.0, -0.5)], **walks)
    assert doubts(through) == ["shield_assumes_less"]
    assert doubts(nav.Human(start=(2.0, 2.5), velocity=(0.0, -1.0), **walks)) == ["shield_assumes_less"]
    assert doubts(nav.Human.from_path([0.5, 4.0], [(5.1, 5.0), (5.1, 2.0)], **walks)) == ["shield_assumes_less"]


def test_whom_no_wall_hides_is_dodged_and_whom_a_wall_hides_is_not_told_of() -> None:
    person = nav.Human(start=(5.1, 5.6), velocity=(0.0, 0.0), radius=0.3)
    run = nav.simulate(replace(SCENE, obstacles=(person,), time_limit=10.0), law())
    assert run.contacts_at_fault == 0
    alone = nav.simulate(replace(SCENE, time_limit=2.0), law())
    # Behind the corner he changes nothing.
    early = alone.time < 1.5
    assert np.array_equal(run.position[: early.sum()], alone.position[early])


def test_who_appears_where_a_controller_saw_nobody_refutes_it() -> None:
    lidar = nav.Lidar(map=CORNER, beams=1440, range_max=8.0)
    robot = nav.Controller(law(), ROBOT, (5.1, 5.2), control_period=0.05, lidar=lidar, person_radius=0.3)
    place = (0.8, 0.9)
    scan = lidar.scan(place)
    for index in range(4):
        told = robot.update(0.05 * index, place, (0.0, 0.0), scan=scan, heading=0.0)
        assert told.unexpected == ()
    told = robot.update(0.2, place, (0.0, 0.0), scan=scan, heading=0.0, people={"p": (2.0, 0.9, 0.0, 0.0)})
    assert told.unexpected == ("p",)
    assert "unexpected" in told.refuted
    assert told.status != "kept"


def test_what_does_not_fit_is_refused() -> None:
    for bad in (
        {"cell": 0.1},
        {"person_core": 0.5},
        {"beams": 0},
        {"range": 0.0},
        {"field_of_view": 7.0},
        {"creep_speed": -1.0},
        {"sampling": 0.0},
        {"pose_error": math.nan},
    ):
        with pytest.raises(InvalidParameterError, match=next(iter(bad))):
            nav.laws.Unseen(**bad)
    with pytest.raises(InvalidParameterError, match="person_speed"):
        nav.Shield(person_speed=None, unseen=UNSEEN)
    with pytest.raises(InvalidParameterError, match="map"):
        nav.simulate(SCENE, nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(unseen=UNSEEN)))
    outlined = nav.HolonomicRobot(max_speed=1.2, footprint=nav.robots.Footprint.rectangle(0.5, 0.4))
    with pytest.raises(InvalidParameterError, match="unseen"):
        nav.simulate(replace(SCENE, robot=outlined), law())
    with pytest.raises(InvalidParameterError, match="radius"):
        nav.simulate(replace(SCENE, obstacles=[nav.Human(start=(3, 0.9), velocity=(0.1, 0), radius=0.5)]), law())
    with pytest.raises(InvalidParameterError, match="unseen"):
        nav.metrics.record_safety(SCENE, law())


def test_walls_hide_people_from_a_robot_of_a_world() -> None:
    def codes(unseen: nav.laws.Unseen | None) -> set[str]:
        person = nav.Person(start=(5.1, 5.4), route=[(5.1, 3.0)])
        robot = nav.Robot(start=(0.8, 0.9), goal=(5.1, 5.2), body=ROBOT, law=law(unseen), occlusion=True)
        world = nav.World(people=[person], robots=[robot], walls=CORNER, time_limit=1.0)
        return {each.subject.rpartition(".")[2] for each in unsafe_doubts(nav.simulate(world).warnings)}

    assert "occlusion" in codes(None)
    # People of worlds come nearer to walls than a core.
    assert codes(UNSEEN) >= {"unseen"}
    assert "occlusion" not in codes(UNSEEN)
