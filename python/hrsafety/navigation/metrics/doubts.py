"""Doubts about episodes that are scored; of many episodes only those are looked at that may have some."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.navigation.metrics.between import doubts_between
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.sources import track_doubts
from hrsafety.plausibility import RANGES, ResultWarning, implausible

__all__ = ["ENDS", "contacts_between", "implausible_numbers", "may_be_implausible", "of_tracks"]

ENDS = ("arrival_time", "min_time_to_collision", "wall_clearance")
"""Metrics that `doubts_between` needs."""

SLACK = 1e-9
"""What rounding may change of a number, relative to it: far more than it does."""


def implausible_numbers(episode: Episode, max_speed: float) -> tuple[ResultWarning, ...]:
    """Return doubts about units, unless what the episode comes from has some; ``max_speed`` is the metric."""
    if any(doubt.code == "implausible" for doubt in episode.warnings):
        return ()
    people = np.asarray(episode.people, dtype=np.float64)
    values: dict[str, object] = {"step": episode.step, "robot_radius": episode.robot_radius}
    values |= {"person_radius": episode.person_radius, "speed of the robot": max_speed}
    if people.size and len(people) > 1:
        # From the first to the last instant, for who is there at both.
        way = np.hypot(*(people[-1] - people[0]).T)
        values["speed of the people"] = way / ((len(people) - 1) * episode.step)
    return implausible(values, _QUANTITIES)


def of_tracks(episode: Episode) -> tuple[ResultWarning, ...]:
    """Return doubts about positions that were measured: jumps, exchanged ids and noise, of the robot and of people."""
    if episode.simulated or episode._resampled or episode.period != (0.0, 0.0):
        return ()
    remedy = "metrics.Episode(...).smoothed(0.6) takes the noise out"
    robot, people = episode.ways()
    return (*track_doubts(robot, "the robot", remedy), *track_doubts(people, "people", remedy))


_QUANTITIES = {
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


def may_be_implausible(max_speed: Array, extremes: Mapping[str, Array]) -> npt.NDArray[np.bool_]:
    """Return for which episodes `implausible_numbers` may have something to say."""
    found = [
        _outside("control_period", extremes["step"]),
        _outside("robot_radius", extremes["robot_radius"]),
        _outside("person_radius", extremes["least_person_radius"]),
        _outside("person_radius", extremes["greatest_person_radius"]),
        _outside("person_speed", max_speed),
        _outside("person_speed", extremes["person_speed"], SLACK),
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
