"""The bus of ROS 2, by rclpy."""

from __future__ import annotations

import importlib
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from hrsafety.errors import MissingExtraError
from hrsafety.ros.bus import Message, Publisher, Quality

__all__ = ["RclBus", "connected", "stamps_by_default"]

_REMEDY = (
    "rclpy is not installed for this Python: source the setup file of ROS 2 first (source /opt/ros/jazzy/setup.bash), "
    "with a Python of the same version, e.g. a venv made with --system-site-packages"
)


def _rclpy() -> Any:
    try:
        return importlib.import_module("rclpy")
    except ImportError as error:
        missing = isinstance(error, ModuleNotFoundError) and error.name == "rclpy"
        raise MissingExtraError(_REMEDY if missing else f"rclpy cannot be imported ({error}): {_REMEDY}") from None


def _message_class(type: str) -> Any:
    """Return the class of messages of a type, such as ``"nav_msgs/msg/Odometry"``; ``None`` if it is not installed."""
    package, _, name = type.rpartition("/")
    try:
        return getattr(importlib.import_module(package.replace("/", ".")), name, None)
    except ImportError:
        return None


@contextmanager
def connected(name: str) -> Iterator[RclBus]:
    """Connect a node to ROS 2.

    Parameters
    ----------
    name : str
        Name of the node.

    Yields
    ------
    RclBus
        The bus.

    Raises
    ------
    MissingExtraError
        If rclpy is not installed, or a package of messages is not.
    """
    rclpy = _rclpy()
    # Ctrl-C stays an interrupt of Python, so that the run is scored.
    rclpy.init(args=None, signal_handler_options=importlib.import_module("rclpy.signals").SignalHandlerOptions.NO)
    node = rclpy.create_node(name)
    try:
        yield RclBus(rclpy, node)
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


class RclBus:
    """A node of ROS 2 as a `Bus`.

    Parameters
    ----------
    rclpy : module
        Of ROS 2.
    node : rclpy.node.Node
        The node.
    """

    def __init__(self, rclpy: Any, node: Any) -> None:
        self._rclpy, self._node = rclpy, node
        self._qos = importlib.import_module("rclpy.qos")
        self._executor = importlib.import_module("rclpy.executors").SingleThreadedExecutor()
        self._executor.add_node(node)
        self._heard = False

    def has(self, type: str) -> bool:
        """Return whether messages of a type are installed."""
        return _message_class(type) is not None

    def _class(self, type: str) -> Any:
        found = _message_class(type)
        if found is None:
            package = type.partition("/")[0]
            raise MissingExtraError(
                f"{type} is not installed: install the package {package.replace('_', '-')} of ROS 2"
            )
        return found

    def _profile(self, quality: Quality) -> Any:
        qos = self._qos
        reliable, kept = qos.ReliabilityPolicy, qos.DurabilityPolicy
        return qos.QoSProfile(
            depth=quality.depth,
            reliability=reliable.RELIABLE if quality.reliable else reliable.BEST_EFFORT,
            durability=kept.TRANSIENT_LOCAL if quality.transient_local else kept.VOLATILE,
        )

    def publisher(self, topic: str, type: str, quality: Quality) -> Callable[[Message], None]:
        """Announce a topic."""
        kind = self._class(type)
        publisher = self._node.create_publisher(kind, topic, self._profile(quality))
        return lambda message: publisher.publish(_filled(kind, message))

    def subscribe(self, topic: str, type: str, quality: Quality, heard: Callable[[Any], None]) -> Callable[[], None]:
        """Listen to a topic."""

        def take(message: Any) -> None:
            self._heard = True
            heard(message)

        made = self._node.create_subscription(self._class(type), topic, take, self._profile(quality))
        return lambda: self._node.destroy_subscription(made) and None

    def publishers(self, topic: str) -> Sequence[Publisher]:
        """Return who publishes on a topic, but this node."""
        best = self._qos.ReliabilityPolicy.BEST_EFFORT
        own = self._node.get_name()
        name = self._node.resolve_topic_name(topic)
        return [
            Publisher(each.topic_type, each.qos_profile.reliability != best)
            for each in self._node.get_publishers_info_by_topic(name)
            if each.node_name != own
        ]

    def wall(self) -> float:
        """Return a monotonic time in s."""
        return time.monotonic()

    def spin(self, timeout: float) -> None:
        """Hand over what has come; wait for the first message for at most so many seconds."""
        until = time.monotonic() + timeout
        self._heard = False
        while True:
            self._executor.spin_once(timeout_sec=max(0.0, until - time.monotonic()))
            if not self._heard and time.monotonic() < until:
                continue
            if not self._heard:
                return
            self._heard, until = False, 0.0  # and what else has come

    def log(self, level: str, text: str) -> None:
        """Write to the log of the node."""
        getattr(self._node.get_logger(), level)(text)


def stamps_by_default() -> bool:
    """Return whether velocity commands of this ROS 2 have stamps unless told otherwise: from Kilted on."""
    return os.environ.get("ROS_DISTRO", "kilted") not in ("foxy", "galactic", "humble", "iron", "jazzy")


def _filled(kind: Any, fields: Message) -> Any:
    """Return a message of a class with fields by name."""
    message = kind()
    types = kind.get_fields_and_field_types()
    for name, value in fields.items():
        if isinstance(value, Mapping):
            value = _filled(type(getattr(message, name)), value)
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            inner = _message_class(types[name].removeprefix("sequence<").removesuffix(">").replace("/", "/msg/"))
            value = [_filled(inner, each) for each in value]
        setattr(message, name, value)
    return message
