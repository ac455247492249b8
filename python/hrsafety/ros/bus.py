"""The bus between a bridge and the rest of a robot: topics with types and qualities of service, and two clocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

__all__ = ["EVENTS", "LATCHED", "SENSOR", "Bus", "Message", "Publisher", "Quality"]

Message = Mapping[str, Any]
"""Fields of a message by name, as ``ros2 interface show`` lists them; what is left out has its default."""


class Quality(NamedTuple):
    """Quality of service of a topic.

    Attributes
    ----------
    depth : int
        How many messages are kept.
    reliable : bool
        Whether messages are sent again until they arrive; else best effort.
    transient_local : bool
        Whether who comes later gets the last messages, too.
    """

    depth: int
    reliable: bool = True
    transient_local: bool = False


LATCHED = Quality(1, transient_local=True)
EVENTS = Quality(10)
SENSOR = Quality(5, reliable=False)


class Publisher(NamedTuple):
    """Publisher on a topic.

    Attributes
    ----------
    type : str
        Of the messages, such as ``"geometry_msgs/msg/Twist"``.
    reliable : bool
        Whether they are sent reliably.
    """

    type: str
    reliable: bool = True


class Bus(Protocol):
    """Bus that a bridge needs of ROS 2; `hrsafety.ros.rcl` has it from rclpy, tests have one in memory."""

    def has(self, type: str) -> bool:
        """Return whether messages of a type can be sent and received here."""

    def publisher(self, topic: str, type: str, quality: Quality) -> Callable[[Message], None]:
        """Announce a topic, and return what publishes on it."""

    def subscribe(self, topic: str, type: str, quality: Quality, heard: Callable[[Any], None]) -> Callable[[], None]:
        """Listen to a topic, and return what ends that; ``heard`` gets messages with fields as attributes."""

    def publishers(self, topic: str) -> Sequence[Publisher]:
        """Return who publishes on a topic by now."""

    def wall(self) -> float:
        """Return the time of a monotonic clock, in s."""

    def spin(self, timeout: float) -> None:
        """Hand over messages that have come, and wait for one for at most so many seconds if none has."""

    def log(self, level: str, text: str) -> None:
        """Tell the user something; levels are ``"info"``, ``"warn"`` and ``"error"``."""
