"""Scenes of HuNavSim and CrowdNav, settings of Nav2: samples, worlds and robots, what is refused."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import io
from hrsafety import navigation as nav
from hrsafety.errors import FileError, InvalidParameterError
from hrsafety.plausibility import unsafe_doubts

FORMATS = Path("data/formats")
HUNAV, CROWDNAV, NAV2 = "cfg_hunav_agents.yaml", "cfg_crowdnav_env.config", "cfg_nav2_params.yaml"


def codes(found: Any) -> list[str]:
    return [each.code for each in found.warnings]


def expected_of(shared: Path, name: str) -> dict[str, Any]:
    expected = json.loads((shared / FORMATS / "expected.json").read_text(encoding="utf-8"))
    (found,) = (each for each in expected["maps_and_configurations"] if each["file"] == name)
    return {key: value for key, value in found.items() if key not in ("file", "call", "note")}


def listed(value: Any) -> Any:
    """Return a value as JSON has it."""
    if dataclasses.is_dataclass(value):
        return {each.name: listed(getattr(value, each.name)) for each in dataclasses.fields(value)}
    return [listed(each) for each in value] if isinstance(value, (list, tuple)) else value


@pytest.mark.parametrize(("name", "read"), [(HUNAV, io.load_scene), (CROWDNAV, io.load_scene), (NAV2, io.read_nav2)])
def test_samples_are_read_as_expected(name: str, read: Any, shared: Path) -> None:
    found = read(shared / FORMATS / name)
    for key, value in expected_of(shared, name).items():
        if key == "warnings":
            assert sorted(codes(found)) == sorted(value)
        elif key == "people" and isinstance(value, list):
            assert [{each: person[each] for each in value[0]} for person in listed(found.people)] == value
        elif isinstance(value, list):
            assert np.array(getattr(found, key)) == pytest.approx(np.array(value), abs=1e-9)
        else:
            assert getattr(found, key) == (pytest.approx(value, abs=1e-6) if isinstance(value, float) else value)


def changed(shared: Path, folder: Path, name: str, *changes: tuple[str, str]) -> Path:
    text = (shared / FORMATS / name).read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


# ---- scenes --------------------------------------------------------------------------------------


def test_people_of_hunavsim_walk(shared: Path) -> None:
    scene = io.load_scene(shared / FORMATS / HUNAV)
    assert isinstance(scene, io.HuNavScene)
    world = scene.world(time_limit=5.0, walls=[[(-5, 5), (8, 5)]])
    assert [each.group for each in world.people] == [None, 0, 0]
    assert [each.awareness for each in world.people] == [1.0, 0.0, 1.0]
    assert "behavior_not_available" in [each.code for each in unsafe_doubts(world.warnings)]
    run = nav.simulate(world)
    assert run.time[-1] == pytest.approx(5.0)


def test_a_plan_is_the_wall_of_a_scene_and_its_doubts_are_those_of_the_world(shared: Path) -> None:
    plan = io.load_map(shared / FORMATS / "map_plan.dxf")
    world = io.load_scene(shared / FORMATS / HUNAV).world(walls=plan, time_limit=2.0)
    assert {"behavior_not_available", "skipped_entities"} <= {each.code for each in world.warnings}
    assert nav.simulate(world).time[-1] == pytest.approx(2.0)


def test_goals_of_all_and_behaviors_with_settings(tmp_path: Path) -> None:
    path = tmp_path / "agents.yaml"
    path.write_text(
        "hunav_loader:\n  ros__parameters:\n    agents: [a]\n    global_goals: {1: {x: 2.0, y: 3.0}}\n"
        "    a: {id: 1, behavior: {type: 2, duration: 40.0}, group_id: 3, max_vel: 1.0, radius: 0.3,\n"
        "      goal_radius: 0.2, init_pose: {x: 0, y: 1}, cyclic_goals: off, goals: [1]}\n",
        encoding="utf-8",
    )
    (agent,) = io.load_scene(path).people
    assert (agent.route, agent.behavior, agent.group, agent.start) == (((2.0, 3.0),), "impassive", 3, (0.0, 1.0))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("- agent5", "- agent9", "hold agent9"),
        ("- agent5", "- agent1", r"agents\[2\] must name every agent once"),
        ("id: 2", "id: 1", "another number than that of agent1"),
        ("behavior: 4", "behavior: 7", "behavior must be a behavior"),
        ("behavior: 4", "behavior: scared", "whole number"),
        (
            "max_vel: 1.1",
            "max_vel: -1.1",
            r"line 14, hunav_loader\.ros__parameters\.agent1\.max_vel must be finite and pos",
        ),
        ("- g1", "- g7", "name a goal of agent1"),
        ("x: 3.0", "x: .inf", "must be finite"),
        ("group_id: 0", "group_id: -2", "-1 for none"),
        ("cyclic_goals: true", "cyclic_goals: 1", "true or false"),
        ("    agents:", "    persons:", "known format"),
    ],
)
def test_agents_that_break_a_rule_are_named(shared: Path, tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(FileError, match=words):
        io.load_scene(changed(shared, tmp_path, HUNAV, (old, new)))


@pytest.mark.parametrize("scene", ["circle_crossing", "square_crossing"])
@pytest.mark.parametrize("drawn", ["true", "false"])
def test_cases_of_crowdnav_keep_the_room_that_the_file_says(
    shared: Path, tmp_path: Path, scene: str, drawn: str
) -> None:
    changes = (("test_sim = circle_crossing", f"test_sim = {scene}"), ("attributes = false", f"attributes = {drawn}"))
    settings = io.load_scene(changed(shared, tmp_path, CROWDNAV, *changes, ("human_num = 5", "human_num = 8")))
    assert isinstance(settings, io.CrowdNavScene)
    assert codes(settings) == (["drawn_attributes"] if drawn == "true" else [])
    for case in range(20):
        world = settings.world(case)
        assert world.people == settings.world(case).people
        assert len(world.people) == 8
        ends = [((0.0, -4.0), 0.3), *((each.start, each.radius) for each in world.people)]
        for index, (place, radius) in enumerate(ends):
            for other, size in ends[:index]:
                assert math.dist(place, other) >= radius + size + 0.2
    assert world.people != settings.world(3).people
    run = nav.simulate(settings.world(0, law=nav.OptimalReciprocalCollisionAvoidance()))
    assert run.outcomes[0] in ("arrived", "collided", "timed_out")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("time_step = 0.25", "", "line 1, env must hold time_step"),
        ("time_step = 0.25", "time_step = 0", "line 3, env.time_step must be finite and positive, got '0'"),
        ("human_num = 5", "human_num = 10001", "line 19, sim.human_num must be an integer from 0 to 1000"),
        ("test_sim = circle_crossing", "test_sim = circle", "line 16, sim.test_sim must be one of"),
        ("visible = false", "visible = maybe", "robot.visible must be true or false"),
        ("[reward]", "[env]", "already exists"),
        ("[env]", "env", "known format"),
        ("v_pref = 1", "v_pref = nan", "humans.v_pref must be finite"),
    ],
)
def test_settings_that_break_a_rule_are_named(shared: Path, tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(FileError, match=words):
        io.load_scene(changed(shared, tmp_path, CROWDNAV, (old, new)))


def test_people_of_another_policy_are_doubted(shared: Path, tmp_path: Path) -> None:
    settings = io.load_scene(changed(shared, tmp_path, CROWDNAV, ("policy = orca", "policy = linear")))
    assert codes(settings) == []
    assert [each.code for each in unsafe_doubts(settings.world(0).warnings)] == ["behavior_not_available"]
    assert settings.world(0, model=nav.crowd.Moussaid()).warnings == ()


def test_too_many_people_find_no_room(shared: Path, tmp_path: Path) -> None:
    settings = io.load_scene(changed(shared, tmp_path, CROWDNAV, ("human_num = 5", "human_num = 500")))
    with pytest.raises(InvalidParameterError, match="room for"):
        settings.world(0)


# ---- Nav2 ----------------------------------------------------------------------------------------


def params(folder: Path, text: str) -> io.Nav2Settings:
    path = folder / "nav2.yaml"
    path.write_text(text, encoding="utf-8")
    return io.read_nav2(path)


COSTMAP = "local_costmap: {{local_costmap: {{ros__parameters: {{{}}}}}}}\n"
SQUARE = COSTMAP.format('footprint: "[ [.2, .2],[.2,-.2], [-.2,-.2],[-.2,.2] ]", footprint_padding: 0.0')


@pytest.mark.parametrize(
    ("controller", "speed", "turn", "up", "down", "drive"),
    [
        (
            "plugin: dwb_core::DWBLocalPlanner, max_vel_x: 0.26, min_vel_x: 0.0, max_vel_y: 0.0, max_vel_theta: 1.0, "
            "acc_lim_x: 2.5, decel_lim_x: -1.5, acc_lim_theta: 3.2",
            *(0.26, 1.0, 2.5, 1.5, "two wheels"),
        ),
        ("max_vel_x: 0.5, max_vel_y: 0.3, max_vel_theta: 1.0, acc_lim_x: 1", 0.5, 1.0, 1.0, None, "holonomic"),
        (
            "vx_max: 0.5, vy_max: 0.5, wz_max: 1.9, ax_max: 3, ax_min: -3, motion_model: Omni",
            0.5,
            1.9,
            3.0,
            3.0,
            "holonomic",
        ),
        (
            "vx_max: 0.5, wz_max: 1.9, motion_model: own, own: {plugin: mppi::DiffDriveMotionModel}",
            *(0.5, 1.9, None, None, "two wheels"),
        ),
        ("max_vel_x: 0.5, max_speed_xy: 0.4, acc_lim_x: 2.5", 0.4, None, 2.5, None, "two wheels"),
        ("vx_max: 0.5, motion_model: Ackermann", 0.5, None, None, None, "car"),
        ("desired_linear_vel: 0.4, max_angular_accel: 3.2", 0.4, None, None, None, "two wheels"),
        ("max_linear_vel: 0.6, desired_linear_vel: 0.4, max_angular_vel: 1.5", 0.6, 1.5, None, None, "two wheels"),
    ],
)
def test_limits_of_every_controller(
    tmp_path: Path, controller: str, speed: float, turn: float | None, up: float | None, down: float | None, drive: str
) -> None:
    text = f"{SQUARE}controller_server: {{ros__parameters: {{FollowPath: {{{controller}}}}}}}\n"
    found = params(tmp_path, text)
    assert (found.max_speed, found.max_turn_rate, found.max_acceleration, found.max_deceleration, found.drive) == (
        *(speed, turn, up, down, drive),
    )
    assert found.circumscribed_radius == pytest.approx(0.2 * math.sqrt(2.0))
    assert found.inscribed_radius == pytest.approx(0.2)
    assert codes(found) == []
    if drive == "car":
        with pytest.raises(InvalidParameterError, match="Ackermann"):
            found.robot()
        return
    robot = found.robot(max_acceleration=1.0)
    assert isinstance(robot, nav.HolonomicRobot if drive == "holonomic" else nav.DifferentialDriveRobot)
    assert robot.radius == pytest.approx(found.circumscribed_radius)
    assert robot.max_speed >= speed
    if up is None:
        with pytest.raises(InvalidParameterError, match="give max_acceleration="):
            found.robot()


def test_the_stricter_of_controller_and_smoother_counts_and_of_controllers_the_freer(tmp_path: Path) -> None:
    text = SQUARE + (
        "controller_server:\n  ros__parameters:\n    controller_plugins: [FollowPath, Slow]\n"
        "    FollowPath: {max_vel_x: 0.8, max_vel_theta: 1.0, decel_lim_x: -2.0}\n"
        "    Slow: {max_vel_x: 0.2, max_vel_theta: 2.0, decel_lim_x: -0.5}\n"
        "velocity_smoother:\n  ros__parameters:\n    max_velocity: [0.6, 0.0, 1.5]\n"
        "    min_velocity: [-0.1, 0.0, -1.5]\n"
        "    max_accel: [1.0, 0.0, 2.0]\n    max_decel: [-1.0, 0.0, -2.0]\n"
    )
    found = params(tmp_path, text)
    assert (found.max_speed, found.max_turn_rate, found.max_deceleration) == (0.6, 1.5, 0.5)
    assert (found.min_speed, found.max_acceleration, found.max_turn_acceleration) == (-0.1, 1.0, 2.0)


def test_a_round_robot_has_the_outline_that_nav2_makes_of_it(tmp_path: Path) -> None:
    found = params(tmp_path, COSTMAP.format('robot_radius: 0.3, footprint: "[]"'))
    assert found.footprint is None
    assert found.robot_radius == 0.3
    assert found.padded is not None
    assert len(found.padded) == 16
    assert found.padded[0] == (0.31, 0.0)  # zero stays where it is
    assert found.circumscribed_radius == pytest.approx(0.3 + 0.01 * math.sqrt(2.0))
    assert codes(params(tmp_path, COSTMAP.format("resolution: 0.05"))) == ["assumed"]


def test_dots_in_keys_are_maps(tmp_path: Path) -> None:
    text = (
        COSTMAP.format("robot_radius: 0.2, inflation_layer.inflation_radius: 0.1")
        + "controller_server:\n  ros__parameters:\n    FollowPath.max_vel_x: 0.3\n    FollowPath.plugin: dwb\n"
    )
    found = params(tmp_path, text)
    assert (found.inflation_radius, found.max_speed) == (0.1, 0.3)
    assert codes(found) == ["inflation_below_circumscribed"]


def test_both_costmaps_are_doubted_once(tmp_path: Path) -> None:
    one = COSTMAP.format("robot_radius: 0.5, inflation_layer: {inflation_radius: 0.3}")
    (doubt,) = params(tmp_path, one + one.replace("local", "global")).warnings
    assert doubt.code == "inflation_below_circumscribed"
    assert "local_costmap" in doubt.message
    assert "global_costmap" in doubt.message
    # How a planner inflates is nothing to a judge of recorded ways or a zone that stops.
    assert params(tmp_path, one).body_warnings == ()


@pytest.mark.parametrize(
    ("shape", "found"),
    [
        ('footprint: "[[.03, .02], [.03, -.02], [-.03, -.02], [-.03, .02]]"', ["implausible"]),
        ("robot_radius: 0.05", ["implausible"]),
        ("robot_radius: 0.2, footprint_padding: 0.15", ["implausible"]),
        ('footprint: "[[.3, .2], [.3, .2], [-.3, -.2], [-.3, .2]]"', ["repeated_corners"]),
        ('footprint: "[[.3, .2], [.3, -.2], [-.3, -.2], [.3, .2], [-.3, .2]]"', ["repeated_corners"]),
        # Small robots with the usual padding, and outlines that are closed by their first corner.
        ("robot_radius: 0.105", []),
        ("robot_radius: 0.09, footprint_padding: 0.03", []),
        ('footprint: "[[.3, .2], [.3, -.2], [-.3, -.2], [-.3, .2], [.3, .2]]"', []),
        ('footprint: "[[1.2, .6], [1.2, -.6], [-1.2, -.6], [-1.2, .6]]", footprint_padding: 0.1', []),
    ],
)
def test_shapes_that_no_robot_has_are_doubted(tmp_path: Path, shape: str, found: list[str]) -> None:
    settings = params(tmp_path, COSTMAP.format(shape))
    assert codes(settings) == found
    assert [each.code for each in unsafe_doubts(settings.body_warnings)] == found


@pytest.mark.parametrize(
    ("corners", "said"),
    [
        ("[[.2, .2], [.2, .2], [.2, .2], [.2, .2]]", "three corners or more that differ"),
        ("[[.1, .1], [.3, .1], [.3, .3], [.1, .3]]", "hold the origin inside"),
    ],
)
def test_a_footprint_that_is_no_body_is_named(tmp_path: Path, corners: str, said: str) -> None:
    found = params(tmp_path, COSTMAP.format(f'footprint: "{corners}"'))
    with pytest.raises(InvalidParameterError, match=f"^footprint must .*{said}"):
        found.robot(max_speed=1.0, max_acceleration=1.0)
    assert found.robot(max_speed=1.0, max_acceleration=1.0, radius=0.4).footprint is None


def test_namespaces_and_files_without_costmaps(tmp_path: Path) -> None:
    inside = "robot1:\n" + "".join(f"  {line}\n" for line in SQUARE.splitlines())
    assert params(tmp_path, inside).footprint is not None
    found = params(tmp_path, "velocity_smoother: {ros__parameters: {max_velocity: [0.5, 0.0, 2.0]}}\n")
    assert (found.footprint, found.circumscribed_radius, found.max_speed) == (None, None, 0.5)
    with pytest.raises(InvalidParameterError, match="give radius="):
        found.robot()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (COSTMAP.format('footprint: "[[0.1, 0.2], [0.3, x], [0.1, 0.1]]"'), r"but holds \[0\.3, x\]"),
        (COSTMAP.format('footprint: "[[0.1, 0.2], [0.3, 0.1, 0.2], [0.1, 0.1]]"'), r"but holds \[0\.3, 0\.1, 0\.2\]"),
        (COSTMAP.format('footprint: "[[0.1, 0.2] [0.3, 0.1], [0.1, 0.1]]"'), "commas between"),
        (COSTMAP.format('footprint: "[[0.1, 0.2], [0.3, 0.1]]"'), "three corners"),
        (COSTMAP.format('footprint: "[[0.1, 0.2], [0.3, 0.1], [0, 0]"'), "footprint must be"),
        (COSTMAP.format('footprint: "circle"'), "footprint must be"),
        (COSTMAP.format("footprint: [[0.1, 0.2], [0.3, 0.1], [0, 0]]"), "put quotes around it"),
        (COSTMAP.format("robot_radius: 0"), "robot_radius must be finite and positive"),
        (COSTMAP.format("robot_radius: 0.2, footprint_padding: -1.0"), "not be negative"),
        (SQUARE + "velocity_smoother: {ros__parameters: {max_decel: [1.0, 0.0, 1.0]}}", "negative or zero"),
        (SQUARE + "velocity_smoother: {ros__parameters: {max_velocity: [1.0, 0.0]}}", "3 numbers"),
        (SQUARE + "controller_server: {ros__parameters: {FollowPath: {vx_max: fast}}}", "vx_max must be a number"),
        (SQUARE + "controller_server: {ros__parameters: {FollowPath: {vx_max: -0.5}}}", "vx_max must be positive"),
        (SQUARE + "controller_server: {ros__parameters: {FollowPath: {motion_model: Tank}}}", "motion_model must be"),
        ("controler_server: {ros__parameters: {}}", "did you mean"),
    ],
)
def test_parameters_that_break_a_rule_are_named(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(FileError, match=words):
        params(tmp_path, text)


def test_files_that_are_cut_off_are_results_or_errors(shared: Path, tmp_path: Path) -> None:
    for name, read in ((HUNAV, io.load_scene), (CROWDNAV, io.load_scene), (NAV2, io.read_nav2)):
        content = (shared / FORMATS / name).read_bytes()
        for cut in range(0, len(content), 17):
            path = tmp_path / name
            path.write_bytes(content[:cut])
            with contextlib.suppress(FileError):  # any other escapes
                read(path)
