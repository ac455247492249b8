"""Positions of people over time: who is where, and as obstacles of a scenario."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety._arguments import number, positive, with_article
from hrsafety._records import dataclass
from hrsafety.datasets.flow import Flow, flow_of
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["Recording"]

Array = npt.NDArray[np.float64]

# Without a row for longer than this, and than so many median steps, somebody is not seen; the first in s.
LONG_GAP = 2.0
GAP_RATIO = 10.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Recording:
    """Positions of people over time, one row for each person and instant.

    Parameters
    ----------
    time_s : array_like, shape (n,)
        Instants in s, not decreasing.
    person : array_like of int, shape (n,)
        Who; the instants of one person must strictly increase.
    position : array_like, shape (n, 2)
        Positions in m.

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
    person: npt.NDArray[np.int64]
    position: Array

    def __post_init__(self) -> None:
        """Check the rows and freeze the arrays."""
        time, position = _finite("time_s", self.time_s), _finite("position", self.position)
        try:
            person = np.array(self.person)
        except (TypeError, ValueError, OverflowError):
            raise InvalidParameterError("person", "hold integers", self.person) from None
        if time.ndim != 1:
            raise ShapeError("time_s", "(n,)", time.shape)
        if len(time) == 0:
            raise InvalidParameterError("time_s", "hold at least one row", Shown("an empty array"))
        if person.shape != time.shape:
            raise ShapeError("person", f"({len(time)},)", person.shape)
        if position.shape != (len(time), 2):
            raise ShapeError("position", f"({len(time)}, 2)", position.shape)
        if person.dtype.kind not in "iu":
            raise InvalidParameterError("person", "hold integers", Shown(str(person.dtype)))
        _check_order(time, person)
        for name, array in (("time_s", time), ("person", person.astype(np.int64)), ("position", position)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.time_s)

    @property
    def duration(self) -> float:
        """Time from the first to the last row in s."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about units and ids: speeds that people hardly walk at, and people who are away for long.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> millimeters = Recording(time_s=[0.0, 0.4], person=[7, 7], position=[[0, 0], [500, 0]])
        >>> millimeters.warnings[0].code
        'implausible'
        """
        order = np.lexsort((self.time_s, self.person))
        same = np.diff(self.person[order]) == 0
        steps = np.hypot(*np.diff(self.position[order], axis=0)[same].T)
        spans = np.diff(self.time_s[order])[same]
        rows = order[:-1][same]
        return (*self._speed_doubts(steps / spans, rows), *self._gaps(spans, rows))

    def _speed_doubts(self, speed: Array, rows: npt.NDArray[np.int64]) -> tuple[ResultWarning, ...]:
        """Return doubts about the speeds of the steps that begin in rows."""
        walking = speed[speed > 0.0]
        if len(walking) == 0:
            return ()
        median = float(np.median(walking))
        found = implausible({"median speed of the people": median}, {"median speed of the people": "walking_speed"})
        if found:
            return found
        fastest = int(np.argmax(speed))
        row = rows[fastest]
        name = f"speed of person {self.person[row]} after {self.time_s[row]:g} s"
        return implausible({name: float(speed[fastest])}, {name: "running_speed"})

    def _gaps(self, spans: Array, rows: npt.NDArray[np.int64]) -> tuple[ResultWarning, ...]:
        """Return a doubt about steps, which begin in rows, that take much longer than others."""
        if len(spans) == 0:
            return ()
        long = np.flatnonzero(spans > max(LONG_GAP, GAP_RATIO * float(np.median(spans))))
        if len(long) == 0:
            return ()
        worst = long[np.argmax(spans[long])]
        row = rows[worst]
        more = f" ({len(long) - 1} more gaps)" if len(long) > 1 else ""
        message = (
            f"person {self.person[row]} is not seen for {spans[worst]:g} s after {self.time_s[row]:g} s and taken to "
            f"go straight on in between{more}: give who was away, or another person, an id of its own"
        )
        return (ResultWarning("gap_in_track", "person", message),)

    def people(self) -> npt.NDArray[np.int64]:
        """Return the ids of all people, sorted."""
        return np.unique(self.person)

    def track(self, person: int) -> tuple[Array, Array]:
        """Return the recorded way of one person.

        Parameters
        ----------
        person : int
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
            If nobody has this id.
        """
        rows = self.person == person
        if not rows.any():
            raise InvalidParameterError("person", "be the id of a recorded person", person)
        return self.time_s[rows], self.position[rows]

    def present(self, start_time: float, *, duration: float) -> npt.NDArray[np.int64]:
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

    def momentary(self, start_time: float, *, duration: float) -> npt.NDArray[np.int64]:
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

    def _seen(self, start_time: float, duration: float, *, for_some_time: bool) -> npt.NDArray[np.int64]:
        start_time, duration = _checked_window(start_time, duration)
        ids, index = np.unique(self.person, return_inverse=True)
        first, last = np.full(len(ids), np.inf), np.full(len(ids), -np.inf)
        np.minimum.at(first, index, self.time_s)
        np.maximum.at(last, index, self.time_s)
        shared = np.minimum(last, start_time + duration) - np.maximum(first, start_time)
        seen: npt.NDArray[np.int64] = ids[shared > 0.0 if for_some_time else shared == 0.0]
        return seen

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
        start_time, duration = _checked_window(start_time, duration)
        people = []
        for person in self.present(start_time, duration=duration):
            time, position = self.track(int(person))
            begin = max(int(np.searchsorted(time, start_time, side="right")) - 1, 0)
            end = int(np.searchsorted(time, start_time + duration, side="left")) + 1
            people.append(nav.Human.from_path(time[begin:end] - start_time, position[begin:end], **human_fields))
        return tuple(people)

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
            If nobody moves.

        Examples
        --------
        >>> from hrsafety.datasets import Recording
        >>> walk = Recording(time_s=[0.0, 4.0], person=[7, 7], position=[[0, 1], [5, 1]])
        >>> walk.main_flow().direction
        (1.0, 0.0)
        """
        return flow_of([self.track(int(person)) for person in self.people()])


def _finite(name: str, value: npt.ArrayLike) -> Array:
    """Return a copy of ``value`` as float64, or say why not."""
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameterError(name, "be an array of numbers", Shown(with_article(type(value).__name__))) from None
    if not np.isfinite(array).all():
        raise InvalidParameterError(name, "be finite", float(array[~np.isfinite(array)][0]))
    return array


def _check_order(time: Array, person: npt.NDArray[Any]) -> None:
    backward = np.flatnonzero(np.diff(time) < 0.0)
    if len(backward):
        row = int(backward[0]) + 1
        rule = f"not be before time_s[{row - 1}] = {time[row - 1]}"
        remedy = "sort the rows by time: np.lexsort((person, time_s)) gives their order"
        raise InvalidParameterError(f"time_s[{row}]", rule, float(time[row]), remedy)
    order = np.lexsort((time, person))
    same = (np.diff(person[order]) == 0) & (np.diff(time[order]) <= 0.0)
    if same.any():
        row = int(order[int(np.flatnonzero(same)[0]) + 1])
        raise InvalidParameterError(f"person[{row}]", "have one row for each instant", Shown(f"two at {time[row]} s"))


def _checked_window(start_time: object, duration: object) -> tuple[float, float]:
    begin = number("start_time", start_time)
    if not math.isfinite(begin):
        raise InvalidParameterError("start_time", "be finite", start_time)
    return begin, positive("duration", duration)
