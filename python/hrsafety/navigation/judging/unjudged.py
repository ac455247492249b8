"""Parts of a log that are not judged, when and why: a person who was not seen does not count as safe."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Annotated, Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety.navigation.judging.synchronized import PERSON_PERIODS, Flags, Synchronized
from hrsafety.navigation.judging.touches import runs_of
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.metrics.sights import LOST

__all__ = ["REASONS", "NotJudged", "nearest_unseen", "not_judged"]

REASONS = {
    "no_pose": "the robot has no pose",
    "pose_jump": "the pose of the robot was corrected",
    "people_silent": "nothing was reported about people",
    "person_lost_nearby": "a person who may be near is not seen",
    "out_of_view": "a person who may be near is outside the field of view",
    "clock": "clocks differ",
    "smoothing_edge": "accelerations are those of one side only",
    "outside_map": "the robot is outside the map, or where it is unknown: walls are not judged",
}
"""Meaning of each reason."""


@displayed
class NotJudged(NamedTuple):
    """A part of a log that is not judged.

    Attributes
    ----------
    begin, end : float
        Times in s.
    reason : str
        Among `REASONS`.
    person : int, str or None
        Person it is about; ``None``: everybody.
    """

    begin: Annotated[float, "s"]
    end: Annotated[float, "s"]
    reason: str
    person: int | str | None = None


def nearest_unseen(both: Synchronized, person_speed: float) -> Array:
    """Return how near the centers of robot and people may be where one of them is not known, (T, n) in m.

    From the last distance at which both were known, and from the next one, both approach with the greatest speed of the
    robot and that of people. Infinite where both are known, and farther than 2 s from any sight. An id that jumps is
    that of another person, or of nobody, from there on: who it was before is lost.
    """
    away = both.people - both.position[:, None]
    distance = np.hypot(away[..., 0], away[..., 1])
    speed = person_speed + float(np.nanmax(np.hypot(*both.velocity.T), initial=0.0))
    bound = _nearest_between_sights(distance, speed, both.step)
    for column in np.flatnonzero(both.leaps.any(axis=0)).tolist():
        walkers = _walkers(both, column, person_speed)
        each = _nearest_between_sights(np.where(walkers, distance[:, column], np.nan).T, speed, both.step)
        bound[:, column] = each.min(axis=1)
    return bound


def _nearest_between_sights(distance: Array, speed: float, step: float) -> Array:
    """Return the same from distances (T, n), NaN where a person is not seen, and the speed at which both approach."""
    known = np.isfinite(distance)
    count = len(distance)
    rows = np.arange(count)[:, None]
    last = np.maximum.accumulate(np.where(known, rows, -1), axis=0)
    following = np.minimum.accumulate(np.where(known, rows, count)[::-1], axis=0)[::-1]
    column = np.arange(distance.shape[1])[None, :]
    bound = np.full(distance.shape, -np.inf)
    for place, there in ((last, last >= 0), (following, following < count)):
        since = np.abs(rows - place) * step
        reached = distance[np.clip(place, 0, count - 1), column] - speed * since
        between = (last >= 0) & (following < count)
        bound = np.where(there & (between | (since <= LOST + 1e-9)), np.maximum(bound, reached), bound)
    return np.where(known | np.isneginf(bound), np.inf, bound)


def _walkers(both: Synchronized, column: int, person_speed: float) -> Flags:
    """Return which sights of an id that jumps may be of one person, (persons, T): who jumps away is lost."""
    place, seen = both.people[:, column], both.seen[:, column]
    cuts = np.flatnonzero(both.leaps[:, column]) + 1
    found: list[Flags] = []
    for begin, end in zip([0, *cuts.tolist()], [*cuts.tolist(), len(seen)], strict=True):
        rows = begin + np.flatnonzero(seen[begin:end])
        if len(rows) == 0:
            continue
        for walker in found:
            last = int(np.flatnonzero(walker)[-1])
            way = float(np.hypot(*(place[rows[0]] - place[last])))
            if last < begin - 1 and way <= person_speed * (rows[0] - last) * both.step:
                walker[rows] = True
                break
        else:
            walker = np.zeros(len(seen), dtype=np.bool_)
            walker[rows] = True
            found.append(walker)
    return np.stack(found)


def not_judged(
    both: Synchronized,
    log: Any,
    *,
    bound: Array,
    reach: float,
    walls: StaticMap | None,
    view: float | None,
) -> list[NotJudged]:
    """Return every part that is not judged, in the order of time.

    Parameters
    ----------
    both : Synchronized
        Robot and people.
    log : Logged
        What they come from.
    bound : ndarray, shape (T, n)
        Of `nearest_unseen`.
    reach : float
        Sum of the radii in m.
    walls : StaticMap or None
        The map.
    view : float or None
        Angle in rad in which the sensors of the robot see people, ahead of it; all around when ``None``.
    """
    found = [*_of_robot(both, log), *_of_people(both, log), *_lost(both, bound < reach, view), *_leaps(both, reach)]
    if walls is not None:
        outside = np.zeros(len(both.time), dtype=np.bool_)
        outside[both.known] = walls.unseen(both.position[both.known])
        found += [NotJudged(*_times(both, run), "outside_map") for run in runs_of(outside)]
    if any(each.code == "clock_offset" for each in getattr(log, "warnings", ())):
        found.append(NotJudged(float(both.time[0]), float(both.time[-1]), "clock"))
    return sorted(found, key=lambda each: (each.begin, each.end, each.reason, str(each.person)))


def _of_robot(both: Synchronized, log: Any) -> Iterator[NotJudged]:
    time = np.asarray(log.time)
    jumps = [(float(each[0]), float(each[1])) for each in getattr(log, "pose_jumps", ())]
    yield from (NotJudged(*each, "pose_jump") for each in jumps)
    for begin, end in runs_of(~both.known):
        since = float(time[max(int(np.searchsorted(time, both.time[begin])) - 1, 0)])
        until = float(time[min(int(np.searchsorted(time, both.time[end - 1])), len(time) - 1)])
        if not any(since >= one - 1e-6 and until <= other + 1e-6 for one, other in jumps):
            yield NotJudged(since, until, "no_pose")
    for begin, end in runs_of(both.known & ~both.whole):
        yield NotJudged(*_times(both, (begin, end)), "smoothing_edge")


def _of_people(both: Synchronized, log: Any) -> Iterator[NotJudged]:
    """Yield the parts in which nothing was reported about people."""
    given = getattr(log, "people_time", None)
    reports = np.unique(np.asarray(log.people.time_s if log.people is not None else [], dtype=np.float64))
    if given is not None and len(given):
        reports = np.unique(np.asarray(given, dtype=np.float64))
    start, end = float(both.time[0]), float(both.time[-1])
    if len(reports) == 0:
        yield NotJudged(start, end, "people_silent")
        return
    period = float(np.median(np.diff(reports))) if len(reports) > 1 else np.inf
    ends = np.concatenate([[start], reports, [end]]) if len(reports) > 1 else np.array([start, end])
    for one, other in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True):
        if other - one > PERSON_PERIODS * period * (1.0 + 1e-9) or len(reports) == 1:
            yield NotJudged(max(one, start), min(other, end), "people_silent")


def _lost(both: Synchronized, near: Flags, view: float | None) -> Iterator[NotJudged]:
    """Yield when a person is not seen who may touch the robot."""
    bearing = np.full(near.shape, 0.0)
    if view is not None:
        away = both.people - both.position[:, None]
        turned = np.arctan2(away[..., 1], away[..., 0]) - both.heading[:, None]
        bearing = np.abs((turned + np.pi) % (2.0 * np.pi) - np.pi)
    for column in np.flatnonzero(near.any(axis=0)).tolist():
        for begin, end in runs_of(near[:, column]):
            if not both.known[begin:end].any():
                continue  # of the robot: no_pose
            edge = bearing[max(begin - 1, 0), column]
            outside = view is not None and edge > 0.45 * view
            reason = "out_of_view" if outside else "person_lost_nearby"
            yield NotJudged(*_times(both, (begin, end)), reason, both.ids[column].item())


def _leaps(both: Synchronized, reach: float) -> Iterator[NotJudged]:
    """Yield the steps in which a person jumps past the robot."""
    away = both.people - both.position[:, None]
    for step, column in zip(*np.nonzero(both.leaps), strict=True):
        start, way = away[step, column], away[step + 1, column] - away[step, column]
        share = min(max(-float(start @ way) / float(way @ way), 0.0), 1.0) if way.any() else 0.0
        if float(np.hypot(*(start + share * way))) < reach:
            yield NotJudged(*_times(both, (step, step + 2)), "person_lost_nearby", both.ids[column].item())


def _times(both: Synchronized, run: tuple[int, int]) -> tuple[float, float]:
    return float(both.time[run[0]]), float(both.time[run[1] - 1])


def judged_share(both: Synchronized, parts: Iterable[NotJudged]) -> float:
    """Return the share of the time in which contacts are judged."""
    open_ones = np.zeros(len(both.time), dtype=np.bool_)
    for each in parts:
        if each.reason not in ("smoothing_edge", "outside_map"):
            open_ones |= (both.time >= each.begin - 1e-9) & (both.time <= each.end + 1e-9)
    return float(1.0 - open_ones.mean())
