"""Closed loop of a robot in a place that it knows from its scans alone: what is there, what it measures, contacts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from hrsafety import _hrsafety
from hrsafety.navigation.laws.arc_rollouts import ArcRollouts
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot
from hrsafety.navigation.scan_controller import outline_of, twist_limits
from hrsafety.navigation.sensing.lidar import Lidar

__all__ = ["unknown_trial"]


def unknown_trial(
    rollouts: ArcRollouts,
    robot: DifferentialDriveRobot,
    place: StaticMap,
    lidar: Lidar,
    *,
    start: Sequence[float],
    heading: float,
    goal: Sequence[float],
    control_period: float = 0.05,
    arrival_tolerance: float = 1.0,
    time_limit: float = 100.0,
    length_drift: float = 0.0,
    heading_drift: float = 0.0,
    late: int = 0,
    seed: int = 0,
    timed: bool = False,
) -> dict[str, Any]:
    """Run an episode: commands act at once, contact and arrival of the exact outline are looked for every 1/20 period.

    Parameters
    ----------
    rollouts : ArcRollouts
        How the robot finds its way.
    robot : DifferentialDriveRobot
        Its speeds, accelerations and footprint.
    place : StaticMap
        What is there, of which the robot knows what its lidar shows.
    lidar : Lidar
        Mounting, beams, noise and dropouts; its own map does not count.
    start, heading, goal : (float, float), float, (float, float)
        In m and rad; the goal in the frame of the odometry.
    control_period, arrival_tolerance, time_limit : float
        In s, m and s.
    length_drift, heading_drift : float
        Share by which lengths of the odometry are wrong, and rad in each m; signs are drawn.
    late : int
        Control periods by which scans come late.
    seed : int
        Of noise, dropouts and signs.
    timed : bool
        Whether decisions are timed.

    Returns
    -------
    dict
        ``outcome``, ``arrival_time`` from leaving 0.1 m around the start and ``end_time`` in s, ``clearance`` and
        ``path_length`` in m, ``recoveries``, ``braking`` periods, ``poses`` (n, 3), ``decision_times`` in s.
    """
    return _hrsafety.unknown_trial(
        rollouts._native,
        outline_of(robot)._native,
        twist_limits(robot),
        control_period,
        place._native,
        start=start,
        heading=heading,
        goal=goal,
        arrival_tolerance=arrival_tolerance,
        time_limit=time_limit,
        lidar=lidar._lidar,
        length_drift=length_drift,
        heading_drift=heading_drift,
        late=late,
        seed=seed,
        timed=timed,
    )
