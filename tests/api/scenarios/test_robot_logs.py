"""Logs of robots: every format, frames, clocks, people, and what is refused."""

from __future__ import annotations

import json
import os
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest

from api.robot_logs import FORMATS, ORIGIN, Messages, Scene, rows_of, write_bag, write_log, write_people
from hrsafety import io
from hrsafety import navigation as nav
from hrsafety.errors import FileError, InvalidParameterError

SHARED = Path(__file__).resolve().parents[3].parent / "shared"
FORMATS_FOLDER = Path(os.environ.get("HRSAFETY_SHARED", SHARED)) / "data" / "formats"
NEEDED = pytest.mark.skipif(not FORMATS_FOLDER.is_dir(), reason="needs the files of formats (HRSAFETY_SHARED)")
PEOPLE, TRANSFORMS = "people_msgs/msg/People", "tf2_msgs/msg/TFMessage"


def expectations() -> list[Any]:
    place = FORMATS_FOLDER / "expected.json"
    entries = json.loads(place.read_text())["logs"] if place.is_file() else [{"file": "none"}]
    return [pytest.param(each, id=each["file"]) for each in entries]


@NEEDED
@pytest.mark.parametrize("entry", expectations())
def test_a_sample_is_read_as_expected(entry: dict[str, Any]) -> None:
    path = FORMATS_FOLDER / entry["file"]
    if "error" in entry:
        with pytest.raises(FileError) as caught:
            io.load_log(path)
        assert caught.value.code == entry["error"]
        assert all(name in str(caught.value) for name in entry["names"])
        return
    log = io.load_log(path, scans="scan_valid_beams" in entry)
    assert sorted(each.code for each in log.warnings) == sorted(entry["warnings"])
    assert log.duration == pytest.approx(entry["duration"], abs=1e-9)
    assert len(log) == entry.get("rows", len(log))
    for time, (x, y, yaw) in entry["robot_map_poses"].items():
        row = int(np.argmin(np.abs(log.time - float(time))))
        assert log.time[row] == pytest.approx(float(time), abs=1e-9)
        assert (*log.position[row], log.heading[row]) == pytest.approx((x, y, yaw), abs=1e-6)
    jumps = [tuple(each) for each in entry["pose_jumps"]]
    assert [pytest.approx(each, abs=1e-3) for each in jumps] == [tuple(each) for each in log.pose_jumps]
    for person, rows in entry.get("person", {}).items():
        assert log.people is not None
        assert list(map(str, log.people.people().tolist())) == [person]
        assert len(log.people) == entry["person_rows"]
        assert not np.isin(np.round(log.people.time_s, 6), entry["person_missing"]).any()
        for time, (x, y, vx, vy) in rows.items():
            row = int(np.argmin(np.abs(log.people.time_s - float(time))))
            assert log.people.position[row] == pytest.approx((x, y), abs=1e-6)
            assert log.people.velocity is not None
            assert log.people.velocity[row] == pytest.approx((vx, vy), abs=1e-6)
        assert log.twist[0] == pytest.approx(entry["robot_body_twist"], abs=1e-9)
        assert {topic: log.delay[topic].median for topic in entry["delay"]} == pytest.approx(entry["delay"], abs=1e-6)
        assert [np.flatnonzero(each.valid).tolist() for each in log.scans] == [entry["scan_valid_beams"]]
        assert log.time_from["/cmd_vel"] == "record time"
        assert {kind for topic, kind in log.time_from.items() if topic != "/cmd_vel"} == {"header.stamp"}


def test_one_log_in_six_formats_has_the_same_poses_and_metrics(tmp_path: Path) -> None:
    scene = Scene()
    found = {}
    for kind in FORMATS:
        people = {"table": 0.0, "tum": float(ORIGIN), "euroc": float(ORIGIN)}
        beside = {"people": write_people(tmp_path, scene, origin=people[kind])} if kind in people else {}
        log = io.load_log(write_log(tmp_path, scene, kind), **beside)
        assert log.position == pytest.approx(scene.position, abs=1e-6), kind
        assert log.heading == pytest.approx(scene.heading, abs=1e-6), kind
        assert log.warnings == ()
        found[kind] = nav.metrics.judge(log, robot_radius=0.3, goal=tuple(scene.position[-1]))
    first = found["rosbag1"].metrics.to_dict()
    for kind, judged in found.items():
        for name, value in judged.metrics.to_dict().items():
            assert value == pytest.approx(first[name], abs=1e-5, nan_ok=True), (kind, name)
        assert [each.kept for each in judged.passings] == [each.kept for each in found["rosbag1"].passings]
        assert judged.counts["contact"] == found["rosbag1"].counts["contact"]


@pytest.mark.parametrize("kind", ["sqlite3", "mcap"])
def test_a_file_of_a_bag_is_read_without_its_folder_whatever_its_name(tmp_path: Path, kind: str) -> None:
    folder = write_log(tmp_path, Scene(), kind)
    (file,) = (each for each in folder.iterdir() if each.suffix != ".yaml")
    moved = tmp_path / "recording"
    moved.write_bytes(file.read_bytes())
    (folder / "metadata.yaml").unlink()
    for path in (moved, folder):
        assert len(io.load_log(path)) == 121


def moved_people(*, ros1: bool, **changes: Any) -> list[Any]:
    return rows_of(Scene(3.0), ros1=ros1, **changes)


def test_a_correction_of_the_map_is_held_and_never_interpolated(tmp_path: Path) -> None:
    make, rows = Messages(ros1=False), []
    for step in range(41):
        stamp = ORIGIN * 10**9 + step * 10**8
        moved = make.transform(stamp, "odom", "base_link", (0.05 * step, 0.0, 0.0))
        rows.append(("/tf", TRANSFORMS, stamp, moved))
        if step in (0, 20):
            rows.append(("/tf", TRANSFORMS, stamp, make.transform(stamp, "map", "odom", (0.0, 0.02 * step, 0.0))))
    log = io.load_log(write_bag(tmp_path / "held", "mcap", rows))
    assert log.position[19, 1] == 0.0
    assert log.position[20, 1] == pytest.approx(0.4)
    assert [(each.begin, each.end) for each in log.pose_jumps] == [pytest.approx((1.9, 2.0))]


def test_without_a_chain_both_trees_are_told(tmp_path: Path) -> None:
    make = Messages(ros1=False)
    rows = []
    for step in range(20):
        stamp = ORIGIN * 10**9 + step * 10**8
        rows.append(("/tf", TRANSFORMS, stamp, make.transform(stamp, "odom", "base_link", (0.1 * step, 0.0, 0.0))))
    rows.append(
        ("/tf_static", TRANSFORMS, ORIGIN * 10**9, make.transform(ORIGIN * 10**9, "map", "dock", (1.0, 0.0, 0.0)))
    )
    rows.sort(key=lambda each: each[2])
    path = write_bag(tmp_path / "trees", "sqlite3", rows)
    with pytest.raises(FileError, match=r"map > dock; odom > base_link") as caught:
        io.load_log(path)
    assert caught.value.code == "no_chain"
    assert 'frame="odom"' in str(caught.value)
    assert len(io.load_log(path, frame="odom")) == 20


def test_nothing_usable_lists_topics_and_types(tmp_path: Path) -> None:
    make = Messages(ros1=True)
    text = make.make("std_msgs/msg/String", data="hello")
    path = write_bag(tmp_path / "talk.bag", "rosbag1", [("/chatter", "std_msgs/msg/String", 10**9, text)])
    with pytest.raises(FileError, match=r"/chatter \(std_msgs/msg/String, 1\)") as caught:
        io.load_log(path)
    assert caught.value.code == "nothing_usable"


def test_a_clock_that_is_set_back_leaves_the_longest_part(tmp_path: Path) -> None:
    make, rows = Messages(ros1=False), []
    for step in range(60):
        stamp = (100 if step < 20 else 50) * 10**9 + step * 10**8
        record = 10**12 + step * 10**8
        moved = make.transform(stamp, "odom", "base_link", (0.1 * step, 0.0, 0.0))
        rows.append(("/tf", TRANSFORMS, record, moved))
    log = io.load_log(write_bag(tmp_path / "restart", "mcap", rows), frame="odom")
    assert "restarted" in [each.code for each in log.warnings]
    assert (len(log), log.position[0, 0]) == (40, pytest.approx(2.0))


def test_clocks_that_differ_are_told_and_corrected_on_demand(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "late", "mcap", moved_people(ros1=False, latency=-0.3))
    log = io.load_log(path)
    assert [each.code for each in log.warnings] == ["clock_offset"]
    judged = nav.metrics.judge(log, robot_radius=0.3)
    assert any(each.reason == "clock" for each in judged.not_judged)
    assert all("kept" not in each.kept.values() for each in judged.passings)
    right = io.load_log(path, offset={"/people": -0.4})
    assert right.warnings == ()
    assert right.delay["/people"].median == pytest.approx(0.1)
    with pytest.raises(InvalidParameterError, match="/people"):
        io.load_log(path, offset={"/persons": 1.0})


def test_simulated_stamps_are_those_of_the_clock(tmp_path: Path) -> None:
    make, rows = Messages(ros1=False), []
    for step in range(50):
        record = ORIGIN * 10**9 + step * 5 * 10**7
        time = make.make("builtin_interfaces/msg/Time", sec=step // 10, nanosec=step % 10 * 10**8)
        rows.append(("/clock", "rosgraph_msgs/msg/Clock", record, make.make("rosgraph_msgs/msg/Clock", clock=time)))
        stamp = step * 10**8
        rows.append(("/tf", TRANSFORMS, record, make.transform(stamp, "odom", "base_link", (0.1 * step, 0.0, 0.0))))
    log = io.load_log(write_bag(tmp_path / "simulated", "sqlite3", rows), frame="odom")
    assert log.time_factor == pytest.approx(2.0)
    assert log.delay["/tf"].most == pytest.approx(0.0, abs=1e-6)
    assert log.duration == pytest.approx(4.8)
    assert [each.code for each in log.warnings] == ["no_people"]


def test_people_stand_where_a_description_says(tmp_path: Path) -> None:
    make, rows = Messages(ros1=False), moved_people(ros1=False)
    rows = [row for row in rows if row[0] != "/people"]
    for step in range(31):
        stamp = ORIGIN * 10**9 + step * 10**8
        poses = [
            make.make(
                "geometry_msgs/msg/PoseStamped",
                header=make.header(stamp, frame),
                pose=make.make(
                    "geometry_msgs/msg/Pose", position=make.point(5.0, 1.0), orientation=make.quaternion(0.0)
                ),
            )
            for frame in ("map", "map")
        ]
        path = make.make("nav_msgs/msg/Path", header=make.header(stamp, "map"), poses=poses[:1])
        rows.append(("/seen", "nav_msgs/msg/Path", stamp + 10**7, path))
    rows.sort(key=lambda each: each[2])
    bag = write_bag(tmp_path / "described", "mcap", rows)
    log = io.load_log(bag, people="/seen:poses[] id=header.frame_id position=pose.position")
    assert log.people is not None
    assert log.people.people().tolist() == ["map"]
    assert log.people.position[0] == pytest.approx((5.0, 1.0))
    with pytest.raises(FileError, match="field agents"):
        io.load_log(bag, people="/seen:agents[] id=id position=pose")
    with pytest.raises(InvalidParameterError, match="say id=, position="):
        io.load_log(bag, people="/seen:poses[] id=id place=pose")
    with pytest.raises(InvalidParameterError, match=r"/seen \(nav_msgs/msg/Path\)"):
        io.load_log(bag, people="/seen")
    with pytest.raises(InvalidParameterError, match="topics: "):
        io.load_log(bag, people="/nobody")


def test_old_bags_hold_no_definitions(tmp_path: Path) -> None:
    import sqlite3

    folder = write_log(tmp_path, Scene(3.0), "sqlite3")
    (file,) = folder.glob("*.db3")
    with sqlite3.connect(file) as database:
        database.executescript(
            "DROP TABLE message_definitions; DROP TABLE schema; DROP TABLE metadata;"
            "ALTER TABLE topics DROP COLUMN type_description_hash;"
        )
    database.close()
    (folder / "metadata.yaml").unlink()
    log = io.load_log(folder)
    assert log.people is not None
    assert log.people.people().tolist() == [0, 1, 2]


def test_poses_without_ids_are_refused(tmp_path: Path) -> None:
    make, rows = Messages(ros1=False), moved_people(ros1=False)
    array = make.make("geometry_msgs/msg/PoseArray", header=make.header(ORIGIN * 10**9, "map"), poses=[])
    rows = [("/poses", "geometry_msgs/msg/PoseArray", ORIGIN * 10**9, array), *rows]
    with pytest.raises(InvalidParameterError, match="PoseArray"):
        io.load_log(write_bag(tmp_path / "poses", "mcap", rows), people="/poses")


TABLES = {
    "degrees": "time;x;y;yaw_deg\n0;0;0;0\n0,1;0,1;0;90\n0,2;0,2;0;180\n",
    "milliseconds": "t_ms x_mm y_mm theta_rad\n0 0 0 0\n100 100 0 1.570796327\n200 200 0 3.141592654\n",
    "tabs": "zeit [s]\tpos_x (m)\tpos_y (m)\theading/deg\n0\t0\t0\t0\n0.1\t0.1\t0\t90\n0.2\t0.2\t0\t180\n",
}


@pytest.mark.parametrize("text", TABLES.values(), ids=TABLES)
def test_units_of_tables_stand_in_their_names(tmp_path: Path, text: str) -> None:
    path = tmp_path / "odometry.csv"
    path.write_text(text)
    log = io.load_log(path)
    assert log.time == pytest.approx([0.0, 0.1, 0.2])
    assert log.position[:, 0] == pytest.approx([0.0, 0.1, 0.2])
    assert log.heading == pytest.approx([0.0, np.pi / 2, np.pi], abs=1e-6)


BAD = {
    "no_rows": "t_s,x_m,y_m,yaw_rad\n",
    "columns_needed": "t_s,x_m,z_m\n0,0,0\n",
    "ambiguous_columns": "t_s,time_s,x_m,y_m\n0,0,0,0\n",
    "unknown_format": "1 2 3\n4 5 6\n",
    "unreadable_number": "t_s,x_m,y_m\n0,0,0\n1,zero,0\n",
    "two_positions_at_one_instant": "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n0,1,0,0\n",
    "quaternion": "0 0 0 0 0 0 0 1\n1 0 0 0 0.5 0.5 0.5 5\n",
}


@pytest.mark.parametrize(("code", "text"), BAD.items(), ids=BAD)
def test_what_a_table_breaks_is_told(tmp_path: Path, code: str, text: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text)
    with pytest.raises(FileError) as caught:
        io.load_log(path)
    assert caught.value.code == code
    assert "log.csv" in str(caught.value)


def test_poses_that_are_not_finite_are_left_out_and_told(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{k / 10},{'nan' if k in (7, 8, 9) else k / 10},0,0" for k in range(30)]
    path.write_text("\n".join(["t_s,x_m,y_m,yaw_rad", *rows]))
    log = io.load_log(path)
    assert [each.code for each in log.warnings] == ["missing_positions", "no_people"]
    judged = nav.metrics.judge(log, robot_radius=0.3)
    assert ("no_pose", 0.6, 1.0) in [
        (each.reason, round(each.begin, 6), round(each.end, 6)) for each in judged.not_judged
    ]
    assert [each.reason for each in judged.not_judged].count("people_silent") == 1


def test_people_of_another_clock_do_not_overlap(tmp_path: Path) -> None:
    scene = Scene(3.0)
    log, people = write_log(tmp_path, scene, "tum"), write_people(tmp_path, scene, origin=0.0)
    with pytest.raises(FileError, match="overlap in time") as caught:
        io.load_log(log, people=people)
    assert caught.value.code == "no_overlap"
    moved = io.load_log(log, people=people, offset={"people": float(ORIGIN)})
    assert moved.people is not None
    assert moved.people.time_s[0] == pytest.approx(0.0, abs=1e-6)


def test_people_of_a_file_stand_beside_a_bag(tmp_path: Path) -> None:
    scene = Scene(3.0)
    bag, people = write_log(tmp_path, scene, "mcap"), write_people(tmp_path, scene, origin=float(ORIGIN))
    inside, beside = io.load_log(bag), io.load_log(bag, people=people)
    assert inside.people is not None
    assert beside.people is not None
    assert beside.people.position == pytest.approx(inside.people.position, abs=1e-6)
    assert beside.people.time_s == pytest.approx(inside.people.time_s, abs=1e-6)
    assert beside.people_topic == ""
    again = io.load_log(bag, people=io.load_people(people))
    assert again.people is not None
    assert again.people.time_s == pytest.approx(inside.people.time_s, abs=1e-6)


def test_two_odometries_are_asked_for(tmp_path: Path) -> None:
    make, rows = Messages(ros1=True), []
    for step in range(20):
        stamp = ORIGIN * 10**9 + step * 10**8
        for topic, far in (("/wheels", 0.1), ("/fused", 0.2)):
            pose = (far * step, 0.0, 0.0)
            rows.append((topic, "nav_msgs/msg/Odometry", stamp, make.odometry(stamp, pose, (10 * far, 0.0))))
    path = write_bag(tmp_path / "two.bag", "rosbag1", rows)
    with pytest.raises(FileError) as caught:
        io.load_log(path, frame="odom")
    assert caught.value.code == "several_pose_topics"
    log = io.load_log(path, frame="odom", robot="/fused")
    assert log.position[-1, 0] == pytest.approx(3.8)
    assert log.twist[0] == pytest.approx((2.0, 0.0, 0.0))


def test_quaternions_may_stand_in_named_columns(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    half = np.sqrt(0.5)
    path.write_text(
        "timestamp tx ty tz qx qy qz qw\n" + "".join(f"{k / 10} {k} 0 0 0 0 {half} {half}\n" for k in range(5))
    )
    assert io.load_log(path).heading == pytest.approx(np.full(5, np.pi / 2))


def test_a_bag_of_six_thousand_poses_is_read_in_a_quarter_of_a_second(tmp_path: Path) -> None:
    make, rows = Messages(ros1=False), []
    for step in range(6000):
        stamp = ORIGIN * 10**9 + step * 2 * 10**7
        pose = (0.01 * step, 0.0, 0.0)
        rows.append(("/odom", "nav_msgs/msg/Odometry", stamp, make.odometry(stamp, pose, (0.5, 0.0))))
    path = write_bag(tmp_path / "long", "mcap", rows)
    io.load_log(path, frame="odom")
    begin = process_time()
    assert len(io.load_log(path, frame="odom")) == 6000
    assert process_time() - begin < 5.0  # nothing is decoded that is not needed


def test_a_part_of_a_log_is_judged_alone(tmp_path: Path) -> None:
    log = io.load_log(write_log(tmp_path, Scene(), "mcap"))
    part = log.part(3.0, 8.0)
    assert (part.time[0], part.time[-1], len(part)) == (3.0, 8.0, 51)
    assert part.people is not None
    assert part.people.time_s[[0, -1]] == pytest.approx([3.0, 8.0])
    whole, alone = (nav.metrics.judge(each, robot_radius=0.3) for each in (log, part))
    rows = (whole.time >= 3.0 - 1e-9) & (whole.time <= 8.0 + 1e-9)
    assert alone.clearance == pytest.approx(whole.clearance[rows], abs=1e-9)
    with pytest.raises(InvalidParameterError, match="leave two poses or more"):
        log.part(30.0, 40.0)
