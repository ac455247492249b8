"""Robots as built: motion by wheels, sensing by cameras, and the runs they give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, flag, instance, number, sequence
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.kinematics import OmniKinematics, Slip
from hrsafety.navigation.laws import Law
from hrsafety.navigation.scenario import Scenario, _require
from hrsafety.navigation.tracking_laws import (
    ExponentialTracking,
    FullSpeedTracking,
    NonlinearTracking,
    Tracking,
    VirtualTorque,
)
from hrsafety.navigation.trajectory import Performance, Trajectory, check_weights, without_obstacles
from hrsafety.navigation.vision import Vision
from hrsafety.navigation.wheels import WheelDrive
from hrsafety.tables import Columns, each, plane

__all__ = ["AsBuilt", "BuiltTrajectory", "PoseFusion", "evaluate_built", "simulate_built"]


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
    >>> nav.PoseFusion().mark_distance
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
        the force.
    robot_vision, obstacle_vision : Vision or None
        Cameras that see the robot, and the obstacles that move; an obstacle that no frame has
        shown yet is not there. ``None``: known exactly. Instead of the scenario's measurement.
    pose_fusion : PoseFusion
        How a two-wheel robot knows its pose.

    Raises
    ------
    InvalidParameterError
        If a value is of another kind.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> built = nav.AsBuilt(wheels=nav.HOLONOMIC_WHEELS, robot_vision=nav.Vision())
    >>> len(built.wheels)
    3
    """

    wheels: tuple[WheelDrive, ...] | None = None
    kinematics: OmniKinematics = field(default_factory=OmniKinematics)
    slip: Slip = field(default_factory=Slip)
    tracking: Tracking | VirtualTorque = field(default_factory=FullSpeedTracking)
    robot_vision: Vision | None = None
    obstacle_vision: Vision | None = None
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
        _require("tracking", self.tracking, FullSpeedTracking, NonlinearTracking, ExponentialTracking, VirtualTorque)
        self._set(_native=self._build())

    def _build(self) -> _hrsafety.AsBuilt:
        fusion = self.pose_fusion
        return _hrsafety.AsBuilt(
            wheels=None if self.wheels is None else [wheel._native for wheel in self.wheels],
            kinematics=self.kinematics._native,
            slip=self.slip._native,
            tracking=self.tracking._native,
            robot_vision=None if self.robot_vision is None else self.robot_vision._native,
            obstacle_vision=None if self.obstacle_vision is None else self.obstacle_vision._native,
            position_share=fusion.position_share,
            heading_share=fusion.heading_share,
            mark_distance=fusion.mark_distance,
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BuiltTrajectory(Trajectory):
    """One run of a robot as built: a `Trajectory` with what its motors and its controller know.

    Attributes
    ----------
    scenario, law, time, position, velocity, force, stabilizing, lyapunov
        As for `Trajectory`.
    obstacle_position, distance, outcome, arrival_time, path_length
        As for `Trajectory`.
    min_distance, min_clearance, contact_time, contact_speed
        As for `Trajectory`.
    heading : ndarray, shape (n,)
        Heading in rad; it counts whole turns.
    wheel_current : ndarray, shape (n, w)
        Mean motor currents in A over the step that ends at the row.
    energy : float
        Electrical loss of the motors, in J: with wheels that have controllers, of their currents.
    wheel_speed : ndarray, shape (n, w)
        Wheel speeds in rad/s.
    energy_used : ndarray, shape (n,)
        Electrical loss up to each row, in J.
    reference_position : ndarray, shape (n, 2)
        Position of the point mass that the law drives, in m.
    seen_position : ndarray, shape (n, 2)
        Position of the robot as the law knows it since the last sample, in m.
    """

    wheel_speed: Array
    energy_used: Array
    reference_position: Array
    seen_position: Array

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Those of `Trajectory`, then what motors and controller know.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> run = nav.simulate_built(scenarios.configuration("c1"), nav.VirtualForceField())
        >>> list(run.columns())[-4:]
        ['reference_x_m', 'reference_y_m', 'seen_x_m', 'seen_y_m']
        """
        found = Trajectory.columns(self) | each("wheel_{}_speed", self.wheel_speed, "rad/s")
        found |= {"energy_used_J": self.energy_used, **plane("reference_{}", self.reference_position, "m")}
        return found | plane("seen_{}", self.seen_position, "m")


def simulate_built(
    scenario: Scenario,
    law: Law,
    built: AsBuilt | None = None,
    *,
    step: float = 0.01,
    stop_on_contact: bool = False,
) -> BuiltTrajectory:
    """Run one robot as built from start to goal.

    The law is asked once a control period, with the positions as measured, and its force is held. A
    holonomic robot moves as a point mass; a two-wheel robot follows one. With ideal motion and
    exact sensing the run of a holonomic robot is that of `simulate`, bit for bit.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, measurement.
    law : Law
        What drives the robot.
    built : AsBuilt or None
        How the robot is built; ``AsBuilt()`` when ``None``.
    step : float
        Motion step in s, which divides the control period.
    stop_on_contact : bool
        Whether the run ends at the first contact.

    Returns
    -------
    BuiltTrajectory
        The run.

    Raises
    ------
    InvalidParameterError
        If the step is not positive and finite or does not divide the control period, or an
        argument is of another kind.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> scene = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())
    >>> run = nav.simulate_built(scene, nav.VirtualForceField())
    >>> run.outcome, run.wheel_speed.shape[1]
    ('arrived', 2)
    """
    built = _checked(scenario, law, built)
    fields = _hrsafety.built_simulate(
        scenario._native,
        law._native,
        built._native,
        step=number("step", step),
        stop_on_contact=flag("stop_on_contact", stop_on_contact),
    )
    return BuiltTrajectory(scenario=scenario, law=law, **fields)


def evaluate_built(
    scenario: Scenario,
    law: Law,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    built: AsBuilt | None = None,
    *,
    step: float = 0.01,
) -> Performance:
    """Run one robot as built and score it as `evaluate` does.

    T* and L* come from the same robot and law without obstacles and without measurement errors.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, measurement.
    law : Law
        What drives the robot.
    weights : sequence of float
        Weights of time, distance and energy; not negative, sum 1.
    built : AsBuilt or None
        How the robot is built; ``AsBuilt()`` when ``None``.
    step : float
        As for `simulate_built`.

    Returns
    -------
    Performance
        total, arrival_time, avoidance, energy_saving and both trajectories.

    Raises
    ------
    InvalidParameterError
        As `simulate_built`, or if the weights are negative or do not sum to 1.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> scene = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())
    >>> 0.0 < nav.evaluate_built(scene, nav.VirtualForceField()).total < 1.0
    True
    """
    built = _checked(scenario, law, built)
    scores, run, nominal = _hrsafety.built_evaluate(
        scenario._native, law._native, built._native, check_weights(weights), step=number("step", step)
    )
    free = replace(without_obstacles(scenario), measurement=None, seed=0)
    return Performance(
        **scores,
        trajectory=BuiltTrajectory(scenario=scenario, law=law, **run),
        nominal=BuiltTrajectory(scenario=free, law=law, **nominal),
    )


def _checked(scenario: Scenario, law: Law, built: AsBuilt | None) -> AsBuilt:
    instance("scenario", scenario, Scenario)
    instance("law", law, Law)
    return AsBuilt() if built is None else instance("built", built, AsBuilt)
