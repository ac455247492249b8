"""Giving way to people: what is wanted, as far as it meets no person."""

from __future__ import annotations

import math
from dataclasses import field

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters
from hrsafety._records import dataclass

__all__ = ["Yielding"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Yielding(Parameters):
    """Choice of a velocity that stays out of the way of people, as far as their velocities tell.

    A wanted velocity that meets no person within the horizon, everybody at his present velocity, is
    kept. Otherwise it is compared with rest and with 36 directions at three speeds, by

    ``|v - wanted|/V_max - k_g v.g/V_max + k_t (1/t_c - 1/H) + k_d (1 - c/c_p)^2``,

    with the direction g to the (local) goal, the time t_c until surfaces come nearer than
    ``clearance`` while closing, and the least clearance c within the horizon. With a shield only what is
    verified is chosen.

    Parameters
    ----------
    clearance : float
        Surfaces that come nearer than this meet, y in m.
    horizon : float
        H in s.
    time_weight : float
        k_t in s.
    distance_weight : float
        k_d.
    comfort : float
        c_p in m: a least clearance of more costs nothing.
    goal_weight : float
        k_g.
    reach : float
        People whose surface is farther away are not examined, in m; may be infinite.

    Raises
    ------
    InvalidParameterError
        If a number is negative or not finite, or one that must be positive is zero.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), yielding=nav.Yielding())
    >>> nav.simulate(scenarios.configuration("c1"), law).outcome
    'arrived'
    """

    clearance: float = 0.15
    horizon: float = 5.0
    time_weight: float = 3.8
    distance_weight: float = 1.0
    comfort: float = 0.1
    goal_weight: float = 1.3
    reach: float = math.inf
    _native: _hrsafety.Yielding = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("clearance", "horizon", "time_weight", "distance_weight", "comfort", "goal_weight", "reach")
        self._set(_native=_hrsafety.Yielding(**self._as_numbers(*names)))
