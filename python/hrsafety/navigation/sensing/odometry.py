"""Odometry that drifts: a robot that reckons where it is from the way of its wheels."""

from __future__ import annotations

from typing import Annotated, ClassVar

from hrsafety._records import dataclass
from hrsafety.navigation.sensing.robot_sensor import RobotSensor

__all__ = ["Odometry"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Odometry(RobotSensor):
    """Odometry of a robot, whose errors grow with its way: its law knows the robot's pose by it alone.

    Lengths are wrong by a share, and the heading goes wrong evenly along the way. Signs are drawn by the seed of the
    scenario, one for each run. Slip of wheels with controllers is a thing of its own, `Slip`. What a law knows by other
    means, a map or obstacles, stays where it is while the pose drifts: a result says so by ``"pose_drifts"``.

    Parameters
    ----------
    length_error : float
        Share by which lengths are wrong.
    heading_error : float
        Angle by which the heading goes wrong, in rad/m.

    Raises
    ------
    InvalidParameterError
        If a number is negative or not finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> odometry = nav.sensing.Odometry(length_error=0.01)
    >>> scene = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(4, 0))
    >>> run = nav.simulate(scene, nav.VirtualForceField(), built=nav.robots.AsBuilt(sensors=[odometry]))
    >>> round(float(run.seen_position[-1, 0] - run.position[-1, 0]), 2)  # how far off it takes itself to be, in m
    0.03
    """

    NAME: ClassVar[str] = "odometry"
    TELLS: ClassVar[bool] = False

    length_error: float = 0.01
    heading_error: Annotated[float, "rad/m"] = 0.0

    @property
    def drifts(self) -> bool:
        """Whether it is wrong at all."""
        return self.length_error > 0.0 or self.heading_error > 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        self._make(**self._as_numbers("length_error", "heading_error"))
