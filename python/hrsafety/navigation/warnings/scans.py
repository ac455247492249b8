"""Warnings of laws that make their own map of scans: movers, and plans that are not verified."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety.navigation.knowledge import OF_REGIONS, told_by, warnings_of
from hrsafety.navigation.laws.arc_rollouts import ArcRollouts
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scan_controller import POSITION_TRACKING, SCAN_TIMEOUT
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.warnings.shields import object_of
from hrsafety.navigation.warnings.walls import NOT_THERE
from hrsafety.plausibility import ResultWarning

__all__ = ["MOVERS_UNWATCHED", "of_object", "of_robot", "unwatched"]

ROUNDING = 1e-9
MOVERS_UNWATCHED = "movers_unwatched"
"""Code of people and things that move around a law that takes all it sees for standing."""


def unwatched(law: object, movers: int) -> Iterator[ResultWarning]:
    """Yield the doubts of a law that makes its own map of scans.

    Parameters
    ----------
    law : Law or None
        What drives the robot.
    movers : int
        People, robots and things around it that may move.

    Yields
    ------
    ResultWarning
        With the codes ``"movers_unwatched"`` and ``"not_verified"``; nothing for other laws.
    """
    if not isinstance(law, ArcRollouts):
        return
    if movers:
        message = (
            f"the law takes what its lidars see for standing, but {movers} around the robot may move: nothing keeps it "
            "from driving into their way; nothing is proved for this run"
        )
        yield ResultWarning(MOVERS_UNWATCHED, "law", message)
    if not law.verify:
        message = "plans are not verified: nothing keeps the robot from contact"
        yield ResultWarning("not_verified", "law.verify", message)


def of_object(
    law: object,
    robot: HolonomicRobot | DifferentialDriveRobot,
    built: AsBuilt | None,
    time_limit: float,
    *,
    walls: bool,
) -> Iterator[ResultWarning]:
    """Yield doubts about the object in Python within a law: its own about its robot, and walls that are not there.

    Parameters
    ----------
    law : Law or None
        What drives the robot.
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot.
    built : AsBuilt or None
        Its sensors.
    time_limit : float
        Of the run, in s.
    walls : bool
        Whether walls stand there.

    Yields
    ------
    ResultWarning
        With codes of the object, and ``"walls_not_there"``.
    """
    own = object_of(law)
    if getattr(own, "known_map", None) is not None and not walls:
        message = (
            "the law knows walls that do not stand in the scene: the robot passes through them, and no contact with "
            "them is counted; give them to the scene as well, as walls="
        )
        yield ResultWarning(NOT_THERE, "law", message)
    ask = getattr(own, "doubts_of", None)
    if callable(ask):
        yield from ask(robot, () if built is None else built.sensors, time_limit)


def of_robot(scenario: Scenario, law: object, built: AsBuilt) -> Iterator[ResultWarning]:
    """Yield the doubts about the sensors and wheels of a robot that matter for its law.

    Parameters
    ----------
    scenario : Scenario
        Where it runs.
    law : Law or None
        What drives it. One that makes its own map of scans has no regions, and plans of its own.
    built : AsBuilt
        How it is built.

    Yields
    ------
    ResultWarning
        Those of `hrsafety.navigation.knowledge.warnings_of`; for a law with a map of its own ``"scans_too_late"`` and
        ``"pose_off_plan"``, both on the safe side, ``"scans_too_noisy"`` and ``"wheels_lag"``, too.
    """
    no_regions = isinstance(law, ArcRollouts) or getattr(object_of(law), "without_regions", False)
    yield from (each for each in warnings_of(scenario, built) if not (no_regions and each.code in OF_REGIONS))
    if isinstance(law, ArcRollouts):
        yield from _of_rollouts(law, scenario, built)


def _of_rollouts(law: ArcRollouts, scenario: Scenario, built: AsBuilt) -> Iterator[ResultWarning]:
    if built.wheels is not None:
        message = (
            "plans are those of a robot that takes up each twist evenly; wheels with motors lag and slip, and that "
            "they are off a plan is noticed afterwards: nothing is proved for this run"
        )
        yield ResultWarning("wheels_lag", "wheels", message)
    for index, sensor in enumerate(built.sensors):
        if isinstance(sensor, Lidar) and sensor.range_noise > law.margin + ROUNDING:
            message = (
                f"ranges of sensors[{index}] have a standard deviation of {sensor.range_noise:.4g} m, more than the "
                f"margin of {law.margin:.4g} m from occupied cells, which is to cover errors of the map: nothing is "
                "proved for this run; give a larger margin"
            )
            yield ResultWarning("scans_too_noisy", f"sensors[{index}].range_noise", message)
        if isinstance(sensor, Lidar) and sensor.latency > SCAN_TIMEOUT:
            message = (
                f"scans of sensors[{index}] are {sensor.latency:.4g} s old when they arrive, and the robot brakes "
                f"after {SCAN_TIMEOUT:g} s without a scan: it never drives"
            )
            yield ResultWarning("scans_too_late", f"sensors[{index}].latency", message, safe_side=True)
    source = told_by(scenario.measurement, built).robot
    if source in ("measurement", "camera"):
        message = (
            f"the pose comes from a {source} with errors: the robot brakes whenever it seems to be more than "
            f"{POSITION_TRACKING:g} m off its plan, and may stand still; a robot reckons its own way by Odometry"
        )
        yield ResultWarning("pose_off_plan", "law", message, safe_side=True)
