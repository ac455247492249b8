"""Worlds, their runs, tables and benchmarks say where a shield assumes less than there is."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import pytest

from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark
from hrsafety.cli import exit_codes, main
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.plausibility import unsafe_doubts


def shielded(**shield: Any) -> nav.SafeNavigation:
    return nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(**({"margin": 0.0125} | shield)))


def world(law: Any, person: dict[str, Any] | None = None, **robot: Any) -> nav.World:
    walker = nav.Person(**({"start": (4, 1), "route": [(0, 1)], "desired_speed": 1.0} | (person or {})))
    driven = nav.Robot(start=(0, 0), goal=(4, 0), law=law, **robot)
    return nav.World(people=[walker], robots=[driven], time_limit=1.0)


def subjects(place: nav.World) -> list[str]:
    return [each.subject for each in place.warnings]


def test_enough_is_no_doubt() -> None:
    assert world(shielded(person_speed=1.0)).warnings == ()
    assert world(shielded(person_speed=None)).warnings == ()
    assert world(nav.VirtualForceField(), {"desired_speed": 3.0}).warnings == ()


@pytest.mark.parametrize(
    ("person", "robot", "subject"),
    [
        ({"desired_speed": 1300.0}, {}, "people[0].desired_speed"),
        ({"recording": ([0.0, 0.4], [(4000.0, 1000.0), (3500.0, 1000.0)])}, {}, "people[0].recording"),
        ({"radius": 25.0}, {}, "people[0].radius"),
        ({}, {"measurement": nav.Measurement(latency=40.0)}, "robots[0].latency"),
        ({}, {"body": nav.HolonomicRobot(max_speed=700.0)}, "robots[0].robot_max_speed"),
    ],
)
def test_numbers_in_other_units_are_told(person: dict[str, Any], robot: dict[str, Any], subject: str) -> None:
    place = world(nav.VirtualForceField(), {"start": (40.0, 40.0)} | person, **robot)
    assert [(each.code, each.subject) for each in place.warnings] == [("implausible", subject)]
    assert simulated([place])[0].warnings == place.warnings


@pytest.mark.parametrize(
    ("person", "least"),
    [
        ({"desired_speed": 1.2}, "person_speed=1.2"),
        ({"desired_speed": None}, "person_speed=2.2"),
        ({"model": nav.crowd.Moussaid()}, "person_speed=1.3"),
        ({"model": nav.crowd.SocialForce2000()}, "has no largest speed"),
        # Forces push people away who do not want to go.
        ({"model": nav.crowd.SocialForce2000(), "desired_speed": 0.0}, "has no largest speed"),
        ({"recording": ([0.0, 1.0], [(4.0, 1.0), (2.5, 1.0)])}, "person_speed=1.5"),
    ],
)
def test_people_who_may_be_faster_are_told(person: dict[str, Any], least: str) -> None:
    place = world(shielded(person_speed=1.0), person)
    assert subjects(place) == ["robots[0].law.shield.person_speed"]
    assert least in place.warnings[0].message


def test_measurements_that_are_worse_are_told() -> None:
    late = nav.Measurement(scale=0.05, of="both", latency=0.2)
    place = world(shielded(person_speed=1.0), measurement=late)
    names = [each.rpartition(".")[2] for each in subjects(place)]
    assert names == ["latency", "position_error", "margin"]
    assert "knows its own place" in place.warnings[2].message


def test_a_range_within_which_the_robot_cannot_stop_is_told() -> None:
    place = world(shielded(person_speed=1.0), sensing_range=0.65)
    assert [(each.code, each.subject) for each in place.warnings] == [("shield_sees_less", "robots[0].sensing_range")]
    # Radii 0.2 and 0.25, margin 0.0125; a control period and two of braking at 1.0 and 0.7 m/s.
    assert "give at least sensing_range=0.718" in place.warnings[0].message
    assert world(shielded(person_speed=1.0), sensing_range=0.718).warnings == ()


def test_maps_of_laws_in_worlds_need_a_margin_of_their_own() -> None:
    law = shielded(person_speed=1.0).replaced(map=nav.StaticMap.from_polylines([[(0.0, -2.0), (4.0, -2.0)]]))
    assert subjects(world(law)) == ["robots[0].law.shield.wall_margin"]


def test_long_motion_steps_need_a_margin() -> None:
    # Up to 0.5 m/s in a control period of 0.05 s, reached at once where the plan has a ramp.
    place = world(shielded(person_speed=1.0, margin=0.005))
    assert subjects(place) == ["robots[0].law.shield.margin"]
    assert "margin=0.0125" in place.warnings[0].message
    wall = [[(0.0, -2.0), (4.0, -2.0)]]
    assert "robots[0].law.shield.wall_margin" in subjects(replace(world(shielded(person_speed=1.0)), walls=wall))
    assert replace(world(shielded(person_speed=1.0, wall_margin=0.0125)), walls=wall).warnings == ()


@pytest.mark.parametrize("step", [0.01, 0.06])
def test_the_motion_step_of_runs_counts(step: float) -> None:
    scene = nav.Scenario(start=(0, 0), goal=(4, 0), time_limit=4.0)
    law = shielded(margin=0.005)
    run = nav.Run(scene, law, step=step)
    run.step()
    found = [
        nav.simulate(scene, law, step=step),
        nav.evaluate(scene, law, step=step).trajectory,
        run.trajectory,
        nav.simulate_many(scene, law, step=step),
        nav.simulate_batch([scene], law, step=step),
        nav.falsify(scene, law, episodes=2, step=step),
    ]
    margins = [[each for each in result.warnings if each.subject.endswith("margin")] for result in found]
    assert [len(each) for each in margins] == [int(step > 0.05)] * len(found)


def test_sources_and_other_robots_count() -> None:
    fast = nav.Source(low=(8, 0), high=(9, 1), rate=1.0, route=[(0, 0)], desired_speed=2.0)
    robots = [
        nav.Robot(start=(0, 4 * index), goal=(4, 4 * index), law=shielded(person_speed=speed))
        for index, speed in enumerate((0.5, 1.9))
    ]
    place = nav.World(sources=[fast], robots=robots)
    assert subjects(place) == [f"robots[{index}].law.shield.person_speed" for index in (0, 1)]
    alone = nav.World(robots=robots)
    assert subjects(alone) == ["robots[0].law.shield.person_speed"]
    assert "robots[1] moves" in alone.warnings[0].message


def test_runs_and_tables_carry_the_doubts() -> None:
    place = world(shielded(person_speed=0.5))
    run = nav.simulate(place)
    assert run.warnings == place.warnings
    assert place.warnings[0].message in repr(run)
    table = nav.simulate_many([place, place])
    assert [each.code for each in table.warnings] == ["shield_assumes_less", "same_runs"]
    assert "1 more of this kind in these scenarios" in repr(table)
    assert pickle.loads(pickle.dumps(table)).warnings == table.warnings


def test_metrics_of_a_run_carry_its_doubts() -> None:
    walker = nav.MovingDisc(center=(2.0, 1.0), velocity=(0.0, -1.5), radius=0.3)
    scene = nav.Scenario(start=(0, 0), goal=(4, 0), obstacles=[walker], time_limit=4.0)
    run = nav.simulate(scene, shielded(person_speed=0.5))
    doubts = {each.code for each in run.warnings}
    assert "shield_assumes_less" in doubts
    found = nav.metrics.evaluate(run)
    assert {each.code for each in found.warnings} == doubts
    assert "shield" in repr(found)
    assert {each.code for each in nav.metrics.evaluate_many([run, run]).warnings} == doubts


def test_a_benchmark_tells_what_its_shields_do_not_cover(capsys: pytest.CaptureFixture[str]) -> None:
    fair = benchmark("s5", ["field", "field+shield"], cases=2, person_speed=1.0)
    assert fair.warnings == ()
    assert benchmark("s5", ["field"], cases=2, person_speed=0.5).warnings == ()
    words = ["benchmark", "corridor", "--laws", "field+shield", "--cases", "1", "--strict"]
    assert main(words) == exit_codes.WARNED
    assert "people of corridor move at up to 2.2 m/s" in capsys.readouterr().err


# ---- doubts of a world reach its tables ----------------------------------------------------------


Person = nav.Person
ROOM = [[(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0), (0.0, 0.0)]]
PILLAR = nav.Disc(center=(3.0, 3.0), radius=0.5)
DOUBTFUL: dict[str, tuple[dict[str, Any], str]] = {
    "goal in a wall": ({"walls": [PILLAR], "goal": (3.0, 3.0)}, "goal_in_wall"),
    "start in a wall": ({"walls": [PILLAR], "people": [Person(start=(3.0, 3.0), route=[(1.0, 1.0)])]}, "start_in_wall"),
    "start on a line": ({"walls": ROOM, "people": [Person(start=(6.0, 3.0), route=[(1.0, 1.0)])]}, "start_in_wall"),
    "millimeters": ({"people": [Person(start=(900.0, 3.0), route=[(1.0, 1.0)], radius=250.0)]}, "implausible"),
    "a recording through a line": (
        {"walls": ROOM, "people": [Person(start=(2.0, 3.0), recording=([0.0, 5.0], [(2.0, 3.0), (9.0, 3.0)]))]},
        "recording_in_wall",
    ),
    "a recording in a solid": (
        {"walls": [PILLAR], "people": [Person(start=(2.0, 3.0), recording=([0.0, 5.0], [(2.0, 3.0), (3.0, 3.0)]))]},
        "recording_in_wall",
    ),
}


@pytest.mark.parametrize("name", DOUBTFUL)
def test_doubts_of_a_world_reach_runs_tables_and_comparisons(name: str) -> None:
    given, code = DOUBTFUL[name]
    fields = dict(given)
    robot = nav.Robot(start=(1.0, 5.0), goal=fields.pop("goal", (5.0, 5.0)))
    world = nav.World(robots=[robot], time_limit=1.0, **fields)
    laws = [nav.Khatib(), nav.Masoud()]
    results = (
        world,
        nav.simulate(world),
        nav.simulate_many([world]),
        nav.simulate_many([world], laws),
        nav.compare([world], laws, seeds=2),
    )
    for result in results:
        assert code in {each.code for each in unsafe_doubts(result.warnings)}, type(result).__name__


def test_recordings_beside_walls_are_no_doubt() -> None:
    walk = Person(start=(1.0, 1.0), recording=([0.0, 5.0], [(1.0, 1.0), (5.0, 5.0)]))
    assert nav.World(people=[walk], walls=ROOM).warnings == ()
