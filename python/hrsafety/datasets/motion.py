"""Velocities and accelerations of recorded people, with what their estimates pass and how exact they are."""

from __future__ import annotations

import math
from typing import Annotated, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._display import displayed
from hrsafety._tracks import Ways, cutoff, fitted_rows, motion_of_ways, position_noise

__all__ = ["RecordedMotion", "motion_of"]

Array = npt.NDArray[np.float64]

AGREEMENT = 0.2
"""Stored velocities are believed if half of them differ by less from differences of positions, as a share."""
LEAST_SPEED = 0.2
"""Slower ones are not compared, in m/s."""
SLOW_SAMPLING = 0.2
"""With more time between rows, in s, velocities are differences."""
DIFFERENCES = 0.221
"""Differences over two steps pass 0.71 of a motion at this frequency times the step."""


@displayed
class RecordedMotion(NamedTuple):
    """Velocities and accelerations of recorded people.

    Attributes
    ----------
    velocity : ndarray, shape (n, 2)
        In m/s, NaN for a person with one row.
    acceleration : ndarray, shape (n, 2)
        In m/s^2, NaN where there are no fits.
    velocity_from : {"stored", "fit", "differences"}
        Where the velocities come from.
    bandwidth : float
        Motions below this frequency stay, -3 dB there, in Hz; NaN of stored velocities.
    velocity_noise : float
        Standard deviation per axis, from the noise of the positions, in m/s; NaN if it is not known.
    acceleration_noise : float
        Likewise of the accelerations, in m/s^2.
    """

    velocity: Annotated[Array, "m/s"]
    acceleration: Annotated[Array, "m/s^2"]
    velocity_from: Literal["stored", "fit", "differences"]
    bandwidth: Annotated[float, "Hz"]
    velocity_noise: Annotated[float, "m/s"]
    acceleration_noise: Annotated[float, "m/s^2"]


def motion_of(
    ways: Ways, cuts: npt.NDArray[np.bool_], order: npt.NDArray[np.intp], stored: Array | None, window: float
) -> RecordedMotion:
    """Return the motion of ways in the order of the rows of a recording; see `Recording.motion`."""
    steps = np.diff(ways.time)[ways.same]
    period = float(np.median(steps)) if len(steps) else math.nan
    differences = _differences(ways, cuts)
    sigma = position_noise(ways)
    rows = fitted_rows(window, period) if period > 0.0 else 0
    smooth = bool(rows) and period <= SLOW_SAMPLING
    fits = motion_of_ways(ways, window, cuts) if smooth else None
    acceleration = np.full_like(ways.position, np.nan) if fits is None else fits.acceleration
    velocity = differences if fits is None else np.where(np.isnan(fits.velocity), differences, fits.velocity)
    squares = rows * (rows**2 - 1)
    noise = (
        sigma / period * math.sqrt(12.0 / squares)
        if smooth
        else sigma / period * math.sqrt(0.5)
        if period > 0.0
        else math.nan
    )
    noise_of_acceleration = sigma / period**2 * math.sqrt(720.0 / (squares * (rows**2 - 4))) if smooth else math.nan
    where: Literal["stored", "fit", "differences"] = "differences" if fits is None else "fit"
    bandwidth = cutoff(rows, period) if smooth else DIFFERENCES / period if period > 0.0 else math.nan
    if stored is not None and _agrees(stored[order], differences):
        velocity = np.where(np.isnan(stored[order]), velocity, stored[order])
        where, bandwidth, noise = "stored", math.nan, math.nan
    found = np.empty_like(ways.position), np.empty_like(ways.position)
    for array, values in zip(found, (velocity, acceleration), strict=True):
        array[order] = values
    return RecordedMotion(*found, where, bandwidth, noise, noise_of_acceleration)


def _differences(ways: Ways, cuts: npt.NDArray[np.bool_]) -> Array:
    """Return velocities by differences over the neighbors of each row, one-sided at ends of ways and cuts."""
    whole = ways.same & ~cuts
    last, first = np.arange(len(ways.time)), np.arange(len(ways.time))
    last[:-1] += whole
    first[1:] -= whole
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found: Array = (ways.position[last] - ways.position[first]) / (ways.time[last] - ways.time[first])[:, None]
    return found


def _agrees(stored: Array, differences: Array) -> bool:
    """Return whether stored velocities are those of the positions."""
    speed = np.hypot(differences[:, 0], differences[:, 1])
    some = (speed > LEAST_SPEED) & np.isfinite(stored).all(axis=1)
    if not some.any():
        return bool(np.isfinite(stored).all())
    off = np.hypot(*(stored[some] - differences[some]).T)
    return bool(np.median(off / speed[some]) <= AGREEMENT)
