"""Whether the shield of a run assumes as much as its scene asks for: else its theorem says nothing about the run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from hrsafety._records import dataclass
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.obstacles.standing import Rectangle
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_warnings import own_speed
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.plausibility import ResultWarning

__all__ = ["ASSUMES_LESS", "Motion", "of_shield", "of_surroundings"]

ASSUMES_LESS = "shield_assumes_less"
SEES_LESS = "shield_sees_less"

# A bound this far below what it has to cover was typed with fewer digits; a share of it.
ROUNDING = 1e-4


@dataclass(frozen=True, slots=True)
class Motion:
    """How a robot takes up a velocity.

    Attributes
    ----------
    robot : HolonomicRobot or DifferentialDriveRobot
        Its limits.
    control_period, step : float
        Time between two commands and motion step, in s.
    """

    robot: HolonomicRobot | DifferentialDriveRobot
    control_period: float
    step: float

    @property
    def execution_error(self) -> float:
        """Largest deviation from an even change of velocity within a control period, in m: half a motion step."""
        change = min(self.robot.max_acceleration * self.control_period, 2.0 * self.robot.max_speed)
        return 0.5 * change * min(self.step, self.control_period)


def of_shield(
    scenario: Scenario, shield: Shield, built: AsBuilt | None = None, motion_step: float = 0.01
) -> Iterator[ResultWarning]:
    """Warn of bounds that a scene exceeds: people who are faster, positions that are later or less exact.

    Parameters
    ----------
    scenario : Scenario
        Where the robot runs.
    shield : Shield
        What is assumed.
    built : AsBuilt or None
        Sensors of the robot; without them the obstacles are known as the scenario says.
    motion_step : float
        Of the run, in s.

    Yields
    ------
    ResultWarning
        Codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    others = ((f"obstacles[{index}]", own_speed(obstacle)) for index, obstacle in enumerate(scenario.obstacles))
    yield from of_surroundings(
        shield,
        others,
        measurement=scenario.measurement,
        motion=Motion(scenario.robot, scenario.control_period, motion_step),
        walls=any(isinstance(obstacle, Rectangle) for obstacle in scenario.obstacles),
    )
    if built is not None and built.wheels is not None:
        yield ResultWarning(
            ASSUMES_LESS,
            "wheels",
            "the shield plans for a robot that takes up each velocity evenly within a control period and then stands "
            "still; wheels with motors lag and slip, more than its margin covers: nothing is proved for this run",
        )
    if built is not None and built.robot_vision is not None:
        yield ResultWarning(
            ASSUMES_LESS,
            "robot_vision",
            f"margin of the shield is {shield.margin:.4g}, but a camera tells the robot its own place with noise and "
            "late: it may let the robot move into somebody; give a margin that covers noise and the way in between",
        )
    if built is not None and (built.obstacle_vision is not None or built.sensors):
        yield ResultWarning(
            SEES_LESS,
            "sensors",
            "the shield keeps off those whom the sensors show at the time, with the errors and the age that it "
            "assumes: who is hidden, or was not seen yet, is not there for it",
        )


def of_controller(
    shield: Shield, robot: HolonomicRobot | DifferentialDriveRobot, *, person_speed: float, lidar: bool
) -> Iterator[ResultWarning]:
    """Warn of what a shield on a robot does not cover: people who are faster, and what a lidar does not show.

    Parameters
    ----------
    shield : Shield
        What is assumed.
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot.
    person_speed : float
        Largest speed of people in m/s.
    lidar : bool
        Whether the robot has one.

    Yields
    ------
    ResultWarning
        Codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    # How the robot carries out what it is told is its own: no motion steps here.
    motion = Motion(robot, 1.0, 0.0)
    yield from of_surroundings(shield, [("people", person_speed)], measurement=None, motion=motion, walls=False)
    if lidar:
        yield ResultWarning(
            SEES_LESS,
            "lidar",
            "the shield keeps off at most eight points of a scan, those within the reach of the lidar: what lies "
            "between two beams, behind others or farther away is not there for it; give a reach beyond its "
            "braking distance, and tell of people by people=",
        )


def of_surroundings(
    shield: Shield,
    others: Iterable[tuple[str, float]],
    *,
    measurement: Measurement | None,
    motion: Motion,
    walls: bool,
    owner: str = "shield",
) -> Iterator[ResultWarning]:
    """Warn of bounds of a shield that others or a measurement exceed.

    Parameters
    ----------
    shield : Shield
        What is assumed.
    others : iterable of (str, float)
        Who moves, and the largest speed in m/s.
    measurement : Measurement or None
        How the robot knows them.
    motion : Motion
        How the robot moves.
    walls : bool
        Whether there are any.
    owner : str
        How the warnings call the shield.

    Yields
    ------
    ResultWarning
        With the code ``"shield_assumes_less"``.
    """
    people = () if shield.person_speed is None else others
    needed = [("person_speed", shield.person_speed or 0.0, speed, f"{who} {_moves(speed)}") for who, speed in people]
    needed += _of_measurement(shield, measurement, motion)
    error = motion.execution_error
    why = f"with motion steps of {motion.step:g} s the robot is up to {error:.4g} m off the motion that is planned"
    needed += [(name, getattr(shield, name), error, why) for name in ("margin", "wall_margin")[: 1 + walls]]
    for name, assumed, least, why in needed:
        if assumed < least * (1.0 - ROUNDING):
            mended = f"give at least {name}={least:.4g}" if math.isfinite(least) else "no number covers that"
            yield ResultWarning(
                ASSUMES_LESS,
                f"{owner}.{name}",
                f"{name} of the shield is {assumed:.4g}, but {why}: it may let the robot move into somebody; {mended}",
            )


def _moves(speed: float) -> str:
    return f"moves at up to {speed:.4g} m/s" if math.isfinite(speed) else "has no largest speed"


def _of_measurement(
    shield: Shield, measured: Measurement | None, motion: Motion
) -> Iterator[tuple[str, float, float, str]]:
    """Yield name, assumed value, the least one that covers a measurement, and what asks for it."""
    if measured is None:
        return
    bound, latency = measured._native.error_bound(), measured.latency
    if measured.of in ("both", "obstacles"):
        yield "latency", shield.latency, latency, f"positions are measured {latency:.4g} s late"
        yield "position_error", shield.position_error, bound, f"positions are wrong by up to {bound:.4g} m"
        if shield.velocity_error is not None:
            # Backward differences of two wrong positions.
            error = 2.0 * bound / motion.control_period
            why = f"velocities from differences of positions are wrong by up to {error:.4g} m/s"
            yield "velocity_error", shield.velocity_error, error, why
    if measured.of in ("both", "robot"):
        own = bound + latency * motion.robot.max_speed
        yield "margin", shield.margin, own, f"the robot knows its own place to {own:.4g} m only"
