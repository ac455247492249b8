"""Contacts that no instant shows: people who pass through a robot between two of them, and walls.

They are counted as contacts; what is doubtful is that everybody moves straight from instant to instant.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.metrics.episode import Episode, Wall
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.plausibility import ResultWarning

__all__ = [
    "CONTACT_BETWEEN",
    "PASSED",
    "Between",
    "doubts_between",
    "first_wall_contact",
    "paths_of",
    "touched_between",
    "until_arrival",
    "walls_between",
    "wrapped",
]

CONTACT_BETWEEN = "contact_between_instants"
PASSED = 1e-9
"""Who passes between two instants touches if the bodies overlap by more, in m."""


class Between(NamedTuple):
    """Who touches a robot on straight lines between instants, and at none of them.

    Attributes
    ----------
    people : int
        Their number.
    gap : float
        The least distance of the surfaces in m, negative; infinite without anybody.
    """

    people: int
    gap: float


def wrapped(offset: Array, period: tuple[float, float]) -> Array:
    """Return differences of positions where a world repeats itself."""
    if period == (0.0, 0.0):
        return offset
    found = offset.copy()
    for axis, length in enumerate(period):
        if length > 0.0:
            found[..., axis] -= length * np.floor(found[..., axis] / length + 0.5)
    return found


def until_arrival(episode: Episode, arrival_time: float) -> tuple[Array, Array]:
    """Return places of the robot and of the people, instant by instant, as far as the arrival if there is one."""
    own, people = np.asarray(episode.position), np.asarray(episode.people, dtype=np.float64)
    last = len(own) - 1 if np.isnan(arrival_time) else round(arrival_time / episode.step)
    return own[: last + 1], people[: last + 1]


def paths_of(episode: Episode, own: Array, people: Array) -> tuple[Array, Array, Array]:
    """Return ways of people as seen from the robot, straight from instant to instant.

    Parameters
    ----------
    episode : Episode
        Where the world repeats itself.
    own, people : ndarray, shape (n, 2) and (n, p, 2)
        Places of the robot and of the people in m, as of `until_arrival`.

    Returns
    -------
    tuple of ndarray
        Offsets of the people from the robot at every instant, shape (n, p, 2), the ways from there in every step,
        shape (n - 1, p, 2), and the least distances of the centers in every step, shape (n - 1, p), all in m; NaN
        where a person is absent at either end.
    """
    start = wrapped(people - own[:, None], episode.period)
    way = wrapped(np.diff(start, axis=0), episode.period)
    square = _dots(way, way)
    share = np.divide(-_dots(start[:-1], way), square, out=np.zeros_like(square), where=square > 0.0)
    nearest = start[:-1] + np.clip(share, 0.0, 1.0)[..., None] * way
    return start, way, np.sqrt(_dots(nearest, nearest))


def touched_between(episode: Episode, arrival_time: float, time_to_collision: float) -> Between:
    """Return who touches a robot between instants only, up to its arrival.

    Parameters
    ----------
    episode : Episode
        The robot and the people.
    arrival_time : float
        When the robot arrived, in s; NaN if it did not.
    time_to_collision : float
        The metric ``min_time_to_collision`` of the episode, in s: no person is touched within a step that is shorter.

    Returns
    -------
    Between
        Their number, and how deep.
    """
    # The step and the time are rounded each.
    if not time_to_collision <= episode.step * (1.0 + 1e-9):
        return Between(0, np.inf)
    own, people = until_arrival(episode, arrival_time)
    touch = episode.robot_radius + np.asarray(episode.person_radius)
    start, _, nearest = paths_of(episode, own, people)
    # Who is absent is nowhere near.
    gap = np.fmin.reduce(nearest, axis=0) - touch
    shown = np.sqrt(np.fmin.reduce(_dots(start, start), axis=0)) - touch
    hidden = (gap < -PASSED) & ~(shown < 0.0)
    return Between(int(hidden.sum()), float(gap[hidden].min(initial=np.inf)))


def _dots(first: Array, second: Array) -> Array:
    found: Array = np.einsum("kij,kij->ki", first, second)
    return found


def walls_between(episode: Episode, arrival_time: float, wall_clearance: float) -> Between:
    """Return the steps in which a robot touches a wall on a straight line, and at neither end, up to its arrival.

    Parameters
    ----------
    episode : Episode
        The robot and the walls.
    arrival_time : float
        When the robot arrived, in s; NaN if it did not.
    wall_clearance : float
        The metric ``wall_clearance`` of the episode, in m: no wall is touched within shorter steps than twice that.

    Returns
    -------
    Between
        The number of steps, and how deep.
    """
    if not wall_clearance < np.inf:
        return Between(0, np.inf)
    own, _ = until_arrival(episode, arrival_time)
    ways = np.diff(own, axis=0)
    moves = np.hypot(*ways.T) > 2.0 * wall_clearance
    if not moves.any():
        return Between(0, np.inf)
    begin, end = own[:-1][moves], own[1:][moves]
    walls = _map_of(episode.walls)
    at_ends = np.minimum(walls.clearance(begin), walls.clearance(end))
    gap = np.array([walls.segment_clearance(*way) for way in zip(begin, end, strict=True)]) - episode.robot_radius
    hidden = (gap < 0.0) & (at_ends >= episode.robot_radius)
    return Between(int(hidden.sum()), float(gap[hidden].min(initial=np.inf)))


def first_wall_contact(episode: Episode, arrival_time: float) -> tuple[float, float]:
    """Return when a robot that touches a wall does so first, in s, and how fast it is in that step, in m/s.

    Parameters
    ----------
    episode : Episode
        The robot and the walls.
    arrival_time : float
        When the robot arrived, in s; NaN if it did not.

    Returns
    -------
    tuple of float
        Time of the instant that shows it, or of the end of the step within which it happens.
    """
    own, _ = until_arrival(episode, arrival_time)
    walls = _map_of(episode.walls)
    shown = np.flatnonzero(walls.clearance(own) < episode.robot_radius).tolist()
    rows = shown or [len(own)]
    # Only a step before that one may pass a wall and show it at neither end.
    for row, way in enumerate(itertools.pairwise(own[: rows[0]]), start=1):
        if walls.segment_clearance(*way) < episode.robot_radius:
            rows = [row]
            break
    row = min(rows[0], len(own) - 1)
    speed = float(np.hypot(*(own[max(row, 1)] - own[max(row, 1) - 1]))) / episode.step
    return row * episode.step, speed


def _map_of(walls: Sequence[Wall] | StaticMap) -> StaticMap:
    """Return walls as a map, which knows distances of segments; a line without length is a disc of a nanometer."""
    if isinstance(walls, StaticMap):
        return walls
    solid = [wall for wall in walls if isinstance(wall, Disc | Rectangle)]
    lines = [np.asarray(wall, dtype=np.float64) for wall in walls if not isinstance(wall, Disc | Rectangle)]
    dots = [(*line[0], 1e-9) for line in lines if not np.ptp(line, axis=0).any()]
    drawn = [line for line in lines if np.ptp(line, axis=0).any()]
    return StaticMap.from_obstacles(solid) + StaticMap.from_polylines(drawn) + StaticMap(discs=dots)


def doubts_between(
    episode: Episode, arrival_time: float, time_to_collision: float, wall_clearance: float
) -> tuple[ResultWarning, ...]:
    """Return warnings if a robot is touched, or touches walls, between instants only; see `touched_between`."""
    found = touched_between(episode, arrival_time, time_to_collision)
    walls = walls_between(episode, arrival_time, wall_clearance)
    told = []
    if found.people:
        who = "1 person touches" if found.people == 1 else f"{found.people} people touch"
        told.append(
            f"{who} the robot between two instants, by up to {-found.gap:.2g} m on straight lines, and at none of them"
        )
    if walls.people:
        steps = "1 step" if walls.people == 1 else f"{walls.people} steps"
        told.append(f"the robot touches a wall within {steps}, by up to {-walls.gap:.2g} m, and not at their ends")
    counted = f"counted as contacts; instants are {episode.step:g} s apart, a shorter step shows them"
    # More contacts are found so than at the instants: the result is the more careful one.
    found_so = ResultWarning(CONTACT_BETWEEN, "step", f"{'; '.join(told)}: {counted}", safe_side=True)
    return (found_so,) if told else ()
