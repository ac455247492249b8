"""Warnings of laws that make their own map of scans: movers, and plans that are not verified."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety.navigation.knowledge import told_by
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scan_controller import POSITION_TRACKING, SCAN_TIMEOUT
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.plausibility import ResultWarning

__all__ = ["MOVERS_UNWATCHED", "standing", "unwatched"]

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
    if not getattr(law, "MAPS_SCANS", False):
        return
    if movers:
        message = (
            f"the law takes what its lidars see for standing, but {movers} around the robot may move: nothing keeps it "
            "from driving into their way; nothing is proved for this run"
        )
        yield ResultWarning(MOVERS_UNWATCHED, "law", message)
    if not getattr(law, "verify", True):
        message = "plans are not verified: nothing keeps the robot from contact"
        yield ResultWarning("not_verified", "law.verify", message)


def standing(law: object, measurement: Measurement | None, built: AsBuilt) -> Iterator[ResultWarning]:
    """Yield why a robot under a law that makes its own map of scans may stand still.

    Parameters
    ----------
    law : Law or None
        What drives the robot.
    measurement : Measurement or None
        Of the scenario or robot.
    built : AsBuilt
        Its sensors.

    Yields
    ------
    ResultWarning
        With the codes ``"scans_too_late"`` and ``"pose_off_plan"``, both on the safe side; nothing for other laws.
    """
    if not getattr(law, "MAPS_SCANS", False):
        return
    for index, sensor in enumerate(built.sensors):
        if isinstance(sensor, Lidar) and sensor.latency > SCAN_TIMEOUT:
            message = (
                f"scans of sensors[{index}] are {sensor.latency:.4g} s old when they arrive, and the robot brakes "
                f"after {SCAN_TIMEOUT:g} s without a scan: it never drives"
            )
            yield ResultWarning("scans_too_late", f"sensors[{index}].latency", message, safe_side=True)
    source = told_by(measurement, built).robot
    if source in ("measurement", "camera"):
        message = (
            f"the pose comes from a {source} with errors: the robot brakes whenever it seems to be more than "
            f"{POSITION_TRACKING:g} m off its plan, and may stand still; a robot reckons its own way by Odometry"
        )
        yield ResultWarning("pose_off_plan", "law", message, safe_side=True)
