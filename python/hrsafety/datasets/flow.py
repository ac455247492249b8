"""Main direction of walking people: principal axis, middle and width."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["Flow", "flow_of"]

Array = npt.NDArray[np.float64]


@displayed
class Flow(NamedTuple):
    """Main direction in which people walk, and where.

    Attributes
    ----------
    center : tuple of float
        Middle of the stream (x, y) in m.
    direction : tuple of float
        Unit vector of the principal axis, pointing to where more of the way is walked.
    angle : float
        Angle of the direction to the x axis in rad, from -pi to pi.
    spread : float
        Standard deviation of the places across the stream at which people walk past the
        center, in m.
    """

    center: Annotated[tuple[float, float], "m"]
    direction: tuple[float, float]
    angle: Annotated[float, "rad"]
    spread: Annotated[float, "m"]


def flow_of(tracks: list[tuple[Array, Array]]) -> Flow:
    """Return the main flow of tracks (time in s, position in m); see `Recording.main_flow`."""
    axis = _principal_axis(tracks)
    across = np.array([-axis[1], axis[0]])
    ways = [(position @ axis, position @ across) for _, position in tracks]
    section = _middle_section([along for along, _ in ways])
    passages = (_first_passage(along, side, section) for along, side in ways)
    places = np.array([place for place in passages if place is not None])
    center = section * axis + float(np.median(places)) * across
    return Flow(
        center=(float(center[0]), float(center[1])),
        direction=(float(axis[0]), float(axis[1])),
        angle=math.atan2(axis[1], axis[0]),
        spread=float(np.std(places)),
    )


def _principal_axis(tracks: list[tuple[Array, Array]]) -> Array:
    """Return the unit vector along which the velocities vary most."""
    steps = np.concatenate([np.diff(position, axis=0) for _, position in tracks])
    spans = np.concatenate([np.diff(time) for time, _ in tracks])
    if not steps.any():
        raise InvalidParameterError("recording", "hold people who move", Shown("nobody who does"))
    scatter = np.einsum("ni,nj,n->ij", steps, steps, 1.0 / spans)
    axis: Array = np.linalg.eigh(scatter)[1][:, 1]
    net = float(steps.sum(axis=0) @ axis)
    if net < 0.0 or (net == 0.0 and (axis[0] < 0.0 or (axis[0] == 0.0 and axis[1] < 0.0))):
        axis = -axis
    return axis + 0.0


def _middle_section(ways: list[Array]) -> float:
    """Return the place along the flow before which half of the way is walked."""
    low = np.concatenate([np.minimum(way[:-1], way[1:]) for way in ways])
    high = np.concatenate([np.maximum(way[:-1], way[1:]) for way in ways])
    ends = np.unique(np.concatenate([low, high]))
    people = np.searchsorted(np.sort(low), ends[:-1], side="right") - np.searchsorted(
        np.sort(high), ends[:-1], side="right"
    )
    walked = np.concatenate([[0.0], np.cumsum(people * np.diff(ends))])
    return float(np.interp(0.5 * walked[-1], walked, ends))


def _first_passage(along: Array, side: Array, section: float) -> float | None:
    """Return where across the flow a way meets a section first, if it does."""
    ahead = along - section
    meets = np.flatnonzero((ahead[:-1] * ahead[1:] <= 0.0) & (ahead[:-1] != ahead[1:]))
    if len(meets) == 0:
        return None
    k = int(meets[0])
    share = ahead[k] / (ahead[k] - ahead[k + 1])
    return float(side[k] + share * (side[k + 1] - side[k]))
