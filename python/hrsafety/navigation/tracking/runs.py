"""Runs of a two-wheel robot with ideal wheels that follows a reference."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, callback, number, numbers, pair, sequence, vector
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.batch import check_threads
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, two_wheels
from hrsafety.navigation.robots.tracking_laws import ExponentialTracking, FullSpeedTracking, NonlinearTracking, Tracking
from hrsafety.navigation.tracking.references import CircleReference, LineReference, PathReference, Reference
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.tables import Columns, Table

__all__ = ["TrackingSummary", "track", "track_batch"]

LEVELS = (0.1, 0.01, 0.001)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class TrackingSummary(Table):
    """Summary of many runs, one row for each start; k levels.

    Attributes
    ----------
    levels : ndarray, shape (k,)
        Errors in m.
    final_error, max_error : ndarray, shape (n,)
        Distance between robot and reference at the end, and the largest, in m.
    final_heading : ndarray, shape (n,)
        Heading at the end in rad; whole turns count.
    path_length : ndarray, shape (n,)
        Length of the path in m.
    settling_time : ndarray, shape (n, k)
        First instant from which the error stays below each level, in s; NaN if it does not.
    """

    levels: Annotated[Array, "m"]
    final_error: Annotated[Array, "m"]
    max_error: Annotated[Array, "m"]
    final_heading: Annotated[Array, "rad"]
    path_length: Annotated[Array, "m"]
    settling_time: Annotated[Array, "s"]

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.final_error)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each start.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; settling times by their level in m.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> line = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(0.5, 0.0))
        >>> list(nav.tracking.track_batch(line, starts=[(0.0, 0.5, 0.0)], levels=[0.1]).columns())[-1]
        'settling_time_0.1_s'
        """
        found = {"final_error_m": self.final_error, "max_error_m": self.max_error}
        found |= {"final_heading_rad": self.final_heading, "path_length_m": self.path_length}
        times = zip(self.levels.tolist(), self.settling_time.T, strict=True)
        return found | {f"settling_time_{level:g}_s": column for level, column in times}


def track(
    reference: Reference,
    tracking: Tracking | None = None,
    *,
    position: npt.ArrayLike = (0.0, 0.0),
    heading: float = 0.0,
    speed: float = 0.0,
    turn_rate: float = 0.0,
    robot: DifferentialDriveRobot | None = None,
    control_period: float = 0.06,
    step: float = 0.01,
    duration: float = 30.0,
    goal: npt.ArrayLike | None = None,
) -> Trajectory:
    """Let a two-wheel robot with ideal wheels follow a reference.

    The law commands speed and turn rate every control period. The robot reaches them as fast as
    its limits allow, abs(v) <= V, abs(omega) <= 2 V / l, both with limited rates of change, and
    moves on exact arcs, one for each step.

    Parameters
    ----------
    reference : LineReference, CircleReference or PathReference
        What is followed. Whether the robot can catch up is not checked: leave it 10 % of its
        speed.
    tracking : FullSpeedTracking, NonlinearTracking, ExponentialTracking or None
        The law; `FullSpeedTracking` when ``None``.
    position : array_like, shape (2,)
        Where the robot starts, in m.
    heading : float
        Heading at the start in rad.
    speed, turn_rate : float
        Motion at the start in m/s and rad/s.
    robot : DifferentialDriveRobot or None
        Its limits; the robot of the source when ``None``.
    control_period : float
        Time between two commands in s.
    step : float
        Motion step in s; must divide the control period.
    duration : float
        In s; a whole number of control periods.
    goal : array_like of shape (2,) or None
        Goal of `ExponentialTracking` in m; must be given for it.

    Returns
    -------
    Trajectory
        One row at the start and one for each step, with the reference and what was commanded.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.
    ShapeError
        If a point is not two numbers.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> circle = nav.tracking.CircleReference(center=(0.0, 0.0), radius=1.0, speed=0.5)
    >>> run = nav.tracking.track(circle, position=(0.0, 0.0), heading=3.0)
    >>> bool(run.error[-1] < 1e-6)
    True
    """
    path = _reference("reference", reference)
    law = _tracking(tracking)
    body = two_wheels(robot)
    place = pair("position", position)
    turned, driven, turning = number("heading", heading), number("speed", speed), number("turn_rate", turn_rate)
    history = _hrsafety.track(
        path._native,
        law._native,
        body._native,
        start=(*place, turned, driven, turning),
        control_period=number("control_period", control_period),
        step=number("step", step),
        duration=number("duration", duration),
        goal=_goal(law, goal),
    )
    return _trajectory(path, law, dict(history))


def track_batch(
    reference: Reference | Sequence[Reference],
    tracking: Tracking | None = None,
    *,
    starts: npt.ArrayLike,
    levels: npt.ArrayLike = LEVELS,
    robot: DifferentialDriveRobot | None = None,
    control_period: float = 0.06,
    step: float = 0.01,
    duration: float = 30.0,
    goal: npt.ArrayLike | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> TrackingSummary:
    """Follow a reference from many starts: one call, all cores, the same bits for any number of them.

    Parameters
    ----------
    reference : reference or sequence of them
        One for all starts, or one for each.
    tracking : FullSpeedTracking, NonlinearTracking, ExponentialTracking or None
        The law; `FullSpeedTracking` when ``None``.
    starts : array_like, shape (n, 3) or (n, 5)
        x, y in m and heading in rad of each start, then, if given, its speed in m/s and turn rate
        in rad/s.
    levels : array_like, shape (k,)
        Errors in m whose settling times are wanted.
    robot, control_period, step, duration, goal
        As for `track`.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.

    Returns
    -------
    TrackingSummary
        One row for each start.

    Raises
    ------
    InvalidParameterError
        If a number is out of range or the numbers of references and starts differ.
    ShapeError
        If starts has neither three nor five columns, or levels is not a vector.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> starts = np.random.default_rng(1).uniform((-2, -2, -np.pi), (2, 2, np.pi), (100, 3))
    >>> line = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(0.5, 0.0))
    >>> table = nav.tracking.track_batch(line, starts=starts)
    >>> len(table), bool(table.final_error.max() < 1e-6)
    (100, True)
    """
    law = _tracking(tracking)
    body = two_wheels(robot)
    if isinstance(reference, (LineReference, CircleReference, PathReference)):
        references = [reference]
    else:
        given = sequence("reference", "be a reference or a sequence of them", reference)
        references = [_reference(f"reference[{index}]", path) for index, path in enumerate(given)]
    check_threads(threads)
    heights = vector("levels", levels)
    columns = _hrsafety.track_batch(
        [path._native for path in references],
        law._native,
        body._native,
        starts=_starts(starts),
        levels=heights.tolist(),
        control_period=number("control_period", control_period),
        step=number("step", step),
        duration=number("duration", duration),
        goal=_goal(law, goal),
        threads=threads,
        progress=callback("progress", progress),
    )
    return TrackingSummary(levels=heights, **columns)


def _trajectory(path: Reference, law: Tracking, history: dict[str, Any]) -> Trajectory:
    """Return the record of a run, in which there are no obstacles."""
    heading, rows = history["heading"], len(history["time"])
    # Column by column, and in place: a product along rows of two takes three times as long.
    speed, velocity = history["speed"], np.empty((rows, 2))
    for function, column in ((np.cos, velocity[:, 0]), (np.sin, velocity[:, 1])):
        function(heading, out=column)
        column *= speed
    steps = history["time"][1:] - history["time"][:-1]
    steps *= speed[1:]
    nothing = np.zeros(0)
    return Trajectory(
        reference=path,
        tracking=law,
        velocity=velocity,
        obstacle_position=np.zeros((rows, 0, 2)),
        distance=np.zeros((rows, 0)),
        min_distance=nothing,
        min_clearance=nothing,
        contact_time=nothing,
        contact_speed=nothing,
        contact_toward=np.zeros(0, dtype=bool),
        contact_at_fault=np.zeros(0, dtype=bool),
        contact_apart=np.zeros(0, dtype=bool),
        path_length=float(np.abs(steps, out=steps).sum()),
        **history,
    )


def _reference(name: str, value: object) -> Reference:
    """Return ``value`` if it can be followed."""
    if not isinstance(value, (LineReference, CircleReference, PathReference)):
        raise InvalidParameterError(name, "be a LineReference, CircleReference or PathReference", value)
    return value


@cache
def _default_tracking() -> FullSpeedTracking:
    """Return the default law, which is made once."""
    return FullSpeedTracking()


def _tracking(value: object) -> Tracking:
    """Return ``value`` if it is a tracking law, the default for ``None``."""
    if value is None:
        return _default_tracking()
    if not isinstance(value, (FullSpeedTracking, NonlinearTracking, ExponentialTracking)):
        rule = "be a FullSpeedTracking, NonlinearTracking or ExponentialTracking"
        raise InvalidParameterError("tracking", rule, value)
    return value


def _goal(tracking: Tracking, goal: npt.ArrayLike | None) -> Pair | None:
    """Return the goal as a pair; a law that drives to it needs one."""
    if goal is None and isinstance(tracking, ExponentialTracking):
        raise InvalidParameterError("goal", "be given for ExponentialTracking", None)
    return None if goal is None else pair("goal", goal)


def _starts(starts: npt.ArrayLike) -> Array:
    """Return the starts with five columns."""
    array = numbers("starts", starts, "be an array of numbers")
    if array.ndim != 2 or array.shape[1] not in (3, 5):
        raise ShapeError("starts", "(n, 3) or (n, 5)", array.shape)
    if not len(array):
        raise InvalidParameterError("starts", "hold at least one start", Shown("an empty array"))
    moving = np.zeros((len(array), 5))
    moving[:, : array.shape[1]] = array
    return moving
