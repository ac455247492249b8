"""A controller as a node: it drives among people on a bus, and brakes where it is not told what it needs."""

from __future__ import annotations

import math
from typing import Any

import pytest

from api.ros.fake_bus import FakeBus, pose, told
from api.ros.worlds import Wire, empty, hall, served
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError
from hrsafety.ros import messages
from hrsafety.ros.drive import LawNode
from hrsafety.ros.messages import Pose, Seen


def static(*edges: tuple[str, str, tuple[float, float, float], dict[str, float]]) -> Any:
    """Return transforms of edges: parent, child, place, and parts of the quaternion."""
    none = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 0.0}
    place = [{"translation": dict(zip("xyz", at, strict=True)), "rotation": none | turn} for _, _, at, turn in edges]
    return told(
        {
            "transforms": [
                {"header": {"frame_id": parent}, "child_frame_id": child, "transform": each}
                for (parent, child, _, _), each in zip(edges, place, strict=True)
            ]
        }
    )


AHEAD, BACKWARD, OVER = {"w": 1.0}, {"z": 1.0}, {"x": 1.0}
IN_MAP = static(("map", "odom", (0.0, 0.0, 0.0), AHEAD))


def sent(drive: FakeBus) -> list[tuple[float, float]]:
    twists = [each["twist"] for each in drive.sent["cmd_vel"]]
    return [(each["linear"]["x"], each["angular"]["z"]) for each in twists]


@pytest.mark.parametrize("types", [("tf2_msgs/msg/TFMessage", "people_msgs/msg/People"), ()])
def test_a_shielded_law_drives_among_people_who_react(types: tuple[str, ...]) -> None:
    world, bus = hall(time_limit=40.0), FakeBus(types=types)
    wire = Wire(world, bus, lockstep=True)
    record, _ = served(world, wire, bus=bus)
    assert record.counts["lockstep_timeout"] == 0
    assert record.contacts == (0, 0, 0, 0, 0)
    assert record.arrived
    assert not wire.drive.counts


def test_whoever_is_not_listed_has_left_where_lists_are_complete() -> None:
    seen = Seen("a", 2.0, 0.0, 0.0, 0.0, 0.25)
    for complete in (False, True):
        bus = FakeBus()
        drive = LawNode(hall(), bus, complete=complete)
        for step in range(20):
            told_of(bus, 0.05 * step, *([seen] if step < 10 else []), speed=0.0)
        assert drive.last is not None
        assert (drive.last.oldest > 0.4) == (not complete)
        assert sent(bus)[-1][0] > 0.05 or not complete


def test_it_drives_twice_with_the_same_bits() -> None:
    def bits() -> bytes:
        world, bus = hall(), FakeBus()
        record, _ = served(world, Wire(world, bus, lockstep=True), bus=bus)
        return bytes(record.legs[0].trajectory.robot_position.tobytes())

    assert bits() == bits()


def test_it_drives_in_real_time_as_well() -> None:
    world, bus = hall(time_limit=30.0), FakeBus()
    record, _ = served(world, Wire(world, bus), bus=bus, lockstep=False)
    assert record.contacts.moving == 0
    assert record.legs[0].moved > 5.0
    assert record.counts["command_late"] == record.counts["command_timeout"] == 0


def test_holonomic_robots_are_told_in_their_own_frame() -> None:
    law = nav.VirtualForceField()
    robot = nav.Robot(start=(0, 0), goal=(4, 3), body=nav.HolonomicRobot(), law=law, heading=1.0)
    world, bus = nav.World(robots=[robot], time_limit=30.0), FakeBus()
    record, _ = served(world, Wire(world, bus, lockstep=True), bus=bus)
    run = record.legs[0].trajectory
    assert record.arrived
    away = run.robot_position[:, 0] @ (-0.6, 0.8)
    assert abs(away).max() < 0.05


def told_of(drive: FakeBus, now: float, *people: Seen, x: float = 0.0, speed: float = 0.3) -> None:
    drive.say("/tf", IN_MAP)
    drive.say("/people", told(messages.people(now, people)))
    drive.say("/odom", told(messages.odometry(now, Pose(x, 0.0, 0.0), (speed, 0.0, 0.0))))


def test_it_stands_until_it_has_heard_of_people() -> None:
    bus = FakeBus()
    LawNode(hall(), bus)
    bus.say("/tf", IN_MAP)
    for step in range(10):
        bus.say("/odom", told(messages.odometry(0.05 * step, Pose(0.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    assert sent(bus) == [(0.0, 0.0)] * 10
    told_of(bus, 0.6)
    assert sent(bus)[-1][0] > 0.0


def test_it_brakes_without_people_and_without_odometry() -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    x = 0.0
    for step in range(40):
        x += 0.3 * 0.05
        told_of(bus, 0.05 * step, x=x)
    assert sent(bus)[-1][0] > 0.1
    for step in range(40, 80):
        bus.say("/odom", told(messages.odometry(0.05 * step, Pose(x, 0.0, 0.0), (0.0, 0.0, 0.0))))
    assert drive.counts["people_silent"] > 0
    assert sent(bus)[-1] == (0.0, 0.0)
    before = len(sent(bus))
    bus.spin(0.6)
    drive.watch()
    assert drive.counts["odometry_silent"] == 1
    assert sent(bus)[before:] == [(0.0, 0.0)]


def test_in_lock_step_a_world_that_thinks_for_long_is_not_silent() -> None:
    world, bus = hall(time_limit=3.0), FakeBus()
    wire = Wire(world, bus, lockstep=True)

    def answer(bus: FakeBus) -> None:
        wire.bus.spin(0.7)
        wire.drive.watch()
        wire(bus)

    slow, _ = served(world, answer, bus=bus)
    quick, _ = served(world, Wire(world, other := FakeBus(), lockstep=True), bus=other)
    assert not wire.drive.counts
    places = (each.legs[0].trajectory.robot_position.tobytes() for each in (slow, quick))
    assert len(set(places)) == 1


def test_what_is_not_finite_is_not_measured() -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    told_of(bus, 0.0, Seen("a", math.nan, 0.0, 0.0, 0.0, 0.3), Seen("b", 3.0, 0.0, 0.0, 0.0, 0.3))
    assert drive.counts["people_not_finite"] == 1
    bus.say("/odom", told(messages.odometry(0.1, Pose(math.nan, 0.0, 0.0), (0.0, 0.0, 0.0))))
    assert drive.counts["odometry_not_finite"] == 1
    assert len(sent(bus)) == 1
    bus.say(
        "/people", told({**messages.people(0.2, []), "header": {"frame_id": "camera", "stamp": messages.stamp(0.2)}})
    )
    assert drive.counts["people_frame"] == 1


def test_a_person_in_the_way_is_not_driven_into() -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    told_of(bus, 0.0, Seen("a", 0.9, 0.0, 0.0, 0.0, 0.25), speed=0.0)
    assert drive.last is not None
    assert drive.last.speed is not None
    assert drive.last.speed < 0.05


@pytest.mark.parametrize(
    ("edges", "mounting"),
    [
        ([("base_footprint", "laser", (0.0, 0.0, 0.2), AHEAD)], (0.0, 0.0, 0.0)),
        ([("base_footprint", "laser", (-0.15, 0.0, 0.2), BACKWARD)], (-0.15, 0.0, math.pi)),
        (
            [
                ("base_link", "laser", (0.1, 0.0, 0.1), BACKWARD),
                ("base_footprint", "base_link", (0.0, 0.1, 0.1), {"z": math.sqrt(0.5), "w": math.sqrt(0.5)}),
            ],
            (0.0, 0.2, -0.5 * math.pi),
        ),
        ([("base_footprint", "laser", (0.0, 0.0, 0.2), OVER)], None),
        ([("base_footprint", "laser", (math.nan, 0.0, 0.2), AHEAD)], None),
        ([("arm", "laser", (0.0, 0.0, 0.2), AHEAD)], None),
        ([("laser", "laser", (0.0, 0.0, 0.2), AHEAD)], None),
        ([], None),
    ],
)
def test_a_lidar_is_where_its_transforms_say(edges: Any, mounting: tuple[float, float, float] | None) -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    bus.say("/tf_static", static(*edges))
    lidar = nav.Lidar(beams=360, range_max=12.0, mounting=mounting or (0.0, 0.0, 0.0))
    for step in range(60):
        now, body = 0.05 * step, Seen("a", 1.6, 0.0, 0.0, 0.0, 0.25)
        ranges = lidar.scan((0.0, 0.0), 0.0, people=[(body.x, body.y, body.radius)])
        message = messages.scan(now, lidar, ranges, 0.05) | {
            "header": {"frame_id": "laser", "stamp": messages.stamp(now)}
        }
        told_of(bus, now, *([body] if step < 3 else []), speed=0.0)
        bus.say("/scan", told(message))
    assert drive.counts["lidar_place"] == (60 if mounting is None else 0)
    # Who is in the way, and is not listed any more, stays there: the lidar sees somebody at that place.
    assert drive.last is not None
    assert drive.last.oldest > 2.0
    assert all(speed < 0.3 for speed, _ in sent(bus)[-20:])


@pytest.mark.parametrize(
    ("edges", "place"),
    [
        ([("map", "odom", (2.0, 1.0, 0.0), BACKWARD)], (1.0, 1.0)),
        ([("map", "earth", (2.0, 0.0, 0.0), AHEAD), ("earth", "odom", (0.0, 1.0, 0.0), BACKWARD)], (1.0, 1.0)),
        ([("map", "other/odom", (2.0, 1.0, 0.0), BACKWARD)], None),
        ([("map", "odom", (2.0, 1.0, 0.0), OVER)], None),
        ([("map", "odom", (math.nan, 1.0, 0.0), AHEAD)], None),
        ([], None),
    ],
)
def test_a_robot_whose_frame_is_not_known_in_the_map_does_not_drive(edges: Any, place: tuple[float, float]) -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    bus.say("/tf_static", static(*edges))
    for step in range(3):
        bus.say("/people", told(messages.people(0.05 * step, [])))
        bus.say("/odom", told(messages.odometry(0.05 * step, Pose(1.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    if place is None:
        assert drive.counts["odometry_frame"] == 3
        assert not sent(bus)
    else:
        assert not drive.counts
        assert drive._poses[-1].pose[:2] == pytest.approx(place)


@pytest.mark.parametrize(
    "change",
    [
        {"angle_min": 0.0},
        {"angle_increment": -math.tau / 360},
        {"angle_min": math.nan},
        {"ranges": [1500.0 + beam for beam in range(360)]},
    ],
)
def test_scans_of_other_beams_or_in_other_units_forget_nobody(change: dict[str, Any]) -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    bus.say("/tf_static", static(("base_footprint", "base_scan", (0.0, 0.0, 0.2), AHEAD)))
    lidar, body = nav.Lidar(beams=360, range_max=12.0), Seen("a", 1.6, 0.0, 0.0, 0.0, 0.25)
    ranges = lidar.scan((0.0, 0.0), 0.0, people=[(body.x, body.y, body.radius)])
    for step in range(60):
        now = 0.05 * step
        told_of(bus, now, *([body] if step < 3 else []), speed=0.0)
        bus.say("/scan", told(messages.scan(now, lidar, ranges, 0.05) | (change if step > 2 else {})))
    assert drive.counts["scan_refused"] == 57
    assert drive.last is not None
    assert drive.last.oldest > 2.0


def test_two_people_with_one_name_are_both_there() -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    told_of(bus, 0.0, Seen("a", 0.9, 0.0, 0.0, 0.0, 0.25), Seen("a", 6.0, 2.0, 0.0, 0.0, 0.25), speed=0.0)
    assert drive.counts["people_names"] == 1
    assert drive.last is not None
    assert drive.last.speed is not None
    assert drive.last.speed < 0.05


def test_doubts_about_a_lidar_are_logged_when_it_is_heard() -> None:
    bus = FakeBus()
    LawNode(hall(), bus)
    bus.say("/tf_static", static(("base_footprint", "base_scan", (0.0, 0.0, 0.2), AHEAD)))
    lidar, told_before = nav.Lidar(beams=360, range_max=12.0), len(bus.logs)
    message = messages.scan(0.0, lidar, lidar.scan((0.0, 0.0)), 0.05) | {"range_max": 12000.0}
    for _ in range(2):
        bus.say("/scan", told(message))
    told_of_lidar = [text for _, text in bus.logs[told_before:] if "lidar.range_max is 12000 m" in text]
    assert len(told_of_lidar) == 1


@pytest.mark.parametrize("given", [pose(math.nan, 0.0), pose(1.0, 0.0, frame="odom")])
def test_goals_that_are_none_are_refused(given: Any) -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    bus.say("/goal_pose", given)
    assert drive.counts["goal_pose_refused"] == 1


def test_another_goal_is_driven_to() -> None:
    bus = FakeBus()
    drive = LawNode(empty(), bus)
    told_of(bus, 0.0, speed=0.0)
    assert sent(bus)[-1][0] > 0.0
    bus.say("/goal_pose", pose(-6.0, 0.0))
    told_of(bus, 0.1, speed=0.0)
    assert not drive.counts
    assert sent(bus)[-1][0] <= 0.0 or abs(sent(bus)[-1][1]) > 0.1


def test_a_clock_that_is_set_back_does_not_stop_it_for_good() -> None:
    bus = FakeBus()
    drive = LawNode(empty(), bus)
    for step in range(20):
        told_of(bus, 100.0 + 0.05 * step, speed=0.0)
    before = len(sent(bus))
    for step in range(200):
        told_of(bus, 0.05 * step, speed=0.0)
    assert len(sent(bus)) >= before + 190
    assert drive.last is not None
    assert sent(bus)[-1][0] > 0.0


def test_what_refutes_the_shield_is_told_once_and_counted() -> None:
    bus = FakeBus()
    drive = LawNode(hall(), bus)
    for step in range(5):
        told_of(bus, 0.05 * step, Seen("a", 6.0, 1.0, 3.0, 0.0, 0.25), speed=0.0)
    assert drive.counts["doubt_faster"] == 5
    (line,) = [text for _, text in bus.logs if text.startswith("faster is ('a',)")]
    assert "guarantees nothing" in line


def test_a_world_needs_a_law() -> None:
    world = nav.World(robots=[nav.Robot(start=(0, 0), goal=(1, 0))])
    with pytest.raises(InvalidParameterError, match="one robot with a law"):
        LawNode(world, FakeBus())
