"""Numbers that axes can show: their span, their scale, and what is left blank."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import number, vector
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

__all__ = ["along_axis", "blank_where_infinite", "near_axis", "shown_number"]

LARGEST, LEAST = 1e100, 1e-100
"""Largest magnitude on an axis, whose limits are added and squared; smaller ones than the least are drawn as 0."""
_STEP = 1e-12
"""Least step between two points of an axis, as a share of the largest magnitude on it."""

Array = npt.NDArray[np.float64]


def along_axis(name: str, values: npt.ArrayLike, *, log: bool = False, rising: bool = True) -> Array:
    """Return points along an axis, or say why no axis has them.

    Parameters
    ----------
    name : str
        Of the argument.
    values : array_like, shape (n,)
        The points, two at least.
    log : bool
        Whether the axis is logarithmic.
    rising : bool
        Whether they must rise; else they may stand in any order.

    Returns
    -------
    ndarray, shape (n,)
        The points.

    Raises
    ------
    ShapeError
        If there are less than two.
    InvalidParameterError
        If they do not rise though they must, or are too large, too small or too near to each other to be told apart.
    """
    found = vector(name, values)
    if len(found) < 2:
        raise ShapeError(name, "(n,) with n >= 2", found.shape)
    if not np.isfinite(found).all() or np.abs(found).max() > LARGEST:
        raise InvalidParameterError(name, f"lie within -{LARGEST:g} to {LARGEST:g} to be drawn", found.tolist())
    least = max(_STEP * float(np.abs(found).max()), LEAST)
    if rising and not (np.diff(found) > 0.0).all():
        raise InvalidParameterError(name, "rise from point to point", Shown("an array that does not"))
    if found.max() - found.min() < least:
        raise InvalidParameterError(name, f"differ by {least:g} or more to be drawn", found.tolist())
    if log and found.min() < LEAST:
        raise InvalidParameterError(name, f"be {LEAST:g} or more on a logarithmic axis", found.tolist())
    return found


def blank_where_infinite(name: str, values: npt.ArrayLike) -> Array:
    """Return numbers to be drawn, NaN where they are infinite, or say which is too large.

    Parameters
    ----------
    name : str
        Of the argument.
    values : array_like
        Of any shape.

    Returns
    -------
    ndarray
        Of the same shape.

    Raises
    ------
    InvalidParameterError
        If they are no numbers, or a finite one is too large.
    """
    try:
        found = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidParameterError(name, "be an array of numbers", values) from None
    found = np.where(np.isinf(found), np.nan, found)
    large = np.abs(found) > LARGEST
    if large.any():
        rule = f"lie within -{LARGEST:g} to {LARGEST:g} to be drawn"
        raise InvalidParameterError(name, rule, float(found[large].flat[0]))
    return np.where(np.abs(found) < LEAST, 0.0, found)


def shown_number(name: str, value: float) -> float:
    """Return a number to be drawn, such as a limit, or say why it cannot be.

    Parameters
    ----------
    name : str
        Of the argument.
    value : float
        The number.

    Returns
    -------
    float
        The number.

    Raises
    ------
    InvalidParameterError
        If it is not finite, or too large.
    """
    found = number(name, value)
    if not abs(found) <= LARGEST:
        raise InvalidParameterError(name, f"lie within -{LARGEST:g} to {LARGEST:g} to be drawn", found)
    return 0.0 if abs(found) < LEAST else found


def near_axis(name: str, value: float, axis: Array) -> None:
    """Refuse a mark that lies so far beside an axis that its name would leave no room for the picture.

    Parameters
    ----------
    name : str
        Of the mark.
    value : float
        Where it lies.
    axis : ndarray, shape (n,)
        Points along the axis.

    Raises
    ------
    InvalidParameterError
        If it lies beside the axis by more than the length of that.
    """
    low, high = float(axis.min()), float(axis.max())
    if not low - (high - low) <= value <= high + (high - low):
        rule = f"lie near the picture, which goes from {low:g} to {high:g}"
        raise InvalidParameterError(name, rule, value, "a wider axis shows it, or leave it out")
