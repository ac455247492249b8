"""Doubts about episodes that are scored; of many episodes only those are examined that may have some."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._tracks import Ways
from hrsafety.navigation.metrics.between import doubts_between
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.sources import track_doubts
from hrsafety.plausibility import RANGES, ResultWarning, implausible

__all__ = [
    "ENDS",
    "contacts_between",
    "implausible_numbers",
    "may_be_implausible",
    "may_have_doubts",
    "of_tracks",
    "of_values",
    "of_world",
]

ENDS = ("arrival_time", "min_time_to_collision", "wall_clearance")
"""Metrics that `doubts_between` needs."""

SLACK = 1e-9
"""Largest relative change of a number by rounding: far more than it is."""


def implausible_numbers(episode: Episode, max_speed: float) -> tuple[ResultWarning, ...]:
    """Return doubts about units, unless what the episode comes from has some; ``max_speed`` is the metric."""
    if any(doubt.code == "implausible" for doubt in episode.warnings):
        return ()
    people = np.asarray(episode.people, dtype=np.float64)
    values: dict[str, object] = {"step": episode.step, "robot_radius": episode.robot_radius}
    values |= {"person_radius": episode.person_radius, "speed of the robot": max_speed}
    values |= {name: getattr(episode, name) for name in _OWN}
    if people.size and len(people) > 1:
        # From the first to the last instant, for who is there at both.
        way = np.hypot(*(people[-1] - people[0]).T)
        values["speed of the people"] = way / ((len(people) - 1) * episode.step)
    return implausible(values, _QUANTITIES)


def of_world(
    places: Array, machines: Array, *, step: float, time_limit: float, robot_radius: Array, period: tuple[float, float]
) -> tuple[ResultWarning, ...]:
    """Return doubts about positions of people and robots, (instants, bodies, 2), that a world is scored by."""
    told = list(implausible({"step": step, "time_limit": time_limit, "robot_radius": robot_radius}, _QUANTITIES))
    if period == (0.0, 0.0):
        for bodies, name in ((places, "people"), (machines, "robots")):
            told += _of_bodies(bodies, step, name)
    for bodies, name, open_ones in ((places, "people", "all metrics"), (machines, "robots", "robot_contacts")):
        never = np.isnan(bodies).any(axis=2).all(axis=0)
        if bodies.size and never.any():
            message = (
                f"{name}[{int(np.argmax(never))}] has no position at any instant ({int(never.sum())} of {never.size} "
                f"{name}): {open_ones} are of the others only"
            )
            told.append(ResultWarning("not_scored", name, message))
    gone = np.isnan(machines).any(axis=2)
    if gone.any() and not gone.all(axis=0).all():
        message = "robots have no position at times: robot_contacts counts those instants only at which both are seen"
        told.append(ResultWarning("not_scored", "robots", message))
    return tuple(told)


def _of_bodies(bodies: Array, step: float, name: str) -> tuple[ResultWarning, ...]:
    """Return doubts about the speeds of bodies, and about jumps, exchanged ids and noise."""
    who, when = np.nonzero(~np.isnan(bodies).any(axis=2).T)
    ways = Ways(step * when.astype(np.float64), who.astype(np.int64), bodies[when, who])
    return ways.doubts(
        lambda index: f"{name}[{index}]",
        moving=name,
        of_frames="give step, the time between two of them",
        smoothing="hrsafety.datasets.Recording.smoothed(0.6) takes the noise out",
    )


def of_tracks(episode: Episode) -> tuple[ResultWarning, ...]:
    """Return doubts about positions that were measured: jumps, exchanged ids and noise, of the robot and of people."""
    if episode.simulated or episode._resampled or episode.period != (0.0, 0.0):
        return ()
    remedy = "metrics.Episode(...).smoothed(0.6) takes the noise out"
    robot, people = episode.ways()
    return (*track_doubts(robot, "the robot", remedy), *track_doubts(people, "people", remedy))


def of_values(episode: Episode, values: Mapping[str, Any]) -> tuple[ResultWarning, ...]:
    """Return doubts about what metrics are of: a robot that leaves its goal, and people who are never near.

    Parameters
    ----------
    episode : Episode
        The robot and the people.
    values : mapping of str to float
        The metrics.
    """
    told = []
    away = np.hypot(*(np.asarray(episode.position) - episode.goal).T)
    if values["arrival_time"] == 0.0 and float(away.max()) > episode.arrival_tolerance:
        message = (
            "the robot is within arrival_tolerance of its goal at the first instant and leaves it: nothing after it is "
            "scored; give its goal, and the tolerance in m"
        )
        told.append(ResultWarning("not_scored", "goal", message))
    least, far = values["min_clearance"], RANGES["person_distance"].most
    if far < least < np.inf and all(doubt.code != "implausible" for doubt in episode.warnings):
        message = (
            f"people are never nearer to the robot than {least:.4g} m, beyond the plausible {far:g} m: positions in "
            "another unit or frame than those of the robot?"
        )
        told.append(ResultWarning("implausible", "people", message))
    return tuple(told)


def may_have_doubts(found: Mapping[str, npt.NDArray[Any]]) -> npt.NDArray[np.bool_]:
    """Return for which episodes `of_values` has something to say."""
    least = found["min_clearance"]
    doubtful: npt.NDArray[np.bool_] = (found["arrival_time"] == 0.0) | (
        (least > RANGES["person_distance"].most) & (least < np.inf)
    )
    return doubtful


_OWN = ("arrival_tolerance", "person_tolerance", "person_speed")
_QUANTITIES = {
    "person_tolerance": "arrival_tolerance",
    "step": "control_period",
    "person_radius": "person_radius",
    "speed of the robot": "person_speed",
    "speed of the people": "person_speed",
}


def _outside(quantity: str, values: Array, slack: float = 0.0) -> npt.NDArray[np.bool_]:
    """Return which numbers are outside the plausible range of their quantity; NaN is not."""
    least, most, *_ = RANGES[quantity]
    found: npt.NDArray[np.bool_] = (values < least) | (values > most * (1.0 - slack))
    return found


def may_be_implausible(
    episodes: Sequence[Episode], max_speed: Array, extremes: Mapping[str, Array]
) -> npt.NDArray[np.bool_]:
    """Return for which episodes `implausible_numbers` may have something to say."""
    found = [
        _outside("control_period", extremes["step"]),
        _outside("robot_radius", extremes["robot_radius"]),
        _outside("person_radius", extremes["least_person_radius"]),
        _outside("person_radius", extremes["greatest_person_radius"]),
        _outside("person_speed", max_speed),
        _outside("person_speed", extremes["person_speed"], SLACK),
        *(_outside(_QUANTITIES.get(name, name), np.array([getattr(each, name) for each in episodes])) for name in _OWN),
    ]
    doubtful: npt.NDArray[np.bool_] = np.any(found, axis=0)
    return doubtful


def contacts_between(
    episodes: Sequence[Episode],
    name_of: Callable[[int], str],
    found: Mapping[str, npt.NDArray[Any]],
    extremes: Mapping[str, Array],
) -> Iterator[tuple[str, tuple[ResultWarning, ...]]]:
    """Yield names of episodes with the doubts about contacts between their instants; most episodes can have none."""
    passed = extremes["may_be_passed"] != 0.0
    # No wall is touched within a step that is shorter than twice the distance from it.
    longest = found["max_speed"] * extremes["step"] * (1.0 + SLACK)
    walled = (found["wall_clearance"] < np.inf) & (longest > 2.0 * found["wall_clearance"])
    for index in np.flatnonzero(passed | walled).tolist():
        ends = (found[name][index].item() for name in ENDS)
        yield name_of(index), doubts_between(episodes[index], *ends)
