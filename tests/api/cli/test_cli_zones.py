"""``hrsafety zones`` and ``hrsafety zones check`` as a user calls them: files, pages, exit codes and errors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import zones
from hrsafety.cli import main
from hrsafety.zones.polygons import distance_outside

ROBOT = (
    *("--footprint", "0.22", "--max-speed", "0.4", "--max-turn-rate", "0.5", "--deceleration", "2.5"),
    *("--reaction", "0.15", "--turn-deceleration", "11.4", "--error", "0.02", "--beam-step-deg", "0.5"),
)
CHECKED = ("--attacks", "60", "--generations", "0")
DEFAULT = """collision_monitor:
  ros__parameters:
    source_timeout: 0.1
    polygons: ["Stop"]
    Stop: {type: "circle", radius: 0.3, action_type: "stop"}  # as delivered
    observation_sources: ["scan"]
    scan: {type: "scan"}
"""


def test_zones_are_written_and_their_own_check_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, page, values = tmp_path / "cm.yaml", tmp_path / "page", tmp_path / "zones.json"
    given = ["zones", *ROBOT, "--command-fall", "2.5", "--turn-command-fall", "3"]
    assert main([*given, "--ranges", "2", "--out", str(file), "--report", str(page), "--json", str(values)]) == 0
    told = capsys.readouterr().out
    assert "forward_2" in told
    assert "manuals        S_L" in told
    assert (page / "zones.html").exists()
    assert [each["name"] for each in json.loads(values.read_text())["zones"]] == ["forward_1", "forward_2"]
    folder = tmp_path / "verdict"
    checked = ["zones", "check", str(file), *given[1:], *CHECKED, "--fail-on", "any", "--out", str(folder)]
    assert main(checked) == 0
    assert "passed  holds: none of 60 attacks" in capsys.readouterr().out
    assert {each.name for each in folder.iterdir()} == {
        "zones.html",
        "zones.png",
        "worst_attack.png",
        "worst_attack.csv",
    }


def test_a_broken_file_fails_is_mended_and_replayed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, mended, values = tmp_path / "cm.yaml", tmp_path / "mended.yaml", tmp_path / "v.json"
    file.write_text(DEFAULT)
    call = ["zones", "check", str(file), *ROBOT, *CHECKED]
    assert main([*call, "--fail-on", "broken", "--mend", str(mended), "--json", str(values)]) == 3
    told = capsys.readouterr().out
    assert "--fail-on broken: exit code 3" in told
    assert f"{file}, 1 zone\n" in told
    assert main(call) == 0
    assert "--fail-on broken makes it 3" in capsys.readouterr().out
    assert "# as delivered" in mended.read_text()
    found = json.loads(values.read_text())
    assert found["verdict"] == "broken"
    monitor = zones.load_monitor(file)
    conditions = zones.Conditions(**{name: value for name, value in found["conditions"].items() if value is not None})
    again = zones.replay(monitor, conditions, list(found["worst"]["genes"].values()))
    assert again.contact_speed == found["worst"]["contact_speed_m_per_s"]
    assert main(["zones", "check", str(mended), *ROBOT, *CHECKED, "--fail-on", "any"]) == 0


NESTED = """collision_monitor:
  ros__parameters:
    source_timeout: 0.1
    polygons: ["Stop", "Slow", "Round", "Ahead", "Fast"]
    Stop: {type: "polygon", points: "[[0.4, 0.3], [0.4, -0.3], [-0.3, -0.3], [-0.3, 0.3]]", action_type: "stop"}
    Slow: {type: "polygon", points: "[[0.7, 0.4], [0.7, -0.4], [-0.4, -0.4], [-0.4, 0.4]]", action_type: "slowdown"}
    Round: {type: "circle", radius: 0.6, action_type: "limit"}
    Ahead: {type: "polygon", points: "[[0.9, 0.1], [0.9, -0.1], [0.2, -0.1], [0.2, 0.1]]", action_type: "slowdown"}
    Fast:
      type: "velocity_polygon"
      action_type: "slowdown"
      velocity_polygons: ["all"]
      all: {points: "[[0.8, 0.3], [0.8, -0.3], [-0.3, -0.3], [-0.3, 0.3]]", linear_min: -1.0, linear_max: 1.0,
        theta_min: -2.0, theta_max: 2.0}
    observation_sources: ["scan"]
    scan: {type: "scan"}
"""


def test_mended_zones_stay_in_those_that_lie_around_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, mended = tmp_path / "cm.yaml", tmp_path / "mended.yaml"
    file.write_text(NESTED)
    main(["zones", "check", str(file), *ROBOT, *CHECKED, "--mend", str(mended)])
    told = capsys.readouterr().out
    for name in ("Slow", "Round", "Fast.all"):
        assert f"{name} grows too: it lies around a zone that stops" in told
    assert "Ahead grows" not in told
    zone = {each.name: each for each in zones.load_monitor(mended).polygons}
    stop, before = zone["Stop"].corners, zones.load_monitor(file).polygons[3].corners
    assert stop is not None
    assert stop[:, 0].max() > 0.6  # beyond what two of them were
    slow, fast = zone["Slow"].corners, zone["Fast"].ranges[0].corners
    assert slow is not None
    assert distance_outside(slow, stop).max() == 0.0
    assert distance_outside(fast, stop).max() <= 1e-3
    assert slow[:, 0].max() - stop[:, 0].max() == pytest.approx(0.3, abs=5e-3)
    assert zone["Round"].radius >= np.linalg.norm(stop, axis=1).max()
    np.testing.assert_array_equal(zone["Ahead"].corners, before)


def test_slow_people_keep_a_check_from_passing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "cm.yaml"
    file.write_text(DEFAULT.replace("0.3", "2.0"))
    given = ["zones", "check", str(file), *ROBOT, *CHECKED, "--fail-on", "any"]
    assert main(given) == 0
    capsys.readouterr()
    assert main([*given, "--person-speed", "0.05"]) == 5
    told = capsys.readouterr()
    assert "NOT CHECKED  holds" in told.out
    assert "person_speed is 0.05 m/s: zones hold for people who are no faster" in told.err


def test_a_reaction_in_a_wrong_unit_is_refused_by_its_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "cm.yaml"
    file.write_text(DEFAULT)
    assert main(["zones", "check", str(file), *ROBOT, "--reaction", "0.0002"]) == 2
    assert "--reaction must be 0.002 to 20 s" in capsys.readouterr().err


def test_a_check_that_is_not_told_the_robot_is_not_checked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "cm.yaml"
    file.write_text(DEFAULT.replace("0.3", "2.0"))
    assert main(["zones", "check", str(file), *CHECKED, "--fail-on", "any"]) == 5
    told = capsys.readouterr()
    assert "NOT CHECKED  holds" in told.out
    assert "taken from the default robot of Nav2" in told.err


SETTINGS = """
velocity_smoother:
  ros__parameters:
    max_velocity: [0.4, 0.0, 0.5]
    min_velocity: [-0.1, 0.0, -0.5]
    max_accel: [2.5, 0.0, 3.2]
    max_decel: [-2.5, 0.0, -3.2]
controller_server:
  ros__parameters:
    controller_plugins: ["FollowPath"]
    FollowPath: {plugin: "dwb_core::DWBLocalPlanner", max_vel_x: 0.4, max_speed_xy: 0.4, max_vel_theta: 0.5,
      min_vel_x: 0.0, max_vel_y: 0.0, min_vel_y: 0.0, acc_lim_x: 2.5, decel_lim_x: -2.5, acc_lim_theta: 3.2}
local_costmap:
  local_costmap:
    ros__parameters:
      footprint: "[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"
      footprint_padding: 0.01
"""


def test_a_check_knows_the_robot_that_stands_in_the_same_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, values = tmp_path / "params.yaml", tmp_path / "v.json"
    file.write_text(DEFAULT + SETTINGS)

    def conditions(*options: str) -> dict[str, Any]:
        main(["zones", "check", str(file), *CHECKED, *options, "--json", str(values)])
        found: dict[str, Any] = json.loads(values.read_text())["conditions"]
        return found

    found = conditions()
    assert (found["max_speed"], found["max_turn_rate"]) == (0.4, 0.5)
    assert found["footprint"][0] == pytest.approx([0.31, 0.21])
    # What nobody has measured stays a doubt, and what is given counts.
    told = capsys.readouterr().err
    assert "not told, taken from the default robot of Nav2: deceleration" in told
    assert "max_speed" not in told
    assert conditions("--max-speed", "0.3")["max_speed"] == 0.3
    assert conditions("--holonomic")["holonomic"] is True
    # A robot that drives sideways is as fast as its fastest direction, and inflation is nothing to a zone.
    sideways = DEFAULT + SETTINGS.replace("[0.4, 0.0, 0.5]", "[0.4, 0.6, 0.5]").replace(
        "max_vel_y: 0.0", "max_vel_y: 0.6"
    )
    file.write_text(sideways.replace("max_speed_xy: 0.4", "max_speed_xy: 0.8"))
    found = conditions()
    assert (found["holonomic"], found["max_speed"], found["min_speed"]) == (True, 0.6, 0.0)
    assert "inflation" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["zones"], "zones needs --footprint, --max-speed"),
        (["zones", "check"], "zones check needs a FILE.yaml"),
        (["zones", "check", "FILE", "--fail-on", "contact"], "--fail-on must be among broken, not_covered, any"),
        (["zones", "check", "FILE", "--report", "x"], "--report goes with zones only"),
        (["zones", "check", "FILE", "--footprint", "[[0, 0]"], "--footprint must be a radius"),
        (["zones", "check", "FILE", "--min-speed", "0.1"], "--min-speed must not be positive"),
        (["zones", "check", "FILE", "--reaction", "-1"], "--reaction must be finite and positive"),
        (["zones", "check", "missing.yaml"], "path must name a readable file"),
        (["zones", *ROBOT, "--attacks", "5"], "--attacks goes with zones check"),
        (["zones", *ROBOT, "--out", "zones.txt"], "--out must end in .yaml or .yml"),
        (["zones", *ROBOT, "--max-speed", "9"], "a max_speed of"),
    ],
)
def test_errors_name_the_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    file = tmp_path / "cm.yaml"
    file.write_text(DEFAULT)
    assert main([str(file) if each == "FILE" else each for each in arguments]) == 2
    assert message in capsys.readouterr().err


def test_an_error_in_a_file_names_the_file_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "cm.yaml"
    file.write_text(DEFAULT.replace('"circle"', '"disc"'))
    assert main(["zones", "check", str(file)]) == 2
    told = capsys.readouterr().err
    assert (
        "line 5, collision_monitor.ros__parameters.Stop.type must be one of polygon, circle, velocity_polygon" in told
    )
    assert told.count("cm.yaml") == 1
