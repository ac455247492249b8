"""Where ways of recorded people begin and end: ids that change on the way, and people who are lost near a robot."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from hrsafety._tracks import Ways
from hrsafety._words import some
from hrsafety.plausibility import ResultWarning

__all__ = ["LOST", "TrackEnds", "ends_doubts", "lost_doubts", "track_ends"]

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

LOST = 2.0
"""Before the first and after the last row of a person the person may still be there for this long, in s."""
REACH = 1.6
"""Greatest speed of people while they are not seen, in m/s."""
SOON, MANY_PERIODS = 1.0, 3.0
"""A way continues under another id within so many seconds, or median steps."""
NEAR, ALIKE = 0.6, 1.0
"""There it begins so near the expected place, in m, and with a velocity that differs by less, in m/s."""
BROKEN_SHARE, FEW_ENDS = 0.5, 5
"""A larger share of the ends that continue under another id is no accident, if there are so many ends."""


class TrackEnds(NamedTuple):
    """First and last rows of ways, one of each for every way.

    Attributes
    ----------
    begin, end : ndarray, shape (n,)
        Their instants in s.
    first, last : ndarray, shape (n, 2)
        Their places in m.
    follower : ndarray of int, shape (n,)
        Way that continues where this one ends, -1 without one.
    span : tuple of float
        First and last instant of all, in s.
    """

    begin: Array
    end: Array
    first: Array
    last: Array
    follower: Indices
    span: tuple[float, float]


class Moved(Protocol):
    """A robot over time, as a `Trajectory` has it."""

    @property
    def time(self) -> Array: ...
    @property
    def position(self) -> Array: ...


def track_ends(ways: Ways) -> TrackEnds:
    """Return where ways begin and end, and which continue under another id.

    One continues as another that begins within 1 s (or three median steps) after its end, at most 0.6 m from where it
    leads at constant velocity, with a velocity that differs by less than 1 m/s.
    """
    starts = np.flatnonzero(np.concatenate([[True], ~ways.same]))
    stops = np.append(starts[1:], len(ways.time)) - 1
    moving = stops > starts
    velocity = [np.zeros((len(starts), 2)) for _ in range(2)]
    for found, rows in zip(velocity, (starts, stops - 1), strict=True):
        some = rows[moving]
        span = (ways.time[some + 1] - ways.time[some])[:, None]
        found[moving] = (ways.position[some + 1] - ways.position[some]) / span
    ends = TrackEnds(
        ways.time[starts],
        ways.time[stops],
        ways.position[starts],
        ways.position[stops],
        np.full(len(starts), -1, dtype=np.int64),
        (float(ways.time.min()), float(ways.time.max())),
    )
    steps = np.diff(ways.time)[ways.same]
    soon = max(SOON, MANY_PERIODS * float(np.median(steps))) if len(steps) else SOON
    order = np.argsort(ends.begin, kind="stable")
    order = order[moving[order]]
    sorted_begin, taken = ends.begin[order], np.zeros(len(starts), dtype=np.bool_)
    by_end = np.argsort(ends.end, kind="stable")
    for one in by_end[moving[by_end]].tolist():
        low, high = np.searchsorted(sorted_begin, (ends.end[one], ends.end[one] + soon * (1.0 + 1e-9)), "right")
        others = order[low:high]
        others = others[~taken[others]]
        if len(others) == 0:
            continue
        expected = ends.last[one] + velocity[1][one] * (ends.begin[others] - ends.end[one])[:, None]
        off = np.hypot(*(ends.first[others] - expected).T)
        turned = np.hypot(*(velocity[0][others] - velocity[1][one]).T)
        off[turned > ALIKE] = np.inf
        best = int(np.argmin(off))
        if off[best] <= NEAR:
            ends.follower[one] = others[best]
            taken[others[best]] = True
    return ends


def ends_doubts(ends: TrackEnds, named: Callable[[int], str], *, units: bool) -> tuple[ResultWarning, ...]:
    """Return doubts about ids that change on the way: people with one row, and ways that continue under another id.

    ``units``: whether positions are in m and times in s, without which continued tracks cannot be recognized.
    """
    people = len(ends.begin)
    single = np.flatnonzero(ends.begin == ends.end)
    told = []
    if len(single):
        more = "s have" if len(single) > 1 else " has"
        message = (
            f"{len(single)} of {people} way{more} one row only ({named(int(single[0]))}) and are left out of runs: "
            "ids that change from row to row? Give each person one id"
        )
        told.append(ResultWarning("single_row", "person", message))
    before = ends.end < ends.span[1]
    before[single] = False
    broken = np.flatnonzero(before & (ends.follower >= 0))
    if units and len(broken) >= FEW_ENDS and len(broken) > BROKEN_SHARE * before.sum():
        one = int(broken[0])
        message = (
            f"{len(broken)} of {int(before.sum())} ways that end continue under another id ({named(one)} after "
            f"{ends.end[one]:g} s as {named(int(ends.follower[one]))}): ids change on the way, nobody is there in "
            "between, and who appears on a robot is counted apart; give each person one id"
        )
        told.append(ResultWarning("broken_tracks", "person", message))
    return tuple(told)


def lost_doubts(
    ends: TrackEnds, named: Callable[[int], str], run: Moved, *, start_time: float, touch: Array | float, arrived: bool
) -> tuple[ResultWarning, ...]:
    """Return doubts about people who may have been touched while they were not seen, and about what came after the end.

    A person is within ``1.6 m/s |t - t_k|`` of the first or last place that is known for 2 s before or after it, of
    both where the way continues under another id.

    Parameters
    ----------
    ends : TrackEnds
        Of the recording.
    named : callable
        Returns the name of a way by its number.
    run : Trajectory
        Of a robot across the recording.
    start_time : float
        Instant of the recording at which it starts, in s.
    touch : float
        Distance of the centers at which robot and people touch, in m.
    arrived : bool
        Whether the robot reached its goal without a contact.
    """
    time, own = run.time + start_time, run.position
    least: dict[int, tuple[float, float]] = {}
    preceded = np.zeros(len(ends.begin), dtype=np.bool_)
    preceded[ends.follower[ends.follower >= 0]] = True
    for who in np.flatnonzero((ends.end >= time[0] - LOST) & (ends.end <= time[-1])).tolist():
        later = int(ends.follower[who])
        until = ends.begin[later] if later >= 0 else ends.end[who] + LOST
        rows = slice(*np.searchsorted(time, (np.nextafter(ends.end[who], np.inf), until)))
        gap = _away(time[rows], own[rows], ends.end[who], ends.last[who]) - touch
        if later >= 0:
            gap = np.maximum(gap, _away(time[rows], own[rows], ends.begin[later], ends.first[later]) - touch)
        _keep(least, who, time[rows], gap)
    for who in np.flatnonzero(~preceded & (ends.begin <= time[-1] + LOST) & (ends.begin > time[0])).tolist():
        rows = slice(*np.searchsorted(time, (ends.begin[who] - LOST, ends.begin[who])))
        gap = _away(time[rows], own[rows], ends.begin[who], ends.first[who]) - touch
        _keep(least, who, time[rows], gap)
    told = []
    if least:
        who, (when, _) = min(least.items(), key=lambda each: each[1][1])
        more = f" ({some(len(least) - 1, 'more person', 'more people')} likewise)" if len(least) > 1 else ""
        message = (
            f"{named(who)} may have been touched at {when - start_time:.4g} s{more}, out of sight before the first or "
            f"after the last row, with people up to {REACH:g} m/s: whom nobody sees is taken to be away"
        )
        told.append(ResultWarning("lost_nearby", "people", message))
    if arrived and time[-1] > ends.span[1]:
        message = (
            f"the run arrives {time[-1] - ends.span[1]:.4g} s after the end of the recording, when nobody is there: an "
            "earlier start, or a longer recording"
        )
        told.append(ResultWarning("recording_ended", "start_time", message))
    return tuple(told)


def _away(time: Array, own: Array, when: float, place: Array) -> Array:
    """Return how near a person may be who was at a place at an instant, in m."""
    found: Array = np.hypot(*(own - place).T) - REACH * np.abs(time - when)
    return found


def _keep(least: dict[int, tuple[float, float]], who: int, time: Array, gap: Array) -> None:
    """Note when a person may have been touched deepest."""
    if len(gap) and float(gap.min()) < 0.0:
        row = int(np.argmin(gap))
        if who not in least or gap[row] < least[who][1]:
            least[who] = (float(time[row]), float(gap[row]))
