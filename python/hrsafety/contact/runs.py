"""Runs as contacts see them: how fast people approach, and what a record says against itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.plausibility import RANGES, ResultWarning

__all__ = ["GAP", "approach_of", "doubts_of_run", "gaps_of"]

WINDOW = 0.5
"""Time in s over which a way is compared with velocities, so that noise of single positions does not count."""
WAY = 0.1
"""Difference in m between both ways that counts: noise, and steps between instants."""
SHARE = 0.5
"""Largest difference as a share of the longer one of both ways."""
TURNS = 6.0 * np.pi
"""Headings beyond three turns are hardly radians."""

GAP = ResultWarning(
    "gap_in_track",
    "obstacle_position",
    "a person is not seen between two sights, and may be anywhere within reach: nobody is absent then",
)


def doubts_of_run(run: Any) -> Iterator[ResultWarning]:
    """Give what is doubtful about the robot of a run.

    Parameters
    ----------
    run : object
        With ``time``, ``position``, ``velocity`` and ``heading``.

    Yields
    ------
    ResultWarning
        ``implausible`` headings, ``closing_speed_unknown`` where velocities are not those of the positions.
    """
    time, heading = np.asarray(run.time, dtype=np.float64), np.asarray(run.heading, dtype=np.float64)
    if len(time) < 2:
        return
    steps = np.diff(time)
    with np.errstate(invalid="ignore", divide="ignore"):
        rates = np.abs(np.diff(heading)) / steps
    farthest = float(np.nanmax(np.abs(heading), initial=0.0))
    # A heading may jump by a turn where it is kept within one.
    jumps = np.abs(np.abs(np.diff(heading)) - 2.0 * np.pi) < 1.0
    fastest = float(np.nanmax(np.where(jumps, 0.0, rates), initial=0.0))
    if farthest > TURNS or fastest > RANGES["robot_max_turn_rate"].most:
        message = (
            f"heading goes up to {farthest:g} rad and turns by up to {fastest:g} rad/s: degrees given for radians?"
        )
        yield ResultWarning("implausible", "heading", message)
    velocity, position = (np.asarray(each, dtype=np.float64) for each in (run.velocity, run.position))
    told = np.concatenate([np.zeros((1, 2)), np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * steps[:, None], axis=0)])
    later = np.minimum(np.searchsorted(time, time + WINDOW), len(time) - 1)
    ways, said = position[later] - position, told[later] - told
    lengths = [np.linalg.norm(each, axis=1) for each in (ways, said, ways - said)]
    beyond = lengths[2] - (SHARE * np.fmax(lengths[0], lengths[1]) + WAY)
    worst = int(np.argmax(np.where(np.isnan(beyond), -np.inf, beyond)))
    if beyond[worst] > 0.0:
        moved, said_words = (f"({each[worst][0]:.3g}, {each[worst][1]:.3g}) m" for each in (ways, said))
        message = (
            f"the robot moves by {moved} within {time[later[worst]] - time[worst]:.3g} s from {time[worst]:g} s on, "
            f"and its velocity says {said_words}: another robot, frame or unit; the closing speed is not known"
        )
        yield ResultWarning("closing_speed_unknown", "velocity", message)


def gaps_of(distance: Array) -> npt.NDArray[np.bool_]:
    """Return where a person is not seen between two sights.

    Parameters
    ----------
    distance : ndarray (n, m)
        Distances over time, NaN where a person is not seen.

    Returns
    -------
    ndarray (n, m) of bool
        Not before the first sight and after the last one.
    """
    seen = ~np.isnan(distance)
    before = np.logical_or.accumulate(seen, axis=0)
    after = np.logical_or.accumulate(seen[::-1], axis=0)[::-1]
    return np.asarray(~seen & before & after)


def approach_of(time: Array, position: Array, normal: Array) -> Array:
    """Return speeds of obstacles against a normal, the larger one of those before and after each instant.

    Who stands still from a touch on came with the speed before it, and a mean of both would be half of that.
    """
    if len(time) < 2:
        return np.full(normal.shape[:2], np.nan)
    steps = np.diff(position, axis=0) / np.diff(time)[:, None, None]
    unknown = np.full_like(position[:1], np.nan)
    before, after = np.concatenate([unknown, steps]), np.concatenate([steps, unknown])
    return np.asarray(np.fmax(*(-np.einsum("nmk,nmk->nm", each, normal) for each in (before, after))))
