"""Whether measurements of people refute what a shield assumes of their motion."""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Hashable, Iterable
from typing import NamedTuple

from hrsafety._arguments import Pair
from hrsafety.navigation.laws.shield import Shield

KEPT = 2.0
"""How long a measurement is compared with later ones, in s."""
MOST_KEPT = 64
LEAST_KEPT = 0.5
"""Velocities that no bound is assumed of are compared with places over at least this time, in s."""
SLACK = 0.3
"""They are wrong if they differ from how a person moves by more than this, in m/s."""
ROUNDING = 1e-9


class _Measured(NamedTuple):
    """Where a person was, and between which instants in s."""

    first: float
    last: float
    position: Pair
    velocity: Pair | None


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

    def rename(self, name: Hashable, former: Hashable) -> None:
        """Take a person who was known under another name for the same."""
        if former in self._people:
            self._people[name] = self._people.pop(former)

    def refuted(
        self, name: Hashable, now: float, position: Pair, velocity: Pair | None, time: float | None
    ) -> set[str]:
        """Return what a measurement refutes: ``"faster"``, ``"accelerated"``, ``"velocity_off"``.

        Two places too far apart for the time between them refute the speed, whatever velocity is told with them;
        their errors and the times at which they may have been measured count in favor of the assumption.
        """
        shield, found = self._shield, set[str]()
        told = _Measured(*((now - shield.latency, now) if time is None else (time, time)), position, velocity)
        if velocity is not None and math.hypot(*velocity) > self._speed + (shield.velocity_error or 0.0):
            found.add("faster")
        before = self._people.setdefault(name, deque(maxlen=MOST_KEPT))
        # Also where the clock was set back in between.
        while before and abs(told.last - before[0].last) > KEPT:
            before.popleft()
        for other in before:
            between = max(told.last - other.first, other.last - told.first)
            way = math.dist(told.position, other.position)
            if way > self._speed * between + 2.0 * shield.position_error + ROUNDING:
                found.add("faster")
            if shield.velocity_error is None or shield.person_acceleration is None:
                continue
            if told.velocity is None or other.velocity is None:
                continue
            changed = math.dist(told.velocity, other.velocity)
            if changed > shield.person_acceleration * between + 2.0 * shield.velocity_error + ROUNDING:
                found.add("accelerated")
            spread = (shield.velocity_error + 0.5 * shield.person_acceleration * between) * between
            least = max(0.0, min(told.first - other.last, other.first - told.last, key=abs))
            for known in (told.velocity, other.velocity):
                off = _apart(told.position, other.position, known, least, between)
                if off > spread + 2.0 * shield.position_error + ROUNDING:
                    found.add("velocity_off")
        before.append(told)
        if shield.velocity_error is None and self._moves_otherwise(before):
            found.add("velocity_off")
        return found

    def _moves_otherwise(self, measured: deque[_Measured]) -> bool:
        """Return whether the velocities that were told lead elsewhere than where a person is now."""
        first, last = measured[0], measured[-1]
        lasted = last.last - first.last
        if lasted < LEAST_KEPT:
            return False
        x, y = first.position
        for one, other in itertools.pairwise(measured):
            if one.velocity is None or other.velocity is None:
                return False
            step = 0.5 * (other.last - one.last)
            x += step * (one.velocity[0] + other.velocity[0])
            y += step * (one.velocity[1] + other.velocity[1])
        uncertain = 2.0 * self._shield.position_error + self._speed * (last.last - last.first)
        return math.dist((x, y), last.position) > SLACK * lasted + uncertain


def _apart(later: Pair, sooner: Pair, velocity: Pair, least: float, most: float) -> float:
    """Return how far a way is from any that a velocity leads in a time between two, in s; in m."""
    way = (later[0] - sooner[0], later[1] - sooner[1])
    square = velocity[0] ** 2 + velocity[1] ** 2
    time = 0.0 if square == 0.0 else (way[0] * velocity[0] + way[1] * velocity[1]) / square
    time = min(max(time, least), most)
    return math.dist(way, (velocity[0] * time, velocity[1] * time))
