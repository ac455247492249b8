"""Knowledge of a law from the sensors of its robot, and whether they could tell enough."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import instance
from hrsafety.navigation.free_space import distance, stands
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.navigation.regions import region_radii
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import least_reach
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.sensing.odometry import Odometry
from hrsafety.navigation.sensing.robot_sensor import RobotSensor
from hrsafety.navigation.sensing.vision import Vision
from hrsafety.navigation.warnings.scenarios import BELOW_SAFE, ROUNDING, own_speed
from hrsafety.navigation.warnings.units import of_lidar
from hrsafety.plausibility import ResultWarning

__all__ = ["EchoRegions", "Sensing", "echo_regions", "sensing_of"]

REGION_BEYOND_RANGE = "region_beyond_range"
BLIND_NEARBY = "blind_nearby"
UNSEEN_AT_START = "unseen_at_start"
OBSTACLES_UNSEEN = "obstacles_unseen"
POSE_DRIFTS = "pose_drifts"

OF_REGIONS = (BELOW_SAFE, REGION_BEYOND_RANGE)
"""Codes of sensors whose readings have regions that do not fit; a law that makes its own map has none."""

LOST = 1e-3
"""Probability of more lost frames, one after the other, than a warning counts on."""


class Sensing(NamedTuple):
    """Which sensors told a law of the robot and of the obstacles.

    Attributes
    ----------
    robot : str
        ``"exact"``, ``"measurement"``, ``"odometry"`` or ``"camera"``.
    obstacles : tuple of str
        ``"exact"``, or those of ``"measurement"``, ``"camera"``, ``"ultrasonic"`` and ``"lidar"`` that told of
        them.
    """

    robot: str
    obstacles: tuple[str, ...]


class EchoRegions(NamedTuple):
    """Regions around the point of an echo.

    Attributes
    ----------
    critical_radius, active_radius : float
        r3 and r2 in m.
    reach : float
        Distance from the center of the robot up to which every sensor reads an echo on its axis, in m.
    """

    critical_radius: float
    active_radius: float
    reach: float


def sensing_of(scenario: Scenario, built: AsBuilt) -> Sensing:
    """Return which sensors tell a law of the robot and of the obstacles.

    Parameters
    ----------
    scenario : Scenario
        Whose measurement counts too.
    built : AsBuilt
        Cameras, ultrasonic arrays and lidars.

    Returns
    -------
    Sensing
        Words for the sensors.

    Raises
    ------
    InvalidParameterError
        If an argument is of another kind.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> camera = nav.robots.AsBuilt(robot_vision=nav.sensing.Vision())
    >>> nav.knowledge.sensing_of(scenarios.configuration("c1"), camera)
    Sensing(robot='camera', obstacles=('exact',))
    """
    return told_by(instance("scenario", scenario, Scenario).measurement, instance("built", built, AsBuilt))


def told_by(measurement: Measurement | None, built: AsBuilt) -> Sensing:
    """Return which of a measurement and the sensors of a robot tell its law of the robot and of the obstacles."""
    measured = "" if measurement is None else measurement.of
    told = {
        "measurement": measured in ("both", "obstacles"),
        "camera": built.obstacle_vision is not None,
        **{sensor.NAME: sensor.TELLS for sensor in built.sensors},
    }
    robot = "measurement" if measured in ("both", "robot") else "exact"
    robot = "camera" if built.robot_vision is not None else robot
    # Of several that tell of the robot the last one counts, and cameras are before what rides on it.
    return Sensing(
        robot=Odometry.NAME if any(isinstance(sensor, Odometry) for sensor in built.sensors) else robot,
        obstacles=tuple(word for word, tells in told.items() if tells) or ("exact",),
    )


def echo_regions(scenario: Scenario, sonar: RobotSensor) -> EchoRegions:
    """Return the regions around an echo for the robot of a scenario.

    Parameters
    ----------
    scenario : Scenario
        Robot and control period.
    sonar : Ultrasonic
        The array.

    Returns
    -------
    EchoRegions
        Radii, and how far the sensors reach, in m.

    Raises
    ------
    InvalidParameterError
        If an argument is of another kind.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> regions = nav.knowledge.echo_regions(scenarios.configuration("c3"), nav.sensing.Ultrasonic(max_speed=0.0))
    >>> regions.active_radius < regions.reach
    True
    """
    native = instance("scenario", scenario, Scenario)._native
    return EchoRegions(*instance("sonar", sonar, RobotSensor)._native.sight(native))


def warnings_of(scenario: Scenario, built: AsBuilt) -> Iterator[ResultWarning]:
    """Warn of sensors that do not reach as far as the regions that they must see, or see nothing nearby.

    Or whose regions are sized for slower people than there are, and of cameras that report too late who is there.
    """
    yield from _unseen_at_start(scenario, built.obstacle_vision)
    telling = [sensor for sensor in built.sensors if sensor.TELLS]
    walls_alone = telling and all(isinstance(sensor, Lidar) and not sensor.sees_obstacles for sensor in telling)
    if scenario.obstacles and walls_alone and built.obstacle_vision is None:
        yield ResultWarning(
            OBSTACLES_UNSEEN,
            "sensors",
            f"no sensor sees the {len(scenario.obstacles)} obstacles of the scene: lidars with sees_obstacles=False "
            "tell of walls alone, in place of all that is known otherwise, and the robot may drive into them",
        )
    for index, sensor in enumerate(built.sensors):
        if isinstance(sensor, Lidar):
            yield from of_lidar(f"sensors[{index}]", sensor)
        if isinstance(sensor, Odometry) and sensor.drifts:
            yield ResultWarning(
                POSE_DRIFTS,
                f"sensors[{index}]",
                f"the pose of the robot goes wrong by {100.0 * sensor.length_error:.3g} % of its way and "
                f"{sensor.heading_error:.3g} rad in each m, and nothing corrects it: maps and obstacles that the law "
                "knows, and what it saw before, are elsewhere by then than it takes them to be; no margin covers that "
                "for long, and nothing is proved for this run",
            )
    speeds = [own_speed(obstacle, scenario.time_limit) for obstacle in scenario.obstacles]
    for index, sensor in enumerate(built.sensors):
        if not sensor.TELLS:
            continue
        regions = echo_regions(scenario, sensor)
        fastest = max(range(len(speeds)), key=speeds.__getitem__, default=None)
        sees = not isinstance(sensor, Lidar) or sensor.sees_obstacles
        if fastest is not None and sees and speeds[fastest] > sensor.max_speed + ROUNDING:
            yield ResultWarning(
                BELOW_SAFE,
                f"sensors[{index}].max_speed",
                f"regions of what sensors[{index}] reads are sized for {sensor.max_speed:g} m/s, but "
                f"obstacles[{fastest}] moves at up to {speeds[fastest]:.4g} m/s: the robot may brake too late; give "
                f"max_speed={math.ceil(speeds[fastest] * 1e4 - 1e-4) / 1e4:g}",
            )
        if regions.active_radius > regions.reach:
            yield ResultWarning(
                REGION_BEYOND_RANGE,
                f"sensors[{index}].{sensor.RANGE}",
                f"sensors[{index}] reaches {regions.reach:.3g} m from the center of the robot, less than the active "
                f"radius {regions.active_radius:.3g} m of what it reads: what moves at {sensor.max_speed:g} m/s is "
                f"seen too late; give a larger {sensor.RANGE} or a smaller max_speed",
            )
        covered = least_reach(scenario.robot)
        if isinstance(sensor, Lidar) and sensor.range_min > max(covered - math.hypot(*sensor.mounting[:2]), 0.0):
            yield ResultWarning(
                BLIND_NEARBY,
                f"sensors[{index}].range_min",
                f"sensors[{index}] takes what is nearer than range_min, {sensor.range_min:.4g} m, to be that far away, "
                f"but the robot covers {covered:.4g} m around its center only: it may touch what the law takes to be "
                f"off; give a range_min of at most the radius",
            )


def _unseen_at_start(scenario: Scenario, vision: Vision | None) -> Iterator[ResultWarning]:
    """Warn of obstacles that the robot may be unable to stop for once a camera has first reported them."""
    if vision is None:
        return
    dropped = vision.drop_probability
    # n + 1 frames in a row are lost with the probability p^(n + 1).
    lost = max(math.ceil(math.log(LOST) / math.log(dropped)) - 1, 0) if dropped > 0.0 else 0
    blind = vision.delay + lost * vision.period
    if blind == 0.0:
        return
    robot = scenario.robot
    reaction = blind + scenario.control_period
    speed = min(robot.max_speed, robot.max_acceleration * reaction)
    way = speed * reaction + speed**2 / (2.0 * robot.deceleration)
    for index, obstacle in enumerate(scenario.obstacles):
        gap = math.inf if stands(obstacle) else _gap_at_start(scenario, obstacle)
        toward = own_speed(obstacle, scenario.time_limit) * (reaction + speed / robot.deceleration)
        if gap < way + toward:
            yield ResultWarning(
                UNSEEN_AT_START,
                f"obstacles[{index}]",
                f"obstacles[{index}] ({type(obstacle).__name__}) is {max(gap, 0.0):.3g} m from the robot at the start, "
                f"and obstacle_vision may first report it {blind:.3g} s later: until then the law treats the place as "
                f"free, and the robot may be unable to stop; keep {way + toward:.3g} m, or give a shorter delay",
            )


def _gap_at_start(scenario: Scenario, obstacle: Obstacle) -> float:
    """Return how far robot and obstacle are apart at the start in m, infinite for one who is absent then."""
    x, y = scenario.start
    if isinstance(obstacle, Mobile) and obstacle.path is not None:
        time, places = obstacle.path
        if not time[0] <= 0.0 <= time[-1]:
            return math.inf
        # Distances are from the first sample, which may be before the start.
        ahead = [np.interp(0.0, time, along).item() - along[0] for along in zip(*places, strict=True)]
        x, y = x - ahead[0], y - ahead[1]
    return distance(obstacle, (x, y)) - obstacle.contact_distance(scenario.robot.radius)


def late_cameras(scenario: Scenario, built: AsBuilt) -> Iterator[ResultWarning]:
    """Warn of critical regions that are too small for the delays of cameras, in which a robot brakes too late."""
    seen, own = (_delay(vision) for vision in (built.obstacle_vision, built.robot_vision))
    if seen == own == 0.0:
        return
    measurement, robot = scenario.measurement, scenario.robot
    error = own * robot.max_speed + (0.0 if measurement is None else measurement._native.error_bound())
    latency = max(seen, 0.0 if measurement is None else measurement.latency)
    for index, obstacle in enumerate(scenario.obstacles):
        radius, given = obstacle.critical_radius, obstacle.as_given()
        # Who stands is known without a delay, but for that of the robot itself.
        late = 0.0 if stands(obstacle) else latency
        safe = region_radii(robot, given, scenario.control_period, latency=late, position_error=error)
        if radius is not None and radius < safe.critical_radius - ROUNDING:
            told = " and ".join(
                f"{name} of {delay:g} s" for name, delay in (("obstacle_vision", seen), ("robot_vision", own)) if delay
            )
            yield ResultWarning(
                BELOW_SAFE,
                f"obstacles[{index}].critical_radius",
                f"critical_radius of obstacles[{index}] ({type(obstacle).__name__}) is {radius:.4g} m, below the "
                f"{safe.critical_radius:.4g} m in which the robot can stop with the delay of {told} (region_radii with "
                "latency and position_error); give regions for it",
            )


def _delay(vision: Vision | None) -> float:
    """Return how old positions are that a camera tells; one that moves them on to the present has none."""
    return 0.0 if vision is None or vision.compensated else vision.delay
