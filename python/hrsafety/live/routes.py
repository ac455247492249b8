"""Who is where on the way: people of a world as they are at an instant, so that it can continue otherwise."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety._arguments import Array, Pair
from hrsafety.navigation.crowd.agents import Person, points_of

__all__ = ["Walker"]


class Walker:
    """A person of a running world.

    Parameters
    ----------
    person : Person
        As in the world, with everything that is drawn.
    """

    def __init__(self, person: Person) -> None:
        self.person = person
        self.next = 0
        self.held: Pair | None = None
        self.moved = False

    def pass_by(self, place: Array) -> None:
        """Notice which element of the route has been reached."""
        route = self.person.route
        if self.next < len(route) and self._away(place) <= self.person.arrival_radius:
            self.next += 1
            if self.next == len(route) and self.person.at_end == "repeat":
                self.next = 0

    def _away(self, place: Array) -> float:
        """Return how far the next element of the route is, in m."""
        ends = np.array(points_of(self.person.route[self.next]))
        way = ends[-1] - ends[0]
        square = float(way @ way)
        share = 0.0 if square == 0.0 else float(np.clip((place - ends[0]) @ way / square, 0.0, 1.0))
        return float(np.linalg.norm(place - ends[0] - share * way))

    def left(self, time: float, place: Array | None, velocity: Array, pace: float) -> Person | None:
        """Return the person for a world that begins at a time, ``None`` for who will not be there any more.

        Parameters
        ----------
        time : float
            When, in s.
        place : ndarray of shape (2,), or None
            Where the person is, in m; ``None`` while absent.
        velocity : ndarray, shape (2,)
            In m/s.
        pace : float
            Desired speed over that of the person.
        """
        person = self.person
        if self.held is not None:
            return replace(
                person, start=self.held, velocity=(0.0, 0.0), route=(), at_end="stay", enters=0.0, recording=None
            )
        if person.recording is not None and not self.moved:
            times, places = (np.asarray(each, dtype=np.float64) for each in person.recording)
            if time >= times[-1]:
                return None
            first = max(int(np.searchsorted(times, time, side="right")) - 1, 0)
            shifted = times[first:] - time
            return replace(person, recording=(tuple(shifted.tolist()), tuple(map(tuple, places[first:].tolist()))))
        if place is None and person.enters <= time:
            return None
        speed = None if person.desired_speed is None else max(person.desired_speed * pace, 0.01)
        whole = tuple(person.route)
        route = whole[self.next :] + (whole[: self.next] if person.at_end == "repeat" else ())
        at_end = person.at_end if route else "stay"
        changes: dict[str, Any] = {"desired_speed": speed, "route": route, "at_end": at_end, "recording": None}
        if place is None:
            return replace(person, **changes, enters=person.enters - time)
        return replace(person, **changes, start=_pair(place), velocity=_pair(velocity), enters=0.0)


def _pair(values: Array) -> Pair:
    x, y = values.tolist()
    return x, y
