"""Ranks of entries with their uncertainty: seeds drawn again, the same for all entries."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, numbers
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Ranks", "ranks"]

EQUAL = 1e-12
"""Scores that differ by no more share a place."""
MOST = 1_000_000
"""Most replicates."""
MOST_CELLS = 50_000_000
"""Most episodes of all entries together."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Ranks:
    """Places of entries; 1 is the best.

    Parameters
    ----------
    score : ndarray of shape (entries,)
        Mean over the scenes of the share of successes.
    median, low, high : ndarray of shape (entries,)
        Median and the 2.5 and 97.5 percentiles of the rank. Entries whose intervals overlap share a place.
    """

    score: Annotated[Array, ""]
    median: Annotated[Array, ""]
    low: Annotated[Array, ""]
    high: Annotated[Array, ""]


def ranks(success: npt.ArrayLike, *, replicates: int = 2000) -> Ranks:
    """Return the ranks of entries by their successes in scenes.

    In each replicate the seeds of every scene are drawn again with replacement, the same for all entries, by
    ``numpy.random.default_rng(0)``. A rank is one more than the entries that are better, and a half more for each other
    one with the same score.

    Parameters
    ----------
    success : array_like of shape (entries, scenes, seeds)
        1 for a success, else 0.
    replicates : int
        How often seeds are drawn, at most 1,000,000.

    Returns
    -------
    Ranks
        Scores and ranks.

    Raises
    ------
    ShapeError
        If there are not three axes with an entry each at least.
    InvalidParameterError
        If a value is neither 0 nor 1, or there are more than 50 million.

    Examples
    --------
    >>> from hrsafety import arena
    >>> found = arena.ranks([[[1, 1, 1, 1]], [[1, 0, 0, 1]]])
    >>> found.score.tolist(), found.median.tolist()
    ([1.0, 0.5], [1.0, 2.0])
    """
    told = numbers("success", success, "be an array of 0 and 1")
    if told.ndim != 3 or 0 in told.shape:
        raise ShapeError("success", "(entries, scenes, seeds)", told.shape)
    if told.size > MOST_CELLS:
        raise InvalidParameterError("success", f"hold at most {MOST_CELLS} episodes", told.size)
    if not np.isin(told, (0.0, 1.0)).all():
        raise InvalidParameterError("success", "be 0 or 1 everywhere", success)
    entries, scenes, seeds = told.shape
    drawn = np.empty((count("replicates", replicates, most=MOST), entries))
    generator = np.random.default_rng(0)
    for replicate in drawn:
        shares = [told[:, scene, generator.integers(0, seeds, seeds)].mean(axis=1) for scene in range(scenes)]
        replicate[:] = _places(np.mean(shares, axis=0))
    low, median, high = np.percentile(drawn, (2.5, 50.0, 97.5), axis=0)
    return Ranks(score=told.mean(axis=2).mean(axis=1), median=median, low=low, high=high)


def _places(score: Array) -> Array:
    """Return the rank of each score."""
    above = score[None] - score[:, None]
    better = (above > EQUAL).sum(axis=1)
    equal = (np.abs(above) <= EQUAL).sum(axis=1) - 1
    return np.asarray(1.0 + better + 0.5 * equal)
