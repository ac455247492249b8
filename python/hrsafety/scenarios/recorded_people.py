"""A robot that crosses the main flow of recorded people, at many start instants."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety._arguments import count as checked_count
from hrsafety._arguments import followed, positive, word
from hrsafety._bounds import MOST_REPEATS
from hrsafety._display import displayed
from hrsafety._doubts import LateDoubts
from hrsafety._records import dataclass
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["Crossing", "Selection", "crossings"]

Array = npt.NDArray[np.float64]
Pair = tuple[float, float]
Selection = Literal["busiest", "even"]

START_GRID = 0.4
LONGEST_RECORDING = 1e5
"""More than a day in s; start instants are listed before any is chosen."""
LONGEST_STAY = 3600.0
"""In s. Each instant of a stay is examined."""
"""Start instants lie on this grid in s: the annotation step of the usual recordings."""
DEFAULT_SPACING = 4.0
"""Least time between two start instants in s."""
PERSON_RADIUS, CRITICAL_RADIUS, ACTIVE_RADIUS = 0.4, 0.8, 2.1
"""Person and regions of Zeng (2011), chapter 6, in m."""
NOMINAL_SHARE = 0.7
"""Mean speed of a robot that people hold up, as a share of its largest speed."""
_SIGHTING_STEP = 0.2
"""Step in s at which people are examined to count the traffic."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class Crossing:
    """One run across a recording.

    Attributes
    ----------
    start_time : float
        Instant of the recording at which the run starts, in s.
    planned_time : float
        Instant that was meant before waiting for a free start, in s; differs from
        ``start_time`` only with ``selection="even"``.
    traffic : int
        How many people come within the active radius of a robot that crosses straight at 0.7
        of its largest speed from ``start_time`` on.
    people : tuple of int or str
        Id of the person behind each obstacle of the scenario.
    scenario : Scenario
        What to simulate.
    """

    start_time: Annotated[float, "s"]
    planned_time: Annotated[float, "s"]
    traffic: int
    people: tuple[int | str, ...]
    scenario: nav.Scenario


@dataclass(frozen=True, slots=True)
class _Route:
    """Straight way of the robot at its nominal speed."""

    start: Array
    goal: Array
    speed: float

    @property
    def duration(self) -> float:
        return float(np.linalg.norm(self.goal - self.start)) / self.speed


def crossings(
    recording: Recording,
    *,
    runs: int = 24,
    selection: Selection = "busiest",
    spacing: float = DEFAULT_SPACING,
    length: float | None = None,
    robot: nav.HolonomicRobot | None = None,
    time_limit: float = 60.0,
    person_radius: float = PERSON_RADIUS,
    critical_radius: float = CRITICAL_RADIUS,
    active_radius: float = ACTIVE_RADIUS,
    progress: Callable[[int, int], object] | None = None,
) -> list[Crossing]:
    """Return runs of a robot across the main flow of a recording.

    The robot goes straight across `Recording.main_flow`, from right to left of its direction
    and through its center. Start instants lie on a grid of 0.4 s, one crossing at 0.7 of the
    largest speed or more before the end of the recording, and never where a person touches the
    start. They are chosen by the traffic alone, never by how a run ends:

    - ``"busiest"``: instants at least ``spacing`` apart are taken in the order of their
      traffic, the number of people who come within the active radius of a robot that crosses
      straight at 0.7 of its largest speed, about the mean speed of one that people hold up;
      the earlier one first among equals. In ordinary recordings most instants meet few people,
      so evenly spaced ones test little.
    - ``"even"``: instants are spaced evenly over the recording; one at which a person touches
      the start is moved to the next free instant.

    Every person who is in view for some time within ``time_limit`` from the start becomes an
    obstacle that follows the recording and does not react to the robot; after the end of the
    recording no person is there. Buildings and parked cars are not in the recording and so not in
    the scenario. The robot may rest as long as the time limit: waiting is not giving up.

    Parameters
    ----------
    recording : Recording
        People.
    runs : int
        How many runs, at most 100,000.
    selection : {"busiest", "even"}
        How start instants are chosen, see above.
    spacing : float
        Least time between two start instants for ``"busiest"``, in s.
    length : float or None
        Distance from start to goal in m. ``None``: both lie two standard deviations of the
        flow and the critical radius away from its center.
    robot : HolonomicRobot or None
        The robot; the default one when ``None``.
    time_limit : float
        Longest run in s.
    person_radius, critical_radius, active_radius : float
        Of every person, in m.
    progress : callable or None
        Called with (runs done, runs in all) at the start and after each.

    Returns
    -------
    list of Crossing
        In the order of the start instants.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, no person moves, or the recording is too short or too crowded
        for so many runs.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> from hrsafety.datasets import Recording
    >>> walk = Recording(time_s=[0.0, 20.0], person=[7, 7], position=[[-10, 1], [10, 1]])
    >>> [run.start_time for run in scenarios.crossings(walk, runs=2)]
    [5.2, 9.2]
    """
    _check(recording, runs, selection)
    numbers = {"spacing": spacing, "time_limit": time_limit, "person_radius": person_radius}
    numbers |= {"critical_radius": critical_radius, "active_radius": active_radius}
    for name, value in numbers.items():
        _positive(name, value)
    if active_radius <= critical_radius:
        rule = f"be larger than critical_radius = {critical_radius}"
        raise InvalidParameterError("active_radius", rule, active_radius)
    robot = nav.HolonomicRobot() if robot is None else robot
    route = _route(recording, length, critical_radius, robot)
    candidates = _candidates(recording, route)
    touch = robot.radius + person_radius
    free = candidates[_nobody_near(recording, candidates, route.start, touch)]
    traffic = _traffic(recording, free, route, active_radius)
    if selection == "busiest":
        chosen = planned = _busiest(free, traffic, runs, spacing)
    else:
        chosen, planned = _evenly(candidates, free, runs)
    counts = dict(zip(free.tolist(), traffic.tolist(), strict=True))
    doubts = LateDoubts(lambda: recording.warnings)
    body = {"radius": person_radius, "critical_radius": critical_radius, "active_radius": active_radius}
    return [
        Crossing(
            start_time=start_time,
            planned_time=meant,
            traffic=counts[start_time],
            people=tuple(recording.present(start_time, duration=time_limit).tolist()),
            scenario=_scenario(recording, route, robot, start_time, time_limit, body, doubts),
        )
        for start_time, meant in followed(list(zip(chosen, planned, strict=True)), progress)
    ]


def _scenario(
    recording: Recording,
    route: _Route,
    robot: nav.HolonomicRobot,
    start_time: float,
    time_limit: float,
    body: dict[str, float],
    doubts: LateDoubts,
) -> nav.Scenario:
    return nav.Scenario(
        start=_pair(route.start),
        goal=_pair(route.goal),
        obstacles=recording.humans(start_time, duration=time_limit, **body),
        robot=robot,
        time_limit=time_limit,
        rest_time=time_limit,
        doubts=doubts,
    )


def _check(recording: object, runs: object, selection: object) -> None:
    if not isinstance(recording, Recording):
        raise InvalidParameterError("recording", "be a Recording", recording)
    checked_count("runs", runs, most=MOST_REPEATS)
    word("selection", selection, ("busiest", "even"))


def _positive(name: str, value: object) -> None:
    # Of numbers of NumPy those are refused that are no floats of Python.
    if not isinstance(value, (int, float)):
        raise InvalidParameterError(name, "be finite and positive", value)
    positive(name, value)


def _pair(point: Array) -> Pair:
    return (float(point[0]), float(point[1]))


def _route(recording: Recording, length: float | None, clearance: float, robot: nav.HolonomicRobot) -> _Route:
    """Return the way across the main flow."""
    flow = recording.main_flow()
    if length is None:
        length = 2.0 * (2.0 * flow.spread + clearance)
    _positive("length", length)
    center = np.array(flow.center)
    half = 0.5 * length * np.array([-flow.direction[1], flow.direction[0]])
    return _Route(center - half, center + half, NOMINAL_SHARE * robot.max_speed)


def _doubt(recording: Recording) -> str | None:
    """Return what the recording itself is doubtful about, as the likely reason of a refusal."""
    return next((found.message for found in recording.warnings if found.code == "implausible"), None)


def _candidates(recording: Recording, route: _Route) -> Array:
    """Return all instants at which a run could start."""
    spare = recording.duration - route.duration
    if spare < 0.0:
        rule = f"last for one crossing of {route.duration:.1f} s at least"
        raise InvalidParameterError("recording", rule, Shown(f"{recording.duration:.1f} s"), _doubt(recording))
    if spare > LONGEST_RECORDING:
        rule = f"last for at most {LONGEST_RECORDING:g} s beyond one crossing"
        raise InvalidParameterError("recording", rule, Shown(f"{recording.duration:.6g} s"), _doubt(recording))
    steps = np.arange(math.floor(spare / START_GRID + 1e-9) + 1)
    instants: Array = np.round(float(recording.time_s[0]) + START_GRID * steps, 9)
    return instants


def _nobody_near(recording: Recording, instants: Array, place: Array, distance: float) -> npt.NDArray[np.bool_]:
    """Return at which of the instants no person is within a distance of a place."""
    free = np.ones(len(instants), dtype=bool)
    for _, time, position in recording.tracks():
        seen = slice(*np.searchsorted(instants, (time[0], np.nextafter(time[-1], np.inf))))
        free[seen] &= np.linalg.norm(_along(time, position, instants[seen]) - place, axis=1) > distance
    return free


def _along(time: Array, position: Array, instants: Array) -> Array:
    """Return recorded positions at other instants, linear in between."""
    return np.stack([np.interp(instants, time, position[:, axis]) for axis in (0, 1)], axis=1)


def _traffic(recording: Recording, starts: Array, route: _Route, reach: float) -> npt.NDArray[np.int64]:
    """Count the people that a robot at its nominal speed would have within its reach."""
    count = np.zeros(len(starts), dtype=np.int64)
    along = (route.goal - route.start) / (route.speed * route.duration)
    for person, time, position in recording.tracks():
        if time[-1] - time[0] > LONGEST_STAY:
            rule = f"hold nobody for longer than {LONGEST_STAY:g} s"
            found = Shown(f"person {person} for {time[-1] - time[0]:.6g} s")
            raise InvalidParameterError("recording", rule, found, _doubt(recording))
        instants = np.append(np.arange(time[0], time[-1], _SIGHTING_STEP), time[-1])
        offset = _along(time, position, instants) - route.start
        square = reach * reach - (along[0] * offset[:, 1] - along[1] * offset[:, 0]) ** 2
        near = square > 0.0
        instants, ahead, half = instants[near], offset[near] @ along, np.sqrt(square[near])
        # Within reach at an instant is a robot that started between two times, and is under way.
        first = np.maximum(
            np.searchsorted(starts, instants - (ahead + half) / route.speed, "right"),
            np.searchsorted(starts, instants - route.duration, "left"),
        )
        behind = np.minimum(
            np.searchsorted(starts, instants - (ahead - half) / route.speed, "left"),
            np.minimum(np.searchsorted(starts, instants, "right"), np.searchsorted(starts, time[-1], "left")),
        )
        met = behind > first
        if met.any():
            begin, end = int(first[met].min()), int(behind[met].max())
            edges = np.bincount(first[met] - begin, minlength=end - begin + 1)
            edges -= np.bincount(behind[met] - begin, minlength=end - begin + 1)
            count[begin:end] += np.cumsum(edges[:-1]) > 0
    return count


def _busiest(instants: Array, traffic: npt.NDArray[np.int64], runs: int, spacing: float) -> list[float]:
    chosen: list[float] = []
    for index in np.argsort(-traffic, kind="stable"):
        if len(chosen) == runs:
            break
        if all(abs(instants[index] - other) >= spacing - 1e-9 for other in chosen):
            chosen.append(float(instants[index]))
    if len(chosen) < runs:
        rule = f"be at most {len(chosen)}, the number of free start instants {spacing:g} s apart"
        remedy = f"ask for {len(chosen)}, or take a longer recording" if chosen else None
        raise InvalidParameterError("runs", rule, runs, remedy)
    return sorted(chosen)


def _evenly(candidates: Array, free: Array, runs: int) -> tuple[list[float], list[float]]:
    """Return the instants of evenly spaced runs, and those that were meant."""
    planned = candidates[np.linspace(0, len(candidates) - 1, runs).round().astype(int)]
    chosen: list[float] = []
    for instant in planned:
        index = int(np.searchsorted(free, instant))
        if index == len(free):
            raise InvalidParameterError("runs", f"leave a free start instant after {instant:g} s", runs)
        chosen.append(float(free[index]))
    if len(set(chosen)) < runs:
        raise InvalidParameterError("runs", f"be at most {len(set(chosen))}, the number of different instants", runs)
    return chosen, planned.tolist()
