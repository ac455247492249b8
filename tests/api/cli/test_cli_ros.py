"""``hrsafety ros``, on a fake bus, and without ROS 2."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from api.cli_answers import error_line
from api.ros.fake_bus import STAMPED, TWIST, FakeBus, stamped
from hrsafety.cli import main

WORLD = """start = [0.0, 0.0]
goal = [3.0, 0.0]
time_limit = 12.0
walls = [[[-1.0, 2.0], [4.0, 2.0]]]
[robot]
type = "differential_drive"
max_acceleration = 2.0
[[people]]
start = [3.0, 1.0]
route = [[0.0, 1.0]]
"""


@pytest.fixture
def world(tmp_path: Path) -> Path:
    path = tmp_path / "world.toml"
    path.write_text(WORLD)
    return path


@pytest.fixture
def bus(monkeypatch: pytest.MonkeyPatch) -> FakeBus:
    made = FakeBus()

    @contextmanager
    def connected(_: str) -> Iterator[FakeBus]:
        yield made

    monkeypatch.setattr("hrsafety.cli.ros.connected", connected)
    made.answer = lambda bus: bus.say("cmd_vel", stamped(bus.now, 0.5 if bus.now < 6.0 else 0.0))
    return made


def test_without_rclpy_the_error_says_what_to_do(world: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ros", str(world)]) == 2
    line = error_line(capsys)
    assert "rclpy is not installed" in line
    assert "source /opt/ros/" in line


@pytest.mark.usefixtures("bus")
def test_a_run_is_scored_and_written(world: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place, file = tmp_path / "run", tmp_path / "score.json"
    assert main(["ros", str(world), "--lockstep", "--out", str(place), "--json", str(file)]) == 0
    text = capsys.readouterr().out
    assert "arrived after" in text
    assert text.splitlines()[-1].startswith("passed")
    score = json.loads(file.read_text())
    (leg,) = score["legs"]
    assert leg["outcome"] == "arrived"
    assert leg["metrics"]["arrived"] is True
    assert score["counts"]["commands"] > 100
    assert score["contacts"] == {"toward": 0, "away": 0, "standing": 0, "at_fault": 0, "apart": 0, "walls": 0}
    assert score["settings"]["lockstep"] is True
    page = (place / "summary.html").read_text()
    assert "Social metrics" in page
    assert "velocity commands executed" in page
    assert "<img" in page
    assert (place / "player.html").exists()


def test_fail_on_and_doubts_decide_the_exit_code(world: Path, bus: FakeBus) -> None:
    world.write_text(WORLD.replace("[3.0, 1.0]", "[1.5, 0.0]").replace("route = [[0.0, 1.0]]", "awareness = 0.0"))
    assert main(["ros", str(world), "--lockstep", "--fail-on", "moving_contact"]) == 3
    bus.answer = None
    world.write_text(WORLD.replace("time_limit = 12.0", "time_limit = 1.0"))
    assert main(["ros", str(world), "--lockstep", "--fail-on", "contact"]) == 5


def test_ctrl_c_scores_the_run_so_far(world: Path, bus: FakeBus, capsys: pytest.CaptureFixture[str]) -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, 0.5))
        if bus.now > 1.0:
            raise KeyboardInterrupt

    bus.answer = answer
    assert main(["ros", str(world), "--lockstep"]) == 0
    text = capsys.readouterr().out
    assert "stopped by Ctrl-C" in text
    assert "m from the goal" in text


@pytest.mark.parametrize(
    ("distro", "options", "type"),
    [
        ("jazzy", [], TWIST),
        ("kilted", [], STAMPED),
        ("jazzy", ["--lockstep"], STAMPED),
        ("kilted", ["--commands", "twist"], TWIST),
    ],
)
def test_a_controller_sends_what_the_distribution_has(
    distro: str, options: list[str], type: str, world: Path, bus: FakeBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(_: FakeBus) -> None:
        raise KeyboardInterrupt

    bus.answer = interrupt
    monkeypatch.setenv("ROS_DISTRO", distro)
    shielded = "[safe.shield]\nvelocity_tracking = [0.1, 0.05]\n"
    world.write_text(WORLD.replace("[robot]", shielded + "[robot]"))
    assert main(["ros", str(world), "--drive", *options]) == 130
    assert bus.topics["cmd_vel"][0] == type


@pytest.mark.usefixtures("bus")
@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--period", "7"], "--period must be from 0.005 to 1 s"),
        (["--speed", "0"], "--speed must"),
        (["--beams", "0"], "--beams must"),
        (["--range", "-1"], "--range must"),
        (["--field-of-view", "-20"], "--field-of-view must"),
        (["--commands", "twists"], "invalid choice"),
        (["--fail-on", "touch"], "--fail-on"),
    ],
)
def test_wrong_options_are_told_before_the_run(
    options: list[str], part: str, world: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["ros", str(world), *options]) == 2
    assert part in error_line(capsys)


NAV2 = """local_costmap: {local_costmap: {ros__parameters: {robot_radius: 0.3}}}
velocity_smoother: {ros__parameters: {max_velocity: [0.4, 0.0, 1.0], max_accel: [2.5, 0.0, 3.2]}}
"""


def test_the_robot_may_be_that_of_nav2(world: Path, bus: FakeBus, tmp_path: Path) -> None:
    params, file = tmp_path / "nav2.yaml", tmp_path / "score.json"
    params.write_text(NAV2)
    assert main(["ros", str(world), "--lockstep", "--params", str(params), "--json", str(file)]) == 0
    score = json.loads(file.read_text())
    assert score["counts"]["command_clipped"] > 100  # 0.5 m/s were told
    assert score["legs"][0]["metrics"]["max_speed"] == pytest.approx(0.4)
    assert bus.sent["/odom"][-1]["twist"]["twist"]["linear"]["x"] <= 0.4
    params.write_text("local_costmap: {}\n")
    assert main(["ros", str(world), "--lockstep", "--params", str(params)]) == 2


@pytest.mark.usefixtures("bus")
def test_a_wrong_file_names_its_key(world: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world.write_text(WORLD.replace("route", "root"))
    assert main(["ros", str(world)]) == 2
    assert "people[0].root" in error_line(capsys)
