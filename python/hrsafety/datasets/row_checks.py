"""Checks of the rows of a recording."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import number, positive, with_article
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

__all__ = ["FARTHEST", "LONGEST", "checked_ids", "checked_order", "checked_velocity", "checked_window", "finite_array"]

Array = npt.NDArray[np.float64]

FARTHEST, LONGEST = 1e9, 1e12
"""Bounds of places in m and of times in s: beyond them differences and products lose their meaning."""
SHORTEST = 1e-9
"""Rows of one person are so far apart at least, in s."""


def checked_ids(value: object, rows: int) -> npt.NDArray[Any]:
    """Return ids as integers or as words, or say why not."""
    try:
        person = np.array(value)
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameterError("person", "hold integers or words", value) from None
    if person.shape != (rows,):
        raise ShapeError("person", f"({rows},)", person.shape)
    if person.dtype.kind not in "iuU":
        raise InvalidParameterError("person", "hold integers or words", Shown(str(person.dtype)))
    return person if person.dtype.kind == "U" else person.astype(np.int64)


def finite_array(name: str, value: npt.ArrayLike, most: float) -> Array:
    """Return a copy of ``value`` as float64, or say why not."""
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameterError(name, "be an array of numbers", Shown(with_article(type(value).__name__))) from None
    if not np.isfinite(array).all():
        raise InvalidParameterError(name, "be finite", float(array[~np.isfinite(array)][0]))
    far = np.abs(array) > most
    if far.any():
        raise InvalidParameterError(name, f"be from {-most:g} to {most:g}", float(array[far][0]))
    return array


def checked_order(time: Array, person: npt.NDArray[Any]) -> npt.NDArray[np.intp]:
    """Return the order of the rows by person, then by time, or say which row is out of order."""
    backward = np.flatnonzero(np.diff(time) < 0.0)
    if len(backward):
        row = int(backward[0]) + 1
        rule = f"not be before time_s[{row - 1}] = {time[row - 1]}"
        remedy = "sort the rows by time: np.lexsort((person, time_s)) gives their order"
        raise InvalidParameterError(f"time_s[{row}]", rule, float(time[row]), remedy)
    # The rows are sorted by time, and a stable sort keeps that.
    order = np.argsort(person, kind="stable")
    same = (person[order][1:] == person[order][:-1]) & (np.diff(time[order]) < SHORTEST)
    if same.any():
        row = int(order[int(np.flatnonzero(same)[0]) + 1])
        raise InvalidParameterError(f"person[{row}]", "have one row for each instant", Shown(f"two at {time[row]} s"))
    return order


def checked_window(start_time: object, duration: object) -> tuple[float, float]:
    """Return begin and length of a window in s."""
    begin = number("start_time", start_time)
    if not math.isfinite(begin):
        raise InvalidParameterError("start_time", "be finite", start_time)
    return begin, positive("duration", duration)


def checked_velocity(value: npt.ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return stored velocities, NaN where there is none."""
    try:
        found = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        found_type = Shown(with_article(type(value).__name__))
        raise InvalidParameterError("velocity", "be an array of numbers", found_type) from None
    if found.shape != shape:
        raise ShapeError("velocity", f"({shape[0]}, 2)", found.shape)
    if np.isinf(found).any():
        raise InvalidParameterError("velocity", "be finite, or NaN where it is not known", Shown("an infinite one"))
    found.setflags(write=False)
    return found
