"""Ultrasonic arrays on a navigation robot: a law that knows obstacles by their echoes alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import field
from typing import ClassVar, Literal, Self

from hrsafety._arguments import count, number, numbers
from hrsafety._bounds import MOST_RAYS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.sensing.robot_sensor import RobotSensor

__all__ = ["Ultrasonic"]

MOST_SENSORS = 1000


def _ring(sensors: int, radius: float) -> tuple[tuple[float, float, float], ...]:
    """Mounts at equal angles on a circle, looking outward, the first one forward."""
    axes = [2.0 * math.pi * index / sensors for index in range(sensors)]
    return tuple((radius * math.cos(axis), radius * math.sin(axis), axis) for axis in axes)


@dataclass(frozen=True, kw_only=True, slots=True)
class Ultrasonic(RobotSensor):
    """Ultrasonic sensors on a robot, which tell a law of obstacles by their echoes.

    Every echo becomes a point of an obstacle's boundary: a body of radius 0 at the reading along the
    axis of the beam, with regions for the declared largest speed of what is seen. **What gives no
    echo is not known to the law**: nothing outside the beams, nothing beyond the range, nothing
    nearer to a sensor than its least range, and nothing behind the nearest echo of a beam. Within
    its beam an obstacle may be off the axis by half of the width, and an echo has no velocity: a robot
    that goes by echoes alone stops before a walking person, who then walks into it. The force field
    needs ``side_hysteresis`` to pass what is straight ahead.

    Parameters
    ----------
    mounts : sequence of (float, float, float)
        Places of the sensors on the robot, x forward and y left in m, and directions of their axes
        in rad. Default: twelve sensors at equal angles, 0.15 m from the center.
    beam_width : float
        Full angle of a beam, in rad.
    rays : int
        Rays of a beam, evenly spread over its width; the nearest echo counts.
    least_range, most_range : float
        Nearer and farther echoes are lost, in m.
    range_noise : float
        Standard deviation of a reading, in m.
    firing : str
        ``"together"``; ``"cross_talk"``: together, and each sensor receives the echoes of the others
        that it can see; ``"in_turn"``: one sensor in each control period, the others keep their points.
    max_speed : float
        Largest speed in m/s of what is seen, for which the regions are sized.
    assumed_speed : float
        Speed in m/s at which a point is taken to move toward the robot; 0: it stands.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> built = nav.robots.AsBuilt(sensors=[nav.sensing.Ultrasonic(max_speed=1.0)])
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField(), built=built)
    >>> run.sensing
    Sensing(robot='exact', obstacles=('ultrasonic',))
    """

    NAME: ClassVar[str] = "ultrasonic"
    RANGE: ClassVar[str] = "most_range"

    mounts: Sequence[Sequence[float]] = field(default_factory=lambda: _ring(12, 0.15))
    beam_width: float = math.pi / 6.0
    rays: int = 13
    least_range: float = 0.03
    most_range: float = 3.0
    range_noise: float = 0.005
    firing: Literal["together", "cross_talk", "in_turn"] = "together"
    max_speed: float = 1.0
    assumed_speed: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        rule = "be a sequence of (x, y, axis)"
        mounts = numbers("mounts", self.mounts, rule)
        if mounts.ndim != 2 or mounts.shape[1] != 3 or not 1 <= len(mounts) <= MOST_SENSORS:
            raise InvalidParameterError("mounts", f"{rule} of 1 to {MOST_SENSORS} sensors", mounts.shape)
        self._set(mounts=tuple((float(x), float(y), float(axis)) for x, y, axis in mounts))
        names = ("beam_width", "least_range", "most_range", "range_noise", "max_speed", "assumed_speed")
        self._make(
            mounts=self.mounts,
            rays=count("rays", self.rays, most=MOST_RAYS),
            firing=str(self.firing),
            **self._as_numbers(*names),
        )

    @classmethod
    def ring(cls, sensors: int, radius: float, **options: float) -> Self:
        """Return sensors at equal angles on a circle, looking outward, the first one forward.

        Parameters
        ----------
        sensors : int
            Number of sensors.
        radius : float
            Distance of the sensors from the center of the robot, in m.
        **options
            Parameters of the class.

        Returns
        -------
        Ultrasonic
            The array.

        Raises
        ------
        InvalidParameterError
            If a number is out of range.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> len(nav.sensing.Ultrasonic.ring(8, 0.2, most_range=4.0).mounts)
        8
        """
        mounts = _ring(count("sensors", sensors, most=MOST_SENSORS), number("radius", radius))
        return cls(mounts=mounts, **options)  # type: ignore[arg-type]  # each under its own name
