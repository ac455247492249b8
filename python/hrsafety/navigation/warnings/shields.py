"""Whether the shield of a run assumes as much as its scene asks for: else its theorem says nothing about the run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety.navigation.laws.python_law import PythonLaw
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.navigation.obstacles.standing import Rectangle
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.warnings.scenarios import own_speed, pieces
from hrsafety.plausibility import ResultWarning, implausible

if TYPE_CHECKING:
    from hrsafety.navigation.maps.static_map import StaticMap

__all__ = [
    "ASSUMES_LESS",
    "SEES_LESS",
    "Motion",
    "Mover",
    "maps_of",
    "object_of",
    "of_built",
    "of_hidden_ways",
    "of_order",
    "of_shield",
    "of_surroundings",
    "shield_of",
]

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
        change = min(self.robot.guaranteed_acceleration * self.control_period, 2.0 * self.robot.max_speed)
        return 0.5 * change * min(self.step, self.control_period)

    @property
    def plan_duration(self) -> float:
        """Longest time in s from a command to rest: a control period, and whole ones of braking."""
        period = self.control_period
        return (1.0 + math.ceil(self.robot.max_speed / (self.robot.guaranteed_acceleration * period) - 1e-9)) * period

    def farthest(self, shield: Shield, person_speed: float) -> float:
        """Return how far from the center of the robot whoever it can meet before it rests is at most, in m."""
        speed = person_speed if shield.person_speed is None else shield.person_speed
        own = 0.5 * self.robot.max_speed * (self.control_period + self.plan_duration)
        errors = shield.position_error + shield.margin
        return float(self.robot.radius + own + speed * (shield.latency + self.plan_duration) + errors)


@dataclass(frozen=True, slots=True)
class Mover:
    """How a person moves.

    Attributes
    ----------
    who : str
        Who it is.
    speed, acceleration : float
        Largest speed in m/s and acceleration in m/s^2.
    jump : float
        Largest sum of sudden changes of the velocity while a plan lasts, in m/s.
    """

    who: str
    speed: float
    acceleration: float = 0.0
    jump: float = 0.0


def _mover(who: str, obstacle: Obstacle, until: float, ahead: float | None) -> Mover:
    """Return how an obstacle moves before a time limit, and how it turns while a plan of so many seconds lasts.

    ``None`` where only its speed counts.
    """
    speed = own_speed(obstacle, until)
    if ahead is None or not isinstance(obstacle, Mobile):
        return Mover(who, speed)
    if obstacle.path is not None:
        times, places = obstacle.path
        ways = np.diff(np.array(places), axis=0) / np.diff(np.array(times))[:, None]
        return Mover(who, speed, 0.0, _jump(np.diff(ways, axis=0), np.array(times[1:-1]), ahead))
    parts = list(pieces(obstacle, until))
    ends = np.array([(first, last) for first, last, _ in parts])
    begins = np.cumsum([duration for duration, _, _ in (obstacle.segments or ())[:-1]])
    jump = _jump(ends[1:, 0] - ends[:-1, 1], begins, ahead)
    # Who stops does so at once.
    return Mover(who, speed, max(gained for _, _, gained in parts), jump if obstacle.stop is None else speed)


def _jump(changes: Array, instants: Array, ahead: float) -> float:
    """Return the largest sum of successive changes of a velocity (n, 2) that begin and end within a time in s."""
    summed = np.vstack([np.zeros((1, 2)), np.cumsum(changes, axis=0)])
    largest = 0.0
    for count in range(1, len(changes) + 1):
        within = instants[count - 1 :] - instants[: len(instants) - count + 1] <= ahead
        if not within.any():
            break
        largest = max(largest, float(np.hypot(*(summed[count:] - summed[:-count])[within].T).max()))
    return largest


def shield_of(law: object) -> tuple[Shield | None, bool]:
    """Return the outermost shield of a law, and whether the law knows a map."""
    shield, walls = None, False
    while isinstance(law, SafeNavigation):
        shield, walls = shield or law.shield, walls or law.map is not None
        law = law.law
    return shield, walls


def maps_of(law: object, *, whole: bool = True) -> list[StaticMap]:
    """Return the maps that a law and the laws within it know; as a whole with that of an object in Python."""
    found: list[StaticMap] = []
    inner = law
    while isinstance(inner, SafeNavigation):
        if inner.map is not None:
            found.append(inner.map)
        inner = inner.law
    own = getattr(object_of(law), "known_map", None) if whole else None
    return found if own is None else [*found, own]


def object_of(law: object) -> object:
    """Return the object in Python that decides within a law, or ``None``."""
    while isinstance(law, SafeNavigation):
        law = law.law
    return law.function if isinstance(law, PythonLaw) else None


def of_order(law: object, owner: str = "law") -> Iterator[ResultWarning]:
    """Warn of a shield below parts that command what it has not verified.

    Parameters
    ----------
    law : law
        What drives the robot.
    owner : str
        How the warning calls it.

    Yields
    ------
    ResultWarning
        With the code ``"shield_assumes_less"``.
    """
    if isinstance(law, SafeNavigation) and law.shield is None and shield_of(law)[0] is not None:
        message = (
            "the shield stands below other parts, which may command velocities that it has not verified: nothing is "
            "proved; give all parts to one SafeNavigation"
        )
        yield ResultWarning(ASSUMES_LESS, owner, message)


def of_shield(
    scenario: Scenario,
    shield: Shield,
    built: AsBuilt | None = None,
    motion_step: float = 0.01,
    *,
    walls: bool = False,
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
    walls : bool
        Whether the law knows a map.

    Yields
    ------
    ResultWarning
        Codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    motion = Motion(scenario.robot, scenario.control_period, motion_step)
    ahead = None
    if shield.velocity_error is not None:
        # A measured velocity is that of a whole control period before.
        ahead = shield.latency + motion.plan_duration + (0.0 if scenario.measurement is None else motion.control_period)
    named = ((f"obstacles[{index}]", obstacle) for index, obstacle in enumerate(scenario.obstacles))
    others = [_mover(who, obstacle, scenario.time_limit, ahead) for who, obstacle in named]
    yield from of_surroundings(
        shield,
        others,
        measurement=scenario.measurement,
        motion=motion,
        walls=walls or any(isinstance(obstacle, Rectangle) for obstacle in scenario.obstacles),
    )
    if built is not None:
        yield from of_built(shield, built)


def of_built(shield: Shield, built: AsBuilt) -> Iterator[ResultWarning]:
    """Warn of wheels and sensors of a robot that a shield does not cover.

    Parameters
    ----------
    shield : Shield
        What is assumed.
    built : AsBuilt
        Wheels and sensors.

    Yields
    ------
    ResultWarning
        Codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    if built.wheels is not None:
        yield ResultWarning(
            ASSUMES_LESS,
            "wheels",
            "the shield plans for a robot that takes up each velocity evenly within a control period and then stands "
            "still; wheels with motors lag and slip, more than its margin covers: nothing is proved for this run",
        )
    if built.robot_vision is not None:
        yield ResultWarning(
            ASSUMES_LESS,
            "robot_vision",
            f"margin of the shield is {shield.margin:.4g}, but a camera tells the robot its own place with noise and "
            "late: it may let the robot move into somebody; give a margin that covers noise and the way in between",
        )
    if built.obstacle_vision is not None or any(sensor.TELLS for sensor in built.sensors):
        yield ResultWarning(
            SEES_LESS,
            "sensors",
            "the shield keeps off those whom the sensors show at the time, with the errors and the age that it "
            "assumes: who is hidden, or was not seen yet, is not there for it",
        )


def of_controller(
    shield: Shield,
    robot: HolonomicRobot | DifferentialDriveRobot,
    *,
    person_speed: float,
    control_period: float,
    lidar: bool,
    reach: float | None,
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
    control_period : float
        Time between updates in s.
    lidar : bool
        Whether the robot has one.
    reach : float or None
        Of the lidar in m.

    Yields
    ------
    ResultWarning
        Codes ``"shield_assumes_less"`` and ``"shield_sees_less"``.
    """
    # How the robot carries out what it is told is its own: no motion steps here.
    motion = Motion(robot, control_period, 0.0)
    yield from of_surroundings(shield, [Mover("people", person_speed)], measurement=None, motion=motion, walls=False)
    if shield.unseen is not None and not lidar:
        message = (
            "the shield reckons with people who are not seen, but the controller has no lidar: no place is ever seen "
            "to be empty, and the robot does not move faster than it creeps; give a lidar, and its scans"
        )
        yield ResultWarning(SEES_LESS, "lidar", message, safe_side=True)
    if lidar:
        told = "its active region" if reach is None else f"{reach:.4g} m"
        least = motion.farthest(shield, person_speed)
        yield ResultWarning(
            SEES_LESS,
            "lidar",
            f"the shield keeps off at most eight points of a scan, those within the reach of the lidar ({told}): what "
            "lies between two beams, behind others or farther away is not there for it; whoever can come near before "
            f"the robot is at rest is up to {least:.3g} m away: give reach={least:.3g}, and tell of people by people=",
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
    yield from _of_unseen(shield, owner)
    yield from _of_units(shield, owner)
    needed = [*_of_motions(shield, others, measurement, motion), *_of_measurement(shield, measurement)]
    for name, assumed, least, why in needed:
        if assumed < least * (1.0 - ROUNDING):
            mended = f"give at least {name}={least:.4g}" if math.isfinite(least) else "no number covers that"
            yield ResultWarning(
                ASSUMES_LESS,
                f"{owner}.{name}",
                f"{name} of the shield is {assumed:.4g}, but {why}: it may let the robot move into somebody; {mended}",
            )
    yield from _of_own_motion(shield, measurement, motion, walls=walls, owner=owner)


def _of_units(shield: Shield, owner: str) -> Iterator[ResultWarning]:
    """Warn of errors and margins that are hardly meant: with large ones the robot stands."""
    lengths = ("position_error", "margin", "wall_margin", "position_tracking")
    quantities = {f"{owner}.{name}": "shield_margin" for name in lengths} | {f"{owner}.latency": "shield_latency"}
    values = {name: getattr(shield, name.removeprefix(f"{owner}.")) for name in quantities}
    for doubt in implausible(values, quantities):
        yield replace(doubt, safe_side=True)


def _of_unseen(shield: Shield, owner: str) -> Iterator[ResultWarning]:
    """Warn of a shield that never sees what is behind the robot: it is safe, and hardly moves."""
    if shield.unseen is not None and shield.unseen.field_of_view < math.tau * (1.0 - ROUNDING):
        message = (
            f"field_of_view of the shield's unseen people is {shield.unseen.field_of_view:.4g} rad: somebody may "
            "follow the robot unseen and overtake it while it stops, so it waits nearly everywhere; let it look "
            "all around, 2 pi"
        )
        yield ResultWarning(SEES_LESS, f"{owner}.unseen.field_of_view", message, safe_side=True)


def of_hidden_ways(scenario: Scenario, shield: Shield, maps: Sequence[StaticMap]) -> Iterator[ResultWarning]:
    """Warn of people whom a shield that reckons with unseen ones takes to be nowhere: in walls, or out of nothing.

    Parameters
    ----------
    scenario : Scenario
        Where the robot runs.
    shield : Shield
        What is assumed.
    maps : sequence of StaticMap
        Walls that the law knows.

    Yields
    ------
    ResultWarning
        With the code ``"shield_assumes_less"``.
    """
    if shield.unseen is None:
        return
    core, found = shield.unseen.person_core, []
    for index, obstacle in enumerate(scenario.obstacles):
        if not isinstance(obstacle, Human | MovingDisc) or own_speed(obstacle, scenario.time_limit) == 0.0:
            continue
        way = _way(obstacle, scenario.time_limit)
        near = min((float(np.min(each.clearance(way), initial=math.inf)) for each in maps), default=math.inf)
        if near < core * (1.0 - ROUNDING):
            found.append(
                f"the middle of obstacles[{index}] comes to {near:.3g} m from a wall, nearer than {core:.3g} m"
            )
        elif obstacle.path is not None and obstacle.path[0][0] > 0.0:
            found.append(f"obstacles[{index}] is not there before {obstacle.path[0][0]:.4g} s")
    if found:
        more = f" ({len(found) - 1} more alike)" if found[1:] else ""
        message = (
            f"{found[0]}{more}, but the shield takes people whom it does not see to walk around walls, and nobody to "
            "appear where it saw nobody: nothing is proved about them"
        )
        yield ResultWarning(ASSUMES_LESS, "shield.unseen", message)


def _way(obstacle: Human | MovingDisc, until: float) -> Array:
    """Return places (n, 2) of somebody before a time limit, at most 0.05 m apart up to a way of 500 m."""
    if obstacle.path is not None:
        time, places = np.array(obstacle.path[0]), np.array(obstacle.path[1])
        last = [np.interp(min(until, time[-1]), time, axis) for axis in places.T]
        corners = np.vstack([places[time < until], last])
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        steps = np.linspace(0.0, lengths[-1], _count(lengths[-1]))
        return np.column_stack([np.interp(steps, lengths, axis) for axis in corners.T])
    place = np.array(obstacle.start if isinstance(obstacle, Human) else obstacle.center)
    endless = (math.inf, obstacle.velocity, getattr(obstacle, "acceleration", (0.0, 0.0)))
    parts, left = [place[None]], until
    for duration, velocity, acceleration in obstacle.segments or (endless,):
        first, gained = np.array(velocity), np.array(acceleration)
        length = min(duration, left)
        way = length * max(math.hypot(*first), math.hypot(*(first + gained * length)))
        time = np.linspace(0.0, length, _count(way))[:, None]
        parts.append(place + first * time + 0.5 * gained * time**2)
        place, left = parts[-1][-1], left - length
    walked: Array = np.concatenate(parts)
    if obstacle.stop is None:
        return walked
    # On a straight line.
    stop = math.dist(walked[0], obstacle.stop)
    before: Array = walked[np.hypot(*(walked - walked[0]).T) <= stop + ROUNDING]
    return before


def _count(way: float) -> int:
    return 2 + int(min(way / 0.05, 10_000.0))


def _of_motions(
    shield: Shield, others: Iterable[Mover], measured: Measurement | None, motion: Motion
) -> Iterator[tuple[str, float, float, str]]:
    """Yield name, assumed value, the least one that covers a motion, and what asks for it."""
    differs = 0.0
    if measured is not None and measured.of in ("both", "obstacles"):
        # Backward differences of two wrong positions.
        differs = 2.0 * measured._native.error_bound() / motion.control_period
    for each in others:
        if shield.person_speed is not None:
            yield "person_speed", shield.person_speed, each.speed, f"{each.who} {_moves(each.speed)}"
        if shield.velocity_error is not None:
            # That of a control period is as old as half of it.
            wrong = differs + (0.0 if measured is None else 0.5 * each.acceleration * motion.control_period)
            told = [f"{each.who} changes its velocity by up to {each.jump:.4g} m/s at once"] if each.jump else []
            if wrong:
                told.append(f"its velocity from differences of positions is wrong by up to {wrong:.4g} m/s")
            yield "velocity_error", shield.velocity_error, each.jump + wrong, " and ".join(told)
        if shield.person_acceleration is not None:
            why = f"{each.who} accelerates by {each.acceleration:.4g} m/s^2"
            yield "person_acceleration", shield.person_acceleration, each.acceleration, why


def _moves(speed: float) -> str:
    return f"moves at up to {speed:.4g} m/s" if math.isfinite(speed) else "has no largest speed"


def _of_measurement(shield: Shield, measured: Measurement | None) -> Iterator[tuple[str, float, float, str]]:
    """Yield name, assumed value, the least one that covers a measurement of others, and what asks for it."""
    if measured is None or measured.of == "robot":
        return
    bound, latency = measured._native.error_bound(), measured.latency
    yield "latency", shield.latency, latency, f"positions are measured {latency:.4g} s late"
    yield "position_error", shield.position_error, bound, f"positions are wrong by up to {bound:.4g} m"


def _of_own_motion(
    shield: Shield, measured: Measurement | None, motion: Motion, *, walls: bool, owner: str
) -> Iterator[ResultWarning]:
    """Warn of margins below the deviation of the robot from its plan, and of a robot that measures itself."""
    least = motion.execution_error
    told = [f"with motion steps of {motion.step:g} s the robot is up to {least:.4g} m off the motion that is planned"]
    unproved = ""
    if measured is not None and measured.of in ("both", "robot"):
        bound = measured._native.error_bound()
        own = bound + measured.latency * motion.robot.max_speed
        told = [*(told if least else ()), f"the robot knows its own place to {own:.4g} m only"]
        least += own
        wrong = 2.0 * bound / motion.control_period + measured.latency * max(
            motion.robot.max_acceleration, motion.robot.deceleration
        )
        if own:
            wrong = min(wrong, 2.0 * motion.robot.max_speed + 2.0 * bound / motion.control_period)
            unproved = (
                f"the robot knows its own velocity to {wrong:.4g} m/s only, which no margin covers: nothing is proved"
            )
    for name in ("margin", "wall_margin")[: 1 + walls]:
        assumed = getattr(shield, name)
        message = []
        if assumed < least * (1.0 - ROUNDING):
            message.append(
                f"{name} of the shield is {assumed:.4g}, but {' and '.join(told)}: it may let the robot move into "
                f"somebody; give at least {name}={least:.4g}"
            )
        if unproved and (name == "margin" or message):
            message.append(unproved)
        if message:
            yield ResultWarning(ASSUMES_LESS, f"{owner}.{name}", "; ".join(message))
