"""Doubts about units of scenarios and lidars."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping

from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["of_lidar", "of_scenarios"]

MOST_SCENES = 100
"""So many scenarios or worlds are examined when runs end; the warnings of a table look at all."""


def of_scenarios(*positional: object, **named: object) -> Iterator[ResultWarning]:
    """Yield doubts about units of the first scenarios of a call, which may be one, a sequence or a mapping.

    Parameters
    ----------
    *positional, **named
        Arguments of the call: scenarios are the first one, or named ``scenario`` or ``scenarios``.
    """
    scenarios = positional[0] if positional else named.get("scenario", named.get("scenarios"))
    given: Iterable[object] = ()
    if hasattr(scenarios, "unit_doubts"):
        given = (scenarios,)
    elif isinstance(scenarios, Mapping):
        given = scenarios.values()
    elif isinstance(scenarios, Iterable) and not isinstance(scenarios, Iterator):
        given = scenarios
    for each in itertools.islice(given, MOST_SCENES):
        yield from getattr(each, "unit_doubts", ())


def of_lidar(name: str, lidar: Lidar) -> tuple[ResultWarning, ...]:
    """Return doubts about the units of a lidar: scans that are read with them lie elsewhere.

    Parameters
    ----------
    name : str
        How the doubts call it.
    lidar : Lidar
        The lidar.

    Returns
    -------
    tuple of ResultWarning
        With the code ``"implausible"``.
    """
    values = {
        "mounting": (lidar.mounting[:2], "mounting_offset"),
        "mounting[2]": (lidar.mounting[2], "heading"),
        "angle_min": (lidar.angle_min, "heading"),
        "range_min": (lidar.range_min, "lidar_range"),
        "range_max": (lidar.range_max, "lidar_range"),
        "range_noise": (lidar.range_noise, "lidar_noise"),
    }
    named = {f"{name}.{field}": value for field, value in values.items()}
    return implausible(
        {field: value for field, (value, _) in named.items()}, {field: kind for field, (_, kind) in named.items()}
    )
