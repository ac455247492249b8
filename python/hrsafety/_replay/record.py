"""Data of a player: tracks, verdicts of a shield, contacts, times that were not judged."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import ResultWarning

__all__ = ["VERDICTS", "Decisions", "Event", "PlayedCells", "PlayedLidar", "PlayedRobot", "Replay", "UnjudgedTime"]

Array = npt.NDArray[np.float64]

UNKNOWN, FREE, OCCUPIED, PERSON_POSSIBLE = range(4)
"""Kinds of cells."""

VERDICTS = ("not recorded", "kept", "changed", "taken over", "braking")
"""Words for what the parts around a law did, in the order in which the later one counts for a frame."""


class Event(NamedTuple):
    """Something that happened at an instant.

    Parameters
    ----------
    time : float
        When, in s.
    kind : {"contact", "fault", "arrival", "note"}
        What; ``"fault"`` is a contact by the fault of the robot.
    words : str
        What to say.
    place : (float, float) or None
        Where, in m.
    """

    time: float
    kind: str
    words: str
    place: tuple[float, float] | None = None


class UnjudgedTime(NamedTuple):
    """A time over which nothing was judged.

    Parameters
    ----------
    begin, end : float
        In s.
    reason : str
        Why.
    """

    begin: float
    end: float
    reason: str


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Decisions:
    """Decisions of the parts around a law, d of them.

    Parameters
    ----------
    time : ndarray, shape (d,)
        When, in s, rising.
    verdict : sequence of str
        Of `VERDICTS`.
    margin : ndarray, shape (d,)
        Least distance to everywhere that people can be over the plan, in m; NaN without.
    plan : sequence of ndarray, shape (k, 2)
        Places of the verified plan, in m.
    path : sequence of ndarray, shape (p, 2)
        Path of the guide, in m.
    reach : ndarray, shape (d, m)
        How far each person can have come at the end of the plan, in m.
    way : sequence of ndarray, shape (w, 2)
        Where foresight expects the robot, in m.
    expected : sequence of ndarray, shape (p, 2)
        Where it expects people, one after the other, in m.
    """

    time: Array
    verdict: Sequence[str]
    margin: Array
    plan: Sequence[Array] = ()
    path: Sequence[Array] = ()
    reach: Array | None = None
    way: Sequence[Array] = ()
    expected: Sequence[Array] = ()


class PlayedLidar(NamedTuple):
    """A lidar in the middle of a robot.

    Parameters
    ----------
    start_angle, end_angle : float
        Of the first and the last beam, in rad from the heading.
    range_max : float
        Range in m from which on a beam has hit nothing.
    ranges : callable
        Returns the ranges at a row of the run in m.
    """

    start_angle: float
    end_angle: float
    range_max: float
    ranges: Callable[[int], Array]


class PlayedCells(NamedTuple):
    """Square cells that a robot keeps of its surroundings, at c instants.

    Parameters
    ----------
    time : ndarray, shape (c,)
        Instants in s, rising; cells are those of the last one.
    side : float
        Side of a cell in m.
    low : ndarray, shape (c, 2)
        Lowest corners of the cells in m, whole cells apart.
    size : ndarray of int, shape (c, 2)
        Rows along y, and columns; beyond them nothing is known.
    kinds : callable
        Returns the cells of an instant by its index: 0 unknown, 1 free, 2 occupied; 3 where a person may be.
    belief : bool
        Whether they are the belief of people whom the robot does not see, in place of a map of its scans.
    way : sequence of ndarray, shape (p, 2)
        Way that the law plans in them, in m.
    """

    time: Array
    side: float
    low: Array
    size: npt.NDArray[np.int64]
    kinds: Callable[[int], npt.NDArray[np.uint8]]
    belief: bool = False
    way: Sequence[Array] = ()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlayedRobot:
    """A robot over n instants.

    Parameters
    ----------
    name : str
        What it is called.
    position : ndarray, shape (n, 2)
        In m; NaN while unknown.
    radius : float
        Of the disc that it is, or that holds its footprint, in m.
    heading : ndarray of shape (n,), or None
        In rad; ``None`` for a robot whose heading tells nothing.
    footprint : sequence of (float, float)
        Corners in m about its position at heading 0; none for a disc.
    speed : ndarray of shape (n,), or None
        In m/s.
    clearance : ndarray of shape (n,), or None
        Distance of its surface to the nearest other one, in m; infinite without any, negative in a contact.
    goal : (float, float) or None
        In m.
    tolerance : float
        How near to the goal it has arrived, in m.
    decisions : Decisions or None
        What the parts around its law decided.
    scan : PlayedLidar or None
        Its lidar.
    cells : PlayedCells or None
        Cells of what it knows.
    """

    name: str
    position: Array
    radius: float
    heading: Array | None = None
    footprint: Sequence[tuple[float, float]] = ()
    speed: Array | None = None
    clearance: Array | None = None
    goal: tuple[float, float] | None = None
    tolerance: float = 0.0
    decisions: Decisions | None = None
    scan: PlayedLidar | None = None
    cells: PlayedCells | None = None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Replay:
    """Recorded motion of robots and m people over n instants.

    Parameters
    ----------
    title : str
        Above the player.
    time : ndarray, shape (n,)
        Instants in s, rising.
    robots : sequence of PlayedRobot
        The robots.
    people : ndarray of shape (n, m, 2), or None
        Positions in m, NaN while absent; ``None`` without people.
    radius : ndarray of shape (m,), or None
        Of the people in m.
    names : sequence of str
        What they are called; their numbers if empty.
    kinds : sequence of str
        What they are, for legend and color; people if empty.
    boxes : mapping of int to (float, float, float)
        Length, width and heading, in m and rad, of those of the people who are rectangles.
    maps : sequence of StaticMap
        What stands, with unobserved floor.
    events : sequence of Event
        What happened.
    not_judged : sequence of UnjudgedTime
        What was not judged, and why.
    facts : sequence of (str, str)
        What else to say, by name.
    warnings : sequence of ResultWarning
        Doubts about all of it.

    Raises
    ------
    InvalidParameterError
        If there is no instant, or time does not rise.
    ShapeError
        If an array has another number of instants or people.
    """

    title: str
    time: Array
    robots: Sequence[PlayedRobot] = ()
    people: Array | None = None
    radius: Array | None = None
    names: Sequence[str] = ()
    kinds: Sequence[str] = ()
    boxes: Mapping[int, tuple[float, float, float]] | None = None
    maps: Sequence[Any] = ()
    events: Sequence[Event] = ()
    not_judged: Sequence[UnjudgedTime] = ()
    facts: Sequence[tuple[str, str]] = ()
    warnings: Sequence[ResultWarning] = ()

    def _replay(self) -> Replay:
        """Return itself."""
        return self

    def __post_init__(self) -> None:
        """Check that there is something to play, and that it fits together."""
        count = len(self.time)
        if count == 0:
            remedy = "a player needs at least one instant at which somebody is somewhere"
            raise InvalidParameterError("run", "have frames to play", Shown("none"), remedy)
        if not np.isfinite(self.time).all() or (np.diff(self.time) < 0.0).any():
            raise InvalidParameterError("run", "have finite, rising instants", Shown("others"))
        for robot in self.robots:
            if np.shape(robot.position) != (count, 2):
                raise ShapeError(f"position of {robot.name}", f"({count}, 2)", np.shape(robot.position))
        if self.people is not None and (np.ndim(self.people) != 3 or len(self.people) != count):
            raise ShapeError("people", f"({count}, m, 2)", np.shape(self.people))
