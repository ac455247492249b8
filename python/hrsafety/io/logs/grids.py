"""The map of a bag: an occupancy grid as walls."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hrsafety._arguments import positive
from hrsafety._bounds import MOST_CELLS
from hrsafety.errors import FileError, Shown
from hrsafety.navigation.maps.map_server import doubts_of_place
from hrsafety.navigation.maps.parts import Cells
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["map_of"]

FREE_BELOW = 20
"""Cells of an occupancy below it, in percent, are free: the default of the map server; all others that are known are
occupied."""


def map_of(message: Any, place: str) -> StaticMap:
    """Return the walls of a decoded nav_msgs/OccupancyGrid; unknown cells are no walls, and not seen.

    Parameters
    ----------
    message : object
        Decoded.
    place : str
        File and topic, for errors.
    """
    about = message.info
    shape, cells = (int(about.height), int(about.width)), np.asarray(message.data, dtype=np.int16)
    if shape[0] * shape[1] != len(cells) or not 0 < len(cells) <= MOST_CELLS:
        found = Shown(f"{len(cells)} cells for {shape[1]} x {shape[0]}")
        raise FileError(place, "hold width times height cells", found, code="unreadable")
    grid = cells.reshape(shape)
    origin, turned = about.origin.position, about.origin.orientation
    yaw = math.atan2(
        2.0 * (turned.w * turned.z + turned.x * turned.y), 1.0 - 2.0 * (turned.y * turned.y + turned.z * turned.z)
    )
    corner = (float(origin.x), float(origin.y))
    if not all(map(math.isfinite, (*corner, yaw))):
        raise FileError(place, "have a finite origin", Shown(str((*corner, yaw))), code="unreadable_number")
    size = positive(f"{place}: resolution", float(about.resolution))
    bits, unseen = np.packbits(grid >= FREE_BELOW).tobytes(), np.packbits(grid < 0).tobytes()
    walls = Cells(bits, shape, size, corner, yaw, True, unseen)
    return StaticMap(grids=[walls], warnings=doubts_of_place(size, corner, yaw))
