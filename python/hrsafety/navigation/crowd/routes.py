"""Routes of people around the walls of a map."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from hrsafety._arguments import Pair
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Person, Source, Waypoint, middle_of
from hrsafety.navigation.maps.guide import Guide, Plan
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning, gathered

__all__ = ["Routes", "of_routes"]

Owner = TypeVar("Owner", Person, Source)

SPACING = 0.1
"""Spacing of the nodes of plans, in m."""
ROOM = 0.15
"""Room beyond the radius that a detour keeps, where there is so much, in m: people round the corners of a route."""
ROUNDING = 1e-9


class Routes:
    """Completes routes of people through a map.

    Parameters
    ----------
    walls : StaticMap
        What stands.
    """

    def __init__(self, walls: StaticMap) -> None:
        self.walls = walls
        self._plans: dict[tuple[Pair, float], Plan] = {}

    def completed(self, owner: Owner) -> Owner:
        """Return a person or a source whose way leads around the walls, with points of detours in its route.

        Parameters
        ----------
        owner : Person or Source
            Whose route; that of who follows a recording, or moves as told, is not examined.

        Returns
        -------
        Person or Source
            The same where no straight way is blocked, or nothing leads around.
        """
        if isinstance(owner, Person) and not owner.reacts:
            return owner
        route: list[Waypoint] = []
        here: Pair = _begin(owner)
        for element in tuple(owner.route):
            there: Pair = middle_of(element)
            route += [*self._detour(here, there, owner.radius), element]
            here = there
        if owner.route and owner.at_end == "repeat":
            route += self._detour(here, middle_of(owner.route[0]), owner.radius)
        return owner if len(route) == len(owner.route) else replace(owner, route=route)

    def blocked(self, here: Pair, there: Pair, radius: float) -> bool:
        """Return whether a straight way comes nearer to walls than a radius in m, and than both of its ends do."""
        ends = float(np.min(self.walls.clearance([here, there])))
        return bool(self.walls.segment_clearance(here, there) < min(radius, ends) - ROUNDING)

    def _detour(self, here: Pair, there: Pair, radius: float) -> list[Pair]:
        """Return the points of a way around walls between two places; none where it is straight, or there is none."""
        if here == there or not self.blocked(here, there, radius):
            return []
        for size in (radius + ROOM, radius):
            path = self._path(here, there, size)
            if path:
                return self._straightened(path, size)
        return []

    def _path(self, here: Pair, there: Pair, size: float) -> list[list[float]]:
        """Return a way for a size in m, from a plan to its end that was made before if that reaches so far."""
        known = self._plans.get((there, size))
        path: list[list[float]] = [] if known is None else known.path(here).tolist()
        if path:
            return path
        try:
            plan = Guide(spacing=SPACING).plan(self.walls, radius=size, start=here, goal=there)
        except InvalidParameterError:  # no way
            return []
        self._plans[there, size] = plan
        path = plan.path(here).tolist()
        return path

    def _straightened(self, path: Sequence[Sequence[float]], size: float) -> list[Pair]:
        """Return the points at which a path has to turn, without its ends."""
        places = [(float(x), float(y)) for x, y in path]
        turns: list[Pair] = []
        here = 0
        while here < len(places) - 1:
            ahead = here + 1
            while ahead + 1 < len(places) and self._free(places[here], places[ahead + 1], size):
                ahead += 1
            turns.append(places[ahead])
            here = ahead
        return turns[:-1]

    def _free(self, here: Pair, there: Pair, size: float) -> bool:
        return bool(self.walls.segment_clearance(here, there) >= size - ROUNDING)


def _begin(owner: Person | Source) -> Pair:
    """Return where a person starts, or the middle of where people come."""
    if isinstance(owner, Person):
        return owner.start
    return 0.5 * (owner.low[0] + owner.high[0]), 0.5 * (owner.low[1] + owner.high[1])


def of_routes(people: Sequence[Person], sources: Sequence[Source], walls: StaticMap) -> tuple[ResultWarning, ...]:
    """Return a warning about routes that lead against walls, as nothing leads around them, the first of all.

    Parameters
    ----------
    people, sources : sequence of Person, Source
        Who is in the world, with completed routes.
    walls : StaticMap
        What stands.

    Returns
    -------
    tuple of ResultWarning
        With the code ``"route_blocked"``.
    """
    routes = Routes(walls)
    owners: list[tuple[str, Person | Source]] = [(f"people[{i}]", each) for i, each in enumerate(people) if each.reacts]
    owners += [(f"sources[{i}]", each) for i, each in enumerate(sources)]
    return gathered(((name, tuple(_blocked(routes, owner))) for name, owner in owners), "routes")


def _blocked(routes: Routes, owner: Person | Source) -> Iterator[ResultWarning]:
    """Yield a warning for the first blocked way of a route."""
    here = _begin(owner)
    for index, element in enumerate(owner.route):
        there = middle_of(element)
        if routes.walls.segment_clearance(here, there) == 0.0:
            message = (
                f"a wall stands in the way from ({here[0]:.4g}, {here[1]:.4g}) to ({there[0]:.4g}, {there[1]:.4g}) m, "
                f"and no way of the width {2.0 * owner.radius:.3g} m leads around: the person walks against it"
            )
            yield ResultWarning("route_blocked", f"route[{index}]", message)
            return
        here = there
