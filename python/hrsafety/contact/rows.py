"""Arguments as rows of numbers for the core."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, number, numbers, positive
from hrsafety._bounds import MOST_CONTACTS
from hrsafety._words import meant
from hrsafety.contact.covering import Covering, Region, covering_of, region_of
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import ResultWarning

__all__ = [
    "HORIZON",
    "TOLERANCE",
    "Prepared",
    "applying",
    "columns_of",
    "contact_row",
    "in_order",
    "limits_of",
    "mass_of",
    "missing_limits",
    "row_name",
    "spring_of",
]

NAMES: tuple[str, ...] = tuple(_hrsafety.contact_names())
HORIZON = 0.2
"""Time after which a collision is left alone, in s."""
TOLERANCE = 1e-8
"""Relative tolerance of simulations: peak forces are within about 1e-6."""
_SUPPORTS = ("robot_damping", "robot_stiffness", "body_damping", "body_stiffness")
_SIMULATED = (*_SUPPORTS, "horizon", "stop_time", "stop_deceleration")
_STORED = ("thickness", "bottoming_strain", "backing_stiffness")
_LOST = ("damping", "rate_base", "rate_slope", "rate_reference", "unloading_retained", "unloading_exponent")
_SHAPES = {
    "flat": ("area",),
    "curved": ("radius", "second_radius"),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
}
_REGIONS = {"rigid": (), "spring": ("stiffness", "region_cubic"), "power": ("stiffness", "region_exponent")}


class Prepared(NamedTuple):
    """A contact as the core reads it.

    Attributes
    ----------
    shared : dict
        What is no number: law, shape, region.
    values : dict of str to float
        Numbers of a row by name.
    pad : Covering or None
        The covering.
    limits : object
        What says which limits hold, and for which part of the body.
    doubts : tuple of ResultWarning
        Those about the robot and the limits.
    """

    shared: dict[str, object]
    values: dict[str, float]
    pad: Covering | None
    limits: object
    doubts: tuple[ResultWarning, ...]


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


def missing_limits(values: Mapping[str, float], *, bare: bool) -> tuple[str, ...]:
    """Return the limits that are not checked: none is given, or no area of a bare contact."""
    return tuple(
        name
        for name in ("force", "pressure")
        if math.isnan(values[f"{name}_limit"]) or (name == "pressure" and bare and math.isnan(values["area"]))
    )


def mass_of(name: str, value: object) -> float:
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
    stop: tuple[float, float] | None = None,
    **more: object,
) -> tuple[dict[str, object], dict[str, float]]:
    """Return what is no number, and the numbers by name."""
    spring, pad = region_of(region), covering_of(covering)
    shared: dict[str, object] = {"law": None, "strain": [], "stress": [], "outline": None}
    values = dict.fromkeys(NAMES, math.nan)
    values |= {"robot_mass": mass_of("robot_mass", robot_mass), "body_mass": mass_of("body_mass", body_mass)}
    values |= dict.fromkeys(_SUPPORTS, 0.0) | {"horizon": HORIZON}
    if pad is not None:
        shared, values = shared | pad.shared(), values | pad.numbers()
    if spring is not None:
        values |= spring.numbers()
    shared |= {"region": "rigid" if spring is None else spring.kind, "tolerance": number("tolerance", tolerance)}
    values |= {name: number(name, more[name]) for name in (*_SUPPORTS, "closing_speed", "horizon") if name in more}
    if more.get("max_strain") is not None:
        if pad is None:
            raise InvalidParameterError("max_strain", "be None without a covering", more["max_strain"])
        values["max_strain"] = positive("max_strain", more["max_strain"])
    if more.get("area") is not None:
        if pad is not None:
            raise InvalidParameterError("area", "be None with a covering, which has its own", more["area"])
        values["area"] = positive("area", more["area"])
    if stop is not None:
        values["stop_time"], values["stop_deceleration"] = stop
    return shared, values


def in_order(values: Mapping[str, float]) -> list[float]:
    """Return the numbers of a row as the core reads them."""
    return [values[name] for name in NAMES]


def spring_of(
    region: Region | Mapping[str, object] | float | None, given: Mapping[str, object]
) -> Region | Mapping[str, object] | float | None:
    """Return the region, a spring where its stiffness is given by name."""
    return 1.0 if region is None and "stiffness" in given else region


def applying(kind: str, region: object, covering: Covering | None) -> dict[str, str]:
    """Return which numbers have an effect, with their names in a row: all others are refused, not ignored.

    ``kind`` is ``"collide"``, ``"speed"`` or ``"chance"``, an allowed speed from the stored energy.
    """
    names = ["robot_mass", "body_mass", *_REGIONS[str(region)]]
    names += ["closing_speed"] if kind == "collide" else ["force_limit", "pressure_limit"]
    if kind != "chance":
        names += _SIMULATED
    if covering is None:
        return {name: name for name in (names if kind == "collide" else [*names, "area"])}
    names += [*_STORED, *_SHAPES[covering.shape]]
    if kind != "chance":
        names += _LOST
    if kind != "collide":
        names += ["max_strain"]
    law = {name: f"material_{place}" for place, name in enumerate(covering.material.keys.values())}
    return {name: name for name in names} | law | {f"material.{name}": place for name, place in law.items()}


def row_name(argument: str, name: str, names: Mapping[str, str]) -> str:
    """Return the name of a number in a row, or say which names have an effect."""
    if name not in names:
        remedy = "it has no effect on this contact" if name in NAMES else meant(name, names)
        raise InvalidParameterError(argument, f"be among {', '.join(names)}", name, remedy)
    return names[name]


def columns_of(
    values: Mapping[str, float], arrays: Mapping[str, object], names: Mapping[str, str]
) -> tuple[list[Array | float], tuple[int, ...]]:
    """Return columns with arrays in the place of numbers, and the shape that they broadcast to."""
    given: dict[str, Array] = {}
    shape: tuple[int, ...] = ()
    for name, value in arrays.items():
        place = row_name("arrays", name, names)
        array = numbers(name, value)
        try:
            shape = np.broadcast_shapes(shape, array.shape)
        except ValueError:
            raise ShapeError(name, f"that broadcasts with {shape}", array.shape) from None
        given[place] = array
    rows = math.prod(shape)
    if rows > MOST_CONTACTS:
        raise InvalidParameterError(" and ".join(arrays), f"ask for at most {MOST_CONTACTS} contacts", rows)
    columns: list[Array | float] = []
    for name in NAMES:
        if name not in given:
            columns.append(values[name])
        # One number for all rows; no number at all is one of a row, which is invalid then.
        elif given[name].size == 1 and not np.isnan(given[name]).any():
            columns.append(float(given[name].flat[0]))
        else:
            columns.append(np.ascontiguousarray(np.broadcast_to(given[name], shape)).reshape(-1))
    return columns, shape
