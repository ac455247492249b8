"""What the robots of a world met, and what became of them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from hrsafety._arguments import Array
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.outcomes import OUTCOMES

__all__ = ["WORLD_OUTCOMES", "episodes_in", "outcome_of"]

WORLD_OUTCOMES: Mapping[str, str] = MappingProxyType(
    {word: said for word, said in OUTCOMES.items() if word != "stopped"}
    | {"diverged": "a state of the world was no longer finite"}
)
"""What each outcome of a robot in a world says, by its word: those of other runs, and ``"diverged"``."""


def episodes_in(world: World, robot_position: Array, position: Array, radius: Array, **beside: Any) -> list[Episode]:
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
    **beside
        More of an `Episode`: its warnings, the people of the world without its robots.

    Returns
    -------
    list of Episode
        One for each robot. Other robots are no people.
    """
    groups = [-1 if person.group is None else person.group for person in world.people]
    groups += [-1] * (len(radius) - len(groups))
    grouped = any(group >= 0 for group in groups)
    return [
        Episode(
            position=robot_position[:, index],
            step=world.step,
            goal=robot.goal,
            robot_radius=robot.robot.radius,
            people=position,
            person_radius=radius,
            groups=groups if grouped else (),
            walls=world.walls,
            arrival_tolerance=robot.arrival_tolerance,
            max_speed=robot.robot.max_speed,
            period=world.period,
            simulated=True,
            **beside,
        )
        for index, robot in enumerate(world.robots)
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
        A word of `WORLD_OUTCOMES`.
    """
    # Who had arrived before the world diverged did so with the contacts that it had.
    if diverged and not arrived:
        return "diverged"
    if touched:
        return "collided"
    return "arrived" if arrived else "timed_out"
