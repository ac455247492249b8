"""Walls that a law does not know."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hrsafety._arguments import Array
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.warnings.shields import maps_of
from hrsafety.plausibility import ResultWarning

__all__ = ["NOT_THERE", "UNKNOWN_WALL", "passed_walls", "unknown_walls"]

NOT_THERE = "walls_not_there"
"""Code of walls that a law knows and that do not stand in the scene."""

UNKNOWN_WALL = "unknown_wall"
"""Code of a law that does not know a wall of its world."""
TOUCH = 1e-6
"""Overlap in m from which two bodies touch; a footprint that overlaps a wall is at a distance of 0."""
APART = 0.05
"""Distance in m of a wall from all that a law knows, beyond which it does not know the wall: a cell of common maps."""


def unknown_walls(walls: StaticMap, law: object, sensed: Sequence[StaticMap | None]) -> Iterator[ResultWarning]:
    """Yield a warning if a law does not know the walls of its world.

    Parameters
    ----------
    walls : StaticMap
        What stands.
    law : Law or None
        What drives the robot; no person who stands drives into a wall.
    sensed : sequence of StaticMap or None
        Maps of its lidars.

    Yields
    ------
    ResultWarning
        How many of the ends and middles of the walls it does not know, and where the first one is.
    """
    segments = np.asarray(walls._native.segments())
    if law is None or not len(segments):
        return
    begin, end = segments[:, :2], segments[:, 2:4]
    places = np.concatenate([begin, 0.5 * (begin + end), end])
    known = [*maps_of(law), *(each for each in sensed if each is not None)]
    gaps = [np.asarray(each.clearance(places)) for each in known]
    missed = np.ones(len(places), dtype=bool) if not gaps else np.min(gaps, axis=0) > APART
    if missed.any():
        x, y = places[int(np.argmax(missed))]
        message = (
            f"the law does not know {int(missed.sum())} of {len(places)} ends and middles of the walls, first that at "
            f"({x:.4g}, {y:.4g}) m, and may drive into them: give SafeNavigation(law, map=...), or the robot a Lidar"
        )
        yield ResultWarning(UNKNOWN_WALL, "law", message)


def passed_walls(
    maps: Sequence[StaticMap],
    robot: HolonomicRobot | DifferentialDriveRobot,
    position: Array,
    heading: Array,
    gap: Array,
) -> Iterator[ResultWarning]:
    """Yield a warning if a robot touches walls that its law knows and that do not stand in its world.

    Parameters
    ----------
    maps : sequence of StaticMap
        What its law knows.
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot.
    position : ndarray, shape (n, 2)
        Where it was in m.
    heading : ndarray, shape (n,)
        In rad.
    gap : ndarray, shape (n,)
        Distance of its center from the walls of the world in m.

    Yields
    ------
    ResultWarning
        Where it is deepest in them: contacts are counted with the walls of the world only.
    """
    outline = robot.footprint
    for map in maps:
        # A wall of the world that is as near, but for a cell, is the same one.
        cell = max((grid.resolution for grid in map.grids), default=0.0)
        near = np.asarray(map.clearance(position))
        alone = (near < gap - max(APART, cell)) & (near < robot.radius)
        if not alone.any():
            continue
        if outline is None:
            touched = near[alone] < robot.radius - TOUCH
        else:
            touched = outline.clearance(map, position[alone], heading[alone]) < TOUCH
        if touched.any():
            x, y = position[alone][int(np.argmax(touched))]
            message = (
                f"the robot touches walls, first at ({x:.4g}, {y:.4g}) m, that its law knows and that do not stand in "
                "the world: it passes through them, and no contact with them is counted; give them to the world as "
                "well, as walls="
            )
            yield ResultWarning(NOT_THERE, "law", message)
            return
