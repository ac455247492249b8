"""Repeated measurements of one load: expanded uncertainty, and what they mean for a limit."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import not_negative, positive, vector
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError

__all__ = ["Repetitions", "repetitions"]

FEWEST = 3
"""Measurements from which on a limit can count as kept."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class Repetitions:
    """Repeated measurements of one load beside a limit.

    Attributes
    ----------
    number : int
        Measurements.
    mean, largest : float
        In the unit of the values.
    expanded_uncertainty : float
        2 sqrt(u_device^2 + s^2), with the standard deviation s of the values.
    limit : float
        Limit of the load.
    verdict : {"within_limits", "exceeds", "not_checked"}
        What they mean for it.
    reason : {"", "too_few", "inside_uncertainty", "no_device_uncertainty"}
        Why it is not checked.
    """

    number: int
    mean: float
    largest: float
    expanded_uncertainty: float
    limit: float
    verdict: str
    reason: str


def repetitions(values: npt.ArrayLike, limit: float, *, device_uncertainty: float | None = None) -> Repetitions:
    """Return what repeated measurements of one load mean for a limit.

    A choice of this project: the largest one above the limit exceeds it; with three or more, and the largest one and
    the expanded uncertainty together at most the limit, it is kept.

    Parameters
    ----------
    values : array_like, shape (n,)
        Measurements, in the unit of the limit.
    limit : float
        Limit.
    device_uncertainty : float or None
        Standard uncertainty of the device; ``None``: not known, it is taken as 0 and no limit counts as kept.

    Returns
    -------
    Repetitions
        Mean, largest, uncertainty and verdict.

    Raises
    ------
    InvalidParameterError
        If there is no value, one is not finite, or a limit or an uncertainty is out of range.

    Examples
    --------
    >>> from hrsafety import records
    >>> found = records.repetitions([121.0, 126.0, 118.0], 140.0, device_uncertainty=4.0)
    >>> found.verdict, round(found.expanded_uncertainty, 2)
    ('within_limits', 11.37)
    """
    measured = vector("values", values)
    if not len(measured) or not np.isfinite(measured).all():
        raise InvalidParameterError("values", "be finite numbers, at least one", measured.tolist())
    bound = positive("limit", limit)
    device = 0.0 if device_uncertainty is None else not_negative("device_uncertainty", device_uncertainty)
    spread = float(measured.std(ddof=1)) if len(measured) > 1 else 0.0
    expanded = 2.0 * math.hypot(device, spread)
    largest = float(measured.max())
    verdict, reason = "within_limits", ""
    if largest > bound:
        verdict = "exceeds"
    elif len(measured) < FEWEST:
        verdict, reason = "not_checked", "too_few"
    elif largest + expanded > bound:
        verdict, reason = "not_checked", "inside_uncertainty"
    elif device_uncertainty is None:
        verdict, reason = "not_checked", "no_device_uncertainty"
    return Repetitions(
        number=len(measured),
        mean=float(measured.mean()),
        largest=largest,
        expanded_uncertainty=expanded,
        limit=bound,
        verdict=verdict,
        reason=reason,
    )
