"""Contacts that no instant shows: people who pass through a robot between two of them, and walls.

They are counted as contacts; what is doubtful is that everybody moves straight from instant to instant.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.navigation.maps.outlines import standing
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.robots.footprint import Footprint
from hrsafety.navigation.trajectory import CONTACT_SPEED
from hrsafety.plausibility import ResultWarning

__all__ = [
    "ALONG",
    "CONTACT_BETWEEN",
    "PASSED",
    "Between",
    "Outlined",
    "distances_of",
    "doubts_between",
    "first_wall_contact",
    "least_of_outline",
    "moves_toward",
    "paths_of",
    "touched_between",
    "until_arrival",
    "walls_between",
    "wrapped",
]

CONTACT_BETWEEN = "contact_between_instants"
PASSED = 1e-9
"""Who passes between two instants touches if the bodies overlap by more, in m."""

ALONG = 1e-9
"""A point of a side that moves along it moves toward nobody: what rounding adds to that, in m/s."""


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


class Outlined(NamedTuple):
    """Robot with a footprint over equal instants, of which only part may be known.

    Attributes
    ----------
    footprint : Footprint
        Its outline.
    heading : ndarray, shape (n,)
        In rad.
    robot_radius : float
        Of the circle around the outline in m.
    person_radius : float
        Of the people in m.
    step : float
        Time between two instants in s.
    """

    footprint: Footprint
    heading: Array
    robot_radius: float
    person_radius: float
    step: float


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
    least = np.sqrt(_dots(nearest, nearest))
    return start, way, least if episode.footprint is None else least_of_outline(episode, start, way, least)


def _turns(episode: Episode | Outlined, steps: int) -> Array:
    """Return the headings of the robot at both ends of the first steps in rad, shape (steps, 2)."""
    heading = np.asarray(episode.heading, dtype=np.float64)[: steps + 1]
    return np.column_stack([heading[:-1], heading[1:]])


def least_of_outline(episode: Episode | Outlined, start: Array, way: Array, least: Array) -> Array:
    """Return least distances in steps as `paths_of` does, of a robot with a footprint."""
    assert episode.footprint is not None
    found = np.where(np.isfinite(way).all(axis=2), least, np.nan)
    radius = np.broadcast_to(np.asarray(episode.person_radius, dtype=np.float64), least.shape[1])
    # Who is farther from the circle than it could matter keeps that distance, which is less.
    rows, who = np.nonzero(found < 2.0 * episode.robot_radius + radius + 1.0)
    turns = _turns(episode, len(way))[rows]
    offsets = np.hstack([start[:-1][rows, who], start[:-1][rows, who] + way[rows, who]])
    steps = np.column_stack([offsets, turns, radius[who]])
    gaps = episode.footprint._native.least_in_steps(np.ascontiguousarray(steps))
    found[rows, who] = gaps + episode.robot_radius + radius[who]
    return found


def distances_of(episode: Episode | Outlined, offset: Array) -> Array:
    """Return distances of people from the robot at every instant.

    Parameters
    ----------
    episode : Episode
        The robot.
    offset : ndarray, shape (n, p, 2)
        From the robot to the people in m.

    Returns
    -------
    ndarray, shape (n, p)
        In m, between the centers; of a robot with a footprint as in `paths_of`.
    """
    if episode.footprint is None:
        return np.hypot(offset[..., 0], offset[..., 1])
    heading = np.asarray(episode.heading, dtype=np.float64)[: len(offset)]
    cosine, sine = np.cos(heading)[:, None], np.sin(heading)[:, None]
    x, y = offset[..., 0], offset[..., 1]
    own = np.stack([cosine * x + sine * y, cosine * y - sine * x], axis=-1)
    found = np.full(offset.shape[:2], np.nan)
    there = np.isfinite(own).all(axis=2)
    found[there] = episode.footprint.distance(own[there]) + episode.robot_radius
    return found


def moves_toward(episode: Episode, start: Array, velocity: Array) -> npt.NDArray[np.bool_]:
    """Return in which steps the nearest point of a footprint moves, and toward a person.

    Parameters
    ----------
    episode : Episode
        A robot with a footprint.
    start : ndarray, shape (n, p, 2)
        From the robot to the people in m, as of `paths_of`.
    velocity : ndarray, shape (n - 1, 2)
        Of the robot in each step, in m/s.

    Returns
    -------
    ndarray of bool, shape (n - 1, p)
        At the begin or at the end of each step.
    """
    assert episode.footprint is not None
    found = np.zeros((len(velocity), start.shape[1]), dtype=np.bool_)
    turns = _turns(episode, len(velocity))
    # A disc that reaches the robot from wherever the person is touches its nearest point.
    for step, person in zip(*np.nonzero(np.isfinite(start[:-1]).all(axis=2)), strict=True):
        for row, heading in ((step, turns[step, 0]), (step + 1, turns[step, 1])):
            place = start[row, person]
            if not np.isfinite(place).all():
                continue
            turn = turns[step, 1] - turns[step, 0]
            turn = (turn + np.pi) % (2.0 * np.pi) - np.pi
            ends = (*place, *place, heading, heading + turn * 1e-9, float(np.hypot(*place)) + 1.0)
            contact = episode.footprint._native.contact_in_step(
                ends, tuple(velocity[step]), episode.step * 1e-9, np.inf
            )
            if contact is not None:
                speed, toward = contact[2][0]
                found[step, person] |= speed > CONTACT_SPEED and toward > ALONG
    return found


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
    if episode.footprint is None:
        shown = np.sqrt(np.fmin.reduce(_dots(start, start), axis=0)) - touch
    else:
        shown = np.fmin.reduce(distances_of(episode, start), axis=0) - touch
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
    if episode.footprint is not None:
        return Between(0, np.inf)  # the metrics count them, and no bound tells where to look again
    ways = np.diff(own, axis=0)
    moves = np.hypot(*ways.T) > 2.0 * wall_clearance
    if not moves.any():
        return Between(0, np.inf)
    begin, end = own[:-1][moves], own[1:][moves]
    walls = standing(episode.walls)
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
    walls = standing(episode.walls)
    if episode.footprint is not None:
        shown = np.flatnonzero(_outline_gaps(episode, walls, own) <= PASSED).tolist()
    else:
        shown = np.flatnonzero(walls.clearance(own) < episode.robot_radius).tolist()
    rows = shown or [len(own)]
    # Only a step before that one may pass a wall and show it at neither end.
    for row, way in enumerate(itertools.pairwise(own[: rows[0]]), start=1):
        if episode.footprint is not None:
            share = np.linspace(0.0, 1.0, 17)[:, None]
            touched = bool((_outline_gaps(episode, walls, way[0] + share * (way[1] - way[0]), row - 1) <= PASSED).any())
        else:
            touched = walls.segment_clearance(*way) < episode.robot_radius
        if touched:
            rows = [row]
            break
    row = min(rows[0], len(own) - 1)
    speed = float(np.hypot(*(own[max(row, 1)] - own[max(row, 1) - 1]))) / episode.step
    return row * episode.step, speed


def _outline_gaps(episode: Episode, walls: StaticMap, places: Array, step: int | None = None) -> Array:
    """Return the distances of a footprint from walls at instants, or at places of a step with a number, in m."""
    assert episode.footprint is not None
    heading = np.asarray(episode.heading, dtype=np.float64)
    if step is None:
        heading = heading[: len(places)]
    else:
        turn = (heading[step + 1] - heading[step] + np.pi) % (2.0 * np.pi) - np.pi
        heading = heading[step] + turn * np.linspace(0.0, 1.0, len(places))
    return episode.footprint.clearance(walls, places, heading)


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
