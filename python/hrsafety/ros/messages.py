"""Messages that the bridge sends, as fields by name, and what it reads of those that come."""

from __future__ import annotations

import array
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.ros.bus import Message

__all__ = [
    "Pose",
    "Seen",
    "clock",
    "diagnostics",
    "grid",
    "markers",
    "odometry",
    "people",
    "pose_in",
    "scan",
    "seconds",
    "stamp",
    "transform_in",
    "transforms",
    "twist_in",
]

_NANO = 1_000_000_000
_UPRIGHT = math.cos(math.radians(5.0))
_MOST_CELLS = 4_000_000
"""Cells of a map that is published; finer ones are made coarser."""


class Pose(NamedTuple):
    """Place in m and heading in rad."""

    x: float
    y: float
    yaw: float

    def __matmul__(self, other: Pose) -> Pose:
        """Return the other pose, given in this one, in the frame that this one is given in."""
        sin, cos = math.sin(self.yaw), math.cos(self.yaw)
        x, y = self.x + cos * other.x - sin * other.y, self.y + sin * other.x + cos * other.y
        return Pose(x, y, self.yaw + other.yaw)

    def inverse(self) -> Pose:
        """Return the pose of the frame that this one is given in, in this one."""
        sin, cos = math.sin(self.yaw), math.cos(self.yaw)
        return Pose(-cos * self.x - sin * self.y, sin * self.x - cos * self.y, -self.yaw)


class Seen(NamedTuple):
    """A person at an instant: name, place in m, velocity in m/s, radius in m."""

    name: str
    x: float
    y: float
    vx: float
    vy: float
    radius: float


def stamp(time: float) -> dict[str, int]:
    """Return a time in s as a stamp, to the nearest nanosecond."""
    whole = round(time * _NANO)
    return {"sec": whole // _NANO, "nanosec": whole % _NANO}


def seconds(given: Any) -> float:
    """Return a stamp in s."""
    return float(given.sec) + 1e-9 * float(given.nanosec)


def _header(frame: str, time: float) -> dict[str, Any]:
    return {"frame_id": frame, "stamp": stamp(time)}


def _point(x: float, y: float, z: float = 0.0) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def _turned(yaw: float) -> dict[str, float]:
    return {"x": 0.0, "y": 0.0, "z": math.sin(0.5 * yaw), "w": math.cos(0.5 * yaw)}


def clock(time: float) -> Message:
    """Return rosgraph_msgs/Clock."""
    return {"clock": stamp(time)}


def transforms(time: float, *edges: tuple[str, str, Pose, float]) -> Message:
    """Return tf2_msgs/TFMessage of edges (parent, child, pose, height in m)."""
    return {
        "transforms": [
            {
                "header": _header(parent, time),
                "child_frame_id": child,
                "transform": {"translation": _point(pose.x, pose.y, height), "rotation": _turned(pose.yaw)},
            }
            for parent, child, pose, height in edges
        ]
    }


def odometry(time: float, pose: Pose, twist: tuple[float, float, float]) -> Message:
    """Return nav_msgs/Odometry: pose in odom, twist (vx, vy, turn rate) in base_footprint, known exactly."""
    vx, vy, rate = twist
    return {
        "header": _header("odom", time),
        "child_frame_id": "base_footprint",
        "pose": {"pose": {"position": _point(pose.x, pose.y), "orientation": _turned(pose.yaw)}},
        "twist": {"twist": {"linear": _point(vx, vy), "angular": _point(0.0, 0.0, rate)}},
    }


def scan(time: float, lidar: Lidar, ranges: Array, period: float) -> Message:
    """Return sensor_msgs/LaserScan: infinite where nothing was hit, 0 where something touches the lidar."""
    bearings = lidar.bearings
    found = np.where(ranges >= lidar.range_max, np.inf, ranges)
    step = float(bearings[1] - bearings[0]) if len(bearings) > 1 else 0.0
    return {
        "header": _header("base_scan", time),
        "angle_min": float(bearings[0]),
        "angle_max": float(bearings[-1]),
        "angle_increment": step,
        "time_increment": 0.0,
        "scan_time": period,
        "range_min": max(lidar.range_min, 0.001),
        "range_max": lidar.range_max,
        "ranges": array.array("f", found.astype(np.float32).tobytes()),
    }


def people(time: float, seen: Iterable[Seen]) -> Message:
    """Return people_msgs/People; names are numbers that stay with a person."""
    return {
        "header": _header("map", time),
        "people": [
            {
                "name": each.name,
                "position": {"x": each.x, "y": each.y, "z": 0.0},
                "velocity": {"x": each.vx, "y": each.vy, "z": 0.0},
                "reliability": 1.0,
                "tagnames": ["radius"],
                "tags": [f"{each.radius:g}"],
            }
            for each in seen
        ],
    }


_ADD, _DELETE, _CYLINDER = 0, 2, 3


def markers(time: float, seen: Sequence[Seen], gone: Iterable[str] = ()) -> Message:
    """Return visualization_msgs/MarkerArray: cylinders by number, and the numbers to take away."""
    head = _header("map", time)
    there = [
        {
            "header": head,
            "ns": "people",
            "id": int(each.name),
            "type": _CYLINDER,
            "action": _ADD,
            "pose": {
                "position": _point(each.x, each.y, 0.85),
                "orientation": _turned(math.atan2(each.vy, each.vx) if each.vx or each.vy else 0.0),
            },
            "scale": _point(2.0 * each.radius, 2.0 * each.radius, 1.7),
            "color": {"r": 0.0, "g": 0.45, "b": 0.7, "a": 0.9},
        }
        for each in seen
    ]
    away = [{"header": head, "ns": "people", "id": int(name), "action": _DELETE} for name in gone]
    return {"markers": [*there, *away]}


_OCCUPIED, _FREE, _UNKNOWN = 100, 0, -1


def grid(time: float, known: StaticMap, box: tuple[float, float, float, float], resolution: float) -> Message:
    """Return nav_msgs/OccupancyGrid: a map that is one grid as it is, else cells of a box that walls touch as occupied.

    Parameters
    ----------
    time : float
        In s.
    known : StaticMap
        The map.
    box : tuple of float
        Left, low, right and high end in m.
    resolution : float
        Side of a cell in m, doubled until there are not too many.
    """
    if len(known.grids) == 1 and not (len(known.walls) or len(known.polygons) or len(known.discs)):  # type: ignore[arg-type]  # has a length
        (only,) = known.grids
        cells = np.where(only.occupied, _OCCUPIED, np.where(only.unseen, _UNKNOWN, _FREE))
        return _occupancy(time, cells, only.resolution, Pose(*only.origin, only.yaw))
    left, low, right, high = box
    while (right - left) * (high - low) > _MOST_CELLS * resolution * resolution:
        resolution *= 2.0
    columns, rows = (max(1, math.ceil((end - begin) / resolution)) for begin, end in ((left, right), (low, high)))
    x = left + resolution * (np.arange(columns) + 0.5)
    y = low + resolution * (np.arange(rows) + 0.5)
    centers = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    cells = np.where(known.clearance(centers) <= resolution * math.sqrt(0.5), _OCCUPIED, _FREE)
    cells[np.asarray(known.unseen(centers)) & (cells == _FREE)] = _UNKNOWN
    return _occupancy(time, cells.reshape(rows, columns), resolution, Pose(left, low, 0.0))


def _occupancy(time: float, cells: npt.NDArray[np.int_], resolution: float, origin: Pose) -> Message:
    rows, columns = cells.shape
    return {
        "header": _header("map", time),
        "info": {
            "map_load_time": stamp(time),
            "resolution": resolution,
            "width": columns,
            "height": rows,
            "origin": {"position": _point(origin.x, origin.y), "orientation": _turned(origin.yaw)},
        },
        "data": array.array("b", cells.astype(np.int8).tobytes()),
    }


def diagnostics(time: float, level: int, message: str, values: Mapping[str, object]) -> Message:
    """Return diagnostic_msgs/DiagnosticArray with one status; levels are 0 (good), 1 (warning), 2 (error)."""
    return {
        "header": _header("", time),
        "status": [
            {
                "level": bytes([level]),
                "name": "hrsafety: verdict",
                "message": message,
                "hardware_id": "simulated robot",
                "values": [{"key": key, "value": str(value)} for key, value in values.items()],
            }
        ],
    }


def twist_in(message: Any) -> tuple[float, float, float]:
    """Return speeds along x and y in m/s and turn rate in rad/s of geometry_msgs/Twist."""
    return float(message.linear.x), float(message.linear.y), float(message.angular.z)


def pose_in(message: Any) -> Pose | None:
    """Return the pose of geometry_msgs/Pose; ``None`` where it is not finite or its quaternion is none."""
    return _pose(message.position, message.orientation)


def transform_in(message: Any) -> tuple[Pose | None, bool]:
    """Return the pose of geometry_msgs/Transform as `pose_in`, and whether it keeps up where it is."""
    turn = message.rotation
    pose = _pose(message.translation, turn)
    return pose, pose is not None and 1.0 - 2.0 * (turn.x * turn.x + turn.y * turn.y) > _UPRIGHT


def _pose(place: Any, turn: Any) -> Pose | None:
    parts = [float(each) for each in (place.x, place.y, turn.x, turn.y, turn.z, turn.w)]
    size = math.hypot(*parts[2:])
    if not all(map(math.isfinite, parts)) or not 0.9 < size < 1.1:
        return None
    x, y, *_ = parts
    _, _, i, j, k, w = parts
    return Pose(x, y, math.atan2(2.0 * (w * k + i * j), 1.0 - 2.0 * (j * j + k * k)))
