"""Separation in cell files: how the robot stops, and its speed over the distance to a person."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety._keys import Keys, checked, located
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.separation import SpeedCurve, StoppingData
from hrsafety.standards.separation import speed_over_distance as allowed_over_distance

__all__ = ["separation_of", "speed_over_distance", "stopping_of"]


def _stops(path: str, value: Any) -> Any:
    """Check times or distances of stops: numbers in arrays, one for each load and each extension."""
    if isinstance(value, list):
        return [_stops(f"{path}[{index}]", each) for index, each in enumerate(value)]
    return kind.number(path, value)


_STOPPING: Keys = MappingProxyType(
    {**dict.fromkeys(("speed", "load", "extension"), kind.numbers), **dict.fromkeys(("time", "distance"), _stops)}
)
_SEPARATION: Keys = MappingProxyType(
    {
        **dict.fromkeys(
            ("max_speed", "reaction_time", "deceleration", "human_speed", "intrusion", "uncertainty", "farthest"),
            kind.number,
        ),
        "stopping": kind.table,
        **dict.fromkeys(("load", "extension"), kind.number),
    }
)
_SEPARATION_DEFAULTS = {"human_speed": 1.6, "farthest": 3.0}


def separation_of(table: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """Return the checked rules of a cell with their defaults, ``None`` without any.

    Parameters
    ----------
    table : mapping or None
        ``[separation]`` of the file.

    Returns
    -------
    dict or None
        Numbers by name, and measured stops as a table; intrusion and uncertainty only where they are given.
    """
    if table is None:
        return None
    given = {
        **_SEPARATION_DEFAULTS,
        **checked("separation", table, _SEPARATION, required=("max_speed", "reaction_time")),
    }
    if not 0.0 < given["farthest"] <= 100.0:
        raise InvalidParameterError("separation.farthest", "be above 0 and at most 100", given["farthest"])
    if "stopping" in given:
        path = "separation.stopping"
        given["stopping"] = checked(path, given["stopping"], _STOPPING, required=("speed", "time", "distance"))
    elif "deceleration" not in given:
        remedy = "give it, or the table of measured stops [separation.stopping] in its place"
        raise kind.missing("separation.deceleration", remedy)
    for name in ("load", "extension"):
        if name in given and "stopping" not in given:
            rule = "stand beside [separation.stopping]: a deceleration holds for every one"
            raise InvalidParameterError(f"separation.{name}", rule, given[name])
    with located("separation"):
        speed_over_distance([given["farthest"]], given, contact_speed=None)
    return given


def speed_over_distance(distance: object, separation: Mapping[str, Any], *, contact_speed: float | None) -> SpeedCurve:
    """Return the speed at each distance by the rules of a cell.

    Parameters
    ----------
    distance : array_like (n,)
        In m.
    separation : mapping
        Of a `Cell`.
    contact_speed : float or None
        Allowed contact speed in m/s; ``None`` where contact is not permitted.

    Returns
    -------
    SpeedCurve
        The speeds.
    """
    rules = {name: value for name, value in separation.items() if name != "farthest"}
    if "stopping" in rules:
        rules["stopping"] = stopping_of(separation)
    return allowed_over_distance(distance, contact_speed=contact_speed, **rules)


def stopping_of(separation: Mapping[str, Any]) -> StoppingData:
    """Return the measured stops of a cell."""
    with located("stopping"):
        return StoppingData(**separation["stopping"])
