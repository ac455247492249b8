"""Separation in cell files: how the robot stops, and its speed over the distance to a person."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from types import MappingProxyType
from typing import Any

import numpy as np

from hrsafety import _keys as kind
from hrsafety._keys import Keys, checked, located
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.standards.fields import FieldDistances, field_distances, intrusion_of_field
from hrsafety.standards.separation import SpeedCurve, StoppingData, lighter_load
from hrsafety.standards.separation import speed_over_distance as allowed_over_distance

__all__ = ["distances_of", "doubts_of", "separation_of", "speed_over_distance"]


def _stops(path: str, value: Any) -> Any:
    """Check times or distances of stops: numbers in arrays, one for each load and each extension."""
    if isinstance(value, list):
        return [_stops(f"{path}[{index}]", each) for index, each in enumerate(value)]
    return kind.number(path, value)


_STOPPING: Keys = MappingProxyType(
    {**dict.fromkeys(("speed", "load", "extension"), kind.numbers), **dict.fromkeys(("time", "distance"), _stops)}
)
_FIELD = ("height", "capability")
"""Of the field of a scanner, in the place of the intrusion distance."""
_SEPARATION: Keys = MappingProxyType(
    {
        **dict.fromkeys(
            ("max_speed", "reaction_time", "deceleration", "human_speed", "uncertainty", "farthest"),
            kind.number,
        ),
        **dict.fromkeys(("intrusion", *_FIELD), kind.number),
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
    return allowed_over_distance(distance, contact_speed=contact_speed, **_rules(separation))


def distances_of(separation: Mapping[str, Any], speed: float, contact_speed: float | None) -> FieldDistances | None:
    """Return the distances for the field of a scanner from a speed of the robot by the rules of a cell.

    Parameters
    ----------
    separation : mapping
        Of a `Cell` or a program.
    speed : float
        Largest speed of the robot in m/s.
    contact_speed : float or None
        Allowed contact speed in m/s; ``None`` where contact has none.

    Returns
    -------
    FieldDistances or None
        ``None`` where the stop was not measured from that speed.
    """
    rules = _rules(separation)
    del rules["max_speed"]
    measured = rules.get("stopping")
    if measured is not None and speed > float(np.max(measured.speed)):
        return None
    return field_distances(speed, contact_speed=contact_speed, **rules)


def doubts_of(
    speeds: SpeedCurve | None,
    distances: FieldDistances | None,
    separation: Mapping[str, Any] | None,
    payload: float | None,
) -> tuple[ResultWarning, ...]:
    """Return the doubts about a separation of a robot with a payload in kg, each once."""
    parts = [each.warnings for each in (speeds, distances) if each is not None]
    if separation is not None and "stopping" in separation:
        stops = StoppingData(**separation["stopping"])
        parts.append(lighter_load("separation.stopping", stops, separation.get("load"), payload))
    return tuple(dict.fromkeys(chain.from_iterable(parts)))


def _rules(separation: Mapping[str, Any]) -> dict[str, Any]:
    """Return the rules as the functions of distances take them."""
    rules = {name: value for name, value in separation.items() if name not in ("farthest", *_FIELD)}
    reached = intrusion_of_field(*(separation.get(name) for name in ("intrusion", *_FIELD)))
    if reached is not None:
        rules["intrusion"] = reached
    if "stopping" in rules:
        with located("stopping"):
            rules["stopping"] = StoppingData(**separation["stopping"])
    return rules
