"""The model of Nav2's collision monitor: sample commands, its rules, and what its files refuse."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import zones
from hrsafety.errors import FileError
from hrsafety.zones.polygons import inside

BOX = np.array([[0.5, 0.4], [0.5, -0.4], [-0.5, -0.4], [-0.5, 0.4]])

HEAD = """collision_monitor:
  ros__parameters:
    source_timeout: 0.2
    observation_sources: ["scan"]
    scan: {type: "scan", topic: "scan"}
"""
STOP = """    polygons: ["Stop"]
    Stop:
      type: "polygon"
      points: "[[0.5, 0.4], [0.5, -0.4], [-0.5, -0.4], [-0.5, 0.4]]"
      action_type: "stop"
"""


def written(folder: Path, text: str) -> zones.CollisionMonitor:
    path = folder / "cm.yaml"
    path.write_text(text, encoding="utf-8")
    return zones.load_monitor(path)


def monitor(**given_: Any) -> zones.CollisionMonitor:
    zone = {"name": "Zone", "type": "polygon", "action": "stop", "corners": BOX, "min_points": 1, **given_}
    return zones.CollisionMonitor(polygons=(zones.MonitorPolygon(**zone),), source_timeout=0.5)


# ---- what is done --------------------------------------------------------------------------------


def test_the_sample_monitor_answers_every_command_as_nav2_does(shared: Path) -> None:
    folder = shared / "data" / "formats"
    expected = json.loads((folder / "expected.json").read_text(encoding="utf-8"))["collision_monitor"]
    found = zones.load_monitor(folder / expected["file"])
    assert not found.warnings
    for case in expected["cases"]:
        answer = found.step(case["cmd_vel"], case["points"])
        assert answer.velocity == pytest.approx(case["out"], abs=1e-12), case["case"]
        assert (answer.action, answer.polygon) == (case["action"], case["by"]), case["case"]
    assert found.uncovered(expected["uncovered_example"]) == ("Speed",)


def test_a_silent_source_stops_the_robot_unless_it_may_be_silent_for_good() -> None:
    assert monitor().step([0.3, 0.0, 0.0], silence=0.6).action == "stop"
    assert monitor().step([0.3, 0.0, 0.0], silence={"scan": 0.4}).action == "none"
    patient = zones.CollisionMonitor(polygons=monitor().polygons, source_timeout=0.0)
    assert patient.step([0.3, 0.0, 0.0], silence=1e6).action == "none"


def test_points_are_counted_over_commands() -> None:
    zone = monitor(trigger_consecutive_points=2, release_consecutive_points=3)
    seen = [[[0.4, 0.0]]] * 3 + [[]] * 4
    assert [zone.step([0.3, 0.0, 0.0], each).action for each in seen] == [
        "none",
        "stop",
        "stop",
        "stop",
        "stop",
        "none",
        "none",
    ]
    zone.restart()
    assert zone.step([0.3, 0.0, 0.0], [[0.4, 0.0]]).action == "none"


def test_a_zone_looks_at_its_sources_only() -> None:
    zone = monitor(sources_names=("front",))
    assert zone.step([0.3, 0.0, 0.0], {"rear": [[0.4, 0.0]]}).action == "none"
    assert zone.step([0.3, 0.0, 0.0], {"rear": [[0.4, 0.0]], "front": [[0.3, 0.0]]}).action == "stop"


def test_a_velocity_polygon_without_a_fitting_range_has_no_zone_and_then_keeps_its_last() -> None:
    span = {"linear_min": 0.0, "linear_max": 0.5, "theta_min": -1.0, "theta_max": 1.0}
    zone = monitor(type="velocity_polygon", corners=None, ranges=(zones.VelocityRange(name="a", corners=BOX, **span),))
    beyond = zone.step([0.6, 0.0, 0.0], [[0.4, 0.0]])
    assert (beyond.action, beyond.covered) == ("none", False)
    assert zone.step([0.5, 0.0, 1.0], [[0.4, 0.0]]).action == "stop"  # borders belong to it
    assert zone.step([0.6, 0.0, 0.0], [[0.4, 0.0]]).action == "stop"


def test_directions_of_a_holonomic_range_wrap() -> None:
    behind = zones.VelocityRange(
        name="behind",
        corners=BOX,
        linear_min=0.0,
        linear_max=1.0,
        theta_min=-1.0,
        theta_max=1.0,
        direction_start_angle=2.3,
        direction_end_angle=-2.3,
    )
    commands = np.array([[-0.5, 0.01, 0.0], [-0.5, -0.01, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [-0.9, -0.9, 0.0]])
    assert behind.holds(commands, holonomic=True).tolist() == [True, True, False, False, False]


def test_a_zone_without_an_action_does_nothing() -> None:
    assert monitor(action="none").step([0.3, 0.0, 0.0], [[0.0, 0.0]]).action == "none"


@settings(max_examples=100)
@given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), min_size=1, max_size=20), st.integers(3, 9))
def test_points_inside_are_those_of_the_winding_number(place: list[tuple[float, float]], count: int) -> None:
    angles = np.arange(count) * 2.0 * math.pi / count + 0.1
    corners = np.stack([np.cos(angles), np.sin(angles)], axis=1) * (0.5 + 0.4 * (np.arange(count) % 2))[:, np.newaxis]
    x, y = np.array(place).T
    away = np.arctan2(corners[:, 1, None] - y, corners[:, 0, None] - x)
    turns = np.angle(np.exp(1j * (np.roll(away, -1, axis=0) - away))).sum(axis=0) / (2.0 * math.pi)
    clear = np.abs(turns - np.round(turns)) < 1e-6
    assert (inside(corners, x, y) == (np.round(turns) != 0))[clear].all()


@settings(max_examples=100)
@given(
    command=st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-2.0, 2.0)),
    place=st.lists(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)), max_size=12),
    action=st.sampled_from(zones.monitor.ACTIONS),
)
def test_no_zone_makes_a_robot_faster_or_turns_its_way(
    command: tuple[float, float, float], place: list[tuple[float, float]], action: str
) -> None:
    out = np.array(monitor(action=action).step(command, place).velocity)
    given_ = np.array(command)
    assert (np.abs(out) <= np.abs(given_) + 1e-12).all()
    assert np.abs(np.cross(np.append(out[:2], 0.0), np.append(given_[:2], 0.0))).max() < 1e-12


# ---- files ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'type: "polygon"',
            'type: "polygone"',
            r"cm\.yaml, line 8, .*Stop\.type must be one of .*did you mean.*polygon",
        ),
        ('"stop"', '"halt"', r"Stop\.action_type must be one of stop, slowdown, limit, approach, none"),
        (
            "[0.5, 0.4], [0.5, -0.4], [-0.5, -0.4], [-0.5, 0.4]",
            "[0.5, 0.4], [0.5, -0.4]",
            r"Stop\.points must have at least 3",
        ),
        (
            "[0.5, 0.4], [0.5, -0.4], [-0.5, -0.4], [-0.5, 0.4]",
            "[0.5, 0.4], [-0.5, -0.4], [0.5, -0.4], [-0.5, 0.4]",
            r"Stop\.points must be a polygon that does not cross itself",
        ),
        ("[0.5, 0.4], [0.5", "[0.5 0.4], [0.5", r"Stop\.points must be corners as"),
        ('["Stop"]', '["Stop", "Slow"]', r"collision_monitor\.ros__parameters must hold Slow"),
        ('["scan"]', '["scan", "lidar"]', r"must hold lidar"),
        ('      action_type: "stop"\n', "", r"Stop must hold action_type"),
        ('"stop"\n', '"stop"\n      min_points: 2.5\n', r"Stop\.min_points must be a whole number"),
        ("source_timeout: 0.2", "source_timeout: -1", r"source_timeout must be at least 0"),
        (
            "source_timeout: 0.2",
            'source_timeout: 0.2\n    cmd_vel_in_topic: "cmd_vel"\n    cmd_vel_out_topic: "/cmd_vel"',
            r"cmd_vel_out_topic must be another topic than cmd_vel_in_topic, got '/cmd_vel'",
        ),
        ("collision_monitor:", "planner:", None),
    ],
)
def test_a_wrong_file_is_refused_with_the_path_of_the_key(
    tmp_path: Path, old: str, new: str, message: str | None
) -> None:
    text = HEAD + STOP
    assert old in text
    if message is None:  # the only node with polygons is taken
        assert written(tmp_path, text.replace(old, new)).polygons[0].name == "Stop"
        return
    with pytest.raises(FileError, match=message):
        written(tmp_path, text.replace(old, new))


def test_what_a_file_leaves_open_is_doubted(tmp_path: Path) -> None:
    text = (
        HEAD
        + STOP.replace('["Stop"]', '["Stop", "Feet", "Off"]')
        + (
            '    Feet: {type: "polygon", action_type: "approach", footprint_topic: "feet", min_point: 3}\n'
            '    Off: {type: "circle", radius: 1.0, action_type: "slowdown", enabled: false}\n'
        )
    )
    found = written(tmp_path, text)
    assert [each.code for each in found.warnings] == ["shape_unknown", "unknown_key", "disabled"]
    assert 'did you mean "min_points"?' in found.warnings[1].message
    assert [each.name for each in found.polygons] == ["Stop", "Feet"]
    path = tmp_path / "cm.yaml"
    known = zones.load_monitor(path, footprint=0.3)
    assert [each.code for each in known.warnings] == ["unknown_key", "disabled"]
    assert known.step([0.5, 0.0, 0.0], [[0.8, 0.0]] * 4).action == "approach"


def test_older_files_count_points_that_may_be_in_a_zone(tmp_path: Path) -> None:
    text = HEAD + STOP.replace(
        '"[[0.5, 0.4], [0.5, -0.4], [-0.5, -0.4], [-0.5, 0.4]]"', "[0.5, 0.4, 0.5, -0.4, -0.5, 0.0]"
    )
    found = written(tmp_path, text + "      max_points: 2\n")
    assert found.polygons[0].min_points == 3
    assert np.shape(found.polygons[0].corners) == (3, 2)
