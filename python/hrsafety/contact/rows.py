"""Arguments as rows of numbers for the core."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, not_negative, number, numbers, positive
from hrsafety._words import meant
from hrsafety.contact.covering import Covering, Region, covering_of, region_of
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["HORIZON", "Rows", "contact_row", "limits_of"]

NAMES: tuple[str, ...] = tuple(_hrsafety.contact_names())
HORIZON = 0.2
"""Time after which a collision is left alone, in s."""
_SUPPORTS = ("robot_damping", "robot_stiffness", "body_damping", "body_stiffness")
Rows = tuple[dict[str, object], dict[str, Any]]


def limits_of(given: object) -> dict[str, float]:
    """Return the limits of a class of contact as numbers of a row, NaN where there is none."""
    if given is None:
        return {"force_limit": math.nan, "pressure_limit": math.nan}
    if isinstance(given, Mapping):
        for key in given:
            if key not in ("force", "pressure"):
                raise InvalidParameterError(
                    "limits", "have no keys but force, pressure", key, meant(key, ("force", "pressure"))
                )
        found = {name: given.get(name) for name in ("force", "pressure")}
    else:
        missing = [name for name in ("force", "pressure") if not hasattr(given, name)]
        if missing:
            raise InvalidParameterError("limits", "be a mapping or have force and pressure", given)
        if not getattr(given, "permitted", True):
            raise InvalidParameterError("limits", "permit the contact", str(given), "not_permitted: there is no speed")
        found = {name: getattr(given, name) for name in ("force", "pressure")}
    return {
        f"{name}_limit": math.nan if value is None else positive(f"limits.{name}", value)
        for name, value in found.items()
    }


def _mass(name: str, value: object) -> float:
    """Return a mass, which may be infinite."""
    if value is None:
        return math.inf
    given = number(name, value)
    return given if given == math.inf else positive(name, given)


def contact_row(
    *,
    robot_mass: object,
    body_mass: object,
    region: Region | Mapping[str, object] | float | None,
    covering: Covering | Mapping[str, object] | None,
    tolerance: float,
    **more: object,
) -> tuple[dict[str, object], dict[str, float]]:
    """Return what is no number, and the numbers by name."""
    spring, pad = region_of(region), covering_of(covering)
    shared: dict[str, object] = {"law": None, "strain": [], "stress": [], "outline": None, "material_varies": False}
    values = dict.fromkeys(NAMES, math.nan)
    values |= {"robot_mass": _mass("robot_mass", robot_mass), "body_mass": _mass("body_mass", body_mass)}
    values |= dict.fromkeys(_SUPPORTS, 0.0) | {"horizon": HORIZON}
    if pad is not None:
        shared, values = shared | pad.shared(), values | pad.numbers()
    if spring is not None:
        values |= spring.numbers()
    shared |= {"region": "rigid" if spring is None else spring.kind, "tolerance": number("tolerance", tolerance)}
    for name in _SUPPORTS:
        values[name] = not_negative(name, more.get(name, 0.0))
    if more.get("closing_speed") is not None:
        values["closing_speed"] = number("closing_speed", more["closing_speed"])
    if more.get("horizon") is not None:
        values["horizon"] = positive("horizon", more["horizon"])
    if more.get("max_strain") is not None:
        values["max_strain"] = positive("max_strain", more["max_strain"])
    if more.get("area") is not None:
        if pad is not None:
            raise InvalidParameterError("area", "be None with a covering, which has its own", more["area"])
        values["area"] = positive("area", more["area"])
    stop = more.get("stop")
    if stop is not None:
        if not isinstance(stop, (tuple, list)) or len(stop) != 2:
            raise InvalidParameterError("stop", "be a time and a deceleration", stop)
        values["stop_time"] = not_negative("stop.time", stop[0])
        values["stop_deceleration"] = positive("stop.deceleration", stop[1])
    return shared, values


def in_order(values: Mapping[str, float]) -> list[float]:
    """Return the numbers of a row as the core reads them."""
    return [values[name] for name in NAMES]


def columns_of(
    shared: dict[str, object], values: dict[str, float], arrays: Mapping[str, object], covering: Covering | None
) -> tuple[list[Array | float], tuple[int, ...]]:
    """Return columns with arrays in the place of numbers, and the shape that they broadcast to."""
    names = {name: name for name in NAMES if not name.startswith("material_")}
    if covering is not None:
        law = covering.material
        names |= {name: f"material_{place}" for place, name in enumerate(law.keys.values())}
        names |= {f"material.{name}": f"material_{place}" for place, name in enumerate(law.keys.values())}
    given: dict[str, Array] = {}
    shape: tuple[int, ...] = ()
    for name, value in arrays.items():
        if name not in names:
            shown = ", ".join(names)
            raise InvalidParameterError("arrays", f"be among {shown}", name, meant(name, names))
        array = numbers(name, value)
        try:
            shape = np.broadcast_shapes(shape, array.shape)
        except ValueError:
            raise ShapeError(name, f"that broadcasts with {shape}", array.shape) from None
        given[names[name]] = array
    shared["material_varies"] = any(name.startswith("material_") for name in given)
    if "radius" in given and "second_radius" not in given and values["second_radius"] == values["radius"]:
        given["second_radius"] = given["radius"]
    columns: list[Array | float] = []
    for name in NAMES:
        if name not in given:
            columns.append(values[name])
        elif given[name].size == 1:
            columns.append(float(given[name].reshape(())) if given[name].ndim == 0 else float(given[name].flat[0]))
        else:
            columns.append(np.ascontiguousarray(np.broadcast_to(given[name], shape)).reshape(-1))
    return columns, shape
