"""Whether measurements of people refute what a shield assumes of their motion."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Hashable, Iterable
from typing import NamedTuple

from hrsafety._arguments import Pair
from hrsafety.navigation.laws.shield import Shield

KEPT = 2.0
"""How long a measurement is compared with later ones, in s."""
MOST_KEPT = 64
ROUNDING = 1e-9


class _Measured(NamedTuple):
    """Where somebody was, and between which instants in s."""

    first: float
    last: float
    position: Pair
    velocity: Pair


class MeasuredPeople:
    """The last measurements of everybody, compared with what a shield assumes.

    Parameters
    ----------
    shield : Shield
        What is assumed.
    person_speed : float
        Largest speed of people in m/s.
    """

    __slots__ = ("_people", "_shield", "_speed")

    def __init__(self, shield: Shield, person_speed: float) -> None:
        self._shield, self._speed = shield, person_speed
        self._people: dict[Hashable, deque[_Measured]] = {}

    def forget(self, names: Iterable[Hashable]) -> None:
        """Forget those who left."""
        for name in names:
            self._people.pop(name, None)

    def refuted(self, name: Hashable, now: float, position: Pair, velocity: Pair, time: float | None) -> set[str]:
        """Return which assumptions a measurement refutes: ``"faster"``, ``"accelerated"``.

        Two places too far apart for the time between them refute the speed, whatever velocity is told with them;
        their errors and the times at which they may have been measured count in favor of the assumption.
        """
        shield, found = self._shield, set[str]()
        told = _Measured(*((now - shield.latency, now) if time is None else (time, time)), position, velocity)
        if math.hypot(*velocity) > self._speed + (shield.velocity_error or 0.0):
            found.add("faster")
        before = self._people.setdefault(name, deque(maxlen=MOST_KEPT))
        while before and told.last - before[0].last > KEPT:
            before.popleft()
        for other in before:
            between = max(told.last - other.first, other.last - told.first)
            way = math.dist(told.position, other.position)
            if way > self._speed * between + 2.0 * shield.position_error + ROUNDING:
                found.add("faster")
            if shield.velocity_error is None or shield.person_acceleration is None:
                continue
            changed = math.dist(told.velocity, other.velocity)
            if changed > shield.person_acceleration * between + 2.0 * shield.velocity_error + ROUNDING:
                found.add("accelerated")
        before.append(told)
        return found
