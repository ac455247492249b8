"""Speed past a corner behind which a person may be who is not seen yet, in closed form."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import finite, number, numbers, word
from hrsafety.errors import InvalidParameterError

__all__ = ["blind_corner_speed"]

Array = npt.NDArray[np.float64]

EDGES = ("near", "far", "both")


def blind_corner_speed(
    offset: npt.ArrayLike,
    distance: npt.ArrayLike | None = None,
    *,
    edge: Literal["near", "far", "both"] = "both",
    robot_radius: float,
    deceleration: float,
    max_speed: float,
    person_radius: float = 0.3,
    person_speed: float = 1.6,
    person_core: float = 0.15,
    wall_thickness: float = 0.1,
    margin: float = 0.0,
    latency: float = 0.0,
    control_period: float = 0.05,
) -> Array:
    """Return the largest speeds past openings in a wall at which no person hidden behind it is driven into.

    The robot drives straight along a wall with an opening. At the speed v it comes to rest before a person who steps
    out of the nearest hidden place K reaches the half disc ahead of it:
    ``hypot(max(K_x - v (L + T) - v^2/(2 a), 0), K_y) >= R + v_h (L + T + v/a)`` with R the sum of radii and margin. The
    straight way of the person bounds every other one, so a person behind the wall never is faster.

    Parameters
    ----------
    offset : array_like
        Distance w in m of the wall's near face beside the center of the robot.
    distance : array_like or None
        Distance d in m along the course to the edge, broadcast with ``offset``. ``None``: wherever the far edge is,
        ahead or already passed, ``a ((w + q + r_k - R)/v_h - L - T)``; ``edge`` has no part in it.
    edge : {"near", "far", "both"}
        Edge at that distance: the one that the robot passes first, the other one, or the slower of the two.
    robot_radius, person_radius : float
        Radii in m of contact.
    deceleration, max_speed : float
        Deceleration a of the robot in m/s^2 and its largest speed in m/s.
    person_speed : float
        Largest speed v_h of people in m/s; 1.6 m/s is that of ISO 13855.
    person_core : float
        Radius r_k in m of the core of a person, which never overlaps a wall and ends every beam that meets it.
    wall_thickness : float
        Thickness q of the wall in m.
    margin : float
        Margin of the shield in m.
    latency, control_period : float
        Age L in s of a measured position when the command takes effect, and control period T in s.

    Returns
    -------
    ndarray
        Speeds in m/s, at most ``max_speed``; 0 where the robot would have to stand.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, or a distance is not positive and the edge is not given as passed.

    Notes
    -----
    The closed forms are those of one straight wall with one edge and one person, of a robot that sees all round
    without errors and holds its course; give what it does not know as ``margin`` and ``latency``. Among several
    corners take the least. A person may still walk into the robot at rest.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> robot = dict(robot_radius=0.2, deceleration=2.0, max_speed=3.0, margin=0.005, latency=0.05)
    >>> float(nav.laws.blind_corner_speed(0.6, 0.4, edge="near", **robot).round(6))
    0.622569
    >>> float(nav.laws.blind_corner_speed(0.6, **robot).round(5))
    0.23125
    """
    which = word("edge", edge, EDGES)
    beside = numbers("offset", offset)
    ahead = np.ones_like(beside) if distance is None else numbers("distance", distance)
    for name, values in (("offset", beside), ("distance", ahead)):
        if values.size and not (np.isfinite(values).all() and (values > 0.0).all()):
            wrong = values[~(np.isfinite(values) & (values > 0.0))].flat[0]
            remedy = "leave distance out for an edge beside or behind the robot" if name == "distance" else None
            raise InvalidParameterError(name, "be finite and positive", float(wrong), remedy)
    try:
        ahead, beside = np.broadcast_arrays(ahead, beside)
    except ValueError:
        shapes = f"shapes {ahead.shape} and {beside.shape}"
        raise InvalidParameterError("distance", "broadcast with offset", shapes) from None
    places = np.ascontiguousarray(np.stack([ahead.ravel(), beside.ravel()], axis=1), dtype=np.float64)
    speeds = _hrsafety.blind_corner_speeds(
        places,
        robot_radius=number("robot_radius", robot_radius),
        person_radius=number("person_radius", person_radius),
        person_core=number("person_core", person_core),
        margin=number("margin", margin),
        wall_thickness=number("wall_thickness", wall_thickness),
        person_speed=number("person_speed", person_speed),
        latency=number("latency", latency),
        control_period=number("control_period", control_period),
        deceleration=number("deceleration", deceleration),
        max_speed=finite("max_speed", max_speed),
    )
    if distance is None:
        found = speeds[:, 2]
    else:
        found = {"near": speeds[:, 0], "far": speeds[:, 1], "both": speeds[:, :2].min(axis=1)}[which]
    return found.reshape(ahead.shape)
