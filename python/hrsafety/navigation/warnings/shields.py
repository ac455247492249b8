"""Whether the shield of a run assumes as much as its scene asks for: else its theorem says nothing about the run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from hrsafety._arguments import Pair
from hrsafety._records import dataclass
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.navigation.obstacles.standing import Rectangle
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.warnings.scenarios import own_speed, pieces
from hrsafety.plausibility import ResultWarning

__all__ = ["ASSUMES_LESS", "Motion", "Mover", "of_shield", "of_surroundings"]

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


@dataclass(frozen=True, slots=True)
class Mover:
    """How somebody moves.

    Attributes
    ----------
    who : str
        Who it is.
    speed, acceleration : float
        Largest speed in m/s and acceleration in m/s^2.
    jump : float
        Largest sudden change of the velocity in m/s.
    """

    who: str
    speed: float
    acceleration: float = 0.0
    jump: float = 0.0


def _mover(who: str, obstacle: Obstacle, until: float) -> Mover:
    """Return how an obstacle moves before a time limit in s."""
    speed = own_speed(obstacle, until)
    if not isinstance(obstacle, Mobile):
        return Mover(who, speed)
    if obstacle.path is not None:
        steps = [
            ((x2 - x1) / (late - soon), (y2 - y1) / (late - soon))
            for soon, late, (x1, y1), (x2, y2) in _pairs(*obstacle.path)
        ]
        return Mover(who, speed, 0.0, _jump(steps[:-1], steps[1:]))
    parts = list(pieces(obstacle, until))
    jump = _jump([last for _, last, _ in parts[:-1]], [first for first, _, _ in parts[1:]])
    # Who stops does so at once.
    return Mover(who, speed, max(gained for _, _, gained in parts), jump if obstacle.stop is None else speed)


def _pairs(time: Sequence[float], places: Sequence[Pair]) -> Iterator[tuple[float, float, Pair, Pair]]:
    return zip(time, time[1:], places, places[1:], strict=False)


def _jump(before: Iterable[Pair], after: Iterable[Pair]) -> float:
    return max((math.dist(one, other) for one, other in zip(before, after, strict=True)), default=0.0)


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
    named = ((f"obstacles[{index}]", obstacle) for index, obstacle in enumerate(scenario.obstacles))
    others = [_mover(who, obstacle, scenario.time_limit) for who, obstacle in named]
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
    yield from of_surroundings(shield, [Mover("people", person_speed)], measurement=None, motion=motion, walls=False)
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
    others: Sequence[Mover],
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
    others : sequence of Mover
        Who moves.
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
    needed = list(_of_motions(shield, others))
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


def _of_motions(shield: Shield, others: Iterable[Mover]) -> Iterator[tuple[str, float, float, str]]:
    """Yield name, assumed value, the least one that covers a motion, and what asks for it."""
    for each in others:
        if shield.person_speed is not None:
            yield "person_speed", shield.person_speed, each.speed, f"{each.who} {_moves(each.speed)}"
        if shield.velocity_error is not None:
            why = f"{each.who} changes its velocity by up to {each.jump:.4g} m/s at once"
            yield "velocity_error", shield.velocity_error, each.jump, why
        if shield.person_acceleration is not None:
            why = f"{each.who} accelerates by {each.acceleration:.4g} m/s^2"
            yield "person_acceleration", shield.person_acceleration, each.acceleration, why


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
