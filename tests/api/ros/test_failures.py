"""What goes wrong on a bus is counted, told once, and does what the specification says."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from api.ros.fake_bus import STAMPED, TWIST, FakeBus, pose, stamped, told, twist
from api.ros.worlds import ahead, empty, hall, served
from hrsafety import navigation as nav
from hrsafety.ros import Bridge, Publisher, Settings
from hrsafety.ros.score import report_of


def speeds(record: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    run = record.legs[0].trajectory
    return np.asarray(np.hypot(*run.robot_velocity[:, 0].T))


def told_once(bus: FakeBus, part: str) -> bool:
    return sum(part in text for _, text in bus.logs) == 1


def test_without_commands_for_half_a_second_the_robot_brakes() -> None:
    def answer(bus: FakeBus) -> None:
        if bus.now < 2.0 or bus.now > 4.0:
            bus.say("cmd_vel", stamped(bus.now, 0.6))

    record, bus = served(empty(time_limit=6.0), answer)
    speed, time = speeds(record), record.legs[0].trajectory.time
    assert record.counts["command_timeout"] == 1
    assert told_once(bus, "the robot brakes")
    last = 1.95  # the last command before the silence
    np.testing.assert_allclose(speed[(time > 1.0) & (time <= last + 0.5 + 1e-9)], 0.6)
    assert (speed[(time > last + 0.5 + 0.6 / 2.0 + 0.05) & (time < 4.0)] == 0.0).all()
    assert speed[-1] == pytest.approx(0.6)
    # Every step of the silence waited a second of the wall.
    assert record.counts["lockstep_timeout"] == pytest.approx(41, abs=1)
    assert "lockstep_timeout" in {each.code for each in record.warnings}


def test_a_robot_without_any_command_stands_and_is_in_doubt() -> None:
    record, _ = served(empty(time_limit=1.0), None)
    assert record.legs[0].moved == 0.0
    assert {"no_command", "lockstep_timeout"} <= {each.code for each in record.warnings}
    assert not any(each.safe_side for each in record.warnings if each.code == "no_command")


def test_older_commands_are_ignored() -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, 0.5))
        if bus.now > 0.5:
            bus.say("cmd_vel", stamped(bus.now - 0.1, -0.5))

    record, bus = served(empty(time_limit=3.0), answer)
    assert record.counts["command_out_of_order"] == 49
    assert speeds(record)[-1] == pytest.approx(0.5)
    assert told_once(bus, "older than one before")


def test_late_commands_are_executed_and_counted() -> None:
    record, bus = served(
        empty(time_limit=3.0), lambda bus: bus.say("cmd_vel", stamped(max(bus.now - 0.3, 0.0), 0.5)), lockstep=False
    )
    assert record.counts["command_late"] > 100
    assert speeds(record)[-1] == pytest.approx(0.5)
    assert told_once(bus, "0.2 s old")


def test_late_commands_do_not_answer_a_step() -> None:
    record, _ = served(empty(time_limit=1.0), lambda bus: bus.say("cmd_vel", stamped(max(bus.now - 0.3, 1e-3), 0.5)))
    assert record.counts["lockstep_timeout"] == 19
    assert record.counts["command_late"] > 0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_commands_that_are_not_finite_count_as_none(bad: float, place: int) -> None:
    def answer(bus: FakeBus) -> None:
        values = [0.5, 0.0, 0.0]
        if bus.now > 1.0:
            values[place] = bad
        bus.say("cmd_vel", stamped(bus.now, *values))

    record, bus = served(empty(time_limit=2.5), answer)
    assert record.counts["command_not_finite"] > 0
    assert told_once(bus, "not finite")
    assert record.counts["command_timeout"] == 1
    assert speeds(record)[-1] == 0.0


def test_commands_beyond_the_limits_are_cut() -> None:
    record, bus = served(empty(time_limit=2.0), lambda bus: bus.say("cmd_vel", stamped(bus.now, 1e300, rate=-1e300)))
    assert record.counts["command_clipped"] == 40
    last = bus.sent["/odom"][-1]["twist"]["twist"]
    assert last["linear"]["x"] == pytest.approx(0.8)
    assert last["angular"]["z"] == pytest.approx(-1.5)
    assert told_once(bus, "beyond the limits")


def test_two_wheels_do_not_go_sideways() -> None:
    record, _ = served(empty(time_limit=2.0), lambda bus: bus.say("cmd_vel", stamped(bus.now, 0.0, 0.5)))
    assert record.counts["command_clipped"] == 40
    assert record.legs[0].moved == 0.0


def test_commands_at_the_limits_are_not_beyond_them() -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, float(np.float32(0.8)), rate=float(np.float32(1.5))))

    record, _ = served(empty(time_limit=2.0), answer)
    assert record.counts["command_clipped"] == 0


def test_two_publishers_are_a_warning() -> None:
    bus = FakeBus(publishers={"cmd_vel": [Publisher(STAMPED), Publisher(STAMPED)]})
    record, _ = served(empty(time_limit=2.0), ahead, bus=bus)
    assert record.several
    assert told_once(bus, "2 publishers")
    assert "several_publishers" in {each.code for each in record.warnings if not each.safe_side}


def test_stamps_later_than_the_clock_are_taken_as_none() -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(1.7e9 if bus.now < 1.0 else bus.now, 0.5))

    record, bus = served(empty(time_limit=2.0), answer)
    assert record.counts["command_from_future"] == 20
    assert record.counts["command_out_of_order"] == 0
    assert told_once(bus, "use_sim_time")
    assert "command_from_future" in {each.code for each in record.warnings}
    assert speeds(record)[-1] == pytest.approx(0.5)


def test_a_world_that_cannot_keep_up_says_so() -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, 0.5))
        bus._wall += 0.03  # a machine on which every tick takes three times as long

    record, bus = served(empty(time_limit=2.0), answer, lockstep=False)
    assert record.counts["overrun"] > 0
    assert record.late > 3.0
    assert "overrun" in {each.code for each in record.warnings if not each.safe_side}
    assert told_once(bus, "cannot keep up")


def test_a_clock_slower_than_real_time_is_a_doubt() -> None:
    for speed, doubted in ((0.5, True), (1.0, False), (2.0, False)):
        record, _ = served(empty(time_limit=1.0), ahead, lockstep=False, speed=speed)
        assert ("slow_clock" in {each.code for each in record.warnings}) == doubted


def put(at: float, message: Any, topic: str = "/initialpose") -> Any:
    """Answer every step, and say something once."""
    said: list[bool] = []

    def answer(bus: FakeBus) -> None:
        ahead(bus)
        if bus.now >= at and not said:
            said.append(True)
            bus.say(topic, message)

    return answer


@pytest.mark.parametrize(
    ("given", "why"),
    [
        (pose(4.0, 2.9, covariance=True), "a wall is there"),
        (pose(400.0, 0.0, covariance=True), "not on the map"),
        (pose(1e300, 0.0, covariance=True), "not on the map"),
        (pose(math.nan, 0.0, covariance=True), "not finite"),
        (pose(4.0, 0.0, w=0.0, covariance=True), "quaternion"),
        (pose(4.0, 0.0, frame="odom", covariance=True), "'odom'"),
    ],
)
def test_places_that_cannot_be_are_refused(given: Any, why: str) -> None:
    record, bus = served(empty(time_limit=2.0), put(1.0, given))
    assert record.counts["initialpose_refused"] == 1
    assert len(record.legs) == 1
    assert any(why in text for _, text in bus.logs)


def test_a_place_on_somebody_is_refused() -> None:
    person = nav.Person(start=(5.0, 1.0))
    world = hall(people=[person], sources=[], time_limit=2.0)
    for x, refused in ((5.4, 1), (5.6, 0)):
        record, bus = served(world, put(1.0, pose(x, 1.0, covariance=True)))
        assert record.counts["initialpose_refused"] == refused
        assert any("somebody is there" in text for _, text in bus.logs) == bool(refused)


def test_a_robot_that_is_carried_begins_a_leg_and_keeps_its_odometry() -> None:
    record, bus = served(empty(time_limit=3.0), put(1.0, pose(5.0, 1.0, covariance=True)))
    assert "carried once" in report_of(record, Settings(), "hall.toml").said
    assert [leg.reason for leg in record.legs] == ["start", "initialpose"]
    first, second = (leg.trajectory for leg in record.legs)
    assert first.time[-1] + second.time[-1] == pytest.approx(3.0)
    np.testing.assert_allclose(second.robot_position[0, 0], (5.0, 1.0))
    odometry = np.array([each["pose"]["pose"]["position"]["x"] for each in bus.sent["/odom"]])
    assert np.abs(np.diff(odometry)).max() < 0.05
    corrected = bus.sent["/tf"][-1]["transforms"]
    assert [(each["header"]["frame_id"], each["child_frame_id"]) for each in corrected] == [
        ("map", "odom"),
        ("odom", "base_footprint"),
    ]
    # Both together are where the robot is.
    turned = [
        2.0 * math.atan2(each["transform"]["rotation"]["z"], each["transform"]["rotation"]["w"]) for each in corrected
    ]
    (outer, inner) = ([each["transform"]["translation"][axis] for axis in "xy"] for each in corrected)
    sin, cos = math.sin(turned[0]), math.cos(turned[0])
    place = (outer[0] + cos * inner[0] - sin * inner[1], outer[1] + sin * inner[0] + cos * inner[1])
    np.testing.assert_allclose(place, second.robot_position[-2, 0], atol=1e-9)


def test_goals_are_taken_and_begin_a_leg_once_the_robot_has_moved() -> None:
    record, _ = served(empty(time_limit=3.0), put(0.0, pose(6.0, 1.0), "/goal_pose"))
    assert [leg.world.robots[0].goal for leg in record.legs] == [(6.0, 1.0)]
    record, _ = served(empty(time_limit=3.0), put(1.0, pose(6.0, 1.0), "/goal_pose"))
    assert [leg.world.robots[0].goal for leg in record.legs] == [(8.0, 0.0), (6.0, 1.0)]
    assert [leg.outcome for leg in record.legs] == ["superseded", "timed_out"]
    record, bus = served(empty(time_limit=3.0), put(1.0, pose(math.inf, 1.0), "/goal_pose"))
    assert record.counts["goal_pose_refused"] == 1
    assert any("/goal_pose is refused" in text for _, text in bus.logs)


def test_contacts_count_in_every_leg() -> None:
    person = nav.Person(start=(1.5, 0.0), awareness=0.0)
    world = hall(people=[person], sources=[], time_limit=6.0)
    answers = put(5.0, pose(6.0, 2.0, covariance=True))

    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, 0.4))
        answers(bus)

    record, bus = served(world, answer)
    assert [leg.outcome for leg in record.legs] == ["collided", "timed_out"]
    assert record.contacts.toward == record.contacts.at_fault == 1
    assert bus.sent["/hrsafety/verdict"][-1]["status"][0]["level"] == bytes([2])


def test_the_run_ends_when_the_robot_rests_at_its_goal() -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, 0.5 if bus.now < 4.0 else 0.0))

    world = empty(time_limit=20.0)
    near = nav.Robot(start=(0, 0), goal=(2, 0), body=world.robots[0].body)
    world = nav.World(robots=[near], time_limit=20.0)
    record, _ = served(world, answer)
    assert record.legs[0].outcome == "arrived"
    assert 5.0 <= record.legs[0].trajectory.time[-1] < 6.0
    record, _ = served(world, answer, stay=True)
    assert record.legs[0].trajectory.time[-1] == pytest.approx(20.0)


def test_a_clock_that_jumps_on_the_other_side_does_not_drive_the_robot_on() -> None:
    def answer(bus: FakeBus) -> None:
        back = 0.0 if bus.now < 1.0 else -50.0 if bus.now < 2.0 else 0.0
        bus.say("cmd_vel", stamped(max(bus.now + back, 0.02), 0.5))

    record, _ = served(empty(time_limit=3.0), answer)
    assert record.counts["command_out_of_order"] > 0
    assert record.counts["command_timeout"] == 1
    assert speeds(record)[-1] == pytest.approx(0.5)


def test_a_publisher_that_vanishes_and_comes_back() -> None:
    def answer(bus: FakeBus) -> None:
        gone = 1.0 <= bus.now < 2.0
        bus.known = {} if gone else {"cmd_vel": [Publisher(TWIST)]}
        if not gone:
            bus.say("cmd_vel", told(twist(0.5)))

    record, _ = served(empty(time_limit=4.0), answer, bus=FakeBus(publishers={"cmd_vel": [Publisher(TWIST)]}))
    assert record.counts["command_timeout"] == 1
    assert speeds(record)[-1] == pytest.approx(0.5)


def test_a_publisher_that_died_without_a_word_does_not_hold_back_another() -> None:
    both = [Publisher(TWIST), Publisher(STAMPED)]

    def answer(bus: FakeBus) -> None:
        if bus.now < 1.0:
            bus.say("cmd_vel", told(twist(0.5)), TWIST)
        else:
            bus.known = {"cmd_vel": both}  # the first one is still listed, and says nothing
            bus.say("cmd_vel", stamped(bus.now, -0.3), STAMPED)

    bus = FakeBus(publishers={"cmd_vel": both[:1]})
    record, _ = served(empty(time_limit=6.0), answer, bus=bus, lockstep=False)
    assert record.legs[0].trajectory.robot_velocity[-1, 0, 0] == pytest.approx(-0.3)
    late = record.legs[0].trajectory.time[record.legs[0].trajectory.robot_velocity[:, 0, 0] < 0.0]
    assert late[0] < 2.5


def test_two_who_send_in_turn_do_not_take_each_other_the_word() -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", told(twist(0.5)), TWIST)
        bus.say("cmd_vel", stamped(bus.now, -0.3), STAMPED)

    bus = FakeBus(publishers={"cmd_vel": [Publisher(TWIST), Publisher(STAMPED)]})
    record, _ = served(empty(time_limit=4.0), answer, bus=bus, lockstep=False)
    assert record.several
    assert (record.legs[0].trajectory.robot_velocity[:, 0, 0] >= 0.0).all()


def test_people_wait_for_the_first_command() -> None:
    def answer(bus: FakeBus) -> None:
        if bus.wall() > 20.0 and bus.sent["/clock"]:
            bus.say("cmd_vel", stamped(bus.now, 0.4))

    record, bus = served(hall(time_limit=2.0), answer, wait=True, lockstep=False)
    assert bus.now > 20.0
    run = record.legs[0].trajectory
    assert run.time[-1] == pytest.approx(2.0)
    assert record.counts["command_late"] == record.counts["command_out_of_order"] == 0
    first = [message["people"][0]["position"]["x"] for message in bus.sent["/people"]]
    assert first[0] == first[100] == pytest.approx(8.0)


def test_lock_step_waits_for_its_first_command_with_a_clock_that_stands() -> None:
    def bits(begin: float) -> tuple[bytes, str]:
        def answer(bus: FakeBus) -> None:
            if bus.wall() > begin and bus.sent["/clock"]:
                bus.say("cmd_vel", stamped(bus.now, 0.4, rate=0.2))

        record, bus = served(hall(time_limit=2.0), answer, wait=True)
        assert record.counts["lockstep_timeout"] == record.counts["command_out_of_order"] == 0
        assert record.counts["commands"] == 40
        run = record.legs[0].trajectory
        assert run.time[-1] == pytest.approx(2.0)
        return run.robot_position.tobytes() + run.obstacle_position.tobytes(), repr(bus.sent["/scan"][-1])

    assert bits(0.5) == bits(20.0)


def test_ctrl_c_scores_what_was_driven() -> None:
    def answer(bus: FakeBus) -> None:
        if bus.now > 1.0:
            raise KeyboardInterrupt
        ahead(bus)

    bus = FakeBus()
    bus.answer = answer
    bridge = Bridge(hall(), bus, Settings(lockstep=True))
    with pytest.raises(KeyboardInterrupt):
        bridge.run()
    (leg,) = bridge.record.legs
    assert leg.trajectory.time[-1] == pytest.approx(1.05)
    assert leg.metrics.path_length > 0.0
    assert bridge.record.counts["commands"] == 21
