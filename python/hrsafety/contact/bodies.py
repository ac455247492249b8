"""Bodies of limit objects: spring, mass and class that come with a limit, and how large the part of the body is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from hrsafety.contact.covering import Covering, Region, region_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

__all__ = [
    "OWN",
    "Body",
    "agreeing",
    "body_of",
    "contact_width_doubt",
    "knows",
    "larger_than_part",
    "part_of",
    "spread_agrees",
]

_REMEDY = "leave it out, or give limits as a mapping of force and pressure for a body of your own"
OWN = MappingProxyType(
    {
        "body_mass": "body_mass",
        "stiffness": "spring_constant",
        "force_limit": "force",
        "pressure_limit": "pressure",
    }
)
"""Numbers of a contact that a limit object knows."""
_EQUAL = 1e-9
"""Relative difference up to which two numbers are the same."""

SQUARE_CENTIMETER = 1e-4
PARTS = MappingProxyType(
    {
        "finger": 4.0,
        "thumb": 4.0,
        "hand": 60.0,
        "palm": 60.0,
        "thenar": 60.0,
        "face": 60.0,
        "masticatory": 60.0,
        "lower_arm": 60.0,
        "forearm": 60.0,
        "wrist": 60.0,
        "radial bone": 60.0,
        "arm nerve": 60.0,
        "neck": 40.0,
        "shin": 40.0,
        "lower_leg": 40.0,
    }
)
"""Areas in cm^2 that parts of a body have at most, by what their names contain; a choice of this project."""
LARGEST_PART = 100.0
"""Area in cm^2 of every other part."""
_WHOLE = ("calf",)
_WITH_FINGERS = ("hand",)
"""A region that is called so, without an area, is as small as a finger."""


class BodyPart(NamedTuple):
    """A part of a body with the area that it has at most, in m^2."""

    name: str
    area: float


class Body(NamedTuple):
    """Spring of a region and its mass in kg, inf where it is clamped, ``None`` where no object has told it."""

    region: Region | None
    mass: Any


def body_of(
    limits: object,
    region: Region | Mapping[str, object] | float | None,
    body_mass: Any,
    *,
    given: Sequence[str] = (),
) -> Body:
    """Return spring and mass of a contact: those of a limit object where they are left out.

    Parameters
    ----------
    limits : object
        A mapping or ``None`` knows neither; a limit object such as `standards.ContactLimit` knows both, and with them
        whether the body is clamped.
    region, body_mass
        As given; ``None`` where they are left out.
    given : sequence of str
        Numbers that are given by name in the place of those of the object, among ``"stiffness"``, ``"body_mass"``.

    Returns
    -------
    Body
        What counts.

    Raises
    ------
    InvalidParameterError
        If a number contradicts the object, or neither has it.
    """
    if not knows(limits):
        return Body(region_of(region), body_mass)
    spring, mass = getattr(limits, "spring_constant", None), getattr(limits, "body_mass", None)
    if region is None:
        if spring is None and "stiffness" not in given:
            rule = f"be given: limits has no spring constant ({named(limits)})"
            raise InvalidParameterError("region", rule, region)
        found = None if spring is None else Region(k=spring)
    else:
        found = region_of(region)
        if spring is not None and (found is None or found.n is not None or not _same(found.k, spring)):
            rule = f"have the spring constant of limits ({named(limits)}: {spring:g} N/m)"
            raise InvalidParameterError("region", rule, region, _REMEDY)
    if body_mass is None:
        if mass is None and "body_mass" not in given:
            rule = f"be given: limits has no mass of the region ({named(limits)})"
            raise InvalidParameterError("body_mass", rule, body_mass)
        return Body(found, mass)
    agreeing("body_mass", body_mass, mass, limits)
    return Body(found, body_mass)


def knows(limits: object) -> bool:
    """Return whether limits are an object that knows the body, no mapping."""
    return limits is not None and not isinstance(limits, Mapping) and hasattr(limits, "body_mass")


def named(limits: object) -> str:
    """Return region and class of a limit object in words."""
    kind = getattr(limits, "contact", "")
    words = {"quasi_static": "clamped", "transient": "free to give way"}.get(kind, kind)
    return f"{getattr(limits, 'region', 'the region')}, {words}" if words else str(getattr(limits, "region", "region"))


def _same(value: float, own: float) -> bool:
    return math.isclose(value, own, rel_tol=_EQUAL)


def agreeing(name: str, value: Any, own: float | None, limits: object) -> None:
    """Refuse a number, or an array of them, that is not that of a limit object; what is no number is judged later."""
    if own is None:
        return
    try:
        values = np.asarray(value, dtype=np.float64).ravel()
    except (TypeError, ValueError, OverflowError):
        return
    for each in values[~np.isnan(values)].tolist():
        if not _same(each, own):
            rule = f"be that of limits ({named(limits)}: {own:g})"
            raise InvalidParameterError(name, rule, each, _REMEDY)


def spread_agrees(name: str, kind: str, parts: Sequence[float], own: float | None, limits: object) -> None:
    """Refuse a distribution whose middle is farther than its own spread from the number of a limit object."""
    if own is None or not knows(limits):
        return
    if kind in ("uniform", "triangular"):
        fits = parts[0] <= own <= parts[-1]
    elif math.isinf(own) or not parts[0] > 0.0:
        fits = False
    else:
        off = math.log(own / parts[0]) if kind == "lognormal" else own - parts[0]
        fits = abs(off) <= parts[1] + 1e-12
    if not fits:
        rule = f"be around the number of limits ({named(limits)}: {own:g}), within its own spread"
        raise InvalidParameterError(name, rule, {kind: list(parts)}, _REMEDY)


# ---- how large a part of a body is --------------------------------------------------------------


def part_of(limits: object) -> BodyPart | None:
    """Return the part of the body that a limit object is about; of a region without an area its smallest part."""
    region = getattr(limits, "region", None)
    if not isinstance(region, str):
        return None
    area = getattr(limits, "area", None)
    for name in (area, region) if isinstance(area, str) else (region,):
        text = name.lower()
        if any(word in text for word in _WHOLE):
            return BodyPart(name, LARGEST_PART * SQUARE_CENTIMETER)
        found = [most for word, most in PARTS.items() if word in text or word.replace("_", " ") in text]
        if name == region and any(word in text for word in _WITH_FINGERS):
            found.append(PARTS["finger"])
        if found:
            return BodyPart(name, min(found) * SQUARE_CENTIMETER)
    return BodyPart(area if isinstance(area, str) else region, LARGEST_PART * SQUARE_CENTIMETER)


def contact_width_doubt(pad: Covering | None, touched: Any, part: BodyPart, more: str = "") -> ResultWarning:
    """Return the doubt about a contact, bare or on a covering, that is larger than the part of the body, in m^2."""
    shape = "flat" if pad is None else pad.shape
    remedy = {"flat": "the area that it touches", "cylinder": "the length of the covering that it touches"}.get(
        shape, "a flat covering with the area that it touches"
    )
    name = part.name.replace("_", " ")
    return ResultWarning(
        "covering_larger_than_part",
        "area",
        f"the contact is {touched / SQUARE_CENTIMETER:.3g} cm2 where a part of {name} has at most "
        f"{part.area / SQUARE_CENTIMETER:g} cm2{more}: give {remedy}",
    )


def touched_area(pad: Covering | None, depth: Any, numbers: Mapping[str, Any]) -> Any:
    """Return the area that bears a contact in m^2, NaN where it is not known: force over largest stress.

    Of curved contacts that of a linear law, half the footprint; numbers may be arrays.
    """
    if pad is None or pad.shape == "flat":
        return numbers["area"]
    first = np.asarray(numbers["radius"], dtype=np.float64)
    second = np.where(np.isnan(numbers["second_radius"]), first, numbers["second_radius"])
    deep = np.maximum(np.asarray(depth, dtype=np.float64), 0.0)
    if pad.shape == "cylinder":
        return 4.0 / 3.0 * np.asarray(numbers["length"]) * np.sqrt(2.0 * first * deep)
    return math.pi * np.sqrt(first * second) * deep


def larger_than_part(
    pad: Covering | None, depth: Any, numbers: Mapping[str, Any], limits: object
) -> tuple[Any, BodyPart | None]:
    """Return where the contact is larger than the part of the body that a limit object is about, and the part."""
    part = part_of(limits)
    if part is None:
        return False, None
    with np.errstate(invalid="ignore"):
        return np.asarray(touched_area(pad, depth, numbers)) > part.area * (1.0 + _EQUAL), part
