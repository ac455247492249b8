"""Ways of people and robots over time: what makes them doubtful, and what takes noise out of them."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Pair
from hrsafety.plausibility import RANGES, ResultWarning

__all__ = [
    "Breaks",
    "FittedMotion",
    "Ways",
    "cutoff",
    "fitted_rows",
    "gaps_of_paths",
    "motion_of_ways",
    "plausible_unit",
    "position_noise",
    "smoothed_ways",
]

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

SLOWEST_SAMPLING, FASTEST_SAMPLING = 2.0, 1e-3
"""Plausible times between two rows of a person, in s."""
STANDING = 0.05
"""Slower than this a person stands, in m/s."""
MEDIAN_SPEED, HIGH_SPEED = (0.1, 3.0), (0.3, 6.0)
"""Plausible median and 95 % quantile of the speeds of those who do not stand, in m/s."""
STROLL = 0.7
"""Slower people with whole numbers as times may be frames of 2 or more in a second, in m/s."""
MANY_STEPS = 20
"""With fewer steps a 95 % quantile is their largest value."""
MANY_INSTANTS = 10
"""So many different times that all are whole numbers are no accident."""
MILLISECONDS = 20.0
"""Times so far apart may be milliseconds, of a camera with at most 50 frames a second."""
ONE_PLACE, NO_MOTION = 0.2, 1e-3
"""Two people do not stand within the first, and no person stands as still as the second, in m."""
FAR = 0.5
"""Whoever gets so far from the first place does not stand, in m."""
JUMP_SPEED, JUMP_LENGTH, ORDINARY_SPEED = 6.0, 0.5, 3.0
"""A jump is faster in m/s and longer in m than the first two; before and after it people are slower than the last."""
SWITCH_RESIDUAL, SWITCH_GAIN = 0.6, 4.0
"""Deviation of two people from constant velocity in m, and how many times smaller it is with exchanged ids."""
LONG_GAP, GAP_RATIO = 2.0, 10.0
GAP_IN_TRACK = "gap_in_track"
"""Without a row for longer than the first, in s, and than so many median steps a person is not seen."""
NOISE_ACCELERATION = 3.0
"""Noise of accelerations per axis that is more than people do, in m/s^2."""
LEAST_THIRDS = 10
"""Third differences from which a noise is estimated."""
MOST_THIRDS = 400_000
"""Of more rows every second, third, ... one is examined."""
MOST_PAIRS = 1_000_000
"""Pairs of people of an instant that are compared at once."""
HINTS = {"m": (1.0, "meters"), "cm": (0.01, "centimeters"), "mm": (0.001, "millimeters")}
"""Units of positions: meters of one, and its name."""
WALKING = 1.2
"""Usual speed of people in m/s."""


def plausible_unit(median: float) -> str | None:
    """Return the unit of positions in which a median speed is most like that of people who walk, if any makes it so."""
    speeds = {unit: factor * median for unit, (factor, _) in HINTS.items()}
    likely = [unit for unit, speed in speeds.items() if MEDIAN_SPEED[0] <= speed <= MEDIAN_SPEED[1]]
    return min(likely, key=lambda unit: max(speeds[unit] / WALKING, WALKING / speeds[unit]), default=None)


def cutoff(rows: float, step: float) -> float:
    """Return the frequency in Hz at which a local quadratic fit over so many rows passes 0.71 of a motion."""
    return 1.07 / (rows * step)


class Breaks(NamedTuple):
    """Steps that are no motion of one person; step k leads from row k to row k + 1, arrays have shape (n - 1,).

    Attributes
    ----------
    gaps : ndarray of bool
        Long times without a row.
    switches : list of (int, int)
        Pairs of rows from which on two people continue where the other one was.
    exchanged : ndarray of bool
        Steps over which ids were exchanged.
    jumps, back : ndarray of bool
        Steps to places that no person can have reached, and those back from a single wrong one.
    """

    gaps: Flags
    switches: list[tuple[int, int]]
    exchanged: Flags
    jumps: Flags
    back: Flags

    @property
    def steps(self) -> Flags:
        """All of them."""
        found: Flags = self.gaps | self.exchanged | self.jumps | self.back
        return found


class Ways(NamedTuple):
    """Rows of several ways, those of one way together and in the order of time.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Instants in s.
    who : ndarray of int, shape (n,)
        Of which way each row is; does not decrease.
    position : ndarray, shape (n, 2)
        Places in m.
    """

    time: Array
    who: npt.NDArray[np.int64]
    position: Array

    @property
    def same(self) -> Flags:
        """Whether rows k and k + 1 belong to one way, (n - 1,)."""
        found: Flags = self.who[1:] == self.who[:-1]
        return found

    def periods(self) -> Array:
        """Return the median time between the rows of the way that each row belongs to, in s; NaN of a single row."""
        steps, owner = np.diff(self.time)[self.same], self.who[1:][self.same]
        order = np.lexsort((steps, owner))
        steps, owner = steps[order], owner[order]
        ids, first, count = np.unique(owner, return_index=True, return_counts=True)
        found = np.full(len(self.time), np.nan)
        if len(ids):
            middle = 0.5 * (steps[first + (count - 1) // 2] + steps[first + count // 2])
            place = np.minimum(np.searchsorted(ids, self.who), len(ids) - 1)
            known = ids[place] == self.who
            found[known] = middle[place[known]]
        return found

    def gaps(self, periods: Array) -> Flags:
        """Return which steps are so long that the position in between is unknown, (n - 1,)."""
        with np.errstate(invalid="ignore"):
            found: Flags = self.same & (np.diff(self.time) > np.maximum(LONG_GAP, GAP_RATIO * periods[1:]))
        return found

    def doubts(
        self, named: Callable[[int], str], *, moving: str, of_frames: str, smoothing: str, units: bool = True
    ) -> tuple[ResultWarning, ...]:
        """Return why the ways may not be those of people.

        Parameters
        ----------
        named : callable
            Returns the name of a way by its number.
        moving : str
            Whose ways they are, as in "median speed of the people".
        of_frames : str
            What to do if the times are numbers of frames.
        smoothing : str
            What takes the noise out, before the window.
        units : bool
            Whether speeds and times are compared with those of people.
        """
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            return self._doubts(named, moving, of_frames, smoothing, units)

    def _doubts(
        self, named: Callable[[int], str], moving: str, of_frames: str, smoothing: str, units: bool
    ) -> tuple[ResultWarning, ...]:
        spans, lengths, speeds = self._steps()
        same, periods = self.same, self.periods()
        found = self._units(spans[same], speeds[same], moving, of_frames) if units else ()
        sigma, gaps = position_noise(self), self.gaps(periods)
        told = list(found)
        if not found:
            breaks = self._breaks(gaps, sigma, lengths, speeds)
            told += self._switch_doubt(breaks.switches, named)
            told += self._jump_doubts(breaks, lengths, speeds, named)
        told += self._gap_doubt(spans, gaps, named)
        told += self._noise(sigma, float(np.nanmedian(periods)) if same.any() else np.nan, lengths[same], smoothing)
        return tuple(told)

    def breaks(self) -> Breaks:
        """Return the steps that are no motion of one person: gaps, jumps and exchanges of ids."""
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            return self._breaks(self.gaps(self.periods()), position_noise(self), *self._steps()[1:])

    def _breaks(self, gaps: Flags, sigma: float, lengths: Array, speeds: Array) -> Breaks:
        switches = self._switches(gaps, sigma)
        exchanged = self._exchanged(switches)
        return Breaks(gaps, switches, exchanged, *self._jumps(exchanged, lengths, speeds))

    def median_speed(self) -> float:
        """Return the median speed in m/s of those who do not stand, 0 if all do."""
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            speeds = self._steps()[2]
        walking = speeds[speeds > STANDING]
        return float(np.median(walking)) if len(walking) else 0.0

    def _steps(self) -> tuple[Array, Array, Array]:
        """Return times in s, lengths in m and speeds in m/s of the steps; the speed from one way to another is 0."""
        spans, ways = np.diff(self.time), np.diff(self.position, axis=0)
        lengths: Array = np.hypot(ways[:, 0], ways[:, 1])
        return spans, lengths, np.divide(lengths, spans, out=np.zeros_like(spans), where=self.same)

    # ---- units ----------------------------------------------------------------------------------

    def _units(self, spans: Array, speeds: Array, moving: str, of_frames: str) -> tuple[ResultWarning, ...]:
        """Return a doubt if times or speeds are not those of recorded people."""
        if len(spans) == 0:
            return ()
        period = float(np.median(spans))
        said = []
        if not FASTEST_SAMPLING <= period <= SLOWEST_SAMPLING:
            said.append(
                f"median time between two rows of a person is {period:g} s, outside the plausible "
                f"{FASTEST_SAMPLING:g} to {SLOWEST_SAMPLING:g} s"
            )
        walking = speeds[speeds > STANDING]
        median = float(np.median(walking)) if len(walking) else 0.0
        high = float(np.quantile(walking, 0.95)) if len(walking) else 0.0
        if len(walking) and not MEDIAN_SPEED[0] <= median <= MEDIAN_SPEED[1]:
            said.append(
                f"median speed of {moving} is {median:.4g} m/s, outside the plausible {MEDIAN_SPEED[0]:g} to "
                f"{MEDIAN_SPEED[1]:g} m/s"
            )
        elif len(walking) >= MANY_STEPS and not HIGH_SPEED[0] <= high <= HIGH_SPEED[1]:
            said.append(
                f"5 % of the speeds of {moving} are above {high:.4g} m/s, outside the plausible {HIGH_SPEED[0]:g} to "
                f"{HIGH_SPEED[1]:g} m/s"
            )
        elif len(walking) == 0 and self._farthest() > FAR:
            said.append(f"{moving} never move faster than {STANDING:g} m/s and get {self._farthest():.3g} m away")
        whole = self._whole_times()
        if not said and whole and median and median < STROLL:
            said.append(f"all times are whole numbers, and median speed of {moving} is {median:.4g} m/s")
        extent = float(np.hypot(*np.ptp(self.position, axis=0)))
        several = bool(self.who[-1] != self.who[0])
        if len(walking) == 0 and not said and (extent < ONE_PLACE if several else 0.0 < extent < NO_MOTION):
            message = f"all positions lie within {extent:.3g} m: kilometers or degrees given for meters?"
            return (ResultWarning("implausible", "position", message),)
        if not said:
            return ()
        subject = "time_s" if said[0].startswith(("median time", "all times")) else f"median speed of {moving}"
        return (
            ResultWarning(
                "implausible", subject, f"{' and '.join(said)}: {self._cause(whole, median, period, of_frames)}"
            ),
        )

    def _cause(self, whole: bool, median: float, period: float, of_frames: str) -> str:
        """Return the mistake that would explain implausible times or speeds."""
        if median > MEDIAN_SPEED[1]:
            unit = plausible_unit(median)
            if unit and not (whole and period > SLOWEST_SAMPLING):
                return f"{HINTS[unit][1]} (unit {unit}) or pixels given for meters?"
            return "millimeters, centimeters or pixels given for meters?"
        if whole:
            other = ", or are they milliseconds?" if period >= MILLISECONDS else ""
            return f"the times are whole numbers and look like frames: {of_frames}{other}"
        if period > SLOWEST_SAMPLING and FASTEST_SAMPLING <= 1e-3 * period <= SLOWEST_SAMPLING:
            return f"milliseconds (unit ms) given for seconds? Or are they frames: {of_frames}"
        return f"frames or milliseconds given for seconds, or another unit than meters? If they are frames, {of_frames}"

    def _whole_times(self) -> bool:
        """Return whether the times are many whole numbers."""
        if not (self.time == np.floor(self.time)).all():
            return False
        return float(np.ptp(self.time)) >= MANY_INSTANTS or len(np.unique(self.time)) >= MANY_INSTANTS

    def _farthest(self) -> float:
        """Return how far a person gets from the first place, in m."""
        first = np.concatenate([[True], ~self.same])
        start = self.position[np.flatnonzero(first)[np.cumsum(first) - 1]]
        return float(np.hypot(*(self.position - start).T).max())

    # ---- jumps and exchanged ids ----------------------------------------------------------------

    def _exchanged(self, switches: list[tuple[int, int]]) -> Flags:
        """Return the steps over which ids were exchanged, (n - 1,)."""
        found = np.zeros(len(self.same), dtype=np.bool_)
        found[[row - 1 for pair in switches for row in pair]] = True
        return found

    def _jumps(self, exchanged: Flags, lengths: Array, speeds: Array) -> tuple[Flags, Flags]:
        """Return the steps to places out of reach, and those back from a single wrong one, (n - 1,)."""
        fast = self.same & (speeds > JUMP_SPEED) & (lengths > JUMP_LENGTH) & ~exchanged
        if not fast.any():
            return fast, fast.copy()
        before, after = np.zeros_like(speeds), np.zeros_like(speeds)
        before[1:], after[:-1] = speeds[:-1], speeds[1:]
        calm_before, calm_after = before < ORDINARY_SPEED, after < ORDINARY_SPEED
        jumps, back = fast & calm_before & calm_after, np.zeros_like(fast)
        back[1:] = fast[:-1] & fast[1:] & calm_before[:-1] & calm_after[1:] & (self.who[2:] == self.who[:-2])
        jumps[:-1] |= back[1:]
        return jumps, back

    def _jump_doubts(
        self, breaks: Breaks, lengths: Array, speeds: Array, named: Callable[[int], str]
    ) -> tuple[ResultWarning, ...]:
        jumps, back, exchanged = breaks.jumps, breaks.back, breaks.exchanged
        told = []
        if jumps.any():
            found = np.flatnonzero(jumps)
            worst = int(found[np.argmax(speeds[found])])
            more = f" ({len(found) - 1} more jumps)" if len(found) > 1 else ""
            subject = f"speed of {named(int(self.who[worst]))} after {self.time[worst]:g} s"
            message = (
                f"{subject} is {speeds[worst]:.5g} m/s, a jump of {lengths[worst]:.3g} m between two rows{more}: a "
                "wrong position, or an id that changed from one person to another; give who comes after it another id"
            )
            told.append(ResultWarning("teleport", subject, message))
        left = np.where(jumps | back | exchanged, 0.0, speeds)
        limit = RANGES["running_speed"]
        if left.size and float(left.max()) > limit.most:
            worst = int(np.argmax(left))
            subject = f"speed of {named(int(self.who[worst]))} after {self.time[worst]:g} s"
            message = (
                f"{subject} is {left[worst]:.5g} m/s, outside the plausible {limit.least:g} to {limit.most:g} m/s "
                f"({limit.source}): {limit.hint}?"
            )
            told.append(ResultWarning("implausible", subject, message))
        return tuple(told)

    def _switches(self, gaps: Flags, sigma: float) -> list[tuple[int, int]]:
        """Return pairs of rows from which on two people continue where the other one was."""
        least = max(SWITCH_RESIDUAL, 10.0 * (sigma if np.isfinite(sigma) else 0.0))
        if len(gaps) < 2:
            return []
        usable = self.same & ~gaps
        usable = usable[1:] & usable[:-1]
        spans, ways, place = np.diff(self.time), np.diff(self.position, axis=0), self.position
        ahead = ways[1:] - ways[:-1] * (spans[1:] / np.where(usable, spans[:-1], 1.0))[:, None]
        apart_from = np.hypot(ahead[:, 0], ahead[:, 1])
        wrong = usable & (apart_from >= 0.5 * least)
        if not wrong.any():
            return []
        # Only people who are there at the same instant can have exchanged ids.
        instants, now = np.unique(self.time[2:][wrong]), self.time[2:]
        near = np.minimum(np.searchsorted(instants, now), len(instants) - 1)
        some_rows = np.flatnonzero(usable & (instants[near] == now))
        some_rows = some_rows[np.argsort(now[some_rows], kind="stable")]
        rows, off = some_rows + 2, apart_from[some_rows]
        expected = place[rows] - ahead[some_rows]
        now, begun = self.time[rows], self.time[rows - 1]
        doubtful = np.flatnonzero(off >= 0.5 * least)
        first, behind = np.searchsorted(now, now[doubtful], "left"), np.searchsorted(now, now[doubtful], "right")
        found: set[tuple[int, int]] = set()
        for some in _in_parts(behind - first):
            sizes = (behind - first)[some]
            one = np.repeat(doubtful[some], sizes)
            ends = np.cumsum(sizes)
            other = np.arange(ends[-1]) - np.repeat(ends - sizes, sizes) + np.repeat(first[some], sizes)
            apart = off[one] + off[other]
            crossed = np.hypot(*(place[rows[other]] - expected[one]).T) + np.hypot(
                *(place[rows[one]] - expected[other]).T
            )
            hits = (one != other) & (begun[one] == begun[other]) & (apart > least) & (SWITCH_GAIN * crossed < apart)
            pairs = zip(rows[one[hits]].tolist(), rows[other[hits]].tolist(), strict=True)
            found |= {(min(pair), max(pair)) for pair in pairs}
        return sorted(found, key=lambda pair: (self.time[pair[0]], pair))

    def _switch_doubt(self, switches: list[tuple[int, int]], named: Callable[[int], str]) -> tuple[ResultWarning, ...]:
        if not switches:
            return ()
        one, other = switches[0]
        names = f"{named(int(self.who[one]))} and {named(int(self.who[other]))}"
        more = f" ({len(switches) - 1} more exchanges)" if len(switches) > 1 else ""
        message = (
            f"{names} exchange places at {self.time[one]:g} s{more}: their ids were probably switched; exchange them "
            "from there on, as recording.relabeled() and load_people(..., relabel=True) do"
        )
        return (ResultWarning("identity_switch", names, message),)

    # ---- gaps and noise -------------------------------------------------------------------------

    def gap_doubt(self, named: Callable[[int], str]) -> tuple[ResultWarning, ...]:
        """Return the doubt of `doubts` about people who are away for long, alone."""
        return self._gap_doubt(np.diff(self.time), self.gaps(self.periods()), named)

    def _gap_doubt(self, spans: Array, gaps: Flags, named: Callable[[int], str]) -> tuple[ResultWarning, ...]:
        """Return a doubt about people who are away for long."""
        long = np.flatnonzero(gaps)
        if len(long) == 0:
            return ()
        worst = int(long[np.argmax(spans[long])])
        more = f" ({len(long) - 1} more gaps)" if len(long) > 1 else ""
        message = (
            f"{named(int(self.who[worst]))} is not seen for {spans[worst]:g} s after {self.time[worst]:g} s and taken "
            f"to go straight on in between{more}: give who was away, or another person, an id of its own"
        )
        return (ResultWarning(GAP_IN_TRACK, "person", message),)

    def _noise(self, sigma: float, period: float, lengths: Array, smoothing: str) -> tuple[ResultWarning, ...]:
        """Return a doubt about positions whose noise is larger than their motion."""
        if not (np.isfinite(sigma) and np.isfinite(period)):
            return ()
        acceleration = sigma * np.sqrt(6.0) / period**2
        if not (acceleration > NOISE_ACCELERATION and sigma * np.sqrt(2.0) > 0.25 * float(np.median(lengths))):
            return ()
        rows = fitted_rows(WINDOW, period)
        message = (
            f"positions are noisy, {1e3 * sigma:.2g} mm per axis every {period:g} s: ways are too long, and "
            f"differences have {acceleration:.3g} m/s^2 of noise per axis; {smoothing} (what changes slower than "
            f"{cutoff(rows, period):.2g} Hz stays)"
        )
        return (ResultWarning("noisy_positions", "position", message),)


def position_noise(ways: Ways) -> float:
    """Return the standard deviation of positions per axis in m, from their third differences; NaN of too few.

    Robust, and blind to motions with constant acceleration: ``1.4826 median|third difference|/sqrt(20)``.
    """
    count = len(ways.time) - 3
    if count < 1:
        return float("nan")
    rows = np.arange(0, count, max(count // MOST_THIRDS, 1))
    times = [ways.time[rows + later] for later in range(4)]
    spans = [after - before for before, after in itertools.pairwise(times)]
    near = np.maximum(np.maximum(*spans[:2]), spans[2]) <= 1.2 * np.minimum(np.minimum(*spans[:2]), spans[2])
    rows = rows[(ways.who[rows + 3] == ways.who[rows]) & near]
    if 2 * len(rows) < LEAST_THIRDS:
        return float("nan")
    place = ways.position
    third = place[rows + 3] - 3.0 * place[rows + 2] + 3.0 * place[rows + 1] - place[rows]
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20.0))


WINDOW = 0.6
"""Time in s over which noisy positions are fitted, unless another one is given."""
LEAST_ROWS = 5


def fitted_rows(window: float, period: float) -> int:
    """Return how many rows a window holds around its middle one, an odd number of at least 5."""
    return max(2 * int(0.5 * window / period + 1e-9) + 1, LEAST_ROWS)


def smoothed_ways(ways: Ways, window: float, cuts: Flags) -> Array:
    """Return positions of local quadratic fits over a window in s, never across the steps named by ``cuts``.

    At the ends of a way the window is one-sided; ways of fewer than 5 rows stay as they are.
    """
    return motion_of_ways(ways, window, cuts).position


class FittedMotion(NamedTuple):
    """Local quadratic fits of ways, row by row.

    Attributes
    ----------
    position, velocity, acceleration : ndarray, shape (n, 2)
        In m, m/s and m/s^2; of fewer than 5 rows positions as they are, differences, and NaN. NaN for the velocity of a
        single row.
    whole : ndarray of bool, shape (n,)
        Whether the window lies within the way on both sides.
    """

    position: Array
    velocity: Array
    acceleration: Array
    whole: Flags


def motion_of_ways(ways: Ways, window: float, cuts: Flags) -> FittedMotion:
    """Return positions, velocities and accelerations of local quadratic fits; see `smoothed_ways`."""
    place = ways.position.copy()
    velocity, acceleration = np.full_like(place, np.nan), np.full_like(place, np.nan)
    whole = np.zeros(len(place), dtype=np.bool_)
    ends = np.flatnonzero(np.concatenate([~ways.same | cuts, [True]])) + 1
    for begin, end in zip(np.concatenate([[0], ends[:-1]]).tolist(), ends.tolist(), strict=True):
        some, time = slice(begin, end), ways.time[begin:end]
        if end - begin >= LEAST_ROWS:
            found = _fitted(time, ways.position[some], window)
            place[some], velocity[some], acceleration[some] = found[:, 0], found[:, 1], 2.0 * found[:, 2]
            half = 0.5 * window * (1.0 - 1e-9)
            whole[some] = (time - time[0] >= half) & (time[-1] - time >= half)
        elif end - begin > 1:
            velocity[some] = np.gradient(ways.position[some], time, axis=0)
    return FittedMotion(place, velocity, acceleration, whole)


def _fitted(time: Array, position: Array, window: float) -> Array:
    """Return coefficients (n, 3, 2) of quadratic fits in time around each row.

    By sums over the rows within half a window of it, at least five.
    """
    half = 0.5 * window * (1.0 + 1e-9)
    low, high = np.searchsorted(time, time - half, "left"), np.searchsorted(time, time + half, "right")
    few = high - low < LEAST_ROWS
    row = np.arange(len(time))
    low = np.where(few, np.clip(row - LEAST_ROWS // 2, 0, len(time) - LEAST_ROWS), low)
    high = np.where(few, low + LEAST_ROWS, high)
    found = np.empty((len(position), 3, 2))
    most = max(MOST_PAIRS // int((high - low).max()), 1)
    for begin in range(0, len(time), most):
        some = slice(begin, begin + most)
        index = low[some, None] + np.arange(int((high - low)[some].max()))
        inside = index < high[some, None]
        index = np.minimum(index, len(time) - 1)
        ago = (time[index] - time[some, None]) / half
        powers = np.empty((5, *ago.shape))
        powers[0] = inside
        for power in range(1, 5):
            np.multiply(powers[power - 1], ago, out=powers[power])
        moments = powers.sum(axis=2).T[:, [[0, 1, 2], [1, 2, 3], [2, 3, 4]]]
        right = [np.einsum("ink,nk->ni", powers[:3], each[index]) for each in position.T]
        found[some] = np.linalg.solve(moments, np.stack(right, axis=2))
    found /= np.array([1.0, half, half * half])[:, None]
    return found


def _in_parts(sizes: Indices) -> list[slice]:
    """Return slices of which the sizes sum to no more than a million each, one element at least."""
    ends = np.cumsum(sizes)
    found, begin = [], 0
    while begin < len(sizes):
        room = MOST_PAIRS + (ends[begin - 1] if begin else 0)
        end = max(int(np.searchsorted(ends, room, "right")), begin + 1)
        found.append(slice(begin, end))
        begin = end
    return found


def gaps_of_paths(
    paths: Mapping[str, tuple[Sequence[float], Sequence[Pair]]], told: Sequence[ResultWarning]
) -> tuple[ResultWarning, ...]:
    """Return the doubt about paths with long times between two places, unless it has been told of their recording.

    Parameters
    ----------
    paths : mapping of str to pair
        Instants in s and places in m by the names of those who move.
    told : sequence of ResultWarning
        Doubts about what they come from.
    """
    if not paths or any(each.code == GAP_IN_TRACK for each in told):
        return ()
    names, counts = list(paths), [len(time) for time, _ in paths.values()]
    time = np.concatenate([np.asarray(each, dtype=np.float64) for each, _ in paths.values()])
    place = np.concatenate([np.asarray(each, dtype=np.float64) for _, each in paths.values()])
    return Ways(time, np.repeat(np.arange(len(names)), counts), place).gap_doubt(names.__getitem__)
