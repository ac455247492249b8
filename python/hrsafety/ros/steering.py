"""Velocity commands as their publisher sends them: with a stamp or without one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hrsafety.ros.bus import Bus, Publisher, Quality
from hrsafety.ros.messages import seconds, twist_in

__all__ = ["STAMPED", "TWIST", "Steering"]

TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
_GIVEN = {"twist": TWIST, "stamped": STAMPED}
_LOOK = 0.5
"""Time between two looks at who publishes, in s of the wall."""


class Steering:
    """A subscription to velocity commands that follows whoever publishes them.

    Parameters
    ----------
    bus : Bus
        Where they come.
    topic : str
        Their topic.
    kind : {"auto", "twist", "stamped"}
        Messages; ``"auto"``: those of their publisher.
    heard : callable
        Called with a twist and its stamp in s, ``None`` without one.
    tell : callable
        Called with what the user is to know.
    """

    def __init__(
        self,
        bus: Bus,
        topic: str,
        kind: str,
        heard: Callable[[tuple[float, float, float], float | None], None],
        tell: Callable[[str], None],
    ) -> None:
        self._bus, self._topic, self._given = bus, topic, _GIVEN.get(kind)
        self._heard, self._tell = heard, tell
        self._now: Publisher | None = None
        self._end: Callable[[], None] = lambda: None
        self._next, self._quiet = -1.0, False
        self.several = False
        if self._given is not None:
            self._listen(Publisher(self._given))

    def look(self) -> None:
        """Look who publishes, now and then."""
        now = self._bus.wall()
        if now < self._next:
            return
        self._next = now + _LOOK
        found = self._bus.publishers(self._topic)
        if len(found) > 1 and not self.several:
            self.several = True
            kinds = ", ".join(sorted({each.type for each in found}))
            self._tell(f"{len(found)} publishers send velocity commands on {self._topic} ({kinds}): they mix")
        usable = [each for each in found if each.type in (self._given or TWIST, self._given or STAMPED)]
        for each in found:
            if each not in usable and self._given is not None:
                self._tell(f"{self._topic} is {each.type}, not {self._given}: it is not heard")
        # One that died without a word stays in the list for a while: whoever sends something else then is heard.
        others = [each for each in usable if each != self._now]
        if others and (self._now not in usable or self._quiet):
            self._listen(others[0])
        self._quiet = True

    def _listen(self, publisher: Publisher) -> None:
        """Listen to messages as a publisher sends them."""
        self._end()
        self._now = publisher
        stamped = publisher.type == STAMPED
        quality = Quality(10, reliable=publisher.reliable)
        self._end = self._bus.subscribe(self._topic, publisher.type, quality, self._stamped if stamped else self._plain)

    def _stamped(self, message: Any) -> None:
        self._quiet = False
        self._heard(twist_in(message.twist), seconds(message.header.stamp))

    def _plain(self, message: Any) -> None:
        self._quiet = False
        self._heard(twist_in(message), None)
