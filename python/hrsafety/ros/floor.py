"""People of a world around a robot that is driven from outside."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, Pair
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Robot
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.situation import Situation
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.trajectory import Divergence

__all__ = ["Crowd", "largest_step", "walk"]

_FAR = 9_000.0
"""How far away the goal is of the robot that people see: it never arrives, in m."""
_FASTEST = 1e6
"""Its limits in m/s and m/s^2 let it be wherever it is put."""
_SIGHT = 1e5
_STRIDE = 6.0
"""No person who comes from a source is faster, in m/s: who is farther away than that is another person."""


@dataclass(frozen=True, slots=True, eq=False)
class Crowd:
    """People at an instant, n of them.

    Attributes
    ----------
    number : ndarray of int, shape (n,)
        Who; numbers stay with a person and are not used again.
    position, velocity : ndarray, shape (n, 2)
        In m and m/s.
    radius : ndarray, shape (n,)
        In m.
    """

    number: npt.NDArray[np.int64]
    position: Array
    velocity: Array
    radius: Array


def largest_step(world: World, period: float, *, at_most: float) -> float:
    """Return the largest step in s, a whole part of a period, at which all people of a world decide anew."""
    models = [*(each.model for each in world.people), *(each.model for each in world.sources)]
    step = min([period, at_most, *(model.largest_step for model in models)])
    return period / math.ceil(period / step - 1e-9)


def walk(world: World, step: float, meet: Callable[[float, Crowd], Pair | None]) -> Divergence | None:
    """Let the people of a world walk, and put the robot among them where it is told to be.

    Parameters
    ----------
    world : World
        The world; its law drives nothing.
    step : float
        Time step in s, of `largest_step`.
    meet : callable
        Called at every instant with the time in s and who is there; returns where the robot is a step later, in m, or
        ``None`` to end.

    Returns
    -------
    Divergence or None
        Whose state was no longer finite, which ended the world.

    Raises
    ------
    InvalidParameterError
        If the world has not one robot, or repeats itself.
    """
    if len(world.robots) != 1:
        raise InvalidParameterError("world.robots", "be one robot", len(world.robots))
    if world.period != (0.0, 0.0):
        raise InvalidParameterError("world.period", "be (0, 0): a map does not repeat itself", world.period)
    (given,) = world.robots
    body = HolonomicRobot(mass=1.0, radius=given.body.radius, max_speed=_FASTEST, max_acceleration=_FASTEST)
    robot = Robot(
        body,
        start=given.start,
        goal=(given.start[0] + _FAR, given.start[1]),
        law=_Put(world, step, meet),
        sensing_range=_SIGHT,
    )
    # One step more than the longest time: the last instant is met, too.
    put = replace(world, robots=[robot], step=step, time_limit=world.time_limit + 2.0 * step)
    try:
        return simulated([put], threads=1)[0].diverged
    except _Ended:
        return None


class _Ended(Exception):  # noqa: N818  # not an error
    """The robot is no longer put anywhere."""


class _Put:
    """Law of a robot that is where it is told to be, whatever else a law would do."""

    def __init__(self, world: World, step: float, meet: Callable[[float, Crowd], Pair | None]) -> None:
        self._step, self._meet = step, meet
        self._people = len(world.people)
        told = () if isinstance(world.walls, StaticMap) else world.walls
        self._walls = sum(len(wall) - 1 if isinstance(wall, tuple) else 1 for wall in told)
        self._next = self._people
        self._guests = (np.empty(0, dtype=np.int64), np.empty((0, 2)))
        """Numbers and places of those who came from sources, by their places in the list; below 0 for nothing."""

    def velocity(self, situation: Situation) -> Pair:
        """Return the velocity that brings the robot where it is to be."""
        place = self._meet(situation.time, self._crowd(situation))
        if place is None:
            raise _Ended
        x, y = situation.position
        return (place[0] - x) / self._step, (place[1] - y) / self._step

    def _crowd(self, situation: Situation) -> Crowd:
        """Return who is there, with numbers."""
        last = len(situation.obstacle_present) - self._walls
        there = np.flatnonzero(situation.obstacle_present[:last])
        position, velocity = situation.obstacle_position[there], situation.obstacle_velocity[there]
        known = int(np.searchsorted(there, self._people))
        number = there.astype(np.int64)
        if last > self._people:
            number[known:] = self._named(there[known:] - self._people, position[known:], last - self._people)
        return Crowd(number, position, velocity, situation.obstacle_radius[there])

    def _named(self, slot: npt.NDArray[np.intp], position: Array, slots: int) -> npt.NDArray[np.int64]:
        """Return numbers of those who came from sources, by their places in the list, which another person may take."""
        numbers, places = self._guests
        found = np.full(len(slot), -1, dtype=np.int64)
        if len(numbers) == slots:
            same = np.hypot(*(position - places[slot]).T) <= _STRIDE * self._step
            found[same] = numbers[slot[same]]
        elif (numbers >= 0).any() and len(slot):  # the list has grown, and everybody has another place
            away = np.linalg.norm(position[:, None] - places[None], axis=2)
            nearest = np.argmin(np.where(numbers >= 0, away, np.inf), axis=1)
            same = away[np.arange(len(slot)), nearest] <= _STRIDE * self._step
            found[same] = numbers[nearest[same]]
            _, first = np.unique(found, return_index=True)
            found[np.setdiff1d(np.arange(len(slot)), first)] = -1
        new = np.flatnonzero(found < 0)
        found[new] = self._next + np.arange(len(new))
        self._next += len(new)
        numbers, places = np.full(slots, -1, dtype=np.int64), np.full((slots, 2), np.nan)
        numbers[slot], places[slot] = found, position
        self._guests = (numbers, places)
        return found
