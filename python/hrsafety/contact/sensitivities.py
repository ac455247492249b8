"""How an allowed speed changes with each number that is given."""

from __future__ import annotations

import math

from hrsafety import _hrsafety
from hrsafety.contact.rows import Prepared, in_order
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["sensitivities_of"]

_STEP = 1e-5
_FIXED = ("bottoming_strain", "horizon", "backing_stiffness", "unloading_retained", "unloading_exponent")
"""Numbers without a sensitivity: an allowed speed belongs to the first loading."""


def sensitivities_of(given: Prepared) -> dict[str, float]:
    """Return d ln v/d ln x of the allowed speed for every number x that is given, the largest first."""
    shared, values, pad, _, _ = given
    laws = [] if pad is None else list(pad.material.keys.values())
    found: dict[str, float] = {}
    for name, value in values.items():
        if name in _FIXED or not (math.isfinite(value) and value > 0.0):
            continue
        slope = _slope(name, shared, values)
        label = laws[int(name.removeprefix("material_"))] if name.startswith("material_") else name
        if abs(slope) > 1e-9:
            found[label] = slope
    return dict(sorted(found.items(), key=lambda item: -abs(item[1])))


def _slope(name: str, shared: dict[str, object], values: dict[str, float]) -> float:
    """Return d ln v/d ln x, from one side where a number is at the end of its range."""
    speeds: list[tuple[float, float]] = []
    for factor in (1.0 + _STEP, 1.0, 1.0 - _STEP):
        try:
            moved = _hrsafety.contact_speed(shared, in_order(values | {name: factor * values[name]}))
        except InvalidParameterError:
            if factor == 1.0:
                raise
            continue
        if math.isnan(moved["speed"]):
            rule = "give an allowed speed on both sides, for a sensitivity"
            raise InvalidParameterError(name, rule, Shown(moved["status"]))
        speeds.append((factor, moved["speed"]))
    (high, fast), (low, slow) = speeds[0], speeds[-1]
    return math.log(fast / slow) / math.log(high / low) if high > low and min(fast, slow) > 0.0 else 0.0
