"""A mobile base that executes velocity commands within its limits."""

from __future__ import annotations

import math
from typing import NamedTuple

from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.ros.messages import Pose

__all__ = ["STANDING", "Limits", "MovingBase", "PlanarTwist", "limits_of"]


class PlanarTwist(NamedTuple):
    """Speeds ahead and to the left in m/s, turn rate in rad/s."""

    ahead: float
    left: float
    rate: float


STANDING = PlanarTwist(0.0, 0.0, 0.0)
_ROUNDING = 1e-6
"""Share by which a command may exceed a limit before it counts, for messages are rounded on their way."""


class Limits(NamedTuple):
    """Limits of a base in m/s, m/s^2, rad/s and rad/s^2; one with two wheels cannot go sideways."""

    speed: float
    acceleration: float
    deceleration: float
    rate: float
    turn_acceleration: float
    sideways: bool

    def within(self, twist: PlanarTwist) -> tuple[PlanarTwist, bool]:
        """Return a command within the limits, in the same direction, and whether it was beyond them."""
        ahead, left, rate = twist
        if not self.sideways:
            left = 0.0
        speed = math.hypot(ahead, left)
        share = min(1.0, self.speed / speed) if speed > 0.0 else 1.0
        turned = min(max(rate, -self.rate), self.rate)
        beyond = speed > self.speed * (1.0 + _ROUNDING) or abs(rate) > self.rate * (1.0 + _ROUNDING)
        return PlanarTwist(share * ahead, share * left, turned), beyond or left != twist.left


def limits_of(robot: HolonomicRobot | DifferentialDriveRobot) -> Limits:
    """Return the limits of a robot.

    One with two wheels turns at up to twice its speed over the span of its wheels, as they then run against each
    other; one with three at up to its speed over its radius, as its wheels stand there.
    """
    speed, acceleration, deceleration = robot.max_speed, robot.max_acceleration, robot.deceleration
    if isinstance(robot, HolonomicRobot):
        return Limits(speed, acceleration, deceleration, speed / robot.radius, acceleration / robot.radius, True)
    rates = (2.0 * speed / robot.wheel_span, robot.max_turn_rate)
    changes = (robot.max_angular_acceleration, robot.max_turn_acceleration)
    rate, change = (min(each for each in given if each is not None) for given in (rates, changes))
    return Limits(speed, acceleration, deceleration, rate, change, False)


class MovingBase:
    """A base at work: its pose, its twist in its own frame, and the twist that it is to have.

    Parameters
    ----------
    limits : Limits
        What it can do.
    pose : Pose
        Where it starts, at rest.
    """

    __slots__ = ("limits", "pose", "twist", "wanted")

    def __init__(self, limits: Limits, pose: Pose) -> None:
        self.limits = limits
        self.pose = pose
        self.twist = STANDING
        self.wanted = STANDING

    def advance(self, duration: float) -> None:
        """Move for a time in s: the twist changes at once as far as the limits let it, then the base runs on an arc."""
        limits = self.limits
        change = (self.wanted.ahead - self.twist.ahead, self.wanted.left - self.twist.left)
        brakes = change[0] * self.twist.ahead + change[1] * self.twist.left < 0.0
        most = (limits.deceleration if brakes else limits.acceleration) * duration
        size = math.hypot(*change)
        share = min(1.0, most / size) if size > 0.0 else 0.0
        turn = limits.turn_acceleration * duration
        rate = self.twist.rate + min(max(self.wanted.rate - self.twist.rate, -turn), turn)
        self.twist = PlanarTwist(self.twist.ahead + share * change[0], self.twist.left + share * change[1], rate)
        self.pose = self.pose @ _arc(self.twist, duration)

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity in the frame of the map, in m/s."""
        sin, cos = math.sin(self.pose.yaw), math.cos(self.pose.yaw)
        ahead, left, _ = self.twist
        return cos * ahead - sin * left, sin * ahead + cos * left


def _arc(twist: PlanarTwist, duration: float) -> Pose:
    """Return the motion of a base that keeps its twist for a time."""
    turn = twist.rate * duration
    if abs(turn) < 1e-6:
        along, across = duration, 0.5 * turn * duration
    else:
        along, across = math.sin(turn) / twist.rate, (1.0 - math.cos(turn)) / twist.rate
    return Pose(twist.ahead * along - twist.left * across, twist.ahead * across + twist.left * along, turn)
