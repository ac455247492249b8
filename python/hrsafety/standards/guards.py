"""Least distance between a light curtain or a scanner and what it guards."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import number
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import telling, warn_implausible

__all__ = ["GuardDistance", "minimum_distance"]

LOWEST_FACTOR = 15.0
LOWEST_OFFSET = 0.05
LEAST_INTRUSION = 0.85
"""Intrusion distance C in m of the highest field parallel to the floor, and of one across the way of a body."""


@displayed
class GuardDistance(NamedTuple):
    """Least distance of a guard, S = K T + C, and how it came about.

    Attributes
    ----------
    distance : float
        Least distance S in m, at least 0.1.
    first : float
        The first result in m: with a curtain that is beyond 0.5 m the lower speed of approach counts, and below 0.1 m
        that least distance.
    approach_speed : float
        Speed of approach K in m/s.
    intrusion : float
        Intrusion distance C in m.
    """

    distance: Annotated[float, "m"]
    first: Annotated[float, "m"]
    approach_speed: Annotated[float, "m/s"]
    intrusion: Annotated[float, "m"]


@telling()
def minimum_distance(
    stopping_time: float, *, capability: float | None = None, height: float | None = None
) -> GuardDistance:
    """Return the least distance between a guard and what it guards, S = K T + C.

    Parameters
    ----------
    stopping_time : float
        Time T from detection to rest in s: of the sensor, the control and the robot together.
    capability : float or None
        Detection capability in m of a light curtain that detects hands, at most 0.04: K is 2 m/s and
        C = 8 (d - 14 mm), at least 0; beyond 0.5 m again with 1.6 m/s, and at least 0.5 m. With `height`, that of
        the sensors of a field, which may not lie below 15 (d - 50 mm).
    height : float or None
        Height in m of a field parallel to the floor, at most 1: K is 1.6 m/s and C = 1.2 m - 0.4 H, at least 0.85 m.
        Without both, of a field across the way of a body: C is 0.85 m.

    Returns
    -------
    GuardDistance
        The distance in m with the speed of approach and the intrusion distance.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range: a field above 1 m, or one below which a person could creep.

    Warns
    -----
    ImplausibleWarning
        If the stopping time is hardly meant in seconds.

    Examples
    --------
    >>> from hrsafety import standards
    >>> found = standards.minimum_distance(0.32, capability=0.014)
    >>> found.first, found.distance
    (0.64, 0.512)
    """
    time = number("stopping_time", stopping_time)
    if capability is not None and height is not None:
        fine, level = number("capability", capability), number("height", height)
        lowest = LOWEST_FACTOR * (fine - LOWEST_OFFSET)
        if not 0.0 < fine < float("inf"):
            raise InvalidParameterError("capability", "be finite and positive", capability)
        if not level >= lowest:
            rule = f"be at least {lowest:g} for a capability of {fine:g}: else a person could creep below"
            raise InvalidParameterError("height", rule, height)
        capability = None
    hands = None if capability is None else number("capability", capability)
    found = _hrsafety.guard_distance(time, hands, None if height is None else number("height", height))
    warn_implausible({"stopping_time": time}, {"stopping_time": "reaction_time"})
    return GuardDistance(*found)
