"""Walls that a law does not know."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.warnings.shields import maps_of
from hrsafety.plausibility import ResultWarning

__all__ = ["UNKNOWN_WALL", "unknown_walls"]

UNKNOWN_WALL = "unknown_wall"
"""Code of a law that does not know a wall of its world."""
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
