"""What a controller is told of people, and what it commands."""

from __future__ import annotations

import math
from collections.abc import Hashable
from typing import Literal, NamedTuple

from hrsafety._arguments import Pair, number
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError

__all__ = ["Command", "Sighting"]

ROUNDING = 1e-9
"""Of a number of periods."""


class Sighting(NamedTuple):
    """Where somebody was measured to be.

    Attributes
    ----------
    x, y : float
        Center in m.
    vx, vy : float or None
        Velocity in m/s; taken for zero when ``None``, which a shield that reckons with velocities refuses.
    time : float or None
        When it was measured, in s. When ``None``: at the update that tells of it, or before, by at most the
        ``latency`` of the shield.
    """

    x: float
    y: float
    vx: float | None = None
    vy: float | None = None
    time: float | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Command:
    """What a robot is to do until the next update.

    Attributes
    ----------
    force : (float, float)
        In N, before the limits of the robot, as a law asks for it.
    velocity : (float, float)
        To have a control period from now, within the limits, in m/s.
    speed, turn_rate : float or None
        The same for a robot with two wheels, in m/s and rad/s.
    status : {"kept", "changed", "braking"} or None
        What the shield has done with the wanted velocity; ``None`` without parts around the law.
    taken_over : bool
        Whether the robot heads for its (local) goal by itself.
    timing : {"regular", "late", "out_of_order", "lost"}
        What became of the update: in time; more than one and a half control periods after the last one; not
        after the last one, so that it counted for nothing and the last command stands; or without the
        place of the robot, which then brakes as its last plan ends.
    arrived : bool
        Whether the robot is within the arrival tolerance of the goal.
    oldest : float
        Age of the oldest measurement of somebody that counts, in s.
    faster : tuple of hashable
        Names of those who were measured to be faster than the shield reckons with, by their velocity or by two
        places too far apart for the time between them; what it guarantees does not hold for them.
    accelerated : tuple of hashable
        Names of those whose measured velocity changed faster than the ``person_acceleration`` of the shield; what
        it guarantees does not hold for them.
    before : (float, float)
        Velocity at the update, in m/s.
    period, max_acceleration : float
        Control period in s, and the limit of the robot in m/s^2.
    """

    force: Pair
    velocity: Pair
    speed: float | None
    turn_rate: float | None
    status: Literal["kept", "changed", "braking"] | None
    taken_over: bool
    timing: Literal["regular", "late", "out_of_order", "lost"]
    arrived: bool
    oldest: float
    faster: tuple[Hashable, ...]
    accelerated: tuple[Hashable, ...]
    before: Pair
    period: float
    max_acceleration: float

    @property
    def refuted(self) -> tuple[str, ...]:
        """Names of the assumptions of the shield that the measurements of this update refute."""
        return tuple(name for name in ("faster", "accelerated") if getattr(self, name))

    def velocity_after(self, seconds: float) -> Pair:
        """Return the velocity to have some time after the update if no other update comes.

        The plan that a shield verifies: the velocity is taken up evenly within a control period, and
        then the robot brakes to rest. A robot that executes it keeps the guarantee of the shield when
        updates are late or stop.

        Parameters
        ----------
        seconds : float
            Time since the update in s.

        Returns
        -------
        (float, float)
            In m/s.

        Raises
        ------
        InvalidParameterError
            If the time is negative or not finite.
        """
        since = number("seconds", seconds)
        if not 0.0 <= since < math.inf:
            raise InvalidParameterError("seconds", "be finite and not negative", seconds)
        (x, y), (u, v) = self.before, self.velocity
        if since <= self.period:
            share = since / self.period
            return x + (u - x) * share, y + (v - y) * share
        periods = math.ceil(math.hypot(u, v) / (self.max_acceleration * self.period) - ROUNDING)
        if periods <= 0:
            return 0.0, 0.0
        left = max(0.0, 1.0 - (since - self.period) / (periods * self.period))
        return u * left, v * left
