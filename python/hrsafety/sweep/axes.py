"""Varied axes and result columns of a sweep, each with its unit."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, number, numbers, refuse_masked, sequence, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

__all__ = ["Axis", "Column"]

Scale = Literal["linear", "log", "integer"]
Kind = Literal["number", "integer", "flag", "word"]

# Beyond this a float64 no longer tells neighboring integers apart.
LARGEST_INTEGER = 2**53


def checked_name(argument: str, value: object) -> str:
    """Return ``value`` if it can name an axis or a column in every format that is written."""
    if not isinstance(value, str) or not value.isidentifier() or value.startswith("_"):
        raise InvalidParameterError(argument, "be a name of letters, digits and underscores", value)
    return value


def labeled(name: str, unit: str | None) -> str:
    """Return a name with its unit in parentheses, in words."""
    if not unit:
        return name.replace("_", " ")
    words = name.removesuffix(f"_{unit}").replace("_", " ")
    return f"{words} ({unit.replace('^2', '²')})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """One named column of the result of a study.

    Parameters
    ----------
    name : str
        An identifier.
    unit : str
        Unit; empty without one.
    kind : {"number", "integer", "flag", "word"}
        What the column holds: float64, int64, truth values, or words of a known list.
    words : tuple of str
        The words that can occur, for ``"word"``; stored as their numbers.

    Raises
    ------
    InvalidParameterError
        If the name is no identifier, the kind is unknown, or words are missing or repeated.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> sweep.Column(name="clearance", unit="m").label
    'clearance (m)'
    """

    name: str
    unit: str = ""
    kind: Kind = "number"
    words: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check the values."""
        checked_name("name", self.name)
        if not isinstance(self.unit, str):
            raise InvalidParameterError("unit", "be a text", self.unit)
        word("kind", self.kind, ("number", "integer", "flag", "word"))
        given = sequence("words", "be a sequence of texts", self.words)
        if not all(isinstance(each, str) for each in given) or len(set(given)) != len(given):
            raise InvalidParameterError("words", "be different texts", self.words)
        if bool(given) != (self.kind == "word"):
            raise InvalidParameterError("words", 'be given for the kind "word" and for no other', self.words)
        object.__setattr__(self, "words", tuple(given))

    @property
    def label(self) -> str:
        """Name and unit, as on the axis of a picture."""
        return labeled(self.name, self.unit)

    @property
    def stored(self) -> np.dtype[Any]:
        """Type in which the values are stored."""
        if self.kind == "word":
            return np.min_scalar_type(max(len(self.words) - 1, 0))
        return np.dtype({"number": np.float64, "integer": np.int64, "flag": np.bool_}[self.kind])

    def encoded(self, values: npt.ArrayLike, rows: int) -> npt.NDArray[Any]:
        """Return the values as they are stored, checked.

        Parameters
        ----------
        values : array_like, shape (rows,)
            As the study computed them.
        rows : int
            How many there must be.

        Returns
        -------
        ndarray, shape (rows,)
            Words are replaced by their numbers.

        Raises
        ------
        InvalidParameterError
            If the values are of another kind than declared.
        ShapeError
            If there are more or fewer.
        """
        refuse_masked(self.name, values)
        array = np.asarray(values)
        if array.shape != (rows,):
            raise ShapeError(self.name, f"({rows},)", array.shape)
        allowed = {"number": "fiu", "integer": "iu", "flag": "b", "word": "U"}[self.kind]
        if array.dtype.kind not in allowed:
            raise InvalidParameterError(
                self.name, f"hold values of the kind {self.kind!r}", Shown(f"dtype {array.dtype}")
            )
        if self.kind != "word":
            return np.ascontiguousarray(array, dtype=self.stored)
        codes = np.zeros(rows, dtype=self.stored)
        known = np.zeros(rows, dtype=np.bool_)
        for index, each in enumerate(self.words):
            here = array == each
            codes[here] = index
            known |= here
        if not known.all():
            raise InvalidParameterError(self.name, f"hold words among {', '.join(self.words)}", str(array[~known][0]))
        return codes

    def decoded(self, stored: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return stored values as they are shown: words for their numbers.

        Parameters
        ----------
        stored : ndarray
            As returned by `encoded`.

        Returns
        -------
        ndarray
            Of the same shape.
        """
        return np.asarray(self.words)[stored] if self.kind == "word" else stored

    def settings(self) -> dict[str, Any]:
        """Return the fields for the manifest."""
        return {"name": self.name, "unit": self.unit, "kind": self.kind, "words": list(self.words)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """One quantity that is varied.

    Give either a range or values. A range is evenly divided, or evenly sampled, on a linear or
    logarithmic scale; on the scale ``"integer"`` only whole numbers occur, both ends included.
    A grid needs ``points`` with a range; on the integer scale every number without it. A
    sampled design picks each of the values equally often.

    Parameters
    ----------
    name : str
        What is varied: the name of a parameter of the study.
    low, high : float or None
        Ends of the range.
    points : int or None
        Number of points in a grid.
    values : array_like of shape (n,), or None
        The values, instead of a range.
    unit : str or None
        Unit; that of the study when ``None``. A unit that differs from the study's is refused.
    scale : {"linear", "log", "integer"}
        How the range is divided.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, the range is empty or unsuitable for the scale, or range and
        values are both given or both missing.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> sweep.Axis(name="foam_stiffness", low=1e3, high=1e5, points=3, scale="log").levels().round(6).tolist()
    [1000.0, 10000.0, 100000.0]
    """

    name: str
    low: float | None = None
    high: float | None = None
    points: int | None = None
    values: tuple[float, ...] | None = None
    unit: str | None = None
    scale: Scale = "linear"

    def __post_init__(self) -> None:
        """Check the values."""
        checked_name("name", self.name)
        word("scale", self.scale, ("linear", "log", "integer"))
        if self.unit is not None and not isinstance(self.unit, str):
            raise InvalidParameterError("unit", "be a text or None", self.unit)
        if self.values is not None:
            for name in ("low", "high", "points"):
                if getattr(self, name) is not None:
                    raise InvalidParameterError(name, "be None when values are given", getattr(self, name))
            object.__setattr__(self, "values", self._checked_values())
            return
        low, high = (self._end(name) for name in ("low", "high"))
        if not high > low:
            raise InvalidParameterError("high", f"be above low = {low:g}", high)
        if self.scale == "log" and low <= 0.0:
            raise InvalidParameterError("low", "be positive on a logarithmic scale", low)
        object.__setattr__(self, "low", low)
        object.__setattr__(self, "high", high)
        if self.points is not None:
            object.__setattr__(self, "points", count("points", self.points, least=2, most=LARGEST_INTEGER))
            if self.scale == "integer" and self.points > high - low + 1:
                raise InvalidParameterError("points", f"be at most {high - low + 1:g}, one a number", self.points)

    def _end(self, name: str) -> float:
        if getattr(self, name) is None:
            raise InvalidParameterError(name, "be given when there are no values", None)
        value = number(name, getattr(self, name))
        if not math.isfinite(value):
            raise InvalidParameterError(name, "be finite", value)
        if self.scale == "integer" and (value != math.floor(value) or abs(value) > LARGEST_INTEGER):
            raise InvalidParameterError(name, "be an integer of at most 2**53", value)
        return value

    def _checked_values(self) -> tuple[float, ...]:
        array = numbers("values", self.values)
        if array.ndim != 1 or len(array) == 0:
            raise ShapeError("values", "(n,) with n > 0", array.shape)
        if not np.isfinite(array).all():
            raise InvalidParameterError("values", "be finite", array)
        if len(np.unique(array)) != len(array):
            raise InvalidParameterError("values", "be different from each other", array)
        if self.scale != "linear":
            raise InvalidParameterError("scale", 'be "linear" when values are given', self.scale)
        return tuple(array.tolist())

    @property
    def label(self) -> str:
        """Name and unit, as on the axis of a picture."""
        return labeled(self.name, self.unit)

    @property
    def size(self) -> int | None:
        """Number of levels in a grid; ``None`` for a range without ``points``."""
        if self.values is not None:
            return len(self.values)
        if self.points is None and self.scale == "integer":
            return int(self._span())
        return self.points

    def _span(self) -> float:
        low, high = self._range()
        return high - low + 1.0

    def _range(self) -> tuple[float, float]:
        assert self.low is not None  # checked at construction, as there are no values
        assert self.high is not None
        return self.low, self.high

    def levels(self) -> Array:
        """Return the values of the axis in a grid.

        Returns
        -------
        ndarray, shape (size,)
            In the unit of the axis.

        Raises
        ------
        InvalidParameterError
            If a range has no ``points``.
        """
        if self.values is not None:
            return np.array(self.values)
        if self.size is None:
            raise InvalidParameterError(f"points of axis {self.name!r}", "be given for a grid", None)
        low, high = self._range()
        if self.scale == "log":
            return np.geomspace(low, high, self.size)
        levels = np.linspace(low, high, self.size)
        return np.round(levels) if self.scale == "integer" else levels

    def at(self, share: npt.ArrayLike) -> Array:
        """Return the values at shares of the way along the axis.

        Parameters
        ----------
        share : array_like
            From 0 up to, not including, 1.

        Returns
        -------
        ndarray
            In the unit of the axis.
        """
        along = np.asarray(share, dtype=np.float64)
        if self.values is not None:
            return np.array(self.values)[(along * len(self.values)).astype(np.int64)]
        low, high = self._range()
        if self.scale == "log":
            return np.asarray(low * np.exp(along * math.log(high / low)))
        if self.scale == "integer":
            return low + np.floor(along * self._span())
        return low + along * (high - low)

    def settings(self) -> dict[str, Any]:
        """Return the fields for the manifest."""
        return {
            "name": self.name,
            "unit": self.unit,
            "low": self.low,
            "high": self.high,
            "points": self.points,
            "values": None if self.values is None else list(self.values),
            "scale": self.scale,
        }
