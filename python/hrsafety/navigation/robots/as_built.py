"""Robots as built: wheels with controllers, and cameras in place of exact positions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, instance, sequence
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.robots.kinematics import OmniKinematics, Slip
from hrsafety.navigation.robots.tracking_laws import (
    ExponentialTracking,
    FullSpeedTracking,
    NonlinearTracking,
    Tracking,
    VirtualTorque,
)
from hrsafety.navigation.robots.wheels import WheelDrive
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.sensing.robot_sensor import RobotSensor
from hrsafety.navigation.sensing.vision import Vision

__all__ = ["AsBuilt", "PoseFusion"]


@dataclass(frozen=True, kw_only=True, slots=True)
class PoseFusion(Parameters):
    """How a two-wheel robot joins the pose that its wheels tell with the measured one.

    Between two measurements the known pose moves as the wheels do; every measurement takes over a
    share of the difference. Nothing of this acts where the robot is known exactly.

    Parameters
    ----------
    position_share, heading_share : float
        Share of the difference of positions and of headings, from 0 to 1. Not in the source:
        chosen so that an error of 25 mm does not shake the heading.
    mark_distance : float
        Distance in m from the center of the robot to the second mark, whose direction is the
        heading, (7.3.1) of Zeng (2011).

    Raises
    ------
    InvalidParameterError
        If a share is not from 0 to 1, or the distance is not finite and positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.robots.PoseFusion().mark_distance
    0.1
    """

    position_share: float = 0.3
    heading_share: float = 0.1
    mark_distance: float = 0.1

    def __post_init__(self) -> None:
        """Check the values."""
        for name, value in self._as_numbers("position_share", "heading_share").items():
            if not 0.0 <= value <= 1.0:
                raise InvalidParameterError(name, "be from 0 to 1", value)
        (distance,) = self._as_numbers("mark_distance").values()
        if not 0.0 < distance < float("inf"):
            raise InvalidParameterError("mark_distance", "be finite and positive", distance)


@dataclass(frozen=True, kw_only=True, slots=True)
class AsBuilt(Parameters):
    """How a robot is built, beside what its scenario says.

    Parameters
    ----------
    wheels : iterable of WheelDrive, or None
        Wheels with motor, encoder and controller: three of a `HolonomicRobot`, two of a
        `DifferentialDriveRobot`; see ``HOLONOMIC_WHEELS`` and ``DIFFERENTIAL_WHEELS``. ``None``:
        ideal wheels, which do at once what they are told.
    kinematics : OmniKinematics
        Where the wheels of a holonomic robot are; a two-wheel robot knows that itself.
    slip : Slip
        Slip of wheels with controllers.
    tracking : FullSpeedTracking, NonlinearTracking, ExponentialTracking or VirtualTorque
        How a two-wheel robot follows the point mass that the law drives, or how it turns toward
        the force. Not used under a `SafeNavigation` with a shield, which commands speed and turn rate.
    robot_vision, obstacle_vision : Vision or None
        Cameras that see the robot, and the obstacles that move; an obstacle that no frame has
        shown yet is not there. ``None``: known exactly. Instead of the scenario's measurement.
    sensors : sequence of RobotSensor
        Sensors on the robot, such as `Ultrasonic` or `Lidar`. With one, obstacles are known by what it reads, and by
        the camera or the measurement of obstacles where there is one too; nothing else is known of them.
    pose_fusion : PoseFusion
        How a two-wheel robot knows its pose.

    Raises
    ------
    InvalidParameterError
        If a value is of another kind.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> built = nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS, robot_vision=nav.sensing.Vision())
    >>> len(built.wheels)
    3
    """

    wheels: tuple[WheelDrive, ...] | None = None
    kinematics: OmniKinematics = field(default_factory=OmniKinematics)
    slip: Slip = field(default_factory=Slip)
    tracking: Tracking | VirtualTorque = field(default_factory=FullSpeedTracking)
    robot_vision: Vision | None = None
    obstacle_vision: Vision | None = None
    sensors: Sequence[RobotSensor] = ()
    pose_fusion: PoseFusion = field(default_factory=PoseFusion)
    _native: _hrsafety.AsBuilt = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        if self.wheels is not None:
            wheels = sequence("wheels", "be a sequence of WheelDrive or None", self.wheels)
            self._set(wheels=tuple(instance(f"wheels[{i}]", wheel, WheelDrive) for i, wheel in enumerate(wheels)))
        kinds = {"kinematics": OmniKinematics, "slip": Slip, "pose_fusion": PoseFusion}
        for name, kind in kinds.items():
            instance(name, getattr(self, name), kind)
        for name in ("robot_vision", "obstacle_vision"):
            if getattr(self, name) is not None:
                instance(name, getattr(self, name), Vision)
        sensors = sequence("sensors", "be a sequence of sensors, such as Ultrasonic", self.sensors)
        self._set(sensors=tuple(instance(f"sensors[{i}]", one, RobotSensor) for i, one in enumerate(sensors)))
        instance("tracking", self.tracking, FullSpeedTracking, NonlinearTracking, ExponentialTracking, VirtualTorque)
        self._set(_native=self._build())

    def seeing_all(self, law: object = None) -> AsBuilt:
        """Return the same robot with exact sensing.

        Parameters
        ----------
        law : Law or None
            What drives it: one that makes its own map of scans keeps its lidars, which then see nothing and err in
            nothing.

        Returns
        -------
        AsBuilt
            Without cameras, sonars and lidars.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.robots.AsBuilt(sensors=[nav.sensing.Ultrasonic()]).seeing_all() == nav.robots.AsBuilt()
        True
        """
        kept = [each for each in self.sensors if isinstance(each, Lidar) and getattr(law, "MAPS_SCANS", False)]
        lidars = tuple(replace(each, map=None, range_noise=0.0, dropout=0.0, latency=0.0) for each in kept)
        return replace(self, robot_vision=None, obstacle_vision=None, sensors=lidars)

    def _sensors(self) -> list[_hrsafety.Sensor]:
        kind, found = _hrsafety.Sensor, []
        if self.robot_vision is not None:
            found.append(kind.robot_camera(self.robot_vision._native))
        if self.obstacle_vision is not None:
            found.append(kind.obstacle_camera(self.obstacle_vision._native))
        return found + [sensor._native for sensor in self.sensors]

    def _build(self) -> _hrsafety.AsBuilt:
        fusion = self.pose_fusion
        return _hrsafety.AsBuilt(
            wheels=None if self.wheels is None else [wheel._native for wheel in self.wheels],
            kinematics=self.kinematics._native,
            slip=self.slip._native,
            tracking=self.tracking._native,
            sensors=self._sensors(),
            position_share=fusion.position_share,
            heading_share=fusion.heading_share,
            mark_distance=fusion.mark_distance,
        )
