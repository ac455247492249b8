"""Shares and means with intervals, and paired comparisons of the same runs."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import checked_seed, vector
from hrsafety._arguments import count as whole
from hrsafety._bounds import MOST_RESAMPLES
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Mean", "Paired", "Share", "compare_paired", "mean_interval", "wilson"]

# Two-sided 95 % of the normal distribution.
_Z95 = 1.959963984540054


@displayed
@dataclass(frozen=True, slots=True)
class Share:
    """A share with its 95 % Wilson interval.

    Attributes
    ----------
    count, runs : int
        How many of how many.
    value, low, high : float
        The share and its interval, from 0 to 1.
    """

    count: int
    runs: int
    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return the share in percent with its interval, and what it was counted in."""
        return f"{self.value:.1%} ({self.low:.1%} to {self.high:.1%}), {self.count} of {self.runs}"


def wilson(count: int, runs: int) -> Share:
    """Return a share with its 95 % Wilson score interval.

    Parameters
    ----------
    count, runs : int
        How many of how many; at least one run.

    Returns
    -------
    Share
        Share and interval.

    Raises
    ------
    InvalidParameterError
        If there is no run, or count is not an integer from 0 to runs.

    Examples
    --------
    >>> from hrsafety._statistics import wilson
    >>> print(wilson(0, 200))
    0.0% (0.0% to 1.9%), 0 of 200
    """
    whole("runs", runs)
    if whole("count", count, least=0) > runs:
        raise InvalidParameterError("count", f"be an integer from 0 to {runs}", count)
    share = count / runs
    spread = _Z95**2 / runs
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = _Z95 * math.sqrt(share * (1.0 - share) / runs + spread / (4.0 * runs)) / (1.0 + spread)
    low = 0.0 if count == 0 else middle - half
    high = 1.0 if count == runs else middle + half
    return Share(count, runs, share, low, high)


@displayed
class Paired(NamedTuple):
    """Two yes-or-no outcomes of the same runs.

    Attributes
    ----------
    only_first, only_second : int
        Runs in which just one of them happened.
    p_value : float
        Exact two-sided McNemar test: chance of a split at least this uneven if both were
        equally likely.
    """

    only_first: int
    only_second: int
    p_value: float


def compare_paired(first: npt.NDArray[np.bool_], second: npt.NDArray[np.bool_]) -> Paired:
    """Compare two outcomes of the same runs by the exact McNemar test.

    Parameters
    ----------
    first, second : ndarray of bool, shape (n,)
        Whether it happened, run by run.

    Returns
    -------
    Paired
        Runs that differ and the two-sided p value; 1 if none differs.

    Raises
    ------
    ShapeError
        If the two are not of the same length.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety._statistics import compare_paired
    >>> compare_paired(np.array([True] * 6), np.array([False] * 6)).p_value
    0.03125
    """
    one, other = np.asarray(first, dtype=bool), np.asarray(second, dtype=bool)
    if one.ndim != 1 or one.shape != other.shape:
        raise ShapeError("second", f"({one.size},)", other.shape)
    only_first = int(np.sum(one & ~other))
    only_second = int(np.sum(other & ~one))
    differing = only_first + only_second
    smaller = min(only_first, only_second)
    # In whole numbers until the last division: 2^-n alone underflows for many runs.
    tail = sum(math.comb(differing, k) for k in range(smaller + 1))
    return Paired(only_first, only_second, min(1.0, 2 * tail / 2**differing))


@displayed
@dataclass(frozen=True, slots=True)
class Mean:
    """A mean with its 95 % bootstrap interval.

    Attributes
    ----------
    runs : int
        Of how many runs.
    value, low, high : float
        Mean and interval; NaN without any run, and the mean itself of a single run.
    """

    runs: int
    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return the mean with its interval, and of how many runs."""
        return f"{self.value:.4g} ({self.low:.4g} to {self.high:.4g}), {self.runs} runs"


def mean_interval(values: npt.ArrayLike, *, resamples: int = 2000, seed: int = 0) -> Mean:
    """Return a mean with its 95 % percentile bootstrap interval.

    Parameters
    ----------
    values : array_like, shape (n,)
        One number of each run, or one difference of each pair of runs.
    resamples : int
        Number of bootstrap samples.
    seed : int
        Seed of the draws: the same interval for the same numbers.

    Returns
    -------
    Mean
        Mean and interval.

    Raises
    ------
    InvalidParameterError
        If values are not numbers, or resamples is not a positive integer.
    ShapeError
        If values is not one-dimensional.

    Examples
    --------
    >>> from hrsafety._statistics import mean_interval
    >>> mean_interval([1.0, 1.0, 1.0])
    Mean(runs=3, value=1.0, low=1.0, high=1.0)
    >>> print(mean_interval([1.0, 1.0, 1.0]))
    1 (1 to 1), 3 runs
    """
    whole("resamples", resamples, most=MOST_RESAMPLES)
    given = vector("values", values)
    if not len(given):
        return Mean(0, math.nan, math.nan, math.nan)
    generator = np.random.Generator(np.random.PCG64(checked_seed("seed", seed)))
    means = np.empty(resamples)
    for index in range(resamples):
        means[index] = given[generator.integers(0, len(given), len(given))].mean()
    low, high = np.quantile(means, [0.025, 0.975])
    return Mean(len(given), float(given.mean()), float(low), float(high))
