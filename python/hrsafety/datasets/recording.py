"""Positions of people over time: who is where, and as obstacles of a scenario."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety._arguments import finite, instance, points, positive, sequence
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety._replay.played import Played
from hrsafety._replay.record import Replay
from hrsafety._sources import Provenance
from hrsafety._tracks import WINDOW, Breaks, Ways, smoothed_ways
from hrsafety.datasets.flow import Flow, flow_of
from hrsafety.datasets.motion import RecordedMotion, motion_of
from hrsafety.datasets.robots import RecordedRobot
from hrsafety.datasets.row_checks import (
    FARTHEST,
    LONGEST,
    checked_ids,
    checked_order,
    checked_velocity,
    checked_window,
    finite_array,
)
from hrsafety.datasets.track_ends import TrackEnds, ends_doubts, lost_doubts, track_ends
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["Recording"]

Array = npt.NDArray[np.float64]

_OF_FRAMES = "give the frames per second, load_people(..., fps=) or --fps, or divide the times by them"
_SMOOTHING = "recording.smoothed(0.6) takes the noise out"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Recording(Played):
    """Positions of people over time, one row for each person and instant.

    Parameters
    ----------
    time_s : array_like, shape (n,)
        Instants in s, not decreasing.
    person : array_like of int or str, shape (n,)
        Who; the instants of one person must strictly increase.
    position : array_like, shape (n, 2)
        Positions in m.
    velocity : array_like, shape (n, 2), or None
        Velocities in m/s as they were stored; see `motion` for those that are estimated.
    walls : sequence of ndarray, each of shape (k, 2)
        Rings and lines in m, of rings without the first point again.
    robot : RecordedRobot or None
        Robot among the people.
    frame_rate : float or None
        Frames per second.
    frame_rate_from : {"file", "format", "argument", "stored velocities"} or None
        Who says so.
    time_origin : float
        Time of the file at ``time_s = 0``, in s.
    source : Provenance or None
        File that the recording was read from.
    details : mapping of str to object
        What else was found in the file: counts of rows that were left out, scenes, units.
    notes : sequence of ResultWarning
        Doubts of whoever made the recording; they are among the `warnings`.

    Raises
    ------
    InvalidParameterError
        If there is no row, a value is not finite, ids are not integers, or rows are out of
        order.
    ShapeError
        If the arrays do not fit together.

    Examples
    --------
    >>> from hrsafety.datasets import Recording
    >>> walk = Recording(time_s=[0.0, 0.4], person=[7, 7], position=[[0, 0], [0.5, 0]])
    >>> walk.people().tolist(), walk.duration
    ([7], 0.4)
    """

    time_s: Array
    person: npt.NDArray[Any]
    position: Array
    velocity: Array | None = None
    walls: tuple[Array, ...] = ()
    robot: RecordedRobot | None = None
    frame_rate: float | None = None
    frame_rate_from: str | None = None
    time_origin: float = 0.0
    source: Provenance | None = None
    details: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[ResultWarning, ...] = ()
    _order: npt.NDArray[np.intp] = field(init=False, repr=False)
    _ids: npt.NDArray[Any] = field(init=False, repr=False)
    _first: npt.NDArray[np.intp] = field(init=False, repr=False)
    _sorted: Ways | None = field(init=False, repr=False, default=None)
    _ends: TrackEnds | None = field(init=False, repr=False, default=None)
    _found: Breaks | None = field(init=False, repr=False, default=None)
    _warnings: tuple[ResultWarning, ...] | None = field(init=False, repr=False, default=None)

    def __post_init__(self) -> None:
        """Check the rows and freeze the arrays."""
        time = finite_array("time_s", self.time_s, LONGEST)
        position = finite_array("position", self.position, FARTHEST)
        if time.ndim != 1:
            raise ShapeError("time_s", "(n,)", time.shape)
        if len(time) == 0:
            raise InvalidParameterError("time_s", "hold at least one row", Shown("an empty array"))
        person = checked_ids(self.person, len(time))
        if position.shape != (len(time), 2):
            raise ShapeError("position", f"({len(time)}, 2)", position.shape)
        if self.velocity is not None:
            object.__setattr__(self, "velocity", checked_velocity(self.velocity, position.shape))
        object.__setattr__(self, "notes", tuple(checked_doubts("notes", self.notes)))
        if self.robot is not None:
            instance("robot", self.robot, RecordedRobot)
        object.__setattr__(self, "time_origin", finite("time_origin", self.time_origin))
        if self.frame_rate is not None:
            object.__setattr__(self, "frame_rate", positive("frame_rate", self.frame_rate))
        if not isinstance(self.details, Mapping):
            raise InvalidParameterError("details", "be a mapping of words to what the file says", self.details)
        walls = sequence("walls", "be a list of polylines", self.walls)
        object.__setattr__(self, "walls", tuple(points(f"walls[{place}]", each) for place, each in enumerate(walls)))
        order = checked_order(time, person)
        ids, first = np.unique(person[order], return_index=True)
        arrays = {"time_s": time, "person": person, "position": position, "_order": order}
        arrays |= {"_ids": ids, "_first": np.append(first, len(time))}
        for name, array in arrays.items():
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what makes the recording again, without what was found out about it."""
        names = (each.name for each in fields(self) if each.init)
        return _recording, ({name: getattr(self, name) for name in names},)

    def _replay(self) -> Replay:
        from hrsafety.datasets.replays import replay_of_people

        return replay_of_people(self)

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.time_s)

    @property
    def duration(self) -> float:
        """Time from the first to the last row in s."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about units, ids and noise; found when first asked for.

        ``implausible``: a median time between the rows of a person above 2 s or below 1 ms, or speeds (above 0.05 m/s)
        with a median outside 0.1 to 3 m/s or a 95 % quantile outside 0.3 to 6 m/s; whole numbers as times and people
        slower than 0.7 m/s. ``teleport``: a step faster than 6 m/s and longer than 0.5 m among slow ones.
        ``identity_switch``: two people continue where the other one was. ``gap_in_track``: no row for longer than 2 s
        and 10 median steps. ``noisy_positions``: noise of differences beyond 3 m/s^2 and a quarter of a step.
        ``single_row``: a person has one row only. ``broken_tracks``: more than half of the ways
        that end continue under another id within 1 s.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> millimeters = Recording(time_s=[0.0, 0.4], person=[7, 7], position=[[0, 0], [500, 0]])
        >>> millimeters.warnings[0].code
        'implausible'
        """
        if self._warnings is None:
            ways = self._ways().doubts(self._named, moving="the people", of_frames=_OF_FRAMES, smoothing=_SMOOTHING)
            units = all(each.code != "implausible" for each in ways)
            ends = ends_doubts(self._track_ends(), self._named, units=units)
            object.__setattr__(self, "_warnings", (*self.notes, *ways, *ends))
        return self._warnings  # type: ignore[return-value]  # just set

    def _track_ends(self) -> TrackEnds:
        if self._ends is None:
            object.__setattr__(self, "_ends", track_ends(self._ways()))
        return self._ends  # type: ignore[return-value]  # just set

    def _named(self, index: int) -> str:
        return f"person {self._ids[index]}"

    def _ways(self) -> Ways:
        """Return the rows sorted by person, then by time; people by their number in `people`."""
        if self._sorted is None:
            index = np.repeat(np.arange(len(self._ids)), np.diff(self._first))
            ways = Ways(self.time_s[self._order], index, self.position[self._order])
            for array in ways:
                array.setflags(write=False)
            object.__setattr__(self, "_sorted", ways)
        return self._sorted  # type: ignore[return-value]  # just set

    def smoothed(self, window: float = WINDOW) -> Recording:
        """Return the same rows with positions of local quadratic fits, which takes noise out of them.

        Each position is that of the parabola that fits the rows within half a window before and after it best, five
        rows at least, and never across a gap, a jump or an exchange of ids. With ``N`` rows in a window, ``dt`` apart,
        motions below ``1.07/(N dt)`` Hz stay (-3 dB there, 1.7 Hz for 31 rows at 50 Hz).

        Parameters
        ----------
        window : float
            Length of the window in s.

        Returns
        -------
        Recording
            The same people at the same instants.

        Raises
        ------
        InvalidParameterError
            If the window is not finite and positive.

        Examples
        --------
        >>> import numpy as np
        >>> from hrsafety.datasets import Recording
        >>> time = 0.02 * np.arange(200)
        >>> walk = time[:, None] * (1.2, 0.0) + np.random.default_rng(1).normal(0.0, 0.02, (200, 2))
        >>> noisy = Recording(time_s=time, person=[7] * 200, position=walk)
        >>> noisy.warnings[0].code, noisy.smoothed().warnings
        ('noisy_positions', ())
        """
        ways = self._ways()
        found = np.empty_like(self.position)
        found[self._order] = smoothed_ways(ways, positive("window", window), self._breaks().steps)
        return replace(self, position=found, velocity=None)

    def motion(self, window: float = WINDOW) -> RecordedMotion:
        """Return velocities and accelerations, with how exact they are and what they pass.

        Stored velocities are taken if they are within 20 % of differences of the positions. Others are those of local
        quadratic fits over the window, at least 5 rows and never across a gap, a jump or an exchange of ids; of
        recordings with less than 5 rows a second differences.

        Parameters
        ----------
        window : float
            Length of the window in s.

        Returns
        -------
        RecordedMotion
            One row for each of the recording.

        Raises
        ------
        InvalidParameterError
            If the window is not finite and positive.

        Examples
        --------
        >>> import numpy as np
        >>> from hrsafety.datasets import Recording
        >>> time = 0.02 * np.arange(200)
        >>> walk = time[:, None] * (1.2, 0.0) + np.random.default_rng(1).normal(0.0, 0.02, (200, 2))
        >>> motion = Recording(time_s=time, person=[7] * 200, position=walk).motion()
        >>> motion.velocity_from, round(motion.bandwidth, 1), round(motion.velocity_noise, 2)
        ('fit', 1.7, 0.02)
        """
        length = positive("window", window)
        return motion_of(self._ways(), self._breaks().steps, self._order, self.velocity, length)

    @property
    def sampling_period(self) -> float:
        """Median time between two rows of a person in s; NaN if no person has two."""
        steps = np.diff(self._ways().time)[self._ways().same]
        return float(np.median(steps)) if len(steps) else float("nan")

    def median_speed(self) -> float:
        """Return the median speed in m/s of those who do not stand, 0 if all do."""
        return self._ways().median_speed()

    def _breaks(self) -> Breaks:
        if self._found is None:
            object.__setattr__(self, "_found", self._ways().breaks())
        return self._found  # type: ignore[return-value]  # just set

    @property
    def switches(self) -> list[tuple[Any, Any, float]]:
        """Pairs of people who continue where the other one was, with the first instant after it in s."""
        ways = self._ways()
        ids = self._ids[ways.who]
        return [(*sorted((ids[a].item(), ids[b].item())), float(ways.time[a])) for a, b in self._breaks().switches]

    @property
    def teleports(self) -> list[tuple[Any, float, float]]:
        """Steps to places that no person can have reached: id, last instant before and first one after it in s."""
        return self._steps_of(self._breaks().jumps)

    @property
    def gaps(self) -> list[tuple[Any, float, float]]:
        """Long times without a row: id, last instant before and first one after it in s."""
        return self._steps_of(self._breaks().gaps)

    def _steps_of(self, steps: npt.NDArray[np.bool_]) -> list[tuple[Any, float, float]]:
        ways, rows = self._ways(), np.flatnonzero(steps)
        ids = self._ids[ways.who[rows]].tolist()
        return list(zip(ids, ways.time[rows].tolist(), ways.time[rows + 1].tolist(), strict=True))

    def relabeled(self) -> Recording:
        """Return the recording with the ids of `switches` exchanged again.

        Returns
        -------
        Recording
            The same places under other ids from each exchange on; ``details["relabeled"]`` lists the exchanges.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> time, ids = [0, 0, 1, 1, 2, 2, 3, 3], [1, 2] * 4
        >>> walk = [[0, 0], [0, 5], [1, 0], [1, 5], [2, 5], [2, 0], [3, 5], [3, 0]]
        >>> walked = Recording(time_s=time, person=ids, position=walk)
        >>> walked.switches, walked.relabeled().switches
        ([(1, 2, 2.0)], [])
        """
        done = self.switches
        if not done:
            return self
        person, whose = self.person.copy(), dict[Any, Any]()
        for one, other, when in done:
            # Whose rows stand under an id, since the last exchange.
            whose[one], whose[other] = whose.get(other, other), whose.get(one, one)
            for each in (one, other):
                person[(self.time_s >= when) & (self.person == each)] = whose[each]
        order = np.lexsort((person, self.time_s))
        velocity = None if self.velocity is None else self.velocity[order]
        rows: dict[str, Any] = {
            "time_s": self.time_s,
            "person": person[order],
            "position": self.position[order],
            "velocity": velocity,
        }
        return replace(self, **rows, details={**self.details, "relabeled": done})

    def people(self) -> npt.NDArray[Any]:
        """Return the ids of all people, sorted."""
        return self._ids.copy()

    def track(self, person: int | str) -> tuple[Array, Array]:
        """Return the recorded way of one person.

        Parameters
        ----------
        person : int or str
            Id.

        Returns
        -------
        time : ndarray, shape (k,)
            Instants in s.
        position : ndarray, shape (k, 2)
            Positions in m.

        Raises
        ------
        InvalidParameterError
            If no person has this id.
        """
        fits = isinstance(person, str if self._ids.dtype.kind == "U" else int | np.integer)
        index = int(np.searchsorted(self._ids, person)) if fits else len(self._ids)
        if index == len(self._ids) or self._ids[index] != person:
            raise InvalidParameterError("person", "be the id of a recorded person", person)
        rows = slice(self._first[index], self._first[index + 1])
        ways = self._ways()
        return ways.time[rows].copy(), ways.position[rows].copy()

    def tracks(self) -> Iterator[tuple[Any, Array, Array]]:
        """Go through the recorded ways of everybody, in the order of the ids.

        Yields
        ------
        person : int or str
            Id.
        time : ndarray, shape (k,)
            Instants in s.
        position : ndarray, shape (k, 2)
            Positions in m.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> walk = Recording(time_s=[0.0, 0.4, 0.4], person=[7, 9, 7], position=[[0, 0], [4, 0], [0.5, 0]])
        >>> [(person, time.tolist()) for person, time, _ in walk.tracks()]
        [(7, [0.0, 0.4]), (9, [0.4])]
        """
        ways, ends = self._ways(), self._first.tolist()
        for person, begin, end in zip(self._ids.tolist(), ends[:-1], ends[1:], strict=True):
            yield person, ways.time[begin:end], ways.position[begin:end]

    def present(self, start_time: float, *, duration: float) -> npt.NDArray[Any]:
        """Return who is in view for some time within a window.

        Parameters
        ----------
        start_time : float
            Begin of the window in s.
        duration : float
            Length of the window in s.

        Returns
        -------
        ndarray of int
            Ids, sorted: the people of `humans`, in the same order.

        Raises
        ------
        InvalidParameterError
            If start_time is not finite or duration is not finite and positive.
        """
        return self._seen(start_time, duration, for_some_time=True)

    def momentary(self, start_time: float, *, duration: float) -> npt.NDArray[Any]:
        """Return who is in view at one single instant of a window only.

        These are people with a single row, and people whose last row is the begin or whose
        first row is the end of the window. `humans` leaves them out.

        Parameters
        ----------
        start_time : float
            Begin of the window in s.
        duration : float
            Length of the window in s.

        Returns
        -------
        ndarray of int
            Ids, sorted.

        Raises
        ------
        InvalidParameterError
            As `present`.
        """
        return self._seen(start_time, duration, for_some_time=False)

    def _seen(self, start_time: float, duration: float, *, for_some_time: bool) -> npt.NDArray[Any]:
        start_time, duration = checked_window(start_time, duration)
        first, last = (self.time_s[self._order[rows]] for rows in (self._first[:-1], self._first[1:] - 1))
        shared = np.minimum(last, start_time + duration) - np.maximum(first, start_time)
        seen: npt.NDArray[Any] = self._ids[shared > 0.0 if for_some_time else shared == 0.0]
        return seen

    @telling(lambda self, *_, **__: self.warnings)
    def humans(self, start_time: float, *, duration: float, **human_fields: Any) -> tuple[nav.Human, ...]:
        """Return the people in view during a window as obstacles.

        Time is shifted so that 0 is ``start_time``. Each track is cut to the rows that matter:
        from the last one at or before the window to the first one at or after it, so first
        times may be negative. People who are in view at a single instant only are left out;
        `momentary` names them.

        Parameters
        ----------
        start_time : float
            Begin of the window in s.
        duration : float
            Length of the window in s.
        **human_fields
            ``radius``, ``active_radius``, ``critical_radius``, ``max_speed`` of every person.

        Returns
        -------
        tuple of Human
            In the order of `present`.

        Raises
        ------
        InvalidParameterError
            As `present`, or if a field is wrong.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> walk = Recording(time_s=[0.0, 0.4, 0.8], person=[7, 7, 7], position=[[0, 0], [0.5, 0], [1, 0]])
        >>> walk.humans(0.4, duration=10.0)[0].path[0]
        (0.0, 0.4)
        """
        start_time, duration = checked_window(start_time, duration)
        people = []
        for person in self.present(start_time, duration=duration).tolist():
            time, position = self.track(person)
            begin = max(int(np.searchsorted(time, start_time, side="right")) - 1, 0)
            end = int(np.searchsorted(time, start_time + duration, side="left")) + 1
            people.append(nav.Human.from_path(time[begin:end] - start_time, position[begin:end], **human_fields))
        return tuple(people)

    def lost_near(
        self, run: nav.Trajectory, *, start_time: float, person_radius: float = 0.4
    ) -> tuple[ResultWarning, ...]:
        """Return doubts about people that a robot may have touched while they were not seen.

        Before the first and after the last row a person is absent. Who vanishes in the middle of the scene may still be
        there: within 1.6 m/s of the last place for 2 s, and likewise before the first one.

        Parameters
        ----------
        run : Trajectory
            Of a robot among these people.
        start_time : float
            Instant of the recording at which it starts, in s.
        person_radius : float
            Of the people, in m.

        Returns
        -------
        tuple of ResultWarning
            ``lost_nearby``, and ``recording_ended`` if the robot arrives after the last row of all.

        Raises
        ------
        InvalidParameterError
            If an argument is out of range, or the run has no scenario.

        Examples
        --------
        A person vanishes 1 m beside the robot:

        >>> from hrsafety import navigation as nav
        >>> from hrsafety.datasets import Recording
        >>> time = [0.0, 0.4, 0.8, 60.0]
        >>> walk = Recording(time_s=time, person=[7, 7, 7, 9], position=[[1.9, -2], [1.9, -1.5], [1.9, -1], [9, 9]])
        >>> scene = nav.Scenario(start=(0, 0), goal=(4, 0), obstacles=walk.humans(0.0, duration=10.0, radius=0.4))
        >>> run = nav.simulate(scene, nav.VirtualForceField())
        >>> run.outcome, [doubt.code for doubt in walk.lost_near(run, start_time=0.0)]
        ('arrived', ['lost_nearby'])
        """
        instance("run", run, nav.Trajectory)
        if run.scenario is None:
            raise InvalidParameterError("run", "be a run in a scenario", Shown("a run after a reference"))
        touch = run.scenario.robot.radius + positive("person_radius", person_radius)
        begin = finite("start_time", start_time)
        arrived = run.outcome == "arrived"
        return lost_doubts(self._track_ends(), self._named, run, start_time=begin, touch=touch, arrived=arrived)

    def main_flow(self) -> Flow:
        """Return where and in which direction most people walk.

        The direction is the principal axis of all velocities, weighted by time. The section
        across it before which half of the way along it is walked holds the center, at the
        median of the places where people walk through that section first.

        Returns
        -------
        Flow
            Center, direction, angle and spread.

        Raises
        ------
        InvalidParameterError
            If no person moves.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> walk = Recording(time_s=[0.0, 4.0], person=[7, 7], position=[[0, 1], [5, 1]])
        >>> walk.main_flow().direction
        (1.0, 0.0)
        """
        return flow_of([(time, position) for _, time, position in self.tracks()])


def _recording(fields: dict[str, Any]) -> Recording:
    return Recording(**fields)
