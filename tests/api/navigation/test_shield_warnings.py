"""A shield that assumes less than its scene has says nothing about the run, and every result tells so."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from hrsafety import navigation as nav
from hrsafety.navigation.laws import SafeNavigation, Shield
from hrsafety.navigation.sensing import Measurement

FIELD = nav.VirtualForceField()
WALKER = nav.Human(start=(3.0, 3.0), velocity=(0.0, -1.2), max_speed=1.6)
TURNS_BACK = nav.Human.from_segments((3.0, 3.0), [(1.0, (0.0, -0.5), (0.0, -0.3)), (1.0, (0.0, 0.1), (0.0, 0.0))])
SCENE = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=(WALKER,))


def warned(scene: nav.Scenario, shield: Shield, **options: Any) -> set[tuple[str, str]]:
    run = nav.simulate(scene, SafeNavigation(FIELD, shield=shield), **options)
    return {(each.code, each.subject) for each in run.warnings if each.code.startswith("shield")}


def measured(of: str = "obstacles", **values: Any) -> nav.Scenario:
    return replace(SCENE, measurement=Measurement(of=of, **values))


def test_a_shield_that_covers_its_scene_carries_no_warning() -> None:
    assert warned(SCENE, Shield(person_speed=1.2)) == set()
    late = measured(scale=0.025, latency=0.1)
    assert warned(late, Shield(latency=0.1, position_error=0.0354)) == set()
    assert warned(SCENE, Shield(person_speed=None)) == set()


@pytest.mark.parametrize(
    ("scene", "shield", "subject", "told"),
    [
        (SCENE, Shield(person_speed=1.0), "shield.person_speed", "person_speed=1.2"),
        (measured(scale=0.0, latency=0.1), Shield(), "shield.latency", "latency=0.1"),
        (measured(scale=0.025), Shield(latency=0.2), "shield.position_error", "position_error=0.03536"),
        (measured(scale=0.025, distribution="gaussian"), Shield(), "shield.position_error", "position_error=0.2"),
        # Its own place, and half a motion step.
        (measured("robot", scale=0.025), Shield(), "shield.margin", "margin=0.03836"),
        (
            measured(scale=0.003),
            Shield(position_error=0.01, velocity_error=0.1, person_acceleration=1.0),
            "shield.velocity_error",
            "velocity_error=0.1414",
        ),
    ],
)
def test_what_a_scene_exceeds_is_named_with_the_least_that_covers_it(
    scene: nav.Scenario, shield: Shield, subject: str, told: str
) -> None:
    assert warned(scene, shield) == {("shield_assumes_less", subject)}
    run = nav.simulate(scene, SafeNavigation(FIELD, shield=shield))
    assert [told in each.message for each in run.warnings if each.subject == subject] == [True]
    table = nav.simulate_many(scene, [SafeNavigation(FIELD, shield=shield)], seeds=2)
    assert "shield_assumes_less" in {each.code for each in table.warnings}


def test_a_speed_that_is_reached_later_counts() -> None:
    runner = nav.Human.from_segments(start=(3.0, 3.0), segments=[(1.0, (0.0, -0.5), (0.0, -2.0))], max_speed=3.0)
    scene = replace(SCENE, obstacles=(runner,))
    assert warned(scene, Shield(person_speed=2.0)) == {("shield_assumes_less", "shield.person_speed")}
    assert warned(scene, Shield(person_speed=2.5)) == set()


def test_an_acceleration_that_goes_on_counts_up_to_the_time_limit() -> None:
    faster = nav.MovingDisc(center=(6.0, 0.2), radius=0.3, velocity=(-0.1, 0.0), acceleration=(-2.0, 0.0))
    scene = replace(SCENE, obstacles=(faster,), time_limit=5.0)
    assert nav.simulate(scene, SafeNavigation(FIELD, shield=Shield(person_speed=1.0))).contact_at_fault.any()
    assert warned(scene, Shield(person_speed=1.0)) == {("shield_assumes_less", "shield.person_speed")}
    assert warned(scene, Shield(person_speed=10.1)) == set()


@pytest.mark.parametrize(("acceleration", "speed"), [(0.0, 3.0), (0.5, 5.5)])
def test_a_segment_without_an_end_counts(acceleration: float, speed: float) -> None:
    runner = nav.Human.from_segments((9.0, 3.0), [(math.inf, (-3.0, 0.0), (-acceleration, 0.0))], max_speed=6.0)
    scene = replace(SCENE, obstacles=(runner,), time_limit=5.0)
    assert warned(scene, Shield(person_speed=0.99 * speed)) == {("shield_assumes_less", "shield.person_speed")}
    assert warned(scene, Shield(person_speed=speed)) == set()


@pytest.mark.parametrize(
    ("obstacle", "velocity_error", "person_acceleration"),
    [
        (nav.Human(start=(3.0, 3.0), velocity=(0.0, -0.9), stop=(3.0, 1.0)), 0.9, 0.0),
        (nav.Human.from_path([0.0, 1.0, 2.0, 3.0], [(3.0, 3.0), (3.0, 2.0), (3.0, 2.0), (3.6, 2.0)]), 1.0, 0.0),
        (nav.MovingDisc(center=(3.0, 3.0), radius=0.2, velocity=(0.0, -0.1), acceleration=(0.0, -0.4)), 0.0, 0.4),
        (
            nav.Human.from_segments((3.0, 3.0), [(1.0, (0.0, -0.5), (0.0, -0.3)), (1.0, (0.0, 0.1), (0.0, 0.0))]),
            0.9,
            0.3,
        ),
    ],
)
def test_velocities_that_are_known_change_no_faster_than_assumed(
    obstacle: Any, velocity_error: float, person_acceleration: float
) -> None:
    scene = replace(SCENE, obstacles=(obstacle,), time_limit=5.0)

    def subjects(less: float, slower: float) -> set[str]:
        shield = Shield(
            person_speed=4.0, velocity_error=less * velocity_error, person_acceleration=slower * person_acceleration
        )
        return {subject for _, subject in warned(scene, shield)}

    assert subjects(1.0, 1.0) == set()
    assert subjects(0.9, 1.0) == ({"shield.velocity_error"} if velocity_error else set())
    assert subjects(1.0, 0.9) == ({"shield.person_acceleration"} if person_acceleration else set())


def test_turns_and_wrong_velocities_add_up() -> None:
    turning = nav.Human.from_segments((3.0, 3.0), [(1.0, (0.0, -0.5), (0.0, 0.0)), (1.0, (0.5, -0.5), (0.0, 0.0))])
    scene = replace(measured(scale=0.003), obstacles=(turning,))
    for velocity_error, subjects in ((0.6, {"shield.velocity_error"}), (0.6415, set())):
        shield = Shield(position_error=0.01, velocity_error=velocity_error, person_acceleration=0.0)
        assert {subject for _, subject in warned(scene, shield)} == subjects


def test_all_turns_within_a_plan_count() -> None:
    turns = [(0.1, (0.0, -0.3 * k), (0.0, 0.0)) for k in range(4)]
    scene = replace(SCENE, obstacles=(nav.Human.from_segments((3.0, 3.0), turns),))
    shield = Shield(velocity_error=0.5, person_acceleration=0.0)
    assert ("shield_assumes_less", "shield.velocity_error") in warned(scene, shield)
    assert warned(scene, replace(shield, velocity_error=0.6)) == set()
    # Who brakes for longer plans longer.
    slow = replace(scene, robot=nav.HolonomicRobot(max_acceleration=1.0))
    assert ("shield_assumes_less", "shield.velocity_error") in warned(slow, replace(shield, velocity_error=0.6))


def test_velocities_from_differences_of_who_accelerates_are_late() -> None:
    faster = nav.MovingDisc(center=(6.0, 3.0), radius=0.3, velocity=(-0.1, 0.0), acceleration=(-0.3, 0.0))
    scene = replace(measured(scale=0.0), obstacles=(faster,), time_limit=4.0)
    shield = Shield(velocity_error=0.005, person_acceleration=0.3)
    assert warned(scene, shield) == {("shield_assumes_less", "shield.velocity_error")}
    assert warned(scene, replace(shield, velocity_error=0.009)) == set()


def test_no_margin_covers_a_robot_that_measures_itself() -> None:
    covering = Shield(margin=0.1)
    scene = measured("robot", scale=0.025)
    assert warned(scene, covering) == {("shield_assumes_less", "shield.margin")}
    (told,) = [each.message for each in nav.simulate(scene, SafeNavigation(FIELD, shield=covering)).warnings]
    assert "own velocity to 1.179 m/s only, which no margin covers" in told
    assert warned(measured("robot", scale=0.0), covering) == set()


@pytest.mark.parametrize("known", [True, False])
def test_walls_and_maps_need_a_margin_of_their_own(known: bool) -> None:
    wall = nav.Rectangle(center=(3.0, 3.0), length=1.0, width=0.2)
    plan = nav.StaticMap.from_polylines([[(2.5, 3.0), (3.5, 3.0)]])
    scene = replace(SCENE, obstacles=(WALKER,) if known else (WALKER, wall), control_period=0.1)
    law = SafeNavigation(FIELD, map=plan if known else None, shield=Shield(margin=0.1))
    run = nav.simulate(scene, law, step=0.05)
    assert [each.subject for each in run.warnings if each.code == "shield_assumes_less"] == ["shield.wall_margin"]


def test_commands_past_a_shield_are_told() -> None:
    run = nav.Run(SCENE, SafeNavigation(FIELD, shield=Shield()))
    run.step()
    assert run.trajectory.warnings == ()
    run.step(velocity=(0.7, 0.0))
    run.step((1.0, 0.0))
    assert run.trajectory.commanded_periods == 2
    (found,) = run.trajectory.warnings
    assert (found.code, found.subject) == ("shield_assumes_less", "command")
    assert "in 2 control periods" in found.message
    free = nav.Run(SCENE)
    free.step((1.0, 0.0))
    assert free.trajectory.warnings == ()


def test_a_shield_below_other_parts_is_told() -> None:
    inner = SafeNavigation(FIELD, shield=Shield(person_speed=1.0))
    run = nav.simulate(SCENE, SafeNavigation(inner, yielding=nav.Yielding()))
    assert [each.subject for each in run.warnings] == ["law", "shield.person_speed"]
    assert [each.subject for each in nav.simulate(SCENE, SafeNavigation(inner, shield=Shield())).warnings] == []
    robot = nav.Robot(start=(0, 0), goal=(6, 0), law=SafeNavigation(inner, yielding=nav.Yielding()))
    assert "robots[0].law" in {each.subject for each in nav.World(robots=[robot]).warnings}
    controller = nav.Controller(robot.law, SCENE.robot, (5.0, 0.0))
    assert [each.subject for each in controller.warnings] == ["law", "shield.person_speed"]


def test_people_who_decide_may_turn_at_once() -> None:
    shield = Shield(person_speed=2.0, velocity_error=0.1, person_acceleration=1.0)
    robot = nav.Robot(start=(0, 0), goal=(6, 0), law=SafeNavigation(FIELD, shield=shield))
    person = nav.Person(start=(6, 1), route=[(-1, 1)], desired_speed=1.0)
    run = nav.simulate(nav.World(people=[person], robots=[robot], time_limit=1.0))
    assert "robots[0].law.shield.velocity_error" in {each.subject for each in run.warnings}


def test_sensors_that_hide_people_are_told() -> None:
    built = nav.robots.AsBuilt(sensors=[nav.sensing.Ultrasonic()])
    assert ("shield_sees_less", "sensors") in warned(SCENE, Shield(), built=built)
    assert warned(SCENE, Shield(), built=nav.robots.AsBuilt()) == set()


def test_wheels_and_cameras_that_no_margin_covers_are_told() -> None:
    wheels = nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS)
    assert ("shield_assumes_less", "wheels") in warned(SCENE, Shield(), built=wheels)
    camera = nav.robots.AsBuilt(robot_vision=nav.sensing.Vision())
    assert ("shield_assumes_less", "robot_vision") in warned(SCENE, Shield(), built=camera)
    law = SafeNavigation(FIELD, shield=Shield())
    alone = nav.Scenario(start=(0.0, 0.0), goal=(3.0, 0.0), time_limit=5.0)
    found = nav.metrics.falsify(alone, law, episodes=2, built=wheels)
    assert "wheels" in {each.subject for each in found.warnings}


def test_a_controller_tells_what_its_shield_does_not_cover() -> None:
    law = SafeNavigation(FIELD, shield=Shield(person_speed=1.0))
    slow = nav.Controller(law, SCENE.robot, (5.0, 0.0), person_speed=1.0)
    assert slow.warnings == ()
    fast = nav.Controller(law, SCENE.robot, (5.0, 0.0), person_speed=1.6)
    assert [each.subject for each in fast.warnings] == ["shield.person_speed"]
    scanning = nav.Controller(law, SCENE.robot, (5.0, 0.0), person_speed=1.0, lidar=nav.sensing.Lidar())
    assert [each.code for each in scanning.warnings] == ["shield_sees_less"]
    assert nav.Controller(FIELD, SCENE.robot, (5.0, 0.0), lidar=nav.sensing.Lidar()).warnings == ()
