"""Shares with intervals and paired comparisons of yes-or-no outcomes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Paired", "Share", "compare_paired", "wilson"]

# Two-sided 95 % of the normal distribution.
_Z95 = 1.959963984540054


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

    Examples
    --------
    >>> from hrsafety.reproduce.statistics import wilson
    >>> round(wilson(0, 200).high, 3)
    0.019
    """
    share = count / runs
    spread = _Z95**2 / runs
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = _Z95 * math.sqrt(share * (1.0 - share) / runs + spread / (4.0 * runs)) / (1.0 + spread)
    low = 0.0 if count == 0 else middle - half
    high = 1.0 if count == runs else middle + half
    return Share(count, runs, share, low, high)


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

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety.reproduce.statistics import compare_paired
    >>> compare_paired(np.array([True] * 6), np.array([False] * 6)).p_value
    0.03125
    """
    only_first = int(np.sum(first & ~second))
    only_second = int(np.sum(second & ~first))
    differing = only_first + only_second
    smaller = min(only_first, only_second)
    # In whole numbers until the last division: 2^-n alone underflows for many runs.
    tail = sum(math.comb(differing, k) for k in range(smaller + 1))
    return Paired(only_first, only_second, min(1.0, 2 * tail / 2**differing))
