"""The bridge and another process on ROS 2 itself; only where ``HRSAFETY_ROS_PYTHON`` names a Python with rclpy."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import pytest

import hrsafety

PYTHON = os.environ.get("HRSAFETY_ROS_PYTHON", "")
ROOT = Path(__file__).resolve().parents[2]
HALL = ROOT / "examples" / "people_in_a_hall.toml"
LIMIT = 120.0

pytestmark = pytest.mark.skipif(not PYTHON, reason="make test-ros runs it")


@pytest.fixture
def surroundings(tmp_path: Path) -> dict[str, str]:
    """Return the variables of processes that hear each other only, with the package that is tested."""
    (tmp_path / "hrsafety").symlink_to(Path(hrsafety.__file__).parent)
    own = {"PYTHONPATH": str(tmp_path), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    return {**os.environ, **own, "ROS_DOMAIN_ID": str(20 + os.getpid() % 80), "PYTHONUNBUFFERED": "1"}


@contextmanager
def started(surroundings: dict[str, str], *words: str) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [PYTHON, *words], env=surroundings, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def served(surroundings: dict[str, str], *options: str) -> AbstractContextManager[subprocess.Popen[str]]:
    return started(surroundings, "-m", "hrsafety", "ros", str(HALL), *options)


def ended(process: subprocess.Popen[str], code: int) -> str:
    text, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == code, text
    return text


def test_lock_step_drives_twice_with_the_same_score(surroundings: dict[str, str], tmp_path: Path) -> None:
    scores: list[dict[str, Any]] = []
    for number in range(2):
        file = tmp_path / f"{number}.json"
        with (
            served(surroundings, "--lockstep", "--drive", "--complete") as drive,
            served(surroundings, "--lockstep", "--wait", "--json", str(file)) as bridge,
        ):
            assert "passed" in ended(bridge, 0)
            drive.send_signal(signal.SIGINT)
            ended(drive, 130)
        scores.append(json.loads(file.read_text()))
    first, second = scores
    assert first["counts"]["lockstep_timeout"] == 0
    assert first["legs"][0]["outcome"] == "arrived"
    assert first == second


@pytest.mark.parametrize(("kind", "stop"), [("stamped", signal.SIGINT), ("plain", signal.SIGTERM)])
def test_topics_and_commands_in_real_time(
    kind: str, stop: signal.Signals, surroundings: dict[str, str], tmp_path: Path
) -> None:
    file = tmp_path / "score.json"
    listener = str(Path(__file__).with_name("listener.py"))
    with (
        served(surroundings, "--stay", "--json", str(file)) as bridge,
        started(surroundings, listener, "5", kind) as node,
    ):
        heard = json.loads(ended(node, 0).splitlines()[-1])
        time.sleep(1.0)  # without commands
        bridge.send_signal(stop)
        assert "stopped by Ctrl-C" in ended(bridge, 0)
    assert heard["qualities"] == {
        "/clock": [False, False, "rosgraph_msgs/msg/Clock"],
        "/odom": [True, False, "nav_msgs/msg/Odometry"],
        "/scan": [False, False, "sensor_msgs/msg/LaserScan"],
        "/people_markers": [True, False, "visualization_msgs/msg/MarkerArray"],
        "/hrsafety/verdict": [True, False, "diagnostic_msgs/msg/DiagnosticArray"],
        "/map": [True, True, "nav_msgs/msg/OccupancyGrid"],
    }
    for topic, rate in (("/clock", 100), ("/odom", 50), ("/scan", 20), ("/people_markers", 10)):
        assert heard["counts"][topic] == pytest.approx(5 * rate, rel=0.15)
    assert heard["speed"] == pytest.approx(0.4)
    assert heard["beams"] == 720
    assert heard["nothing"] > 0
    assert heard["cells"]
    assert heard["occupied"] > 500
    assert heard["people"] >= 3
    score = json.loads(file.read_text())
    assert score["counts"]["commands"] == pytest.approx(100, rel=0.2)
    assert score["counts"]["command_timeout"] == 1
    assert score["counts"]["command_late"] == score["counts"]["command_from_future"] == 0
    assert score["legs"][0]["metrics"]["path_length"] > 1.5


def test_without_rclpy_the_command_says_so(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "hrsafety", "ros", str(HALL)], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert done.returncode == 2
    assert "source /opt/ros" in done.stderr
