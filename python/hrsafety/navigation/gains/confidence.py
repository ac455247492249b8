"""Confidence in a mean over seeds."""

from __future__ import annotations

import math
from typing import NamedTuple

from hrsafety._arguments import Array
from hrsafety._display import displayed

__all__ = ["Confidence", "confidence_of", "student_quantile"]


@displayed
class Confidence(NamedTuple):
    """Value of the best gain set with noise that the search has not seen.

    Attributes
    ----------
    mean : float
        Mean of the objective over the fresh seeds.
    standard_error : float
        Standard error of that mean.
    low, high : float
        Two-sided interval for the mean by Student's t distribution.
    level : float
        Probability that such an interval covers the true mean, for example 0.95.
    seeds : int
        Number of fresh seeds.
    """

    mean: float
    standard_error: float
    low: float
    high: float
    level: float
    seeds: int


def confidence_of(values: Array, level: float = 0.95) -> Confidence:
    """Return the mean of values, one for each seed, with its interval."""
    count = len(values)
    mean, error = float(values.mean()), float(values.std(ddof=1)) / math.sqrt(count)
    half = student_quantile(0.5 + level / 2.0, count - 1) * error
    return Confidence(mean, error, mean - half, mean + half, level, count)


def student_quantile(probability: float, degrees: int) -> float:
    """Return the quantile, above the median, of Student's t distribution.

    The distribution function is the finite sum of Abramowitz and Stegun (1964), 26.7.3 and
    26.7.4, for whole degrees of freedom; it is inverted by bisection of the angle
    ``atan(t / sqrt(degrees))``.
    """
    low, high = 0.0, math.pi / 2.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if 0.5 + 0.5 * _two_sided(middle, degrees) < probability:
            low = middle
        else:
            high = middle
    return math.tan(low) * math.sqrt(degrees)


def _two_sided(angle: float, degrees: int) -> float:
    """Return the probability of a magnitude below ``sqrt(degrees) tan(angle)``."""
    squared = math.cos(angle) ** 2
    odd = degrees % 2
    term, total = (math.cos(angle) if odd else 1.0), 0.0
    for index in range(degrees // 2):
        total += term
        term *= squared * (2 * index + 1 + odd) / (2 * index + 2 + odd)
    if odd:
        return 2.0 / math.pi * (angle + math.sin(angle) * total)
    return math.sin(angle) * total
