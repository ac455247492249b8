"""What a bridge publishes: topics, qualities, fields, rates; the same bits in lock-step."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from api.ros.fake_bus import STAMPED, TWIST, FakeBus, stamped, told, twist
from api.ros.worlds import ROBOT, WALLS, ahead, empty, hall, served
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError
from hrsafety.ros import Bridge, Publisher, Quality, Settings
from hrsafety.ros.floor import Crowd
from hrsafety.ros.messages import Pose
from hrsafety.ros.scanner import Scanner

PERSON = """string name
geometry_msgs/Point position
geometry_msgs/Point velocity
float64 reliability
string[] tagnames
string[] tags
"""
STORE = get_typestore(Stores.ROS2_JAZZY)
STORE.register(get_types_from_msg(PERSON, "people_msgs/msg/Person"))
STORE.register(get_types_from_msg("std_msgs/Header header\npeople_msgs/Person[] people\n", "people_msgs/msg/People"))

TOPICS = {
    "/clock": ("rosgraph_msgs/msg/Clock", Quality(1, reliable=False)),
    "/tf": ("tf2_msgs/msg/TFMessage", Quality(100)),
    "/tf_static": ("tf2_msgs/msg/TFMessage", Quality(1, transient_local=True)),
    "/odom": ("nav_msgs/msg/Odometry", Quality(10)),
    "/scan": ("sensor_msgs/msg/LaserScan", Quality(5, reliable=False)),
    "/map": ("nav_msgs/msg/OccupancyGrid", Quality(1, transient_local=True)),
    "/people": ("people_msgs/msg/People", Quality(10)),
    "/hrsafety/verdict": ("diagnostic_msgs/msg/DiagnosticArray", Quality(10)),
}


def as_ros(type: str, fields: Mapping[str, Any]) -> Any:
    """Return a message as the definitions of ROS 2 have it; every field that was given must be one of them."""
    _, declared = STORE.fielddefs[type]
    assert set(fields) <= {name for name, _ in declared}, type
    values = {}
    for name, (node, detail) in declared:
        given = fields.get(name)
        if node == 1:  # a number or a text
            kind = detail[0]
            if given is None:
                given = "" if kind == "string" else 0
            values[name] = given[0] if kind in ("octet", "byte") and isinstance(given, bytes) else given
        elif node == 2:
            values[name] = as_ros(detail, given or {})
        else:  # arrays and sequences
            (inner, inner_detail), size = detail
            if inner == 2:
                values[name] = [as_ros(inner_detail, each) for each in given or []]
            elif inner_detail[0] == "string":
                values[name] = given or []
            else:
                kind = {"float64": np.float64, "float32": np.float32, "int8": np.int8}.get(inner_detail[0], np.uint8)
                values[name] = np.array(given if given is not None else [0] * (size or 0), dtype=kind)
    return STORE.types[type](**values)


@pytest.fixture(scope="module")
def served_hall() -> tuple[Any, FakeBus]:
    return served(hall(), ahead)


@pytest.fixture(scope="module")
def paced_hall() -> tuple[Any, FakeBus]:
    return served(hall(time_limit=5.0), ahead, lockstep=False)


def test_topics_have_their_types_and_qualities(served_hall: tuple[Any, FakeBus]) -> None:
    _, bus = served_hall
    assert bus.topics == TOPICS
    assert set(bus.heard) == {"/initialpose", "/goal_pose", "cmd_vel"}
    assert set(bus.heard["cmd_vel"]) == {STAMPED}


def test_messages_are_those_of_ros(served_hall: tuple[Any, FakeBus]) -> None:
    _, bus = served_hall
    for topic, (type, _) in bus.topics.items():
        for message in bus.sent[topic][:3] + bus.sent[topic][-3:]:
            made = as_ros(type, message)
            back = STORE.deserialize_cdr(STORE.serialize_cdr(made, type), type)
            assert STORE.serialize_cdr(back, type) == STORE.serialize_cdr(made, type), topic


def test_without_people_msgs_there_are_markers_and_without_tf2_msgs_no_transforms() -> None:
    record, bus = served(hall(time_limit=20.0), ahead, bus=FakeBus(types=()))
    assert {"/people_markers", "/odom"} <= set(bus.topics)
    assert not {"/people", "/tf", "/tf_static"} & set(bus.topics)
    assert any("tf2_msgs" in text for _, text in bus.logs)
    (type, _) = bus.topics["/people_markers"]
    for message in bus.sent["/people_markers"]:
        STORE.serialize_cdr(as_ros(type, message), type)
    gone = [each["id"] for message in bus.sent["/people_markers"] for each in message["markers"] if each["action"] == 2]
    assert len(gone) == len(set(gone)) > 0
    assert record.legs[0].trajectory.time[-1] == pytest.approx(20.0)


def test_rates_in_real_time(paced_hall: tuple[Any, FakeBus]) -> None:
    _, bus = paced_hall
    for topic, period, header in (
        ("/odom", 0.02, "header"),
        ("/scan", 0.05, "header"),
        ("/people", 0.1, "header"),
        ("/hrsafety/verdict", 1.0, "header"),
    ):
        stamps = [each[header]["stamp"] for each in bus.sent[topic]]
        times = np.array([each["sec"] + 1e-9 * each["nanosec"] for each in stamps])
        np.testing.assert_allclose(np.diff(times), period, atol=1e-6, err_msg=topic)
    clock = np.array([each["clock"]["sec"] + 1e-9 * each["clock"]["nanosec"] for each in bus.sent["/clock"]])
    np.testing.assert_allclose(np.diff(clock), 0.01, atol=1e-6)
    assert len(bus.sent["/map"]) == len(bus.sent["/tf_static"]) == 1
    assert len(bus.sent["/tf"]) == len(bus.sent["/odom"])


def test_the_clock_comes_after_the_state_of_its_step(served_hall: tuple[Any, FakeBus]) -> None:
    _, bus = served_hall
    steps = " ".join(bus.order).split("/clock")[1:-1]
    assert all("/people" in step and "/scan" in step and "/tf" in step and "/odom" in step for step in steps)


def places(bus: FakeBus, topic: str = "/odom") -> np.ndarray[Any, np.dtype[np.float64]]:
    found = [each["pose"]["pose"]["position"] for each in bus.sent[topic]]
    return np.array([(each["x"], each["y"]) for each in found])


def test_a_command_is_executed_a_delay_after_its_step() -> None:
    def answer(bus: FakeBus) -> None:
        if bus.sent["/clock"]:
            bus.say("cmd_vel", stamped(bus.now, 0.4 if bus.now >= 1.0 - 1e-9 else 0.0))

    for delay in (0.0, 0.03, 0.2):
        record, _ = served(empty(time_limit=3.0), answer, delay=delay)
        run = record.legs[0].trajectory
        x, time_of = run.robot_position[:, 0, 0], run.time
        assert (x[time_of <= 1.0 + delay + 1e-9] == 0.0).all()
        # It reaches 0.4 m/s after 0.2 s: from then on it is 0.4 (t - 1 - delay) behind by what it took to get there.
        then = time_of > 1.0 + delay + 0.3
        late = time_of[then] - x[then] / 0.4
        assert np.ptp(late) < 1e-9
        assert late[0] == pytest.approx(1.0 + delay + 0.1, abs=0.03)


def test_two_wheels_run_on_arcs() -> None:
    record, bus = served(empty(time_limit=4.0), lambda bus: bus.say("cmd_vel", stamped(bus.now, 0.5, rate=1.0)))
    twists = bus.sent["/odom"][-1]["twist"]["twist"]
    assert twists["linear"] == {"x": 0.5, "y": 0.0, "z": 0.0}
    assert twists["angular"]["z"] == pytest.approx(1.0)
    run = record.legs[0].trajectory
    late = run.time > 1.0
    turn = run.robot_heading[late, 0]
    center = run.robot_position[late, 0] + 0.5 * np.column_stack([-np.sin(turn), np.cos(turn)])
    assert np.ptp(center, axis=0).max() < 1e-6


def test_scans_are_those_of_the_lidar_with_nothing_as_infinite(served_hall: tuple[Any, FakeBus]) -> None:
    record, bus = served_hall
    run = record.legs[0].trajectory
    walls = nav.maps.StaticMap.from_polylines(WALLS)
    lidar = nav.Lidar(map=walls, beams=720, range_max=12.0)
    for row in (0, 37, 150):
        message = bus.sent["/scan"][row]
        there = np.isfinite(run.obstacle_position[row, :, 0])
        discs = np.column_stack([run.obstacle_position[row, there], run.obstacle_radius[there]])
        expected = lidar.scan(run.robot_position[row, 0], run.robot_heading[row, 0], people=discs)
        expected[expected >= 12.0] = np.inf
        np.testing.assert_allclose(message["ranges"], expected, rtol=1e-6)
        assert np.isinf(message["ranges"]).any()
        assert message["angle_increment"] == pytest.approx(2.0 * math.pi / 720)
        last = message["angle_min"] + 719 * message["angle_increment"]
        assert last == pytest.approx(message["angle_max"])


def test_walls_are_on_the_map_and_people_are_not(served_hall: tuple[Any, FakeBus]) -> None:
    _, bus = served_hall
    (message,) = bus.sent["/map"]
    info = message["info"]
    cells = np.array(message["data"]).reshape(info["height"], info["width"])
    origin, size = info["origin"]["position"], info["resolution"]

    def at(x: float, y: float) -> int:
        return int(cells[int((y - origin["y"]) / size), int((x - origin["x"]) / size)])

    assert at(3.0, -3.0) == at(3.0, 3.0) == 100
    assert at(8.0, 0.6) == at(0.0, 0.0) == 0
    assert set(np.unique(cells)) == {0, 100}


def test_the_grid_of_a_map_server_is_published_as_it_is() -> None:
    occupied = np.zeros((80, 120), dtype=bool)
    occupied[[0, -1]], occupied[:, [0, -1]] = True, True
    occupied[40, 60:70] = True
    walls = nav.StaticMap.from_grid(occupied, resolution=0.1, origin=(-2.0, -4.0), yaw=0.1, outside="unknown")
    person = nav.Person(start=(6.0, 1.0), route=[(0.0, 1.0)], desired_speed=1.2)
    record, bus = served(hall(walls=walls, people=[person], sources=[]), ahead)
    (message,) = bus.sent["/map"]
    np.testing.assert_array_equal(np.array(message["data"]).reshape(80, 120), 100 * occupied)
    assert message["info"]["resolution"] == 0.1
    assert message["info"]["origin"]["position"] == {"x": -2.0, "y": -4.0, "z": 0.0}
    assert message["info"]["origin"]["orientation"]["z"] == pytest.approx(math.sin(0.05))
    run = record.legs[0].trajectory
    lidar = nav.Lidar(map=walls, beams=720, range_max=12.0)
    discs = np.column_stack([run.obstacle_position[20], run.obstacle_radius])
    expected = lidar.scan(run.robot_position[20, 0], run.robot_heading[20, 0], people=discs)
    found = np.array(bus.sent["/scan"][20]["ranges"])
    np.testing.assert_allclose(found[np.isfinite(found)], expected[expected < 12.0], rtol=1e-6)
    STORE.serialize_cdr(as_ros("nav_msgs/msg/OccupancyGrid", message), "nav_msgs/msg/OccupancyGrid")


def test_people_keep_their_names_also_those_who_come_later(served_hall: tuple[Any, FakeBus]) -> None:
    _, bus = served_hall
    last: dict[str, tuple[float, float]] = {}
    ended: set[str] = set()
    names = set()
    for message in bus.sent["/people"]:
        now = {each["name"]: (each["position"]["x"], each["position"]["y"]) for each in message["people"]}
        assert not ended & set(now)
        for name in set(now) & set(last):
            assert math.dist(now[name], last[name]) < 2.5 * 0.05
        ended |= set(last) - set(now)
        last, names = now, names | set(now)
    assert {"0", "1"} < names
    assert len(names) > 3


def test_people_from_doors_have_the_numbers_of_the_world_itself() -> None:
    source = nav.Source(low=(8.0, -2.5), high=(9.5, 2.5), rate=4.0, route=[(4.0, 0.0)], desired_speed=1.3)
    away = nav.Robot(ROBOT, start=(-1.5, -2.5), goal=(8.0, 0.0))
    world = replace(hall(people=[], sources=[source], time_limit=30.0), robots=[away])
    record, _ = served(world, lambda bus: bus.say("cmd_vel", stamped(bus.now)), lidar=nav.Lidar(beams=8))
    mine, whole = record.legs[0].trajectory, nav.simulate(world)
    assert whole.obstacle_position.shape[1] > 60
    rows = min(len(mine.time), len(whole.time))
    np.testing.assert_allclose(mine.obstacle_position[:rows], whole.obstacle_position[:rows], atol=1e-9)


def test_people_react_to_the_robot() -> None:
    def nearest(awareness: float) -> float:
        person = nav.Person(start=(6.0, 0.05), route=[(-1.0, 0.05)], desired_speed=1.2, awareness=awareness)
        record, _ = served(hall(people=[person], sources=[]), ahead)
        return record.clearance

    assert nearest(0.0) < 0.0 < nearest(1.0)


def test_the_robot_moves_as_it_is_told_whatever_people_see_of_it() -> None:
    (with_people, _), (alone, _) = served(hall(), ahead), served(empty(), ahead)
    mine, other = (each.legs[0].trajectory.robot_position for each in (with_people, alone))
    np.testing.assert_array_equal(mine, other)


def test_a_thousand_commands_twice_give_the_same_bits() -> None:
    def bits() -> tuple[Any, ...]:
        record, bus = served(hall(time_limit=50.0), ahead, stay=True)
        assert record.counts["commands"] == 1000
        run = record.legs[0].trajectory
        arrays = (run.robot_position, run.robot_heading, run.obstacle_position, run.obstacle_velocity)
        return (*(each.tobytes() for each in arrays), repr(bus.sent["/scan"]), repr(bus.sent["/people"]))

    assert bits() == bits()


def test_another_seed_gives_other_people() -> None:
    (first, _), (second, _) = (served(hall(seed=seed), ahead) for seed in (1, 2))
    assert first.legs[0].trajectory.obstacle_position.shape != second.legs[
        0
    ].trajectory.obstacle_position.shape or not np.array_equal(
        first.legs[0].trajectory.obstacle_position, second.legs[0].trajectory.obstacle_position, equal_nan=True
    )


@pytest.mark.parametrize(("kind", "message"), [(TWIST, twist(0.4)), (STAMPED, None)])
def test_messages_are_taken_as_their_publisher_sends_them(kind: str, message: Any) -> None:
    def answer(bus: FakeBus) -> None:
        bus.say("cmd_vel", stamped(bus.now, 0.4) if message is None else told(message))

    bus = FakeBus(publishers={"cmd_vel": [Publisher(kind, reliable=False)]})
    record, _ = served(empty(time_limit=2.0), answer, bus=bus)
    assert set(bus.heard["cmd_vel"]) == {kind}
    assert bus.heard["cmd_vel"][kind][0] == Quality(10, reliable=False)
    assert record.counts["commands"] == 40
    assert record.legs[0].moved > 0.5


def test_somebody_else_may_take_over_with_other_messages() -> None:
    def answer(bus: FakeBus) -> None:
        if bus.now < 1.0:
            bus.say("cmd_vel", told(twist(0.4)), TWIST)
        else:
            bus.known = {"cmd_vel": [Publisher(STAMPED)]}
            bus.say("cmd_vel", stamped(bus.now, -0.4), STAMPED)

    bus = FakeBus(publishers={"cmd_vel": [Publisher(TWIST)]})
    record, _ = served(empty(time_limit=5.0), answer, bus=bus)
    assert set(bus.heard["cmd_vel"]) == {STAMPED}
    assert record.legs[0].trajectory.robot_velocity[-1, 0, 0] == pytest.approx(-0.4)


@pytest.mark.parametrize("model", [nav.crowd.SocialForce1995(), nav.crowd.Moussaid(), nav.crowd.ReciprocalAvoidance()])
def test_models_with_a_smaller_step_get_it(model: nav.crowd.Pedestrian) -> None:
    person = nav.Person(start=(6.0, 0.5), route=[(-1.0, 0.5)], desired_speed=1.2, model=model)
    world = hall(people=[person], sources=[], time_limit=4.0)
    record, bus = served(world, ahead)
    assert record.step <= min(0.05, model.largest_step)
    assert record.counts["commands"] == 80
    run = record.legs[0].trajectory
    shown = places(bus)
    np.testing.assert_allclose(shown, run.robot_position[:: round(0.05 / record.step), 0][: len(shown)], atol=1e-9)


@pytest.mark.parametrize("settings", [{"period": 0.1}, {"period": 0.05}, {"lockstep": False}])
def test_scores_have_the_time_of_the_bridge_whatever_the_step_of_the_world(settings: dict[str, Any]) -> None:
    def answer(bus: FakeBus) -> None:
        if bus.sent["/clock"]:
            bus.say("cmd_vel", stamped(bus.now, 0.5))

    near = nav.Robot(ROBOT, start=(0, 0), goal=(2, 0), control_period=0.03)
    world = nav.World(robots=[near], step=0.03, time_limit=6.0)
    record, _ = served(world, answer, stay=True, **settings)
    (leg,) = record.legs
    assert leg.trajectory.time[-1] == pytest.approx(6.0)
    assert leg.trajectory.motion_step == record.step == 0.05
    assert leg.metrics.arrival_time == leg.trajectory.robot_arrival_time[0] == pytest.approx(3.5, abs=0.1)
    assert leg.metrics.path_length == pytest.approx(1.7, abs=0.05)


def test_holonomic_robots_go_sideways() -> None:
    robot = nav.Robot(start=(0, 0), goal=(8, 0), body=nav.HolonomicRobot(), heading=0.5)
    world = nav.World(robots=[robot], time_limit=2.0)
    record, _ = served(world, lambda bus: bus.say("cmd_vel", stamped(bus.now, 0.0, 0.3)))
    velocity = record.legs[0].trajectory.robot_velocity[-1, 0]
    np.testing.assert_allclose(velocity, [-0.3 * math.sin(0.5), 0.3 * math.cos(0.5)], atol=1e-9)
    assert not record.counts["command_clipped"]


def test_two_hundred_people_and_720_beams_at_20_hz_on_one_core() -> None:
    generator = np.random.default_rng(1)
    people = [
        nav.Person(start=tuple(start), route=[tuple(end), tuple(start)], at_end="repeat", desired_speed=1.2)
        for start, end in generator.uniform(-9.0, 9.0, (200, 2, 2))
    ]
    robot = nav.Robot(start=(-11.0, 0.0), goal=(11.0, 0.0), body=ROBOT)
    world = nav.World(people=people, robots=[robot], time_limit=10.0)
    begin = time.process_time()
    record, bus = served(world, ahead)
    taken = time.process_time() - begin
    assert len(bus.sent["/scan"]) == record.counts["commands"] == 200
    # Made sure with a wide margin on a machine that does other things; measured numbers are in the guide.
    assert taken < 10.0


def test_settings_are_checked() -> None:
    with pytest.raises(InvalidParameterError, match=r"period must be from 0\.005 to 1 s"):
        Settings(period=3.0)
    with pytest.raises(InvalidParameterError, match="commands must"):
        Settings(commands="stampd")
    world = nav.World(people=[nav.Person(start=(0, 0))])
    with pytest.raises(InvalidParameterError, match=r"world\.robots must be one robot, got 0"):
        Bridge(world, FakeBus())
    round_world = hall(period=(20.0, 0.0))
    with pytest.raises(InvalidParameterError, match=r"world\.period"):
        served(round_world, ahead)


@pytest.mark.parametrize("lidar", [{}, {"beams": 1440}, {"field_of_view": 3.0}, {"beams": 361, "field_of_view": 4.7}])
def test_sectors_of_a_lidar_read_what_the_whole_reads(lidar: dict[str, Any]) -> None:
    generator = np.random.default_rng(4)
    whole = nav.Lidar(**{"beams": 720, "range_max": 9.0, "map": nav.StaticMap.from_polylines(WALLS), **lidar})
    scanner = Scanner(whole)
    for turn in (0.0, 1.0, -2.5, 40.0):
        position, radius = generator.uniform(-9.0, 9.0, (200, 2)), generator.uniform(0.05, 0.6, 200)
        crowd = Crowd(np.arange(200), position, np.zeros((200, 2)), radius)
        for place in ((0.0, 0.0), tuple(position[7] + 0.01), (3.0, -2.99)):
            discs = np.column_stack([position, radius])
            expected = whole.scan(place, turn, people=discs)
            np.testing.assert_allclose(scanner.scan(Pose(*place, turn), crowd), expected, rtol=1e-9, atol=1e-9)
