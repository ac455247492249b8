"""Contacts of a robot with people: whether it moved then, and whether toward them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.navigation.metrics.between import ALONG, PASSED, Outlined, distances_of, paths_of, until_arrival
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.trajectory import CONTACT_SPEED, DECIDED_OVERLAP

__all__ = [
    "APPEARING",
    "Contacts",
    "FirstTouch",
    "Touches",
    "appears_until",
    "contacts_of",
    "touch_of",
    "touch_of_outline",
    "touches_of",
    "touching_share",
]

APPEARING = 0.2
"""A contact so soon after a person appears in the scene is counted apart, in s."""


class Contacts(NamedTuple):
    """Numbers of people that a robot touched up to its arrival.

    Robot and people move straight from instant to instant; a contact between two instants counts.

    Attributes
    ----------
    toward, away : int
        The robot was faster than 0.05 m/s at the first touch (in the step into it), and moved toward the person,
        V.(o - P) > 0 with its velocity V, its place P and that o of the person at that touch, or it did not.
    standing : int
        It was not faster.
    at_fault : int
        It moved toward them, faster than 0.05 m/s, at an instant of a contact from the first touch until the
        bodies first overlapped by 0.1 m.
    apart : int
        They appeared in the scene where the robot was, and touched it within 0.2 s: in none of the others.
    """

    toward: int
    away: int
    standing: int
    at_fault: int
    apart: int

    @property
    def moving(self) -> int:
        """Number of people touched while the robot was moving."""
        return self.toward + self.away


class Touches(NamedTuple):
    """First touches of a robot and each of m people, up to its arrival.

    Attributes
    ----------
    time, speed : ndarray, shape (m,)
        When, in s, and how fast the robot was, in m/s: 0 where they overlapped by 0.1 m from the start. NaN without.
    toward, at_fault, apart : ndarray of bool, shape (m,)
        As of `Contacts`.
    """

    time: Array
    speed: Array
    toward: npt.NDArray[np.bool_]
    at_fault: npt.NDArray[np.bool_]
    apart: npt.NDArray[np.bool_]

    @property
    def counted(self) -> bool:
        """Whether there is a touch other than by a person who appeared where the robot was."""
        return bool(np.isfinite(self.time).any())


class FirstTouch(NamedTuple):
    """A first touch of one person, as of `Touches`."""

    time: float = math.nan
    speed: float = math.nan
    toward: bool = False
    at_fault: bool = False
    apart: bool = False


def touches_of(episode: Episode, arrival_time: float) -> Touches:
    """Return the first touches of a robot and people, from positions alone.

    Parameters
    ----------
    episode : Episode
        The robot and the people.
    arrival_time : float
        When the robot arrived, in s; NaN if it did not.

    Returns
    -------
    Touches
        Of every person.
    """
    own, people = until_arrival(episode, arrival_time)
    found = [FirstTouch()] * (people.shape[1] if people.ndim == 3 else 0)
    if people.size and len(own) > 1:
        start, way, nearest = paths_of(episode, own, people)
        reach = episode.robot_radius + np.asarray(episode.person_radius)
        with np.errstate(invalid="ignore"):
            touching = distances_of(episode, start) < reach
            near = (nearest < reach - PASSED) | touching[:-1] | touching[1:]
        # Steps in which a person comes or goes have no way.
        near &= np.isfinite(nearest)
        velocity = np.diff(own, axis=0) / episode.step
        radii = np.broadcast_to(reach, people.shape[1])
        for person in np.flatnonzero(near.any(axis=0)).tolist():
            appears = appears_until(people[:, person], episode.step)
            paths, steps = (start[:-1, person], way[:, person]), np.flatnonzero(near[:, person])
            if episode.footprint is None:
                found[person] = touch_of(steps, paths, velocity, float(radii[person]), appears, episode.step)
            else:
                found[person] = touch_of_outline(episode, (steps, person), paths, velocity, appears)
        # Whoever is there at single instants only has appeared.
        for person in np.flatnonzero(touching.any(axis=0) & ~near.any(axis=0)).tolist():
            found[person] = FirstTouch(apart=True)
    rows = np.array(found, dtype=np.float64).reshape(-1, len(FirstTouch._fields)).T
    return Touches(rows[0], rows[1], *(row > 0.0 for row in rows[2:]))


def contacts_of(episode: Episode, arrival_time: float) -> Contacts:
    """Return the people that a robot touched, from positions alone.

    Parameters
    ----------
    episode : Episode
        The robot and the people.
    arrival_time : float
        When the robot arrived, in s; NaN if it did not.

    Returns
    -------
    Contacts
        Numbers of people.
    """
    found = touches_of(episode, arrival_time)
    moving = found.speed > CONTACT_SPEED
    kinds = (found.toward, moving & ~found.toward, found.speed <= CONTACT_SPEED, found.at_fault, found.apart)
    return Contacts(*(int(kind.sum()) for kind in kinds))


def appears_until(path: Array, step: float) -> float:
    """Return up to which number of steps a contact is counted apart; negative for who is there at the start."""
    first = int(np.argmax(np.isfinite(path[:, 0])))
    return -1.0 if first == 0 else first + APPEARING / step + 1e-9


def touch_of(
    steps: npt.NDArray[np.intp],
    paths: tuple[Array, Array],
    velocity: Array,
    reach: float,
    appears: float,
    length: float,
) -> FirstTouch:
    """Return what the steps in which a person touches the robot make of it.

    Parameters
    ----------
    steps : ndarray of int
        Those in which both touch.
    paths : tuple of ndarray, shape (n, 2)
        Offset of the person from the robot at each instant and the way from there, in m.
    velocity : ndarray, shape (n, 2)
        Of the robot in each step, in m/s.
    reach : float
        Sum of the radii in m.
    appears : float
        Up to which number of steps a contact is counted apart; negative: never.
    length : float
        Of a step in s.
    """
    touch = FirstTouch()
    # The step after one that ended in a contact of a person who appeared.
    lasts = -1
    for step in steps.tolist():
        start, way = paths[0][step], paths[1][step]
        begin, end, decided = touching_share(start, way, reach)
        first = math.isnan(touch.time)
        if first and (step == lasts or step + begin <= appears):
            touch = touch._replace(apart=True)
            lasts = step + 1 if np.linalg.norm(start + way) < reach else -1
            continue
        speed = float(np.hypot(*velocity[step]))
        if first and np.linalg.norm(start + begin * way) <= reach - DECIDED_OVERLAP:
            speed = 0.0  # at the start they overlapped: no person came
        moving = speed > CONTACT_SPEED
        toward = [moving and bool(velocity[step] @ (start + share * way) > 0.0) for share in (begin, end)]
        if first:
            touch = touch._replace(time=(step + begin) * length, speed=speed, toward=toward[0])
        touch = touch._replace(at_fault=touch.at_fault or any(toward))
        if decided:
            break
    return touch


def touch_of_outline(
    episode: Episode | Outlined,
    who: tuple[npt.NDArray[np.intp], int],
    paths: tuple[Array, Array],
    velocity: Array,
    appears: float,
) -> FirstTouch:
    """Return what the steps in which a person touches a robot with a footprint make of it, as `touch_of`.

    The velocity is that of the touching point of the robot.
    """
    assert episode.footprint is not None
    heading = np.asarray(episode.heading, dtype=np.float64)
    radii = np.asarray(episode.person_radius, dtype=np.float64)
    radius = float(radii if radii.ndim == 0 else radii[who[1]])
    touch, lasts = FirstTouch(), -1
    for step in who[0].tolist():
        start, way = paths[0][step], paths[1][step]
        row = (*start, *(start + way), heading[step], heading[step + 1], radius)
        found = episode.footprint._native.contact_in_step(row, tuple(velocity[step]), episode.step, DECIDED_OVERLAP)
        if found is None:
            continue
        (begin, end), decided, speeds = found
        first = math.isnan(touch.time)
        if first and (step == lasts or step + begin <= appears):
            touch = touch._replace(apart=True)
            lasts = step + 1 if end >= 1.0 else -1
            continue
        speed = speeds[0][0]
        if first and decided and end <= begin:
            speed = 0.0  # at the start they overlapped: no person came
        toward = [fast > CONTACT_SPEED and nearer > ALONG for fast, nearer in speeds]
        if first:
            touch = touch._replace(time=(step + begin) * episode.step, speed=speed, toward=toward[0])
        touch = touch._replace(at_fault=touch.at_fault or any(toward))
        if decided:
            break
    return touch


def touching_share(start: Array, way: Array, reach: float) -> tuple[float, float, bool]:
    """Return the shares of a step at which a contact begins, and ends or is decided, and whether it is."""
    deep = reach - DECIDED_OVERLAP
    square, along, across = float(way @ way), float(start @ way), float(start @ start)
    share = min(max(-along / square, 0.0), 1.0) if square > 0.0 else 0.0
    least = float(np.linalg.norm(start + share * way))

    def crossing(distance: float, side: float) -> float:
        if square == 0.0:
            return 0.0 if side < 0.0 else 1.0
        root = math.sqrt(max(along * along - square * (across - distance * distance), 0.0))
        return min(max((-along + side * root) / square, 0.0), 1.0)

    begin = crossing(reach, -1.0)
    return (begin, crossing(deep, -1.0), True) if least <= deep else (begin, crossing(reach, 1.0), False)
