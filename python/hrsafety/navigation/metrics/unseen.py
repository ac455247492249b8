"""People who are not seen for a while: where they may have been, and which metrics that leaves open."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._words import some
from hrsafety.navigation.metrics.between import until_arrival, wrapped
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.sights import last_sight, next_sight, seen_instants, track_ends
from hrsafety.plausibility import ResultWarning

__all__ = ["unscored"]

Flags = npt.NDArray[np.bool_]

ZONES = {"intimate_share": 0.45, "personal_share": 1.2, "social_share": 3.6}
"""Beyond these distances from the surface of the robot, in m, a person changes no share."""
COMFORT, DISCOMFORT = 0.5, 0.2
LOW_TIME = 2.0
FORCE_REACH = 10.0
"""Social forces of people farther away are below a millionth of those nearby, in m."""
CONTACTS = ("success", "spl", "max_closing_speed")
FORCES = ("force_on_people", "force_on_robot", "social_work")


def _least_gaps(episode: Episode, own: Array, unseen: Flags) -> tuple[Array, Array]:
    """Return how near unseen people may be to the robot and how fast they may be, both (instants, people).

    Within a speed ``v`` a person last seen at ``x_a`` and next at ``x_b`` is in both discs around them, of radii
    ``v (t - t_a)`` and ``v (t_b - t)``: the surfaces are at least ``max(|p - x_a| - v (t - t_a), |p - x_b| -
    v (t_b - t)) - R - rho`` apart. Infinite where people are seen, or away.
    """
    people = np.asarray(episode.people, dtype=np.float64)
    seen = seen_instants(people)
    instants = np.arange(len(people))[:, None]
    last, following = last_sight(seen), next_sight(seen)
    known_before, known_after = last >= 0, following < len(people)
    column = np.arange(people.shape[1])[None, :]
    begin, end = people[np.maximum(last, 0), column], people[np.minimum(following, len(people) - 1), column]
    speed = np.full(last.shape, float(episode.person_speed))
    both = known_before & known_after & (following > last)
    needed = np.zeros(last.shape)
    way = wrapped(end - begin, episode.period)
    needed[both] = np.hypot(way[..., 0], way[..., 1])[both] / ((following - last)[both] * episode.step)
    speed = np.maximum(speed, needed)[: len(own)]
    touch = episode.robot_radius + np.asarray(episode.person_radius)
    found = np.full(speed.shape, -np.inf)
    for known, sight, place in ((known_before, last, begin), (known_after, following, end)):
        offset = wrapped(place[: len(own)] - own[:, None], episode.period)
        away = np.hypot(offset[..., 0], offset[..., 1])
        reached = speed * np.abs(sight - instants)[: len(own)] * episode.step
        found = np.where(known[: len(own)], np.maximum(found, away - reached), found)
    gaps: Array = np.maximum(found - touch, -touch)
    return np.where(unseen, gaps, np.inf), np.where(unseen, speed, 0.0)


def unscored(episode: Episode, values: Mapping[str, Any]) -> tuple[dict[str, Any], tuple[ResultWarning, ...]]:
    """Return the metrics that unseen people leave open with their values, NaN or false, and a warning that says so.

    Parameters
    ----------
    episode : Episode
        The robot and the people.
    values : mapping of str to float, int or bool
        All metrics as if the floor were free where no person was seen.

    Returns
    -------
    dict of str to float or bool
        What is to be put in their place.
    tuple of ResultWarning
        One for these, and one for who may have been touched before the first or after the last sight.
    """
    if episode.unseen is None:
        return {}, ()
    own, people = until_arrival(episode, values["arrival_time"])
    ends = _ends_doubt(episode, own)
    unseen = np.asarray(episode.unseen)[: len(own)]
    if not unseen.any():
        return {}, ends
    gaps, speeds = _least_gaps(episode, own, unseen)
    changed = _open(episode, values, (own, people), (unseen, gaps, speeds))
    if not changed:
        return {}, ends
    return changed, (_warning(episode, changed, unseen, gaps), *ends)


def _ends_doubt(episode: Episode, own: Array) -> tuple[ResultWarning, ...]:
    """Return a doubt about people who may have been touched before they were seen first, or after the last time."""
    ends = track_ends(np.asarray(episode.people, dtype=np.float64), episode.step)[: len(own)]
    ends &= ~np.asarray(episode.unseen)[: len(own)]
    if not ends.any():
        return ()
    gaps, _ = _least_gaps(episode, own, ends)
    row, worst = (int(each) for each in np.unravel_index(np.argmin(gaps), gaps.shape))
    if gaps[row, worst] >= 0.0:
        return ()
    others = int((gaps < 0.0).any(axis=0).sum()) - 1
    more = f" ({some(others, 'more person', 'more people')} likewise)" if others else ""
    message = (
        f"{episode._named(worst)} may have been touched at {episode._time(row)} s{more}, out of sight before the first "
        f"or after the last place that is known, with people up to {episode.person_speed:g} m/s; metrics take the "
        f"person to be away then{_remedy(episode, 'this is so')}"
    )
    return (ResultWarning("not_scored", "people", message),)


def _open(
    episode: Episode, values: Mapping[str, Any], places: tuple[Array, Array], unknown: tuple[Flags, Array, Array]
) -> dict[str, Any]:
    """Return the metrics that may be different if unseen people were as near as they may have been."""
    (own, people), (unseen, gaps, speeds) = places, unknown
    radius = np.asarray(episode.person_radius)
    nearest, zone = float(gaps.min()), float((gaps + radius).min())
    names = [name for name, reach in ZONES.items() if zone < reach]
    if nearest < 0.0:
        names += [name for name in CONTACTS if name != "spl" or values["success"]]
    if nearest < values["min_clearance"]:
        names.append("min_clearance")
    offset = wrapped(people - own[:, None], episode.period)
    shown = np.hypot(offset[..., 0], offset[..., 1]) - episode.robot_radius - radius
    least = np.fmin.reduce(shown, axis=1, initial=np.inf)
    if (gaps.min(axis=1) < least).any():
        names.append("mean_clearance")
    if nearest < COMFORT:
        names.append("comfort_share")
    moving, before = np.hypot(*np.diff(own, axis=0).T) / episode.step, gaps[:-1]
    if (before < DISCOMFORT).any():
        names.append("discomfort_time")
    closing = speeds[:-1] + moving[:, None]
    room = np.where(np.isfinite(before), np.maximum(before, 0.0), np.inf)
    time = np.divide(room, closing, out=np.where(room > 0.0, np.inf, 0.0), where=closing > 0.0)
    if time.size and time.min() < values["min_time_to_collision"]:
        names.append("min_time_to_collision")
    if time.size and time.min() < LOW_TIME:
        names.append("low_time_to_collision_share")
    if (before < FORCE_REACH).any():
        names += FORCES
    groups = np.asarray(episode.groups)
    if groups.size and (unseen & (groups >= 0)).any():
        names.append("group_intrusion_share")
    return {name: False if name == "success" else float("nan") for name in names if values[name] is not False}


def _warning(episode: Episode, changed: Mapping[str, Any], unseen: Flags, gaps: Array) -> ResultWarning:
    """Return who is not seen when, and what that leaves open."""
    worst = int(np.argmin(gaps.min(axis=0)))
    first, last = (int(each) for each in np.flatnonzero(unseen[:, worst])[[0, -1]])
    row = int(np.argmin(gaps[:, worst]))
    while first < row and not unseen[first:row, worst].all():
        first += 1
    if np.isnan(np.asarray(episode.people)[:, worst]).any(axis=1).all():
        when = "is never seen"
    else:
        when = f"is not seen from {episode._time(first)} to {episode._time(last)} s"
    others = int(unseen.any(axis=0).sum()) - 1
    more = f" ({some(others, 'more person is', 'more people are')} not seen at times)" if others else ""
    touched = bool((gaps < 0.0).any())
    may = (
        f"may have been touched at {episode._time(row)} s"
        if touched
        else f"may have come within {gaps[row, worst]:.3g} m of the robot"
    )
    open_ones = ", ".join(changed)
    message = (
        f"{episode._named(worst)} {when}{more} and {may}, with people up to {episode.person_speed:g} m/s: {open_ones} "
        f"{'is' if len(changed) == 1 else 'are'} not scored, contacts are counted where people are seen only"
        f"{_remedy(episode, 'who has no position is away')}"
    )
    return ResultWarning("not_scored", "people", message)


def _remedy(episode: Episode, meant: str) -> str:
    """Return what tells that people are away; of those in a log nobody can say it."""
    return "" if episode._ids else f"; simulated=True says that {meant}"
