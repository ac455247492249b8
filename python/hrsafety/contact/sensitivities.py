"""How an allowed speed changes with each number that is given."""

from __future__ import annotations

import math
from collections.abc import Mapping

from hrsafety import _hrsafety
from hrsafety.contact.bodies import body_of
from hrsafety.contact.covering import Covering, Region, covering_of
from hrsafety.contact.rows import contact_row, in_order, limits_of
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["sensitivity"]

_STEP = 1e-5
_FIXED = ("bottoming_strain", "horizon", "backing_stiffness", "unloading_retained", "unloading_exponent")
"""Numbers without a sensitivity: an allowed speed belongs to the first loading."""


def sensitivity(
    *,
    robot_mass: float,
    region: Region | Mapping[str, object] | float | None = None,
    limits: object,
    body_mass: float | None = None,
    covering: Covering | Mapping[str, object] | None = None,
    area: float | None = None,
    max_strain: float | None = None,
) -> dict[str, float]:
    """Return d ln v/d ln x of the allowed speed for every number x that is given, the largest first.

    Parameters
    ----------
    robot_mass, region, limits, body_mass, covering, area, max_strain
        As for `allowed_speed`; without supports and stop.

    Returns
    -------
    dict of str to float
        By name; central differences. At a tie of two limits each side has its own slope, and this is
        the mean.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or nothing limits the speed.

    Examples
    --------
    >>> from hrsafety import contact
    >>> found = contact.sensitivity(robot_mass=10.0, region=75e3, limits={"force": 280.0})
    >>> {name: round(value, 6) for name, value in found.items()}
    {'force_limit': 1.0, 'robot_mass': -0.5, 'stiffness': -0.5}
    """
    body = body_of(limits, region, body_mass)
    shared, values = contact_row(
        robot_mass=robot_mass,
        body_mass=body.mass,
        region=body.region,
        covering=covering,
        tolerance=1e-10,
        area=area,
        max_strain=max_strain,
    )
    values |= limits_of(limits)
    pad = covering_of(covering)
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
