"""What all parameter classes share: a checked native counterpart and pickling by value."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import InvalidParameterError, ShapeError

Pair = tuple[float, float]


class Parameters:
    """Base of the frozen parameter classes.

    A subclass builds ``_native`` in ``__post_init__``; the native constructor checks every
    value, so an instance that exists is valid. Equality, hashing and printing use the public
    fields only.
    """

    __slots__ = ()

    def _set(self, **values: object) -> None:
        """Write fields of a frozen instance during construction."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by public fields; the native counterpart is built again on load."""
        fields = {
            field.name: getattr(self, field.name)
            for field in dataclasses.fields(self)  # type: ignore[arg-type]  # subclasses are dataclasses
            if field.init
        }
        return _rebuild, (type(self), fields)


def _rebuild(kind: type, fields: dict[str, object]) -> object:
    return kind(**fields)


def number(name: str, value: object) -> float:
    """Return ``value`` as a float, or say what it should have been."""
    if isinstance(value, (bool, str, bytes)):
        raise InvalidParameterError(name, "be a number", value)
    try:
        return float(value)  # type: ignore[arg-type]  # the failure is the check
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameterError(name, "be a number", value) from None


def flag(name: str, value: object) -> bool:
    """Return ``value`` if it is a truth value, or say that it should have been."""
    if not isinstance(value, (bool, np.bool_)):
        raise InvalidParameterError(name, "be True or False", value)
    return bool(value)


def sequence(name: str, rule: str, value: object) -> list[Any]:
    """Return the elements of ``value``, or say what it should have been."""
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise InvalidParameterError(name, rule, value)
    return list(value)


def numbers(name: str, rule: str, value: object) -> npt.NDArray[np.float64]:
    """Return ``value`` as a contiguous array; words, None and complex numbers are refused."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise InvalidParameterError(name, rule, value) from None
    if array.dtype.kind not in "fiu":
        raise InvalidParameterError(name, rule, value)
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def pair(name: str, value: Sequence[float] | npt.ArrayLike) -> Pair:
    """Return ``value`` as two floats, or say what it should have been."""
    array = numbers(name, "be a pair (x, y) of numbers", value)
    if array.shape != (2,):
        raise ShapeError(name, "(2,)", array.shape)
    return (float(array[0]), float(array[1]))


def points(name: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return ``value`` as a contiguous (n, 2) array, or say what it should have been."""
    array = numbers(name, "be an array of numbers", value)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ShapeError(name, "(n, 2)", array.shape)
    return array
