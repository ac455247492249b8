"""People and robots in the messages of bags: every known type, ROS 1 and 2, written by rosbags."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.robot_logs import ORIGIN, Messages, write_bag
from hrsafety import io
from hrsafety import navigation as nav
from hrsafety.errors import FileError

TRANSFORMS = "tf2_msgs/msg/TFMessage"
TRACKED = "spencer_tracking_msgs/msg/TrackedPerson"
DEFINITIONS = {
    f"{TRACKED}s": "std_msgs/Header header\nspencer_tracking_msgs/TrackedPerson[] tracks\n",
    TRACKED: "uint64 track_id\nbool is_occluded\nbool is_matched\nuint64 detection_id\n{duration} age\n"
    "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n",
    "hunav_msgs/msg/Agents": "std_msgs/Header header\nhunav_msgs/Agent[] agents\n",
    "hunav_msgs/msg/Agent": "int32 id\nuint8 type\nstring name\ngeometry_msgs/Pose position\n"
    "geometry_msgs/Twist velocity\n",
    "vision_msgs/msg/Detection3DArray": "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n",
    "vision_msgs/msg/Detection3D": "std_msgs/Header header\nvision_msgs/BoundingBox3D bbox\nstring id\n",
    "vision_msgs/msg/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n",
}


class Made(Messages):
    """Messages of trackers, of a person who walks from (5, 1) to the left."""

    def __init__(self, *, ros1: bool) -> None:
        super().__init__(ros1=ros1)
        from rosbags.typesys import get_types_from_msg

        for name, text in DEFINITIONS.items():
            if name not in self.store.fielddefs:
                duration = "duration" if ros1 else "builtin_interfaces/Duration"
                self.store.register(get_types_from_msg(text.format(duration=duration), name))

    def pose(self, step: int, y: float = 1.0) -> Any:
        return self.make(
            "geometry_msgs/msg/Pose", position=self.point(5.0 - 0.1 * step, y), orientation=self.quaternion(0.0)
        )

    def twist(self) -> Any:
        return self.make("geometry_msgs/msg/Twist", linear=self.vector(-1.0, 0.0), angular=self.vector(0.0, 0.0))

    def tracked(self, stamp: int, step: int) -> tuple[str, Any]:
        kind, covered = TRACKED, {"covariance": np.zeros(36)}
        person = self.make(
            kind,
            track_id=5,
            is_occluded=10 < step < 20,
            is_matched=True,
            detection_id=0,
            age=self.make("builtin_interfaces/msg/Duration", sec=1, nanosec=0),
            pose=self.make("geometry_msgs/msg/PoseWithCovariance", pose=self.pose(step), **covered),
            twist=self.make("geometry_msgs/msg/TwistWithCovariance", twist=self.twist(), **covered),
        )
        return f"{kind}s", self.make(f"{kind}s", header=self.header(stamp, "map"), tracks=[person])

    def agents(self, stamp: int, step: int) -> tuple[str, Any]:
        people = [
            self.make(
                "hunav_msgs/msg/Agent", id=name, type=kind, name="", position=self.pose(step), velocity=self.twist()
            )
            for name, kind in ((5, 1), (6, 2))
        ]
        kind = "hunav_msgs/msg/Agents"
        return kind, self.make(kind, header=self.header(stamp, "map"), agents=people)

    def detections(self, stamp: int, step: int, name: str = "5") -> tuple[str, Any]:
        box = self.make("vision_msgs/msg/BoundingBox3D", center=self.pose(step), size=self.vector(1.0, 1.0))
        header, kind = self.header(stamp, "map"), "vision_msgs/msg/Detection3DArray"
        found = self.make("vision_msgs/msg/Detection3D", header=header, bbox=box, id=name)
        return kind, self.make(kind, header=header, detections=[found])


def bag_of(folder: Path, made: Made, message: Callable[[int, int], tuple[str, Any]], *, base: bool = True) -> Path:
    rows = []
    for step in range(30):
        stamp = ORIGIN * 10**9 + step * 10**8
        kind, found = message(stamp, step)
        rows.append(("/seen", kind, stamp + 10**7, found))
        if base:
            moved = made.transform(stamp, "/map", "/base_footprint", (0.1 * step, 0.0, 0.0))
            rows.append(("/tf", TRANSFORMS, stamp, moved))
    path = folder / ("seen.bag" if made.ros1 else "seen")
    return write_bag(path, "rosbag1" if made.ros1 else "mcap", sorted(rows, key=lambda each: each[2]))


@pytest.mark.parametrize("ros1", [True, False], ids=["ROS 1", "ROS 2"])
@pytest.mark.parametrize(("name", "rows"), [("tracked", 21), ("agents", 30), ("detections", 30)])
def test_people_of_every_tracker(tmp_path: Path, ros1: bool, name: str, rows: int) -> None:
    made = Made(ros1=ros1)
    log = io.load_log(bag_of(tmp_path, made, getattr(made, name)))
    assert log.people is not None
    assert list(map(str, log.people.people().tolist())) == ["5"]
    assert len(log.people) == rows
    assert log.people.position[0] == pytest.approx((5.0, 1.0))
    assert (log.people.velocity is None) == (name == "detections")
    # Who is occluded was not seen.
    assert [each.code for each in log.warnings] == (["missing_positions"] if name == "tracked" else [])
    assert log.position[-1] == pytest.approx((2.9, 0.0))


@pytest.mark.parametrize("ros1", [True, False], ids=["ROS 1", "ROS 2"])
def test_markers_are_people_of_a_named_topic_until_they_are_deleted(tmp_path: Path, ros1: bool) -> None:
    made = Made(ros1=ros1)

    def markers(stamp: int, step: int) -> tuple[str, Any]:
        known = made.store.types["visualization_msgs/msg/Marker"].__dataclass_fields__
        empty = np.zeros(0, dtype=np.uint8)
        fields: dict[str, Any] = {
            "header": made.header(stamp, "map"),
            "ns": "people",
            "type": 3,
            "scale": made.vector(1.0, 1.0),
            "color": made.make("std_msgs/msg/ColorRGBA", r=0.0, g=0.0, b=0.0, a=1.0),
            "lifetime": made.make("builtin_interfaces/msg/Duration", sec=0, nanosec=0),
            "frame_locked": False,
            "points": [],
            "colors": [],
            "uv_coordinates": [],
            "text": "",
            "texture_resource": "",
            "mesh_resource": "",
            "mesh_use_embedded_materials": False,
        }
        if "texture" in known:
            header = made.header(stamp, "map")
            fields["texture"] = made.make("sensor_msgs/msg/CompressedImage", header=header, format="", data=empty)
            fields["mesh_file"] = made.make("visualization_msgs/msg/MeshFile", filename="", data=empty)
        fields = {name: value for name, value in fields.items() if name in known}
        both = [
            made.make("visualization_msgs/msg/Marker", id=name, action=action, pose=made.pose(step), **fields)
            for name, action in ((1, 0), (2, 2 if step > 15 else 0))
        ]
        kind = "visualization_msgs/msg/MarkerArray"
        return kind, made.make(kind, markers=both)

    path = bag_of(tmp_path, made, markers)
    assert [each.code for each in io.load_log(path).warnings] == ["no_people"]
    log = io.load_log(path, people="/seen")
    assert log.people is not None
    assert [(name, len(time)) for name, time, _ in log.people.tracks()] == [("people/1", 30), ("people/2", 16)]


def test_people_without_ids_are_refused(tmp_path: Path) -> None:
    made = Made(ros1=False)
    path = bag_of(tmp_path, made, lambda stamp, step: made.detections(stamp, step, name=""))
    with pytest.raises(FileError, match="an id for each person") as caught:
        io.load_log(path)
    assert caught.value.code == "no_ids"


def test_poses_alone_are_a_robot(tmp_path: Path) -> None:
    made = Made(ros1=True)

    def estimated(stamp: int, step: int) -> tuple[str, Any]:
        kind, covered = "geometry_msgs/msg/PoseWithCovariance", {"covariance": np.zeros(36)}
        pose = made.make(kind, pose=made.pose(step), **covered)
        return f"{kind}Stamped", made.make(f"{kind}Stamped", header=made.header(stamp, "map"), pose=pose)

    alone = io.load_log(bag_of(tmp_path, made, estimated, base=False))
    assert alone.position[-1] == pytest.approx((2.1, 1.0))
    (tmp_path / "seen.bag").unlink()
    named = io.load_log(bag_of(tmp_path, made, estimated), robot="/seen")
    assert named.position == pytest.approx(alone.position)


def test_the_map_of_a_bag_is_that_of_its_judgement(tmp_path: Path) -> None:
    made = Made(ros1=False)
    cells = np.zeros((20, 60), dtype=np.int8)
    cells[:, 30] = 100
    cells[:, 50:] = -1

    def grid(stamp: int, step: int) -> tuple[str, Any]:  # noqa: ARG001  # the same at every step
        kind = "nav_msgs/msg/OccupancyGrid"
        origin = made.make("geometry_msgs/msg/Pose", position=made.point(0.0, -1.0), orientation=made.quaternion(0.0))
        time = made.make("builtin_interfaces/msg/Time", sec=0, nanosec=0)
        about = made.make(
            "nav_msgs/msg/MapMetaData", map_load_time=time, resolution=0.1, width=60, height=20, origin=origin
        )
        return kind, made.make(kind, header=made.header(stamp, "map"), info=about, data=cells.ravel())

    rows = []
    for step in range(30):
        stamp = ORIGIN * 10**9 + step * 10**8
        rows.append(("/tf", TRANSFORMS, stamp, made.transform(stamp, "map", "base_link", (0.1 * step, 0.0, 0.0))))
    rows.append(("/map", *grid(ORIGIN * 10**9, 0)[:1], ORIGIN * 10**9 + 5, grid(ORIGIN * 10**9, 0)[1]))
    log = io.load_log(write_bag(tmp_path / "mapped", "mcap", sorted(rows, key=lambda each: each[2])))
    assert log.map is not None
    assert log.map.clearance((2.0, 0.05)) == pytest.approx(1.0)
    assert log.map.unseen([(5.5, 0.0), (1.0, 0.0)]).tolist() == [True, False]
    found = nav.metrics.judge(log, map=log.map, robot_radius=0.3)
    assert [each.kind for each in found.contacts] == ["wall"]


@pytest.mark.parametrize("kind", ["rosbag1", "sqlite3"])
def test_two_people_with_one_id_are_refused(tmp_path: Path, kind: str) -> None:
    make = Made(ros1=kind == "rosbag1")
    rows = []
    for step in range(40):
        stamp = ORIGIN * 10**9 + step * 10**8
        there = make.transform(stamp, "map", "base_link", (0.05 * step, 0.0, 0.0))
        rows.append(("/tf", TRANSFORMS, stamp, there))
        message = make.people(stamp, "map", {"person": (5.0 - 0.1 * step, 1.0), "other": (0.0, 9.0)})
        for each in message.people:
            each.name = "person"
        rows.append(("/people", "people_msgs/msg/People", stamp, message))
    path = write_bag(tmp_path / ("log.bag" if kind == "rosbag1" else "log"), kind, rows)
    with pytest.raises(FileError, match=r"'person' at \(5, 1\) and \(0, 9\) in one message") as caught:
        io.load_log(path)
    assert caught.value.code == "two_positions_at_one_instant"
