"""Situation of a controller at a sample: the robot, the goal and the obstacles as measured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety._records import dataclass

__all__ = ["PointMass", "Situation", "point_mass_of", "situation_of"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class PointMass:
    """Point mass that a law drives: the robot, or the one that a two-wheel robot follows.

    Attributes
    ----------
    mass : float
        In kg.
    radius : float
        In m.
    max_speed, max_acceleration, max_deceleration : float
        Limits that the robot keeps, whatever force is asked for, in m/s and m/s^2.
    """

    mass: Annotated[float, "kg"]
    radius: Annotated[float, "m"]
    max_speed: float
    max_acceleration: float
    max_deceleration: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Situation:
    """Situation of a controller at a sample: m obstacles, everything as measured.

    Attributes
    ----------
    time : float
        In s.
    position, velocity : ndarray, shape (2,)
        Of the robot, in m and m/s.
    heading : float
        Of the robot, in rad.
    goal : ndarray, shape (2,)
        In m; where a guide leads the law, the local goal on the way.
    obstacle_present : ndarray of bool, shape (m,)
        Whether an obstacle is there.
    obstacle_position, obstacle_velocity : ndarray, shape (m, 2)
        In m (centroid of a rectangle) and m/s; NaN while an obstacle is absent.
    obstacle_radius : ndarray, shape (m,)
        Radius of a disc in m; NaN for a rectangle.
    obstacle_size : ndarray, shape (m, 2)
        Length and width of a rectangle in m; NaN for a disc.
    obstacle_heading : ndarray, shape (m,)
        Direction of the length of a rectangle in rad; NaN for a disc.
    active_radius, critical_radius : ndarray, shape (m,)
        Radii r_2 and r_3 of the regions in m.
    robot : PointMass
        What the law drives.
    control_period : float
        Time until the next sample, in s.
    """

    time: float
    position: Array
    velocity: Array
    heading: float
    goal: Array
    obstacle_present: npt.NDArray[np.bool_]
    obstacle_position: Array
    obstacle_velocity: Array
    obstacle_radius: Array
    obstacle_size: Array
    obstacle_heading: Array
    active_radius: Array
    critical_radius: Array
    robot: PointMass
    control_period: float


def point_mass_of(given: tuple[float, float, float, float, float]) -> PointMass:
    """Return the point mass with native numbers."""
    mass, radius, speed, acceleration, deceleration = given
    return PointMass(
        mass=mass, radius=radius, max_speed=speed, max_acceleration=acceleration, max_deceleration=deceleration
    )


def situation_of(fields: Mapping[str, Any], robot: PointMass, goal: Array) -> Situation:
    """Return the situation with native fields; its arrays cannot be written to."""
    for value in fields.values():
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
    return Situation(robot=robot, goal=goal, **fields)


def fixed(values: tuple[float, float]) -> Array:
    """Return a pair as an array that cannot be written to."""
    array = np.array(values)
    array.flags.writeable = False
    return array
