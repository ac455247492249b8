"""Units that measuring devices write beside their numbers."""

from __future__ import annotations

import math

import numpy as np

from hrsafety._arguments import Array
from hrsafety.errors import InvalidParameterError

__all__ = ["KNOWN", "dimension_of", "factor_of", "in_unit", "plain"]

STANDARD_GRAVITY = 9.80665
_POUND_FORCE = 4.4482216152605
_INCH = 0.0254

_BY_DIMENSION = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
    "acceleration": {"g": STANDARD_GRAVITY, "m/s2": 1.0},
    "force": {"N": 1.0, "kN": 1e3, "daN": 10.0, "lbf": _POUND_FORCE},
    "pressure": {
        "Pa": 1.0,
        "kPa": 1e3,
        "MPa": 1e6,
        "N/mm2": 1e6,
        "N/cm2": 1e4,
        "bar": 1e5,
        "psi": _POUND_FORCE / _INCH**2,
    },
    "length": {"mm": 1e-3, "m": 1.0},
    "angle": {"rad": 1.0, "deg": math.pi / 180.0},
    "rate": {"deg/s": math.pi / 180.0, "rad/s": 1.0},
}
_UNITS = {name: (dimension, factor) for dimension, units in _BY_DIMENSION.items() for name, factor in units.items()}
_SPELLED = str.maketrans({"²": "2", "µ": "u", "μ": "u", "^": None, "°": "deg", " ": None})

KNOWN = ", ".join(_UNITS)
"""Names of the units, for errors."""


def plain(name: str) -> str | None:
    """Return the name of a unit without superscripts and blanks, ``None`` if it is none that is known."""
    found = name.translate(_SPELLED)
    return found if found in _UNITS else None


def dimension_of(unit: str) -> str:
    """Return what a unit measures."""
    return _UNITS[plain(unit) or unit][0]


def factor_of(unit: str) -> float:
    """Return how many SI units a unit is."""
    return _UNITS[plain(unit) or unit][1]


def in_unit(name: str, values: Array, unit: str, dimension: str) -> Array:
    """Return values in SI units.

    Raises
    ------
    InvalidParameterError
        If the unit is none of the dimension.
    """
    found = plain(unit) if isinstance(unit, str) else None
    if found is None or _UNITS[found][0] != dimension:
        raise InvalidParameterError(name, f"be one of {', '.join(_BY_DIMENSION[dimension])}", unit)
    return np.asarray(values * _UNITS[found][1])
