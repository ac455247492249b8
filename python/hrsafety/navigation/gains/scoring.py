"""Scores of batches of gain sets by callables and over seeds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hrsafety._arguments import Array, numbers
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.gains.settings import Judge
from hrsafety.navigation.tables.runs import RunTable

__all__ = ["judged", "over_seeds"]


def judged(name: str, judge: Judge, batches: Sequence[RunTable], rows: int) -> Array:
    """Return what a callable says of the batch of each seed, (seeds, n)."""
    found = []
    for batch in batches:
        values = numbers(name, judge(batch), "return numbers, one for each gain set")
        if values.shape != (rows,):
            raise InvalidParameterError(name, f"return an array of shape ({rows},)", Shown(f"shape {values.shape}"))
        found.append(values)
    return np.stack(found)


def over_seeds(values: Array, factor: float | None) -> Array:
    """Return the mean over the seeds, or its lower bound; worst of all where there is none.

    Parameters
    ----------
    values : ndarray, shape (seeds, n)
        Values of n gain sets.
    factor : float or None
        How many standard errors the bound lies below the mean; ``None`` for the mean.

    Returns
    -------
    ndarray, shape (n,)
        One value of each gain set.
    """
    with np.errstate(invalid="ignore"):
        mean = values.mean(axis=0)
        if factor is not None:
            mean = mean - factor * values.std(axis=0, ddof=1) / math.sqrt(len(values))
    return np.where(np.isnan(mean), -np.inf, mean)
