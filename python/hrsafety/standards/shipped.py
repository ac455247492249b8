"""Sets of limits that ship with the package, as data with their sources."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from importlib import resources
from typing import Any

from hrsafety.errors import InvalidParameterError
from hrsafety.standards.contact_limits import Quantity
from hrsafety.standards.limit_sets import MILLIMETER, SQUARE_CENTIMETER, LimitRow, LimitSet

__all__ = ["SETS", "shipped"]

SETS = ("iso_ts_15066_2016",)
"""Sets that ship with the package, the default one first."""


@cache
def shipped(name: str) -> LimitSet:
    """Return a set that ships with the package."""
    file = resources.files("hrsafety.standards") / "data" / f"{name}.json"
    data = json.loads(file.read_text(encoding="utf-8"))
    return LimitSet(
        id=data["id"],
        title=data["title"],
        edition=data["edition"],
        note=data["also"],
        rows=tuple(_rows(data)),
        sources=data["sources"],
    )


def _rows(data: dict[str, Any]) -> Iterator[LimitRow]:
    factors = {each["region"]: each["transient_factor"] for each in data["regions"]}
    for each in data["regions"]:
        spring = _quantity(each["spring_constant_N_per_mm"], 1.0 / MILLIMETER)
        mass = _quantity(each["effective_mass_kg"])
        force = _quantity(each["force_N"])
        for contact, numbers, permitted in _both(force, factors[each["region"]]):
            yield LimitRow(
                each["region"],
                None,
                contact,
                permitted,
                force=numbers,
                spring_constant=spring,
                effective_mass=mass,
            )
    for each in data["areas"]:
        area = each["area"] if each["side"] is None else f"{each['area']}, {each['side']}"
        pressure = _quantity(each["pressure_N_per_cm2"], 1.0 / SQUARE_CENTIMETER)
        for contact, numbers, permitted in _both(pressure, factors[each["region"]]):
            yield LimitRow(each["region"], area, contact, permitted, pressure=numbers)


def _both(limit: Quantity, factor: dict[str, Any]) -> Iterator[tuple[str, Quantity | None, bool]]:
    """Yield a limit for both classes of contact; without a factor transient contact is not permitted."""
    yield "quasi_static", limit, True
    if factor["value"] is None:
        yield "transient", None, False
    else:
        yield "transient", limit._replace(value=limit.value * factor["value"]), True


def _quantity(entry: dict[str, Any], scale: float = 1.0) -> Quantity:
    """Return a number of the data in SI units; a number without a source does not load."""
    if not entry["sources"]:
        raise InvalidParameterError("sources", "name where the number was read", entry["value"])
    return Quantity(round(entry["value"] * scale, 9), entry["certainty"], tuple(entry["sources"]))
