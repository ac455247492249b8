"""Certificates that a scene can be solved though nobody gives way."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

import numpy as np

from hrsafety._arguments import Array, instance, sequence
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.certificates import Found, earliest_arrivals
from hrsafety.navigation.crowd.world import World

__all__ = ["Certificate", "certify", "certify_many"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Certificate:
    """When a patient robot that knows the future arrives.

    Parameters
    ----------
    arrival_time : float
        The earliest instant at which it is within 0.3 m of the goal, in s; NaN if it cannot be there in time.
    path : ndarray of shape (n, 2)
        One such way, a place every 0.2 s, in m; empty without one.
    """

    arrival_time: Annotated[float, "s"]
    path: Annotated[Array, "m"]

    @property
    def solvable(self) -> bool:
        """Whether there is a way."""
        return not np.isnan(self.arrival_time)


def certify(scene: World) -> Certificate:
    """Return when a robot that knows the future arrives in a world.

    People walk as they would without robots. The places that the robot can have reached are kept every 0.2 s, as nodes
    every 0.05 m from its start: those within 0.16 m of the last ones, at 0.8 m/s, that are 0.08 m clear of walls and
    0.05 m of people, now and 0.1 s before and after. The speed leaves room for the acceleration, which is not looked
    at, and the first robot alone is. A certificate is no promise that people who react let a robot pass.

    Parameters
    ----------
    scene : World
        A world with a robot.

    Returns
    -------
    Certificate
        Arrival and way.

    Raises
    ------
    InvalidParameterError
        If the world has no robot, repeats itself, has a step that does not divide 0.1 s, or is too large.

    Examples
    --------
    >>> from hrsafety import arena, scenarios
    >>> round(arena.certify(scenarios.social("narrow_doorway", 0)).arrival_time, 6)
    10.6
    """
    return certify_many([scene])[0]


def certify_many(scenes: Iterable[World], *, threads: int | None = None) -> list[Certificate]:
    """Return the certificates of many worlds.

    Parameters
    ----------
    scenes : iterable of World
        Worlds with a robot.
    threads : int or None
        Number of threads; all cores when ``None``.

    Returns
    -------
    list of Certificate
        As `certify` has them.

    Raises
    ------
    InvalidParameterError
        As `certify`, with the index of the world.

    Examples
    --------
    >>> from hrsafety import arena, scenarios
    >>> found = arena.certify_many(scenarios.social("blind_corner", seed) for seed in range(3))
    >>> [each.solvable for each in found]
    [True, True, True]
    """
    worlds = [
        instance(f"scenes[{index}]", each, World)
        for index, each in enumerate(sequence("scenes", "be a sequence of worlds", scenes))
    ]
    try:
        found = earliest_arrivals(worlds, threads)
    except InvalidParameterError as error:
        raise error.renamed(error.argument.replace("worlds", "scenes", 1)) from None
    return [_of(each) for each in found]


def _of(found: Found) -> Certificate:
    if found is None:
        return Certificate(arrival_time=float("nan"), path=np.empty((0, 2)))
    return Certificate(arrival_time=found[0], path=np.array(found[1]))
