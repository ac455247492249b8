"""Logs of one robot among people in every format, written by the writers of rosbags."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
PERSON = """string name
geometry_msgs/Point position
geometry_msgs/Point velocity
float64 reliability
string[] tagnames
string[] tags
"""
FORMATS = ("rosbag1", "sqlite3", "mcap", "tum", "euroc", "table")
ORIGIN = 1_700_000_000


class Scene:
    """A robot that turns among people who walk: exact positions at 10 Hz."""

    def __init__(self, duration: float = 12.0, step: float = 0.1, people: int = 3) -> None:
        self.time = step * np.arange(round(duration / step) + 1)
        self.heading = 0.3 * np.sin(0.5 * self.time)
        speed = 0.8 * np.stack([np.cos(self.heading), np.sin(self.heading)], axis=1)
        way = np.cumsum(0.5 * (speed[1:] + speed[:-1]) * step, axis=0)
        self.position = np.concatenate([[[0.0, 0.0]], way]) + np.array([1.0, 0.5])
        ids = np.arange(people)
        self.people = np.stack(
            [8.0 - 0.9 * self.time[:, None] + 1.5 * ids, np.broadcast_to(1.8 * ids - 0.6, (len(self.time), people))],
            axis=2,
        )


@functools.cache
def types(*, ros1: bool) -> Any:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_JAZZY)
    texts = {
        "people_msgs/msg/People": "std_msgs/Header header\npeople_msgs/Person[] people\n",
        "people_msgs/msg/Person": PERSON,
        "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
    }
    for name, text in texts.items():
        if name not in store.fielddefs:
            store.register(get_types_from_msg(text, name))
    return store


class Messages:
    """Messages of ROS with their numbers filled in."""

    def __init__(self, *, ros1: bool) -> None:
        self.store, self.ros1 = types(ros1=ros1), ros1

    def make(self, kind: str, **fields: Any) -> Any:
        return self.store.types[kind](**fields)

    def header(self, nanoseconds: int, frame: str) -> Any:
        seconds, rest = divmod(nanoseconds, 10**9)
        stamp = self.make("builtin_interfaces/msg/Time", sec=seconds, nanosec=rest)
        number = {"seq": 0} if self.ros1 else {}
        return self.make("std_msgs/msg/Header", stamp=stamp, frame_id=frame, **number)

    def point(self, x: float, y: float) -> Any:
        return self.make("geometry_msgs/msg/Point", x=float(x), y=float(y), z=0.0)

    def vector(self, x: float, y: float, z: float = 0.0) -> Any:
        return self.make("geometry_msgs/msg/Vector3", x=float(x), y=float(y), z=float(z))

    def quaternion(self, yaw: float) -> Any:
        half = 0.5 * float(yaw)
        return self.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=float(np.sin(half)), w=float(np.cos(half)))

    def transform(self, nanoseconds: int, parent: str, child: str, pose: tuple[float, float, float]) -> Any:
        moved = self.make(
            "geometry_msgs/msg/Transform", translation=self.vector(*pose[:2]), rotation=self.quaternion(pose[2])
        )
        fields = {"header": self.header(nanoseconds, parent), "child_frame_id": child, "transform": moved}
        return self.make(
            "tf2_msgs/msg/TFMessage", transforms=[self.make("geometry_msgs/msg/TransformStamped", **fields)]
        )

    def odometry(self, nanoseconds: int, pose: tuple[float, float, float], twist: tuple[float, float]) -> Any:
        place = self.make(
            "geometry_msgs/msg/Pose", position=self.point(*pose[:2]), orientation=self.quaternion(pose[2])
        )
        speed = self.make(
            "geometry_msgs/msg/Twist", linear=self.vector(twist[0], 0.0), angular=self.vector(0, 0, twist[1])
        )
        covered = {"covariance": np.zeros(36)}
        return self.make(
            "nav_msgs/msg/Odometry",
            header=self.header(nanoseconds, "odom"),
            child_frame_id="base_link",
            pose=self.make("geometry_msgs/msg/PoseWithCovariance", pose=place, **covered),
            twist=self.make("geometry_msgs/msg/TwistWithCovariance", twist=speed, **covered),
        )

    def people(self, nanoseconds: int, frame: str, places: dict[str, tuple[float, float]]) -> Any:
        found = [
            self.make(
                "people_msgs/msg/Person",
                name=name,
                position=self.point(*place),
                velocity=self.point(0.0, 0.0),
                reliability=1.0,
                tagnames=[],
                tags=[],
            )
            for name, place in places.items()
        ]
        return self.make("people_msgs/msg/People", header=self.header(nanoseconds, frame), people=found)


Row = tuple[str, str, int, Any]


def write_bag(path: Path, kind: str, rows: Iterable[Row]) -> Path:
    """Write rows of topic, type, record time in ns and message as a bag of a kind."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin, Writer

    ros1 = kind == "rosbag1"
    store = types(ros1=ros1)
    if ros1:
        writer: Any = Writer1(path)
    else:
        writer = Writer(path, version=9, storage_plugin=StoragePlugin[kind.upper()])
    topics: dict[str, Any] = {}
    with writer:
        for topic, name, record, message in rows:
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, name, typestore=store)
            raw = store.serialize_ros1(message, name) if ros1 else store.serialize_cdr(message, name)
            writer.write(topics[topic], record, raw)
    return path


def rows_of(scene: Scene, *, ros1: bool, latency: float = 0.1) -> list[Row]:
    """Return a robot with map, odometry and people in the map, as a driver would record them."""
    make = Messages(ros1=ros1)
    correction = (1.0, 0.5, 0.0)
    rows: list[Row] = []
    for row, time in enumerate(scene.time.tolist()):
        stamp = ORIGIN * 10**9 + round(time * 1e9)
        if row % 5 == 0:
            moved = make.transform(stamp, "map", "odom", correction)
            rows.append(("/tf", "tf2_msgs/msg/TFMessage", stamp + 1000, moved))
        x, y = scene.position[row] - correction[:2]
        pose = (float(x), float(y), float(scene.heading[row]))
        rows.append(("/tf", "tf2_msgs/msg/TFMessage", stamp + 1000, make.transform(stamp, "odom", "base_link", pose)))
        places = {str(person): tuple(place) for person, place in enumerate(scene.people[row])}
        people = make.people(stamp, "map", places)  # type: ignore[arg-type]  # pairs
        rows.append(("/people", "people_msgs/msg/People", stamp + round(latency * 1e9), people))
    return sorted(rows, key=lambda each: each[2])


def write_log(folder: Path, scene: Scene, kind: str) -> Path:
    """Write a robot in a format."""
    if kind in ("rosbag1", "sqlite3", "mcap"):
        return write_bag(folder / f"{kind}.bag", kind, rows_of(scene, ros1=kind == "rosbag1"))
    path, lines = folder / f"{kind}.txt", []
    for time, (x, y), yaw in zip(scene.time, scene.position, scene.heading, strict=True):
        z, w = np.sin(0.5 * yaw), np.cos(0.5 * yaw)
        place = f"{x:.9f},{y:.9f}"
        lines.append(
            {
                "tum": f"{ORIGIN + time:.9f} {place.replace(',', ' ')} 0 0 0 {z:.12f} {w:.12f}",
                "euroc": f"{ORIGIN * 10**9 + round(time * 1e9)},{place},0,{w:.12f},0,0,{z:.12f}",
                "table": f"{time:.3f},{place},{yaw:.9f}",
            }[kind]
        )
    header = {
        "tum": "# time x y z qx qy qz qw",
        "euroc": "#timestamp [ns],x,y,z,qw,qx,qy,qz",
        "table": "t_s,x_m,y_m,yaw_rad",
    }
    path.write_text("\n".join([header[kind], *lines]) + "\n")
    return path


def write_people(folder: Path, scene: Scene, *, origin: float) -> Path:
    """Write the people as a table, in the clock of a log."""
    path = folder / f"people_{origin:.0f}.csv"
    rows = [
        f"{origin + time:.3f},{person},{place[0]:.9f},{place[1]:.9f}"
        for row, time in enumerate(scene.time)
        for person, place in enumerate(scene.people[row])
    ]
    path.write_text("\n".join(["t_s,ped_id,x_m,y_m", *rows]) + "\n")
    return path
