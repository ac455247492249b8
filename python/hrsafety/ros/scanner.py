"""The lidar of a bridge: sectors of beams, each of which looks at the people in its way only."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from hrsafety._arguments import Array
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.ros.floor import Crowd
from hrsafety.ros.messages import Pose

__all__ = ["Scanner"]

_BEAMS = 60
"""Beams of a sector."""
_FEW = 50
"""Fewer people than that all beams look at."""
_ROUNDING = 1e-9


class Scanner:
    """A lidar in the middle of a robot.

    Parameters
    ----------
    lidar : Lidar
        Beams, ranges and the walls that it sees.
    """

    def __init__(self, lidar: Lidar) -> None:
        self.lidar = lidar
        bearings = lidar.bearings
        if any(lidar.mounting):
            raise InvalidParameterError("lidar.mounting", "be (0, 0, 0) in a bridge", lidar.mounting)
        # Noise and dropouts are drawn for all beams at once.
        drawn = max(lidar.range_noise, lidar.dropout) > 0.0
        parts = 1 if drawn or len(bearings) < 2 * _BEAMS else len(bearings) // _BEAMS
        self._sectors = (
            [(lidar, 0.0)] if parts == 1 else [_sector(lidar, each) for each in np.array_split(bearings, parts)]
        )
        self._middle = np.array([middle for _, middle in self._sectors])
        self._half = np.array([0.5 * sector.field_of_view if parts > 1 else math.pi for sector, _ in self._sectors])

    def scan(self, pose: Pose, crowd: Crowd) -> Array:
        """Return the ranges of all beams in m, the greatest one where nothing is hit, shape (beams,)."""
        x, y = (crowd.position - pose[:2]).T
        away = np.hypot(x, y)
        near = away - crowd.radius < self.lidar.range_max
        discs = np.column_stack([crowd.position, crowd.radius])[near]
        if len(discs) < _FEW or len(self._sectors) == 1:
            return self.lidar.scan(pose[:2], pose.yaw, people=discs)
        away = away[near]
        width = np.where(
            away > discs[:, 2], np.arcsin(np.minimum(1.0, discs[:, 2] / np.maximum(away, _ROUNDING))), math.pi
        )
        ahead = np.arctan2(y[near], x[near]) - pose.yaw - self._middle[:, None]
        ahead -= math.tau * np.round(ahead / math.tau)
        seen = np.abs(ahead) <= width + self._half[:, None] + _ROUNDING
        place = pose[:2]
        parts = zip(self._sectors, seen, strict=True)
        return np.concatenate([each._lidar.scan((*place, pose.yaw + to), discs[row], 0) for (each, to), row in parts])


def _sector(lidar: Lidar, bearings: Array) -> tuple[Lidar, float]:
    """Return a lidar with a part of the beams, and where it looks, in rad."""
    first, last = float(bearings[0]), float(bearings[-1])
    return replace(lidar, beams=len(bearings), field_of_view=last - first, angle_min=None), 0.5 * (first + last)
