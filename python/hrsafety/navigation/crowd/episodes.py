"""Episodes of the robots of a world: encounters and outcomes."""

from __future__ import annotations

from typing import Any

from hrsafety._arguments import Array
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.sources import fields_in

__all__ = ["episodes_in", "outcome_of"]


def episodes_in(
    world: World,
    robot_position: Array,
    position: Array,
    radius: Array,
    *,
    robot_heading: Array | None = None,
    **beside: Any,
) -> list[Episode]:
    """Return what each robot of a world met, to be scored.

    Parameters
    ----------
    world : World
        The world.
    robot_position : ndarray of shape (n, k, 2)
        Positions of the robots in m.
    position : ndarray of shape (n, m, 2)
        Positions of the people in m; NaN for those who are absent.
    radius : ndarray of shape (m,)
        Radii of the people in m.
    robot_heading : ndarray of shape (n, k) or None
        Headings of the robots in rad, which those with a footprint need.
    **beside
        More of an `Episode`: its warnings, the people of the world without its robots.

    Returns
    -------
    list of Episode
        One for each robot. Other robots are no people.
    """
    places = (robot_position, position, radius)
    return [
        Episode(**fields_in(world, index, places, robot_heading), simulated=True, **beside)
        for index in range(len(world.robots))
    ]


def outcome_of(*, touched: bool, arrived: bool, diverged: bool) -> str:
    """Return what became of a robot of a world.

    Parameters
    ----------
    touched : bool
        Whether the robot touched people, but those who appeared where it was, or walls.
    arrived, diverged : bool
        Whether the robot has arrived, and whether the world has diverged.

    Returns
    -------
    str
        A word of `OUTCOMES`.
    """
    # Who had arrived before the world diverged did so with the contacts that it had.
    if diverged and not arrived:
        return "diverged"
    if touched:
        return "collided"
    return "arrived" if arrived else "timed_out"
