"""A robot and people at the same equal instants, with velocities of stated bandwidth."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety._tracks import Ways, cutoff, fitted_rows, motion_of_ways, position_noise
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["Logged", "Noise", "Synchronized", "synchronized"]

Flags = npt.NDArray[np.bool_]

ROBOT_GAP = 0.25
"""Between poses farther apart in time, in s, nothing is known of the robot."""
PERSON_PERIODS = 3.0
"""Between rows that are more than so many median periods apart a person is not seen."""
MOST_PLACES = 10**7
"""Instants times people."""
_ROUNDING = 1e-9


class Logged(Protocol):
    """A log as `hrsafety.io.load_log` returns it; any object with these attributes."""

    @property
    def time(self) -> Array:
        """Instants of the poses in s, (n,)."""

    @property
    def position(self) -> Array:
        """Positions of the robot in m, (n, 2)."""

    @property
    def heading(self) -> Array:
        """Headings in rad, (n,)."""

    @property
    def people(self) -> Any:
        """Recording of the people, or None."""


class Noise(NamedTuple):
    """Standard deviations of a fitted way.

    Attributes
    ----------
    position, velocity, acceleration : float
        Per axis in m, m/s and m/s^2; of a heading in rad, rad/s and rad/s^2. 0 where there are too few rows to tell.
    """

    position: float
    velocity: float
    acceleration: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Synchronized:
    """Everybody at T equal instants; n people.

    Attributes
    ----------
    time : ndarray, shape (T,)
        In s.
    step : float
        Between two instants in s.
    position, velocity, acceleration : ndarray, shape (T, 2)
        Of the robot; NaN where it has no pose.
    heading, turn_rate : ndarray, shape (T,)
        In rad (continuous) and rad/s.
    whole : ndarray of bool, shape (T,)
        Whether the windows of the fits of the robot are complete on both sides.
    linked : ndarray of bool, shape (T - 1,)
        Whether the robot went from one instant to the next without a gap or a jump.
    ids : ndarray of int or str, shape (n,)
        People.
    people, person_velocity : ndarray, shape (T, n, 2)
        NaN where a person is not seen.
    person_linked : ndarray of bool, shape (T - 1, n)
        Whether a person was seen from one instant to the next, without a jump.
    first, last : ndarray, shape (n,)
        Times of the first and last sight in s.
    period, person_period : float
        Median times between poses and between rows of people in s; NaN without people.
    noise, heading_noise, person_noise : Noise
        Of robot, heading and people.
    window : float
        Of the fits in s.
    """

    time: Array
    step: float
    position: Array
    velocity: Array
    acceleration: Array
    heading: Array
    turn_rate: Array
    whole: Flags
    linked: Flags
    ids: npt.NDArray[Any]
    people: Array
    person_velocity: Array
    person_linked: Flags
    first: Array
    last: Array
    period: float
    person_period: float
    noise: Noise
    heading_noise: Noise
    person_noise: Noise
    window: float

    @property
    def bandwidth(self) -> tuple[float, float]:
        """Frequencies in Hz up to which motions of robot and people are kept (-3 dB); NaN without people."""
        return tuple(  # type: ignore[return-value]  # two
            cutoff(fitted_rows(self.window, each), each) if each > 0.0 else float("nan")
            for each in (self.period, self.person_period)
        )

    @property
    def known(self) -> Flags:
        """Whether the robot has a pose, (T,)."""
        found: Flags = np.isfinite(self.position[:, 0])
        return found

    @property
    def leaps(self) -> Flags:
        """Steps in which a person is seen at both ends and cannot have walked between them, (T - 1, n)."""
        seen = self.seen
        return seen[:-1] & seen[1:] & ~self.person_linked & self.linked[:, None]

    @property
    def seen(self) -> Flags:
        """Who is seen when, (T, n)."""
        found: Flags = np.isfinite(self.people[..., 0])
        return found


def synchronized(log: Logged, *, step: float, window: float) -> Synchronized:
    """Return robot and people of a log at equal instants.

    Parameters
    ----------
    log : Logged
        Poses and people.
    step : float
        Between two instants in s.
    window : float
        Of the local quadratic fits that velocities come from, in s.
    """
    time, place = np.asarray(log.time, dtype=np.float64), np.asarray(log.position, dtype=np.float64)
    heading = np.unwrap(np.asarray(log.heading, dtype=np.float64))
    people = log.people
    count = int((time[-1] - time[0]) / step + _ROUNDING) + 1
    crowd = 0 if people is None else len(people.people())
    if count * max(crowd, 1) > MOST_PLACES:
        shown = Shown(f"{count} instants of {crowd} people")
        remedy = "a larger step, or log.part(begin, end)"
        raise InvalidParameterError("step", f"leave at most {MOST_PLACES:,} places", shown, remedy)
    instants = time[0] + step * np.arange(count)
    cuts = _robot_cuts(log, time)
    motion, turning = (motion_of_ways(_single(time, rows), window, cuts) for rows in (place, _flat(heading)))
    joined = ~cuts
    at = _Instants(time, joined, instants)
    noise, heading_noise = (_noise(_single(time, rows), window) for rows in (place, _flat(heading)))
    fields: dict[str, Any] = {
        "time": instants,
        "step": step,
        "position": at.between(place),
        "velocity": at.between(motion.velocity),
        "acceleration": at.between(motion.acceleration),
        "heading": at.between(_flat(heading))[:, 0],
        "turn_rate": at.between(turning.velocity)[:, 0],
        "whole": at.both(motion.whole),
        "linked": at.linked(),
        "period": float(np.median(np.diff(time))),
        "noise": noise,
        "heading_noise": heading_noise,
        "window": window,
    }
    return Synchronized(**fields, **_people(people, instants, window))


def _people(people: Any, instants: Array, window: float) -> dict[str, Any]:
    """Return the fields of the people."""
    ids = np.empty(0, dtype=np.int64) if people is None else people.people()
    shape = (len(instants), len(ids), 2)
    place, velocity = np.full(shape, np.nan), np.full(shape, np.nan)
    linked = np.zeros((len(instants) - 1, len(ids)), dtype=np.bool_)
    first, last, periods = np.zeros(len(ids)), np.zeros(len(ids)), []
    noise = Noise(0.0, 0.0, 0.0)
    if people is not None:
        tracks = [(time, rows) for _, time, rows in people.tracks()]
        who = np.repeat(np.arange(len(tracks)), [len(time) for time, _ in tracks])
        ways = Ways(np.concatenate([time for time, _ in tracks]), who, np.concatenate([rows for _, rows in tracks]))
        cuts = _person_cuts(ways)
        motion = motion_of_ways(ways, window, cuts)
        noise, start = _noise(ways, window), 0
        for index, (time, rows) in enumerate(tracks):
            some = slice(start, start + len(time))
            at = _Instants(time, ~cuts[start : start + len(time) - 1], instants)
            place[:, index] = at.between(rows)
            velocity[:, index] = at.between(motion.velocity[some])
            linked[:, index] = at.linked()
            first[index], last[index] = time[0], time[-1]
            start += len(time)
            periods.append(np.diff(time))
        steps = np.concatenate(periods) if periods else np.empty(0)
    return {
        "ids": ids,
        "people": place,
        "person_velocity": velocity,
        "person_linked": linked,
        "first": first,
        "last": last,
        "person_period": float(np.median(steps)) if people is not None and len(steps) else float("nan"),
        "person_noise": noise,
    }


def _single(time: Array, rows: Array) -> Ways:
    return Ways(time, np.zeros(len(time), dtype=np.int64), rows)


def _flat(numbers: Array) -> Array:
    return np.stack([numbers, np.zeros_like(numbers)], axis=1)


def _robot_cuts(log: Any, time: Array) -> Flags:
    """Return the steps between poses that are not bridged: gaps and jumps, (n - 1,)."""
    cuts: Flags = np.diff(time) > ROBOT_GAP * (1.0 + _ROUNDING)
    for jump in getattr(log, "pose_jumps", ()):
        begin, end = np.searchsorted(time, [jump[0] - _ROUNDING, jump[1] - _ROUNDING])
        cuts[begin:end] = True
    return cuts


def _person_cuts(ways: Ways) -> Flags:
    """Return the steps between rows that are not bridged: of other people, gaps, jumps and exchanged ids, (n - 1,)."""
    periods = ways.periods()
    with np.errstate(invalid="ignore"):
        long = np.diff(ways.time) > PERSON_PERIODS * periods[1:] * (1.0 + _ROUNDING)
    found: Flags = long | ways.breaks().steps
    return found


def _noise(ways: Ways, window: float) -> Noise:
    """Return how large the noise of a fit is."""
    sigma = position_noise(ways)
    steps = np.diff(ways.time)[ways.same]
    if not (np.isfinite(sigma) and len(steps)):
        return Noise(0.0, 0.0, 0.0)
    period = float(np.median(steps))
    rows = float(fitted_rows(window, period))
    velocity = sigma / period * np.sqrt(12.0 / (rows * (rows**2 - 1.0)))
    acceleration = sigma / period**2 * np.sqrt(720.0 / (rows * (rows**2 - 1.0) * (rows**2 - 4.0)))
    return Noise(sigma, float(velocity), float(acceleration))


class _Instants:
    """Where equal instants lie between the rows of a way; ``joined``: which steps between rows are bridged."""

    def __init__(self, time: Array, joined: Flags, instants: Array) -> None:
        self._after = np.clip(np.searchsorted(time, instants - _ROUNDING, "left"), 0, len(time) - 1)
        self._before = np.maximum(self._after - 1, 0)
        on = np.abs(time[self._after] - instants) <= 2.0 * _ROUNDING
        inside = (instants > time[0]) & (instants < time[-1])
        if len(joined):
            inside &= joined[np.minimum(self._before, len(joined) - 1)]
        self._on, self._known = on, on | inside
        span = time[self._after] - time[self._before]
        share = np.divide(instants - time[self._before], span, out=np.ones(len(instants)), where=span > 0.0)
        self._share = np.where(on, 1.0, share)
        # Steps between rows up to each row that are not bridged.
        self._breaks = np.append(0, np.cumsum(~joined))

    def between(self, rows: Array) -> Array:
        """Return values linear between two rows, NaN where there are none."""
        one, other = rows[self._before], rows[self._after]
        found = one + self._share[:, None] * (other - one)
        found = np.where((self._share == 1.0)[:, None], other, found)
        return np.where(self._known[:, None], found, np.nan)

    def both(self, flags: Flags) -> Flags:
        """Return whether a flag holds at the rows on both sides."""
        found: Flags = self._known & flags[self._after] & (flags[self._before] | self._on)
        return found

    def linked(self) -> Flags:
        """Return whether one leads from an instant to the next without a break."""
        begin = self._breaks[np.where(self._on, self._after, self._before)]
        end = self._breaks[self._after]
        found: Flags = self._known[:-1] & self._known[1:] & (end[1:] == begin[:-1])
        return found
