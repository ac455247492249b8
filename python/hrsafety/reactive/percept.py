"""Percept of a robot with sound and sonar at a sample."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety._records import dataclass

__all__ = ["Percept", "percept_of"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Percept:
    """Percept of a robot with sound and sonar at a sample.

    Attributes
    ----------
    time : float
        In s.
    position, velocity : ndarray of shape (2,)
        Of the robot, in m and m/s over ground.
    heading : float
        Of the robot, in rad.
    readings : ndarray of shape (sensors,)
        Last reading of each sensor in m; infinite without an echo, or the largest reading of a ring.
    source_range, source_bearing : float or None
        Of a sound, in m and rad from the front, counterclockwise; ``None`` between two bursts.
    obstacle_position : ndarray of shape (m, 2)
        Obstacles as a camera knows them, in m; of shape (0, 2) without a camera.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.SkirtSteps().observe().readings.shape
    (9,)
    """

    time: Annotated[float, "s"]
    position: Annotated[Array, "m"]
    velocity: Array
    heading: Annotated[float, "rad"]
    readings: Annotated[Array, "m"]
    source_range: Annotated[float | None, "m"]
    source_bearing: Annotated[float | None, "rad"]
    obstacle_position: Annotated[Array, "m"]


def percept_of(fields: Mapping[str, Any]) -> Percept:
    """Return what there is with native fields; its arrays cannot be written to."""
    for value in fields.values():
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
    return Percept(**fields)
