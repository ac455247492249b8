"""Places of people by the names that a tracker gives them, also where it gives them others in every frame."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping
from typing import NamedTuple

from hrsafety._arguments import Pair
from hrsafety.errors import InvalidParameterError, Shown

STREAK = 2
"""So many updates in a row without a known name: names tell nothing."""
MOST_LOST = 10_000
"""So many who were lost for good are remembered."""
ROUNDING = 1e-9


class Told(NamedTuple):
    """Report of a person in an update: where, how fast (``None``: not known), and when (``None``: now or before)."""

    position: Pair
    velocity: Pair | None
    time: float | None


class _Known(NamedTuple):
    """Where a person has his place in the core, and where and when he was measured last."""

    slot: int
    position: Pair
    time: float


class NamedPeople:
    """Who is known by which name, for how long, and who was lost for good.

    Parameters
    ----------
    capacity : int
        How many can be there at once.
    speed : float
        Largest speed of people in m/s.
    latency, position_error : float
        Largest age of what is told without its instant in s, and largest error of a position in m.
    age_limit : float or None
        After so many seconds without a measurement a person is lost for good.
    """

    __slots__ = ("_age_limit", "_capacity", "_error", "_known", "_latency", "_speed", "_streak", "lost")

    def __init__(
        self, capacity: int, speed: float, latency: float, position_error: float, age_limit: float | None
    ) -> None:
        self._capacity, self._speed, self._latency, self._error = capacity, speed, latency, position_error
        self._age_limit = age_limit
        self._known: dict[Hashable, _Known] = {}
        self._streak = 0
        self.lost: dict[Hashable, None] = {}

    def copy(self) -> NamedPeople:
        """Return the same people, to come back to."""
        other = NamedPeople(self._capacity, self._speed, self._latency, self._error, self._age_limit)
        other._known, other._streak, other.lost = dict(self._known), self._streak, dict(self.lost)
        return other

    @property
    def indices(self) -> dict[Hashable, int]:
        """Places in the core by names."""
        return {name: known.slot for name, known in self._known.items()}

    def outlived(self, now: float, told: Mapping[Hashable, Told], present: list[bool]) -> list[int]:
        """Return the places of those who are there and were not measured within the age limit: they are lost."""
        if self._age_limit is None:
            return []
        found = []
        for name, known in self._known.items():
            if known.time > now:
                # The clock was set back since.
                self._known[name] = known._replace(time=now)
            elif present[known.slot] and name not in told and now - known.time > self._age_limit:
                found.append(known.slot)
                self.lost[name] = None
        while len(self.lost) > MOST_LOST:
            del self.lost[next(iter(self.lost))]
        return found

    def left(self, names: list[Hashable]) -> list[int]:
        """Return the places of those who left, and are lost no more."""
        for name in names:
            self.lost.pop(name, None)
        return [self._known[name].slot for name in names if name in self._known]

    def place(self, now: float, told: Mapping[Hashable, Told], present: list[bool]) -> dict[Hashable, Hashable]:
        """Give every person of an update a place; return the former names of those who took over another person's.

        Names count as they are given, and a person with a new one is one more person. Where no name of the update
        before comes again several times in a row, or there is no place left, who is new counts as the nearest of those
        who were not measured and can have got there.
        """
        present = present or [False] * self._capacity
        there = [name for name, known in self._known.items() if present[known.slot]]
        new = [name for name in told if name not in there]
        missing = [name for name in there if name not in told]
        if told:
            self._streak = self._streak + 1 if missing and len(new) == len(told) else 0
        crowded = len(there) + len(new) > self._capacity
        renamed = self._matched(now, told, new, missing) if self._streak >= STREAK or crowded else {}
        for name, former in renamed.items():
            self._known[name] = self._known.pop(former)
        for name, (position, _, time) in told.items():
            self.lost.pop(name, None)
            index = self._index(name, told, present)
            self._known[name] = _Known(index, position, now if time is None else time)
        return renamed

    def _matched(
        self, now: float, told: Mapping[Hashable, Told], new: list[Hashable], missing: list[Hashable]
    ) -> dict[Hashable, Hashable]:
        """Return which new people can be which missing ones, the nearest first."""
        pairs = []
        for row, name in enumerate(new):
            position, _, time = told[name]
            for column, former in enumerate(missing):
                known = self._known[former]
                way = math.dist(position, known.position)
                between = max(0.0, (now if time is None else time) - known.time) + self._latency
                if way <= self._speed * between + 2.0 * self._error + ROUNDING:
                    pairs.append((way, row, column))
        found: dict[Hashable, Hashable] = {}
        taken = set[int]()
        for _, row, column in sorted(pairs):
            if new[row] not in found and column not in taken:
                found[new[row]] = missing[column]
                taken.add(column)
        return found

    def _index(self, name: Hashable, told: Mapping[Hashable, Told], present: list[bool]) -> int:
        """Return the place of a person in the core, a free one for who is new.

        A person of the same update keeps his place, though the core does not know of him yet.
        """
        if name in self._known:
            return self._known[name].slot
        taken = {known.slot for known in self._known.values()}
        free = next((index for index in range(self._capacity) if index not in taken), None)
        if free is None:
            absent = (who for who, known in self._known.items() if not present[known.slot] and who not in told)
            left = next(absent, None)
            if left is None:
                rule = f"name at most {self._capacity} who are there at once"
                remedy = f"give the controller people={self._capacity + 1}"
                raise InvalidParameterError("people", rule, Shown(f"one more, {name!r}"), remedy)
            free = self._known.pop(left).slot
        return free
