"""Microphones on a navigation robot: its law heads for a sound that somebody carries."""

from __future__ import annotations

from typing import ClassVar

from hrsafety._arguments import count, instance
from hrsafety._bounds import MOST_OBSTACLES
from hrsafety._records import dataclass
from hrsafety.navigation.sensing.robot_sensor import RobotSensor

__all__ = ["SoundLocalizer"]


@dataclass(frozen=True, kw_only=True, slots=True)
class SoundLocalizer(RobotSensor):
    """A row of microphones on a robot, which makes its law follow a sound.

    At each burst the goal of the law becomes the point at ``standoff`` before the source, along the bearing that was
    heard; between two bursts the last one counts. Scatter of range and bearing is that of table 2 of Avi (2019). The
    localizer tells of nobody else: without another sensor obstacles are known exactly. The run still ends where the
    robot reaches its own goal, so that one says where the way of the source ends. A law that plans the whole way
    itself (`RapidlyExploringRandomTree`, `FieldDStar`) is refused; a guide in a map leads to the robot's own goal while
    it does not see the source.

    Parameters
    ----------
    carrier : int
        Who carries the source: index of an obstacle of a scenario, or of a person of a world. It is not heard while
        absent or out of the ``sensing_range`` of the robot.
    standoff : float
        Distance from the source at which the robot wants to be, in m.
    burst_interval : float
        Time between two bursts, in s; the first one is at the start.
    noise_scale : float
        Factor of the scatter; 0: exact.
    mirrored : bool
        Whether a source behind the row is taken for one in front: three microphones in a row cannot tell.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    A robot follows a person with a beacon, and knows what is around it by sonar alone:

    >>> from hrsafety import navigation as nav
    >>> leader = nav.Person(start=(1.5, 0.0), route=[(6.0, 3.0)], desired_speed=0.5)
    >>> sensors = [nav.sensing.SoundLocalizer(carrier=0), nav.sensing.Ultrasonic(max_speed=1.5)]
    >>> law = nav.laws.VirtualImpedanceLaw(reach=0.4)
    >>> robot = nav.Robot(start=(0, 0), goal=(6, 3), arrival_tolerance=1.4, sensors=sensors, law=law)
    >>> run = nav.simulate(nav.World(people=[leader], robots=[robot], time_limit=30.0))
    >>> run.outcome
    'arrived'
    """

    NAME: ClassVar[str] = "sound_localizer"
    TELLS: ClassVar[bool] = False

    carrier: int
    standoff: float = 0.9
    burst_interval: float = 2.0
    noise_scale: float = 1.0
    mirrored: bool = False

    def __post_init__(self) -> None:
        """Check the values."""
        self._make(
            carrier=count("carrier", self.carrier, least=0, most=MOST_OBSTACLES - 1),
            mirrored=instance("mirrored", self.mirrored, bool),
            **self._as_numbers("standoff", "burst_interval", "noise_scale"),
        )
