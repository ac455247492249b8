"""Standard messages of ROS 1 and 2 from their bytes: stamps, poses, transforms, velocities.

Only what is needed is decoded, and without the definitions of messages, which old bags do not hold. Positions in the
bytes: https://docs.ros.org and the CDR of OMG (numbers are aligned to their size, counted from the fifth byte).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

__all__ = ["Decoder", "Transform"]

Seven = tuple[float, ...]


class Transform(NamedTuple):
    """Pose of a child frame in its parent.

    Attributes
    ----------
    stamp : int
        Time in ns; 0 if it has none.
    parent, child : str
        Frames, without a slash in front.
    pose : tuple of float
        x, y, z in m and a quaternion x, y, z, w.
    """

    stamp: int
    parent: str
    child: str
    pose: Seven


class Decoder:
    """Reader of the bytes of messages.

    Parameters
    ----------
    ros1 : bool
        Whether they are serialized as ROS 1 does.
    """

    def __init__(self, *, ros1: bool) -> None:
        self.ros1 = ros1
        self.first = 0 if ros1 else 4

    def stamp(self, raw: bytes) -> int:
        """Return the time of the header at the start of a message in ns."""
        seconds, rest = struct.unpack_from(f"{self._order(raw)}iI", raw, 4)
        return int(seconds) * 10**9 + int(rest)

    def clock(self, raw: bytes) -> int:
        """Return the time of a message of the simulated clock in ns."""
        seconds, rest = struct.unpack_from(f"{self._order(raw)}iI", raw, self.first)
        return int(seconds) * 10**9 + int(rest)

    def odometry(self, raw: bytes) -> tuple[Transform, tuple[float, float, float]]:
        """Return the pose of nav_msgs/Odometry and its velocity (vx, vy, turn rate) in the child frame."""
        order = self._order(raw)
        stamp, parent, place = self._header(raw, self.first, order)
        child, place = self._string(raw, place, order)
        place = self._aligned(place)
        pose = struct.unpack_from(f"{order}7d", raw, place)
        twist = struct.unpack_from(f"{order}6d", raw, place + 43 * 8)
        return Transform(stamp, parent, child, pose), (twist[0], twist[1], twist[5])

    def pose(self, raw: bytes) -> Transform:
        """Return the pose of geometry_msgs/PoseStamped or PoseWithCovarianceStamped; its child has no name."""
        order = self._order(raw)
        stamp, parent, place = self._header(raw, self.first, order)
        return Transform(stamp, parent, "", struct.unpack_from(f"{order}7d", raw, self._aligned(place)))

    def transforms(self, raw: bytes) -> Iterator[Transform]:
        """Yield the transforms of tf2_msgs/TFMessage."""
        order, place = self._order(raw), self.first
        (count,) = struct.unpack_from(f"{order}I", raw, place)
        place += 4
        for _ in range(count):
            stamp, parent, place = self._header(raw, place, order)
            child, place = self._string(raw, place, order)
            place = self._aligned(place)
            yield Transform(stamp, parent, child, struct.unpack_from(f"{order}7d", raw, place))
            place += 56

    def twist(self, raw: bytes, *, stamped: bool) -> tuple[int, tuple[float, float, float]]:
        """Return the time in ns, 0 without one, and (vx, vy, turn rate) of geometry_msgs/Twist or TwistStamped."""
        order, stamp, place = self._order(raw), 0, self.first
        if stamped:
            stamp, _, place = self._header(raw, place, order)
            place = self._aligned(place)
        six = struct.unpack_from(f"{order}6d", raw, place)
        return stamp, (six[0], six[1], six[5])

    def scan(self, raw: bytes) -> tuple[int, str, tuple[float, ...], tuple[float, ...]]:
        """Return time in ns, frame, (angle_min, angle_max, step, -, -, range_min, range_max) and ranges of a scan."""
        order = self._order(raw)
        stamp, frame, place = self._header(raw, self.first, order)
        place = place if self.ros1 else (place + 3) & ~3
        settings = struct.unpack_from(f"{order}7f", raw, place)
        (count,) = struct.unpack_from(f"{order}I", raw, place + 28)
        if count > len(raw) // 4:
            raise struct.error(f"{count} ranges in {len(raw)} bytes")
        return stamp, frame, settings, struct.unpack_from(f"{order}{count}f", raw, place + 32)

    def _order(self, raw: bytes) -> str:
        return "<" if self.ros1 or len(raw) < 2 or raw[1] & 1 else ">"

    def _aligned(self, place: int) -> int:
        return place if self.ros1 else ((place + 3) & ~7) + 4

    def _header(self, raw: bytes, place: int, order: str) -> tuple[int, str, int]:
        if self.ros1:
            place += 4  # its number
        else:
            place = (place + 3) & ~3
        seconds, rest = struct.unpack_from(f"{order}iI", raw, place)
        frame, place = self._string(raw, place + 8, order)
        return int(seconds) * 10**9 + int(rest), frame, place

    def _string(self, raw: bytes, place: int, order: str) -> tuple[str, int]:
        if not self.ros1:
            place = (place + 3) & ~3
        (size,) = struct.unpack_from(f"{order}I", raw, place)
        end = place + 4 + size
        if end > len(raw):
            raise struct.error(f"a text of {size} bytes in {len(raw)}")
        return raw[place + 4 : end].rstrip(b"\0").decode("utf-8").lstrip("/"), end
