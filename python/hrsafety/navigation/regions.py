"""Regions around obstacles in which a robot can still stop or step aside."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import instance, number
from hrsafety._display import displayed
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.sensing.measurement import Measurement

__all__ = ["Regions", "region_radii"]


@displayed
class Regions(NamedTuple):
    """Radii of the regions of one obstacle.

    Attributes
    ----------
    critical_radius : float
        Radius r_3 of the critical region, in m.
    active_radius : float
        Radius r_2 of the active region, in m.
    """

    critical_radius: Annotated[float, "m"]
    active_radius: Annotated[float, "m"]


def region_radii(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacle: Obstacle,
    control_period: float = 0.06,
    faced_side: float | None = None,
    *,
    latency: float | None = None,
    position_error: float | None = None,
    measurement: Measurement | None = None,
) -> Regions:
    """Return the smallest safe regions of an obstacle, Zeng (2011), section 5.3.

    The robot stops within ``delta_r = V T_s + a dt1^2 / 2`` with ``dt1 = V/a``, while a moving
    obstacle comes ``delta_o = V_o (dt1 + T_s)`` closer::

        disc, person   r_3 = delta_r + delta_o + rho_o + rho_r + delta
                       r_2 = (V + V_o) (dt2 + T_s) + delta,   dt2 = (r_3 - a t_a^2 / 2)/V + t_a
        rectangle      r_3 = delta_r + rho_r + delta
                       r_2 = V (dt2 + T_s) + delta,   dt2 = (r_3 + B - a t_a^2 / 2)/V + t_a

    with ``t_a = V/a`` and B half the side that is faced. A differential-drive robot needs
    ``sqrt(pi / alpha_max)`` more for the turn.

    ``delta`` is not in the source, which knows positions exactly: the most by which the known
    distance can exceed the true one. A measured body has gone ``speed * latency`` since, at most V_o
    an obstacle and V the robot, and each measured position errs by at most ``sqrt(2) scale`` with
    uniform and ``8 scale`` with Gaussian noise. Obstacles at rest are known exactly; their delta is
    above 0 where the robot's own position is measured. It bounds the distance and not the velocity:
    a robot that measures its own position brakes against a velocity that is noisy and late, too.

    Parameters
    ----------
    robot : HolonomicRobot or DifferentialDriveRobot
        Its limits.
    obstacle : Obstacle
        Radii that the obstacle has already are not examined.
    control_period : float
        Control period T_s in s.
    faced_side : float or None
        Side of a rectangle that the robot faces, in m; the longer one when ``None``.
    latency : float or None
        Age of the measured positions in s; that of ``measurement`` when ``None``. Without a
        measurement it is the age of the obstacle's position.
    position_error : float or None
        Largest error of the measured distance in m, whoever is measured; the bound that follows from
        ``measurement`` when ``None``.
    measurement : Measurement or None
        How positions are measured; exactly when ``None``. A `Scenario` uses its own.

    Returns
    -------
    Regions
        critical_radius and active_radius in m.

    Raises
    ------
    InvalidParameterError
        If a value is not finite and positive, latency or position_error is negative, or faced_side
        is given for a round obstacle.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> radii = nav.region_radii(nav.HolonomicRobot(), nav.Human(start=(0, 0), velocity=(1, 0)))
    >>> [round(radius, 4) for radius in radii]
    [0.7965, 2.0959]
    >>> late = nav.region_radii(
    ...     nav.HolonomicRobot(), nav.Human(start=(0, 0), velocity=(1, 0)), latency=0.1, position_error=0.03
    ... )
    >>> [round(radius, 4) for radius in late]
    [0.9265, 2.5416]
    """
    instance("robot", robot, HolonomicRobot, DifferentialDriveRobot)
    instance("obstacle", obstacle, Obstacle)
    if measurement is not None:
        instance("measurement", measurement, Measurement)
    critical, active = _hrsafety.region_radii(
        robot._native,
        obstacle._native,
        number("control_period", control_period),
        _number_or_none("faced_side", faced_side),
        _number_or_none("latency", latency),
        _number_or_none("position_error", position_error),
        None if measurement is None else measurement._native,
    )
    return Regions(critical, active)


def _number_or_none(name: str, value: object) -> float | None:
    return None if value is None else number(name, value)
