"""A bus in memory: what is published stays in lists, and what a test says comes at its instant."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from types import SimpleNamespace
from typing import Any

from hrsafety.ros import Publisher, Quality
from hrsafety.ros.bus import Message

TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def told(fields: Any) -> Any:
    """Return a message whose fields are attributes."""
    if isinstance(fields, Mapping):
        return SimpleNamespace(**{name: told(each) for name, each in fields.items()})
    return [told(each) for each in fields] if isinstance(fields, list) else fields


def stamped(seconds: float, ahead: float = 0.0, left: float = 0.0, rate: float = 0.0) -> Any:
    whole = round(seconds * 1e9)
    head = {"stamp": {"sec": whole // 10**9, "nanosec": whole % 10**9}, "frame_id": ""}
    return told({"header": head, "twist": twist(ahead, left, rate)})


def twist(ahead: float = 0.0, left: float = 0.0, rate: float = 0.0) -> dict[str, Any]:
    return {"linear": {"x": ahead, "y": left, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": rate}}


def pose(x: float, y: float, *, frame: str = "map", w: float = 1.0, covariance: bool = False) -> Any:
    place = {"position": {"x": x, "y": y, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": w}}
    return told({"header": {"frame_id": frame}, "pose": {"pose": place} if covariance else place})


class FakeBus:
    """A bus whose wall clock runs only while somebody waits, unless it is the real one."""

    def __init__(
        self,
        *,
        types: Sequence[str] = ("tf2_msgs/msg/TFMessage", "people_msgs/msg/People"),
        publishers: Mapping[str, list[Publisher]] | None = None,
        real: bool = False,
        keep: bool = True,
    ) -> None:
        self.types = set(types)
        self.topics: dict[str, tuple[str, Quality]] = {}
        self.sent: dict[str, list[Message]] = defaultdict(list)
        self.order: list[str] = []
        self.heard: dict[str, dict[str, tuple[Quality, Callable[[Any], None]]]] = defaultdict(dict)
        self.logs: list[tuple[str, str]] = []
        self.known = {"cmd_vel": [Publisher(STAMPED)]} if publishers is None else dict(publishers)
        self.answer: Callable[[FakeBus], None] | None = None
        self._wall, self._real, self._keep = 0.0, real, keep

    def has(self, type: str) -> bool:
        return type in self.types

    def publisher(self, topic: str, type: str, quality: Quality) -> Callable[[Message], None]:
        self.topics[topic] = (type, quality)

        def publish(message: Message) -> None:
            if not self._keep:
                self.sent[topic].clear()
            else:
                self.order.append(topic)
            self.sent[topic].append(message)

        return publish

    def subscribe(self, topic: str, type: str, quality: Quality, heard: Callable[[Any], None]) -> Callable[[], None]:
        self.heard[topic][type] = (quality, heard)
        return lambda: self.heard[topic].pop(type, None) and None

    def publishers(self, topic: str) -> Sequence[Publisher]:
        return self.known.get(topic, [])

    def say(self, topic: str, message: Any, type: str | None = None) -> None:
        """Hand a message to whoever listens, to all types or one."""
        for kind, (_, heard) in list(self.heard[topic].items()):
            if type in (None, kind):
                heard(message)

    @property
    def now(self) -> float:
        """The clock that was published last."""
        if not self.sent["/clock"]:
            return 0.0
        stamp = self.sent["/clock"][-1]["clock"]
        return float(stamp["sec"] + 1e-9 * stamp["nanosec"])

    def wall(self) -> float:
        return time.perf_counter() if self._real else self._wall

    def spin(self, timeout: float) -> None:
        before = self.wall()
        if self.answer is not None:
            self.answer(self)
        left = timeout - (self.wall() - before)
        if self._real:
            if left > 0.0 and self.answer is None:
                time.sleep(left)
        else:
            self._wall += max(timeout, 0.0)

    def log(self, level: str, text: str) -> None:
        self.logs.append((level, text))
