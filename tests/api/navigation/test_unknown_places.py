"""A robot that knows a place from its scans alone: controller, careful behavior, episodes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark
from hrsafety.benchmarks.unknown import dead_end, driving_time, rollout_entry, trial
from hrsafety.errors import InvalidParameterError, ShapeError

OUTLINE = nav.robots.Footprint.rectangle(0.5, 0.4)
LIMITS = {"max_speed": 1.0, "max_turn_rate": 3.0, "max_acceleration": 2.0, "max_turn_acceleration": 6.0}
ROBOT = nav.DifferentialDriveRobot(**LIMITS, footprint=OUTLINE)
ROOM = nav.StaticMap(
    walls=[([(-1, -2), (7, -2), (7, 2), (-1, 2), (-1, -2)], 0.02), ([(3, -2), (3, 0.3)], 0.05)],
    discs=[(5.0, 0.5, 0.3)],
)
PERIOD = 0.05


def controller(**changed: Any) -> nav.ScanController:
    given: dict[str, Any] = {"lidars": [nav.Lidar(map=ROOM, beams=360)], **changed}
    return nav.ScanController(nav.ArcRollouts(), ROBOT, (6.0, -1.0), **given)


def moved(pose: tuple[float, float, float], before: tuple[float, float], after: tuple[float, float]) -> Any:
    """Return the pose after a control period in which a twist changes evenly into another one."""
    x, y, angle = pose
    for part in range(50):
        share = (part + 0.5) / 50
        speed, rate = ((1 - share) * one + share * other for one, other in zip(before, after, strict=True))
        angle += 0.5 * rate * PERIOD / 50
        x, y = x + speed * PERIOD / 50 * math.cos(angle), y + speed * PERIOD / 50 * math.sin(angle)
        angle += 0.5 * rate * PERIOD / 50
    return x, y, angle


def clearance(pose: tuple[float, float, float]) -> float:
    x, y, angle = pose
    body = [
        (x + a * math.cos(angle) - b * math.sin(angle), y + a * math.sin(angle) + b * math.cos(angle))
        for a, b in OUTLINE.corners
    ]
    return min(ROOM.segment_clearance(one, body[index - 1]) for index, one in enumerate(body))


def test_it_drives_around_walls_that_only_scans_of_two_mounted_lidars_show() -> None:
    front, back = (0.2, 0.1, 0.3), (-0.2, 0.0, math.pi)
    seen = {"map": ROOM, "beams": 270, "field_of_view": 1.5 * math.pi, "range_noise": 0.01}
    lidars = [
        nav.Lidar(mounting=front, **seen),
        nav.Lidar(mounting=back, angle_min=-0.7 * math.pi, dropout=0.1, **seen),
    ]
    robot = controller(lidars=lidars)
    pose, twist = (0.0, 0.0, 0.0), (0.0, 0.0)
    for step in range(400):
        scans = [lidar.scan(pose[:2], pose[2], seed=2 * step + index) for index, lidar in enumerate(lidars)]
        command = robot.update(step * PERIOD, pose[:2], pose[2], scans)
        if command.arrived and command.speed == 0.0:
            break
        pose = moved(pose, twist, (command.speed, command.turn_rate))
        twist = command.speed, command.turn_rate
        assert clearance(pose) > 0.0
    assert command.arrived
    assert robot.known_cells.kinds.shape[0] * robot.known_cells.cell >= 12.0
    assert (robot.known_cells.kinds == 2).sum() > 50


def test_a_lidar_that_is_blind_beside_the_outline_is_doubted() -> None:
    for place, least, doubted in (((0.0, 0.0), 0.19, False), ((0.0, 0.0), 0.21, True), ((0.2, 0.1), 0.06, True)):
        lidar = nav.Lidar(mounting=(*place, 0.0), range_min=least)
        codes = [warning.code for warning in controller(lidars=[lidar]).warnings]
        assert codes == ["blind_nearby"] * doubted


def driving() -> tuple[nav.ScanController, nav.Lidar, tuple[float, float, float], tuple[float, float]]:
    """Return a robot at work after half a second."""
    lidar = nav.Lidar(map=ROOM, beams=360)
    robot, pose, twist = controller(), (0.0, 0.0, 0.0), (0.0, 0.0)
    for step in range(10):
        command = robot.update(step * PERIOD, pose[:2], pose[2], [lidar.scan(pose[:2], pose[2])])
        pose = moved(pose, twist, (command.speed, command.turn_rate))
        twist = command.speed, command.turn_rate
    assert twist[0] > 0.3
    assert not command.blind
    assert command.off_plan is None
    return robot, lidar, pose, twist


def test_without_scans_it_brakes_to_rest_within_its_plan() -> None:
    robot, _, pose, twist = driving()
    speeds = []
    for step in range(10, 40):
        command = robot.update(step * PERIOD, pose[:2], pose[2])
        pose = moved(pose, twist, (command.speed, command.turn_rate))
        twist = command.speed, command.turn_rate
        speeds.append(command.speed)
    assert command.blind
    assert speeds[-1] == 0.0


def test_small_slips_of_one_verified_plan_add_up() -> None:
    robot, _, pose, twist = driving()
    slip, off = 0.008, []
    for step in range(10, 24):
        command = robot.update(step * PERIOD, pose[:2], pose[2])
        off.append(command.off_plan)
        x, y, angle = moved(pose, twist, (command.speed, command.turn_rate))
        pose, twist = (
            (x + slip * math.cos(angle), y + slip * math.sin(angle), angle),
            (command.speed, command.turn_rate),
        )
    # After 0.3 s without a scan a plan runs on, which keeps 0.01 m more away for the whole of it.
    seen = [each for each in off if each is not None]
    assert seen
    assert seen[0][0] == pytest.approx(2 * slip, abs=1e-3)


def test_an_update_without_a_pose_moves_the_plan_on() -> None:
    robot, lidar, pose, twist = driving()
    for step in range(10, 14):
        told = (None, None) if step == 10 else (pose[:2], pose[2])
        command = robot.update(step * PERIOD, *told, [] if step == 10 else [lidar.scan(pose[:2], pose[2])])
        assert command.status == ("braking" if step == 10 else command.status)
        assert command.off_plan is None
        pose = moved(pose, twist, (command.speed, command.turn_rate))
        twist = command.speed, command.turn_rate


def test_scans_without_a_reading_tell_nothing() -> None:
    robot, _, pose, twist = driving()
    for step in range(10, 40):
        command = robot.update(step * PERIOD, pose[:2], pose[2], [np.full(360, np.nan)])
        pose = moved(pose, twist, (command.speed, command.turn_rate))
        twist = command.speed, command.turn_rate
    assert command.blind
    assert command.unknown_beams == 360
    assert command.speed == 0.0


def test_a_pose_that_jumps_forgets_what_was_seen_and_brakes() -> None:
    robot, lidar, pose, _ = driving()
    command = robot.update(10 * PERIOD, (pose[0] + 0.5, pose[1]), pose[2], [lidar.scan(pose[:2], pose[2])])
    assert command.forgotten
    assert command.off_plan is not None
    assert command.off_plan[0] == pytest.approx(0.5, abs=0.01)
    assert command.status == "braking"


def test_a_pose_beside_the_plan_brakes() -> None:
    robot, lidar, pose, _ = driving()
    command = robot.update(10 * PERIOD, (pose[0], pose[1] + 0.02), pose[2], [lidar.scan(pose[:2], pose[2])])
    assert (command.forgotten, command.status) == (False, "braking")


@pytest.mark.parametrize("time", [9 * PERIOD, 0.0, -5.0])
def test_a_clock_that_is_set_back_or_stands_brakes(time: float) -> None:
    robot, lidar, pose, _ = driving()
    command = robot.update(time, pose[:2], pose[2], [lidar.scan(pose[:2], pose[2])][: int(time >= 0.0)])
    assert command.clock_set_back
    assert command.status == "braking"


def test_scans_that_are_too_old_or_from_an_unknown_instant_are_counted_and_not_entered() -> None:
    robot, lidar, pose, _ = driving()
    old = nav.LidarScan(lidar.scan(pose[:2], pose[2]), time=-1.0)
    command = robot.update(10 * PERIOD, pose[:2], pose[2], [old])
    assert command.ignored_scans == 1


def test_a_late_scan_is_entered_with_the_pose_of_its_instant() -> None:
    lidar = nav.Lidar(map=ROOM, beams=720)
    robot, pose, twist, waiting = controller(lidars=[lidar]), (0.0, 0.0, 0.0), (0.0, 0.0), []
    for step in range(40):
        waiting.append(nav.LidarScan(lidar.scan(pose[:2], pose[2]), time=step * PERIOD))
        scans = [waiting.pop(0)] if len(waiting) > 2 else []
        command = robot.update(step * PERIOD, pose[:2], pose[2], scans)
        pose = moved(pose, twist, (command.speed, command.turn_rate))
        twist = command.speed, command.turn_rate
        assert command.ignored_scans == 0
    cells = robot.known_cells
    rows, columns = np.nonzero(cells.kinds == 2)
    middles = np.stack([cells.low[0] + (columns + 0.5) * cells.cell, cells.low[1] + (rows + 0.5) * cells.cell], axis=1)
    # Every occupied cell is one that the true walls are in, give or take a cell.
    assert len(middles) > 100
    assert ROOM.clearance(middles).max() < 0.06
    assert pose[0] > 0.5


def test_right_scans_alone_are_taken() -> None:
    robot, lidar, pose, _ = driving()
    good = lidar.scan(pose[:2], pose[2])
    with pytest.raises(ShapeError):
        robot.update(10 * PERIOD, pose[:2], pose[2], [good[:-1]])
    with pytest.raises(InvalidParameterError, match="at least 0"):
        robot.update(10 * PERIOD, pose[:2], pose[2], [np.where(np.arange(360) == 7, -1.0, good)])
    with pytest.raises(InvalidParameterError, match="no later than the update"):
        robot.update(10 * PERIOD, pose[:2], pose[2], [nav.LidarScan(good, time=1e3)])
    with pytest.raises(InvalidParameterError, match="finite"):
        robot.update(math.nan, pose[:2], pose[2], [good])
    with pytest.raises(InvalidParameterError, match="number of lidars"):
        robot.update(10 * PERIOD, pose[:2], pose[2], [nav.LidarScan(good, lidar=1)])
    # Nothing of these updates counted.
    assert robot.update(10 * PERIOD, pose[:2], pose[2], [good]).status in ("kept", "changed")


def test_a_map_in_which_the_robot_cannot_stop_is_refused() -> None:
    rollouts = nav.ArcRollouts(map=nav.UnknownMap(reach=2.0))
    slow = nav.DifferentialDriveRobot(max_speed=2.0, max_acceleration=1.0)
    with pytest.raises(InvalidParameterError, match="until it stops"):
        nav.ScanController(rollouts, slow, (3.0, 0.0), lidars=[nav.Lidar()])


def test_runs_without_noise_are_those_of_the_specification(shared: Path) -> None:
    cases = json.loads((shared / "spec" / "unknown_places_cases.json").read_text(encoding="utf-8"))["unknown"]
    worlds = shared / "data" / "barn" / "barn_even.json"
    for case in cases["runs_without_noise"][1:]:
        place = nav.StaticMap.from_barn(worlds, case["world"])
        found = trial(rollout_entry("rollouts(noise=0)"), place, 0)
        assert found.outcome == "arrived"
        assert driving_time(found) == pytest.approx(case["time"], rel=0.03)
        assert found.path_length == pytest.approx(case["path"], rel=0.03)
        assert found.map_clearance > 0.03


def test_plans_are_verified_or_contacts_follow_at_low_deceleration(shared: Path) -> None:
    worlds = shared / "data" / "barn"
    result = benchmark("unknown_barn", ["rollouts(acceleration=1,noise=0.03,drift=1)"], cases=3, data=worlds)
    rows = result.rows["rollouts(acceleration=1,noise=0.03,drift=1)"]
    assert all(row.outcome == "arrived" and row.clearance > 0.0 for row in rows)


def test_dead_ends_are_left_again() -> None:
    result = benchmark("dead_ends", ["rollouts(noise=0.03,drift=1)"], cases=4)
    assert result.success("rollouts(noise=0.03,drift=1)").value == 1.0
    assert dead_end(3, 0) == dead_end(3, 0)


@pytest.mark.parametrize("word", ["rollout", "rollouts(noise=1,noise=2)", "rollouts(speed=1)", "rollouts(noise=a)"])
def test_words_for_rollouts_are_checked(word: str) -> None:
    with pytest.raises(InvalidParameterError, match="laws"):
        rollout_entry(word)
