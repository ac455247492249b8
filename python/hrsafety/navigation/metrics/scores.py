"""Social metrics of episodes, one or many, and of whole worlds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, empty, flag, number, numbers, pair, points, sequence, thread_count
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.metrics.between import doubts_between
from hrsafety.navigation.metrics.declared import METRICS, WORLD_METRICS, Measured, MeasuredWorld, Metric, with_metrics
from hrsafety.navigation.metrics.doubts import (
    ENDS,
    contacts_between,
    implausible_numbers,
    may_be_implausible,
    may_have_doubts,
    of_tracks,
    of_values,
    of_world,
)
from hrsafety.navigation.metrics.episode import Episode, Recorded
from hrsafety.navigation.metrics.unseen import unscored
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning, gathered, telling
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["EpisodeMetrics", "MetricTable", "WorldMetrics", "evaluate", "evaluate_many", "evaluate_world"]


class _Scores(Table):
    """Values by the names of declared metrics."""

    __slots__ = ("_values", "warnings")
    _metrics: Mapping[str, Metric] = METRICS
    _values: dict[str, Any]
    warnings: tuple[ResultWarning, ...]

    def __init__(self, values: Mapping[str, Any], warnings: Iterable[ResultWarning] = ()) -> None:
        object.__setattr__(self, "_values", dict(values))
        object.__setattr__(self, "warnings", tuple(warnings))

    def __getattr__(self, name: str) -> Any:
        # Pickling asks before there are values.
        values = object.__getattribute__(self, "_values") if name in self._metrics else {}
        if name not in values:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
        return values[name]

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} cannot be changed", name=name, obj=self)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._values, self.warnings)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        mine, theirs = self._values, other._values
        return all(np.array_equal(mine[name], theirs[name], equal_nan=True) for name in mine)

    __hash__ = None  # type: ignore[assignment]  # they hold arrays

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, with units.

        Returns
        -------
        dict of str to ndarray
            A column for each metric.
        """
        return {
            f"{metric.name}{unit_suffix(metric.unit)}": np.atleast_1d(self._values[metric.name])
            for metric in self._metrics.values()
        }


class _One(_Scores):
    """One row, printed as a list of names."""

    __slots__ = ()

    def to_dict(self) -> dict[str, float | int | bool]:
        """Return the values by name.

        Returns
        -------
        dict of str to float, int or bool
            In the order of the declared list.
        """
        return dict(self._values)

    def __repr__(self) -> str:
        """Return a line for each metric."""
        lines = [f"{type(self).__name__}:"]
        for metric in self._metrics.values():
            value = self._values[metric.name]
            shown = f"{value:.6g}" if isinstance(value, float) else str(value)
            lines.append(f"  {metric.name} = {shown}{' ' if metric.unit else ''}{metric.unit}")
        return "\n".join([*lines, *self._doubts()])


@with_metrics(METRICS)
class EpisodeMetrics(_One, Measured[float, int, bool]):
    """How a robot fared among people; made by `evaluate`.

    Attributes
    ----------
    {metrics}

    See Also
    --------
    MetricTable : of many episodes.
    """

    __slots__ = ()


@with_metrics(WORLD_METRICS)
class WorldMetrics(_One, MeasuredWorld[float, int]):
    """How all fared in a world; made by `evaluate_world`.

    Attributes
    ----------
    {metrics}
    """

    __slots__ = ()
    _metrics = WORLD_METRICS


@with_metrics(METRICS, ", shape (n,)")
class MetricTable(_Scores, Measured[Array, npt.NDArray[np.int64], npt.NDArray[np.bool_]]):
    """How a robot fared in n episodes, one a row; made by `evaluate_many`.

    Attributes
    ----------
    {metrics}

    See Also
    --------
    EpisodeMetrics : of one episode.
    """

    __slots__ = ()

    def __len__(self) -> int:
        """Return the number of episodes."""
        return len(self._values["arrived"])

    def __getitem__(self, index: int) -> EpisodeMetrics:
        """Return the metrics of one episode, with the warnings of the table."""
        return EpisodeMetrics({name: values[index].item() for name, values in self._values.items()}, self.warnings)

    @property
    def success_share(self) -> Share:
        """Share of the episodes that arrived without a contact, with its 95 % Wilson interval."""
        return wilson(int(self.success.sum()), len(self))


@telling()
def evaluate(
    run: Episode | Trajectory | Recorded | npt.ArrayLike, people: npt.ArrayLike | None = None, **options: Any
) -> EpisodeMetrics:
    """Return the social metrics of a run, a recording, or positions of any origin.

    Velocities, accelerations and jerks are forward differences of the positions. The end is the first
    instant within the tolerance of the goal, else the last one; what concerns the robot counts up to it. People who are
    not seen for a while may be near: what that leaves open is NaN, and `success` is false where a contact was possible,
    with a warning ``not_scored``; the formula stands at `Episode`. Jumps (``teleport``), exchanged ids
    (``identity_switch``) and noise (``noisy_positions``) of measured positions are warnings, too.

    Parameters
    ----------
    run : Episode, Trajectory, Recording, or array_like, shape (T + 1, 2)
        What is scored; an array holds positions of the robot at equal instants, in m.
    people : array_like, shape (T + 1, n, 2), or None
        Positions of the people beside an array, NaN while one is absent.
    **options
        Fields of `Episode`: ``step``, ``goal``, ``robot_radius``, ...; of a recording ``robot``, too, see
        `Episode.from_recording`. A run takes them from its scenario unless given; an episode has them.

    Returns
    -------
    EpisodeMetrics
        A value for each of `METRICS`.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range, or arrays are of different lengths.
    ShapeError
        If an array has another number of axes.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> path = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]]
    >>> found = nav.metrics.evaluate(path, step=0.5, goal=(1.0, 0.0), robot_radius=0.3)
    >>> found.arrived, found.arrival_time, found.mean_speed
    (True, 1.0, 1.0)
    """
    episode = _episode(run, people, options)
    found, _ = _hrsafety.crowd_metrics([episode._native], 1, None)
    values = {name: column[0].item() for name, column in found.items()}
    doubts = doubts_between(episode, *(values[name] for name in ENDS))
    numbers_of = (*implausible_numbers(episode, values["max_speed"]), *of_values(episode, values))
    told = (*episode.warnings, *numbers_of, *of_tracks(episode), *doubts)
    changed, unscored_ones = unscored(episode, values)
    return EpisodeMetrics(values | changed, (*told, *unscored_ones))


def _episode(run: Any, people: npt.ArrayLike | None, options: dict[str, Any]) -> Episode:
    beside: dict[str, Any] = {} if people is None else {"people": people}
    if isinstance(run, (Episode, Trajectory)) or hasattr(run, "time_s"):
        if beside:
            raise InvalidParameterError("people", "be None beside a run that has people", people)
        if isinstance(run, Episode):
            if options:
                name = next(iter(options))
                raise InvalidParameterError(name, "be left out: the episode has it", options[name])
            return run
        if isinstance(run, Trajectory):
            return Episode.from_trajectory(run, **options)
        return Episode.from_recording(run, **options)
    return Episode(position=run, **beside, **options)


@telling()
def evaluate_many(
    episodes: Sequence[Episode | Trajectory],
    *,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> MetricTable:
    """Return the social metrics of many episodes, a row for each.

    Parameters
    ----------
    episodes : sequence of Episode or Trajectory
        What is scored.
    threads : int or None
        Number of threads; all cores when ``None``. The results do not depend on it.
    progress : callable or None
        Called with ``(done, total)`` about twenty times a second.

    Returns
    -------
    MetricTable
        Rows in the order of the episodes.

    Raises
    ------
    InvalidParameterError
        If one of them is no episode or run, or threads is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> paths = [speed * np.linspace([0.0, 0.0], [6.0, 0.0], 13) for speed in (0.5, 1.0)]
    >>> rules = {"step": 0.5, "goal": (6.0, 0.0), "robot_radius": 0.3}
    >>> table = nav.metrics.evaluate_many([nav.metrics.Episode(position=path, **rules) for path in paths])
    >>> table.arrived.tolist(), table.mean_speed.tolist()
    ([False, True], [0.5, 1.0])
    """
    given = sequence("episodes", "be a sequence of episodes", episodes)
    scored = [_scored(index, each) for index, each in enumerate(given)]
    found, extremes = _measured(scored, threads=threads, progress=progress)
    speeds = found["max_speed"]
    doubtful = np.flatnonzero(may_be_implausible(scored, speeds, extremes)).tolist()
    doubts = {index: implausible_numbers(scored[index], float(speeds[index])) for index in doubtful}
    own = [
        (_name(index), (*each.warnings, *doubts.get(index, ()), *of_tracks(each))) for index, each in enumerate(scored)
    ]
    of_found = (
        (_name(index), of_values(scored[index], {name: values[index].item() for name, values in found.items()}))
        for index in np.flatnonzero(may_have_doubts(found)).tolist()
    )
    between = contacts_between(scored, _name, found, extremes)
    told = (*gathered((*own, *of_found), "episodes"), *gathered(between, "episodes"))
    return MetricTable(found, (*told, *gathered(_left_open(scored, found), "episodes")))


def _left_open(
    episodes: Sequence[Episode], found: Mapping[str, npt.NDArray[Any]]
) -> Iterator[tuple[str, tuple[ResultWarning, ...]]]:
    """Put NaN and false where unseen people leave metrics open, and yield the warnings that say so."""
    for index, episode in enumerate(episodes):
        if episode.unseen is not None:
            changed, told = unscored(episode, {name: values[index].item() for name, values in found.items()})
            for name, value in changed.items():
                found[name][index] = value
            yield _name(index), told


def table_of(
    episodes: Sequence[Episode],
    warnings: Iterable[ResultWarning] = (),
    *,
    names: Sequence[str] = (),
    threads: int | None,
    progress: Callable[[int, int], object] | None = None,
) -> MetricTable:
    """Return the table of `evaluate_many` with the warnings of what the episodes come from.

    With names of the episodes there are warnings of contacts between their instants, too.
    """
    found, extremes = _measured(episodes, threads=threads, progress=progress)
    between = contacts_between(episodes, names.__getitem__, found, extremes) if names else ()
    return MetricTable(found, (*warnings, *gathered(between, "episodes")))


def _measured(
    episodes: Sequence[Episode], *, threads: int | None, progress: Callable[[int, int], object] | None
) -> tuple[dict[str, npt.NDArray[Any]], dict[str, Array]]:
    """Return columns of the metrics, and of extremes of the episodes."""
    natives = [each._native for each in episodes]
    return _hrsafety.crowd_metrics(natives, thread_count(threads), callback("progress", progress))


def _name(index: int) -> str:
    return f"episodes[{index}]"


def _scored(index: int, given: object) -> Episode:
    if isinstance(given, Trajectory):
        return Episode.from_trajectory(given)
    if not isinstance(given, Episode):
        raise InvalidParameterError(_name(index), "be an Episode or Trajectory", given)
    return given


@telling()
def evaluate_world(
    people: npt.ArrayLike,
    *,
    person_goals: npt.ArrayLike,
    person_arrival_time: npt.ArrayLike = (),
    step: float,
    time_limit: float,
    robots: npt.ArrayLike = (),
    robot_radius: float | npt.ArrayLike = (),
    person_tolerance: float = 0.3,
    period: tuple[float, float] = (0.0, 0.0),
    simulated: bool = False,
) -> WorldMetrics:
    """Return the metrics of a whole world.

    Parameters
    ----------
    people : array_like, shape (T + 1, n, 2)
        Positions of the people in m; NaN while one is absent.
    person_goals : array_like, shape (n, 2)
        Goals of the people in m.
    person_arrival_time : array_like, shape (n,)
        When people arrived, in s, NaN for who did not; for people who leave and are recorded no more. Empty:
        the first instants within ``person_tolerance`` of the goals.
    step : float
        Time between two instants in s.
    time_limit : float
        What counts as arrival time of who has not arrived, in s.
    robots : array_like, shape (T + 1, m, 2)
        Positions of the robots in m.
    robot_radius : float or array_like, shape (m,)
        Radii of the robots in m.
    person_tolerance : float
        Distance to the goal that counts as arrival, in m.
    period : tuple of float
        Lengths in m after which the world repeats along x and y; 0: it does not.
    simulated : bool
        Whether the positions come from a simulation: nothing is measured, and no person is missing.

    Returns
    -------
    WorldMetrics
        A value for each of `WORLD_METRICS`, with doubts about units, jumps, exchanged ids, noise, and bodies that
        have no positions (``not_scored``).

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
    >>> walk = np.linspace([[0.0, 0.0]], [[3.0, 0.0]], 31)
    >>> found = nav.metrics.evaluate_world(walk, person_goals=[(3.0, 0.0)], step=0.1, time_limit=10.0)
    >>> round(found.mean_person_speed, 6), found.deadlocked_share
    (1.0, 0.0)
    """
    places, machines = _places("people", people), _places("robots", robots)
    goals = points("person_goals", person_goals) if not empty("person_goals", person_goals) else np.empty((0, 2))
    if len(goals) != places.shape[1]:
        raise ShapeError("person_goals", f"({places.shape[1]}, 2)", goals.shape)
    times = numbers("person_arrival_time", person_arrival_time)
    if times.size > 0 and times.shape != (places.shape[1],):
        raise ShapeError("person_arrival_time", f"({places.shape[1]},)", times.shape)
    radii = numbers("robot_radius", robot_radius)
    if not np.isfinite(radii).all():
        raise InvalidParameterError("robot_radius", "be finite", robot_radius)
    if radii.ndim == 1 and radii.shape != (machines.shape[1],):
        raise ShapeError("robot_radius", f"({machines.shape[1]},)", radii.shape)
    rules: dict[str, Any] = {"step": number("step", step), "time_limit": number("time_limit", time_limit)}
    rules |= {
        "robot_radius": np.full(machines.shape[1], float(radii)) if radii.ndim == 0 else radii,
        "period": pair("period", period),
    }
    found = _hrsafety.crowd_world_metrics(
        people=places.reshape(-1, 2),
        robots=machines.reshape(-1, 2),
        person_goals=goals,
        person_arrival_time=times if times.size > 0 else None,
        person_tolerance=number("person_tolerance", person_tolerance),
        **rules,
    )
    values = {name: values[0].item() for name, values in found.items()}
    return WorldMetrics(values, () if flag("simulated", simulated) else of_world(places, machines, **rules))


def _places(name: str, value: npt.ArrayLike) -> Array:
    """Return positions (instants, bodies, 2)."""
    array = numbers(name, value)
    if array.size == 0:
        return np.empty((0, 0, 2))
    if array.ndim != 3 or array.shape[2] != 2:
        raise ShapeError(name, "(T + 1, n, 2)", array.shape)
    return array
