"""Bands in which most of many runs lie, over time or along the way."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, number
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.scenario import Scenario

__all__ = ["Band", "along_the_way", "over_time"]

# Stations of a band of paths along the straight way.
_STATIONS = 201


@displayed
class Band(NamedTuple):
    """Where a share of the runs lies.

    Attributes
    ----------
    abscissa : ndarray, shape (k,)
        Time in s; for paths the progress along the straight way from start to goal, in m.
    low, middle, high : ndarray, shape (k,)
        Lower bound, median and upper bound, in m; NaN where no run is.
    runs : ndarray of int, shape (k,)
        Number of runs there: a run counts until it ends.
    """

    abscissa: Array
    low: Annotated[Array, "m"]
    middle: Annotated[Array, "m"]
    high: Annotated[Array, "m"]
    runs: npt.NDArray[np.int64]


def over_time(scenario: Scenario, time: Array, values: Array, share: float) -> Band:
    """Return where a share of the runs lies over time.

    Parameters
    ----------
    scenario : Scenario
        What was run; its control period is the spacing of the band.
    time, values : ndarray, shape (n, k)
        Instants in s and values of each run; NaN after its end.
    share : float
        Share between the bounds, above 0 and at most 1.

    Returns
    -------
    Band
        The values over time.
    """
    period = scenario.control_period
    grid: Array = period * np.arange(math.floor(float(np.nanmax(time)) / period) + 1, dtype=np.float64)
    rows = np.full((len(time), len(grid)), np.nan)
    for run, (times, row) in enumerate(zip(time, values, strict=True)):
        inside = np.isfinite(times)
        rows[run] = np.interp(grid, times[inside], row[inside], right=np.nan)
    return _band(grid, rows, share)


def along_the_way(scenario: Scenario, position: Array, share: float) -> Band:
    """Return where a share of the paths lies beside the straight way.

    Parameters
    ----------
    scenario : Scenario
        What was run.
    position : ndarray, shape (n, k, 2)
        Paths in m; NaN after the end of a run.
    share : float
        Share between the bounds, above 0 and at most 1.

    Returns
    -------
    Band
        Offset to the left over the progress along the straight way, both in m.
    """
    start, goal = np.asarray(scenario.start), np.asarray(scenario.goal)
    length = math.dist(start, goal)
    along = (goal - start) / length
    progress = (position - start) @ along
    offset = (position - start) @ np.array([-along[1], along[0]])
    # The first passage of a station is the passage by the furthest progress so far.
    reached = np.fmax.accumulate(progress, axis=1)
    stations = np.linspace(0.0, length, _STATIONS)
    rows = np.full((len(position), _STATIONS), np.nan)
    for run, (ahead, aside) in enumerate(zip(reached, offset, strict=True)):
        inside = np.isfinite(aside)
        first = np.concatenate(([True], np.diff(ahead[inside]) > 0.0))
        rows[run] = np.interp(stations, ahead[inside][first], aside[inside][first], right=np.nan)
    return _band(stations, rows, share)


def _band(abscissa: Array, rows: Array, share: float) -> Band:
    """Return bounds and median of the columns, over the runs that are there."""
    inside = number("share", share)
    if not 0.0 < inside <= 1.0:
        raise InvalidParameterError("share", "be above 0 and at most 1", share)
    runs = np.isfinite(rows).sum(axis=0)
    bounds = np.full((3, len(abscissa)), np.nan)
    there = runs > 0
    tail = 0.5 * (1.0 - inside)
    bounds[:, there] = np.nanquantile(rows[:, there], [tail, 0.5, 1.0 - tail], axis=0)
    low, middle, high = bounds
    return Band(abscissa, low, middle, high, runs)
