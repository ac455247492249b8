"""Scored episodes: positions over time, with the sizes and rules that they are measured by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from typing import Any, Protocol, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import (
    Array,
    Pair,
    Parameters,
    empty,
    instance,
    not_negative,
    number,
    numbers,
    pair,
    points,
    positive,
    sequence,
)
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety._tracks import WINDOW, Ways, smoothed_ways
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.maps.outlines import outlines
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.metrics.sights import unseen_instants
from hrsafety.navigation.metrics.sources import at_instants, doubts_of_run, steps_of_run, without_noise
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.robots.footprint import Footprint
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning

__all__ = ["Episode", "Recorded", "Wall"]

Wall = Disc | Rectangle | npt.ArrayLike
_SAME = 1e-9
"""Difference of radii that rounding explains, in m."""


class Recorded(Protocol):
    """Positions of people over time, as `hrsafety.datasets.Recording` has them."""

    @property
    def time_s(self) -> Array:
        """Instants in s."""

    @property
    def person(self) -> npt.NDArray[np.int64]:
        """Who."""

    @property
    def position(self) -> Array:
        """Positions in m."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Episode(Parameters):
    """One robot among n people at T + 1 equal instants.

    Parameters
    ----------
    position : array_like, shape (T + 1, 2)
        Positions of the robot in m.
    step : float
        Time between two instants in s.
    goal : tuple of float
        Goal of the robot in m.
    robot_radius : float
        Radius of the robot in m.
    people : array_like, shape (T + 1, n, 2)
        Positions of the people in m; NaN while one is absent, or not seen.
    person_radius : float or array_like, shape (n,)
        Radii of the people in m.
    groups : array_like of int, shape (n,)
        Who belongs together; below 0: to no person. Empty: there are no groups.
    walls : StaticMap, or sequence of Disc, Rectangle, or array_like, shape (k, 2)
        What stands still; arrays are polylines. A map is kept as its outlines.
    people_without : array_like, shape (U + 1, n, 2), or None
        The same people in the same world and with the same seed, without robots.
    person_goals : array_like, shape (n, 2)
        Goals of the people in m, NaN for who has none; needed with ``people_without`` only.
    person_arrivals, person_arrivals_without : array_like, shape (n, 3)
        Instants in s and places in m at which people arrived with robots and without them, NaN for who did
        not; for people who leave at the goal and are recorded no more. Empty: the first instants within
        ``person_tolerance`` of the goals.
    arrival_tolerance, person_tolerance : float
        Distance to the goal that counts as arrival, in m, of the robot and of people.
    max_speed : float
        Greatest speed allowed in m/s; ``efficacy`` is measured by it.
    shortest_length : float or None
        Length of the shortest path to the goal in m; the straight one up to the tolerance when ``None``.
    period : tuple of float
        Lengths in m after which the world repeats along x and y; 0: it does not.
    warnings : sequence of ResultWarning
        Why the positions may not mean what they seem to; the metrics carry them.
    simulated : bool
        Whether the positions come from a simulation: who has no position is away, and nothing is measured.
    unseen : array_like of bool, shape (T + 1, n), or None
        When people are not seen and may be there. ``None``: between two sights, and always for who is never seen;
        never if ``simulated``.
    person_speed : float
        Greatest speed of people while they are not seen, in m/s.
    footprint : Footprint or None
        Outline of a robot that is no disc: contacts and clearances are those of the polygon, also between instants,
        and who came toward whom is told by the velocity of the touching point. ``robot_radius`` is that of the circle
        around it, by which times to collision and people who are not seen are measured, which is more careful.
    heading : array_like, shape (T + 1,)
        Headings of the robot in rad; needed with ``footprint`` only.

    Notes
    -----
    Absence is not clearance. A person last seen at ``x_a`` and next at ``x_b`` is, within the speed ``v``, in both
    discs around them with radii ``v (t - t_a)`` and ``v (t_b - t)``; ``v`` is `person_speed`, or
    ``|x_b - x_a|/(t_b - t_a)`` if that is larger. The surfaces of robot and person are then at least::

        g(t) = max(|p - x_a| - v (t - t_a), |p - x_b| - v (t_b - t)) - R - rho

    apart, with the term that is known where only one is. A contact is possible where ``g < 0``: `success` is false
    then. Every metric that could be different with a person at ``g`` is NaN (``min_clearance`` where ``g`` is below it,
    ``personal_share`` where ``g + rho`` is below 1.2 m, times to collision by ``g/(v + |V|)`` ...), and a warning
    ``not_scored`` names person, times and metrics. Numbers of contacts count what is seen.

    Before the first and after the last sight a person is away, as far as metrics go; where the robot may have touched
    the person within 2 s of them, a warning ``not_scored`` says so.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range, or arrays are of different lengths.
    ShapeError
        If an array has another number of axes.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> x = np.linspace(0.0, 4.0, 9)
    >>> straight = np.stack([x, 0.0 * x], axis=1)
    >>> episode = nav.metrics.Episode(
    ...     position=straight, step=0.5, goal=(4.0, 0.0), robot_radius=0.3, people=[[[2.0, 1.0]]] * 9
    ... )
    >>> round(nav.metrics.evaluate(episode).min_clearance, 3)
    0.45
    """

    position: npt.ArrayLike
    step: float
    goal: Pair
    robot_radius: float
    people: npt.ArrayLike = ()
    person_radius: npt.ArrayLike = 0.25
    groups: npt.ArrayLike = ()
    walls: Sequence[Wall] | StaticMap = ()
    people_without: npt.ArrayLike | None = None
    person_goals: npt.ArrayLike = ()
    person_arrivals: npt.ArrayLike = ()
    person_arrivals_without: npt.ArrayLike = ()
    arrival_tolerance: float = 0.3
    person_tolerance: float = 0.3
    max_speed: float = 1.0
    shortest_length: float | None = None
    period: Pair = (0.0, 0.0)
    warnings: Sequence[ResultWarning] = ()
    simulated: bool = False
    unseen: npt.ArrayLike | None = None
    person_speed: float = 1.6
    footprint: Footprint | None = None
    heading: npt.ArrayLike = ()
    _native: _hrsafety.CrowdEpisode = field(init=False, repr=False, compare=False)
    _resampled: bool = field(init=False, repr=False, default=False)
    _begin: float = field(init=False, repr=False, compare=False, default=0.0)
    _ids: tuple[object, ...] = field(init=False, repr=False, compare=False, default=())

    def _named(self, person: int) -> str:
        """Return what doubts call a person: by the id of a log that this is a part of."""
        return f"person {self._ids[person]}" if self._ids else f"people[{person}]"

    def _time(self, instant: int) -> str:
        """Return an instant as doubts tell it, by the clock of that log."""
        return f"{self._begin + instant * self.step:.10g}"

    def __post_init__(self) -> None:
        """Check the values and keep copies of the arrays."""
        rules: dict[str, Any] = self._as_numbers(
            "step", "robot_radius", "arrival_tolerance", "person_tolerance", "max_speed"
        )
        rules |= {"goal": pair("goal", self.goal), "period": pair("period", self.period)}
        length = self.shortest_length
        rules["shortest_length"] = None if length is None else number("shortest_length", length)
        people = _over_time("people", self.people)
        without = None if self.people_without is None else _over_time("people_without", self.people_without)
        if without is not None and len(without) == 0:
            raise InvalidParameterError("people_without", "hold at least one instant", 0)
        arrays: dict[str, Any] = {
            "position": points("position", self.position),
            "people": people,
            "person_radius": _of_people("person_radius", self.person_radius, people.shape[1]),
            "groups": _whole("groups", self.groups),
            "people_without": without,
            "person_goals": points("person_goals", self.person_goals)
            if not empty("person_goals", self.person_goals)
            else _NOWHERE,
        }
        arrays["heading"] = numbers("heading", self.heading) if not empty("heading", self.heading) else np.empty(0)
        if arrays["heading"].ndim != 1:
            raise ShapeError("heading", "(T + 1,)", arrays["heading"].shape)
        if self.footprint is not None:
            self._check_footprint(rules["robot_radius"])
        arrays |= {name: _arrivals(name, getattr(self, name)) for name in _ARRIVALS}
        missing = [name for name in _ARRIVALS if arrays[name].size == 0]
        if len(missing) == 1:
            raise InvalidParameterError(missing[0], "be given where the other arrivals are", Shown("none"))
        standing = outlines(self.walls) if isinstance(self.walls, StaticMap) else self.walls
        walls = sequence("walls", "be a StaticMap or a sequence of discs, rectangles and polylines", standing)
        doubts = checked_doubts("warnings", self.warnings)
        flat: dict[str, Array | None] = {
            name: _rows(arrays[name]) for name in ("people", "people_without") if arrays[name] is not None
        }
        flat |= dict.fromkeys(missing)
        outline = None if self.footprint is None else self.footprint._native
        native = _hrsafety.CrowdEpisode(footprint=outline, **({**rules, **arrays} | flat | wall_rows(walls)))
        arrays["unseen"] = self._unseen(people)
        self._set(person_speed=not_negative("person_speed", self.person_speed))
        kept = {name: None if array is None else _frozen(array) for name, array in arrays.items()}
        self._set(**rules, **kept, walls=tuple(walls), warnings=doubts, _native=native)

    def _check_footprint(self, radius: float) -> None:
        """Refuse a radius that is not that of the circle around the footprint."""
        around = instance("footprint", self.footprint, Footprint).outer_radius
        if abs(radius - around) > _SAME:
            rule = f"be {around:.6g} m, that of the circle around the footprint"
            raise InvalidParameterError("robot_radius", rule, radius, "give footprint.outer_radius")

    def _unseen(self, people: Array) -> npt.NDArray[np.bool_] | None:
        """Return when people are not seen and may be there, ``None`` without people and in a simulation."""
        if type(self.simulated) is not bool:
            raise InvalidParameterError("simulated", "be True or False", self.simulated)
        if self.unseen is None:
            found = None if self.simulated or not people.size else unseen_instants(people)
        else:
            found = np.asarray(self.unseen)
            if found.dtype != np.bool_:
                raise InvalidParameterError(
                    "unseen", "be an array of truth values", Shown(f"an array of {found.dtype}")
                )
            if found.shape != people.shape[:2]:
                raise ShapeError("unseen", str(people.shape[:2]), found.shape)
            found = found & np.isnan(people).any(axis=2)
        return found

    def ways(self) -> tuple[Ways, Ways]:
        """Return the positions of the robot, and those of the people without the instants at which they are absent."""
        own, people = np.asarray(self.position, dtype=np.float64), np.asarray(self.people, dtype=np.float64)
        time = self.step * np.arange(len(own), dtype=np.float64)
        robot = Ways(time, np.zeros(len(own), dtype=np.int64), own)
        who, when = np.nonzero(~np.isnan(people).any(axis=2).T)
        return robot, Ways(time[when], who.astype(np.int64), people[when, who])

    def smoothed(self, window: float = WINDOW) -> Self:
        """Return the episode with positions of local quadratic fits, which takes noise out of them.

        As `hrsafety.datasets.Recording.smoothed`: with ``N`` instants in a window motions below ``1.07/(N step)`` Hz
        stay.

        Parameters
        ----------
        window : float
            Length of the window in s.

        Returns
        -------
        Episode
            The same one otherwise.

        Raises
        ------
        InvalidParameterError
            If the window is not finite and positive, or the world repeats itself.

        Examples
        --------
        >>> import numpy as np
        >>> from hrsafety import navigation as nav
        >>> walk = 0.02 * np.arange(200)[:, None] * (1.0, 0.0)
        >>> noisy = walk + np.random.default_rng(1).normal(0.0, 0.02, walk.shape)
        >>> seen = nav.metrics.Episode(position=noisy, step=0.02, goal=(9.0, 0.0), robot_radius=0.3)
        >>> [round(nav.metrics.evaluate(each).path_length, 1) for each in (seen, seen.smoothed())]
        [7.7, 4.0]
        """
        length = positive("window", window)
        if self.period != (0.0, 0.0):
            raise InvalidParameterError("period", "be (0, 0) for what is smoothed", self.period)
        robot, walks = self.ways()
        own, walked = (
            smoothed_ways(each, length, each.breaks().steps | (np.diff(each.time) > 1.5 * self.step))
            for each in (robot, walks)
        )
        people = np.asarray(self.people, dtype=np.float64).copy()
        people[np.rint(walks.time / self.step).astype(np.int64), walks.who] = walked
        return replace(self, position=own, people=people)

    @classmethod
    def from_trajectory(cls, trajectory: Trajectory, **options: Any) -> Self:
        """Return a run of `simulate` as an episode.

        The people of its scenario are the people, what stands still are walls. Other robots (`MovingDisc`,
        `MovingRectangle`) and maps of laws and sensors are left out: metrics of the run warn ``not_scored``
        where there is a map, or such a robot was touched. The last row, the arrival inside a step, is moved to
        the end of the step.

        Parameters
        ----------
        trajectory : Trajectory
            A run in a scenario.
        **options
            Fields of `Episode` that are to differ from those of the scenario.

        Returns
        -------
        Episode
            Step, goal, radius, tolerance and greatest speed are those of the run.

        Raises
        ------
        InvalidParameterError
            If the run has no scenario or no two instants.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> run = nav.simulate(scenarios.configuration("parallel_human"), nav.VirtualForceField())
        >>> episode = nav.metrics.Episode.from_trajectory(run)
        >>> nav.metrics.evaluate(episode).arrived
        True
        """
        found = steps_of_run(instance("trajectory", trajectory, Trajectory))
        doubts = doubts_of_run(trajectory, walls="walls" not in options, people="people" not in options)
        return cls(**({**found, "warnings": (*trajectory.warnings, *doubts), "simulated": True} | options))

    @classmethod
    def from_recording(
        cls, recording: Recorded, robot: int | str | npt.ArrayLike, *, step: float, **options: Any
    ) -> Self:
        """Return recorded people as an episode, one of whom, or a path of one's own, is the robot.

        Positions are linear between the rows of a person up to three median steps apart; between others the person is
        not seen, and absent before the first and after the last row. The episode lasts as long as the robot is there.
        Positions that are too noisy (``noisy_positions``) are those of `Recording.smoothed`, and ``smoothed_positions``
        says so.

        Parameters
        ----------
        recording : Recording
            Positions over time; any object with ``time_s``, ``person`` and ``position``.
        robot : int, str or array_like, shape (k, 3)
            Id of the person who is taken for the robot, or instants in s and positions in m of a robot.
        step : float
            Time between two instants of the episode in s.
        **options
            The other fields of `Episode`; the goal is the last position of the robot unless given.

        Returns
        -------
        Episode
            People in the order of their ids.

        Raises
        ------
        InvalidParameterError
            If no person has this id, or a value is out of range.

        Examples
        --------
        >>> from hrsafety import datasets, navigation as nav
        >>> time, person = [0.0, 0.0, 1.0, 1.0, 2.0, 2.0], [1, 2, 1, 2, 1, 2]
        >>> places = [[0, 0], [4, 1], [1, 0], [3, 1], [2, 0], [2, 1]]
        >>> walk = datasets.Recording(time_s=time, person=person, position=places)
        >>> episode = nav.metrics.Episode.from_recording(walk, 1, step=0.25, robot_radius=0.25)
        >>> round(nav.metrics.evaluate(episode).min_clearance, 3)
        0.618
        """
        recording, told = without_noise(recording)
        found = at_instants(recording, robot, positive("step", step))
        doubts = (*told, *found.pop("warnings"))
        episode = cls(**({**found, "step": step, "warnings": doubts} | options))
        episode._set(_resampled=True)
        return episode


_NOWHERE = np.empty((0, 2))
_ARRIVALS = ("person_arrivals", "person_arrivals_without")


def _arrivals(name: str, value: npt.ArrayLike) -> Array:
    """Return instants and places (n, 3)."""
    array = numbers(name, value)
    if array.size == 0:
        return np.empty((0, 3))
    if array.ndim != 2 or array.shape[1] != 3:
        raise ShapeError(name, "(n, 3)", array.shape)
    return np.ascontiguousarray(array)


def _frozen(array: Array) -> Array:
    """Return a copy that cannot be written to."""
    kept = array.copy()
    kept.setflags(write=False)
    return kept


def _rows(array: Array) -> Array:
    return np.ascontiguousarray(array).reshape(-1, 2)


def _over_time(name: str, value: npt.ArrayLike) -> Array:
    """Return positions (instants, people, 2); no person for an empty array."""
    array = numbers(name, value)
    if array.size == 0:
        return np.empty((0, array.shape[1] if array.ndim == 3 else 0, 2))
    if array.ndim != 3 or array.shape[2] != 2:
        raise ShapeError(name, "(T + 1, n, 2)", array.shape)
    return array


def _of_people(name: str, value: npt.ArrayLike, count: int) -> Array:
    """Return a number for each person; a single one holds for all."""
    array = numbers(name, value)
    if array.ndim == 0:
        positive(name, float(array))
        return np.full(count, float(array))
    if array.shape != (count,):
        raise ShapeError(name, f"({count},)", array.shape)
    return array


def _whole(name: str, value: npt.ArrayLike) -> npt.NDArray[np.int64]:
    if empty(name, value):
        return np.empty(0, dtype=np.int64)
    array = numbers(name, value)
    if array.ndim != 1 or not (array == np.floor(array)).all() or np.abs(array).max() > 2**53:
        raise InvalidParameterError(name, "hold integers, one for each person", value)
    return array.astype(np.int64)


def wall_rows(walls: Sequence[Wall]) -> dict[str, Array]:
    """Return walls as the core takes them: segments, discs and rectangles as rows of numbers."""
    segments, discs, rectangles = [], [], []
    for index, wall in enumerate(walls):
        if isinstance(wall, Disc):
            discs.append((*wall.center, wall.radius))
        elif isinstance(wall, Rectangle):
            rectangles.append((*wall.center, wall.length, wall.width, wall.heading))
        else:
            corners = points(f"walls[{index}]", wall)
            if len(corners) < 2:
                raise InvalidParameterError(f"walls[{index}]", "have two points or more", len(corners))
            segments += np.hstack([corners[:-1], corners[1:]]).tolist()
    kinds = {"segments": (segments, 4), "discs": (discs, 3), "rectangles": (rectangles, 5)}
    return {name: np.array(rows, dtype=np.float64).reshape(-1, width) for name, (rows, width) in kinds.items()}
