"""Twists that a law chooses from one place, and the base of laws that do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Annotated, Any, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import (
    Array,
    checked_seed,
    count,
    finite_pair,
    flag,
    instance,
    numbers,
    positive,
    sequence,
    word,
)
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.laws.declared import Law
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["LocalPlanner", "Prediction", "TwistChoice"]

Prediction = Literal["static", "constant_velocity"]

MOST_DRAWS = 2**16
"""Most samples of a kind; the core bounds each more closely."""


@displayed
class TwistChoice(NamedTuple):
    """Twist that a law chose.

    Attributes
    ----------
    forward, left : float
        Velocity in the frame of the robot, in m/s.
    turn_rate : float
        In rad/s.
    score : float
        Score of the best twist that was tried; NaN where none was allowed, and for laws without.
    mode : str
        ``"track"``, ``"rotate"`` for a turn in place, or ``"blocked"`` where nothing that it may command is free: the
        twist is then 0.
    plan : ndarray of shape (n, 3)
        Twists (forward, left, turn_rate) that `PathIntegral` plans, the first one included; else no rows.
    """

    forward: Annotated[float, "m/s"]
    left: Annotated[float, "m/s"]
    turn_rate: Annotated[float, "rad/s"]
    score: float
    mode: str
    plan: Array


class LocalPlanner(Law):
    """Base of the laws that choose twists."""

    __slots__ = ()

    def __post_init__(self) -> None:
        """Check the values; the core checks their rules."""
        names = set(self.GAIN_NAMES)
        others: dict[str, object] = {}
        for each in fields(self):  # type: ignore[arg-type]  # every law is a dataclass
            name, default = each.name, each.default
            if name in names or not each.init:
                continue
            value = getattr(self, name)
            if isinstance(default, bool):
                others[name] = flag(name, value)
            elif isinstance(default, int):
                others[name] = count(name, value, most=MOST_DRAWS)
            elif isinstance(default, str):
                others[name] = word(name, value, get_args(Prediction))
            else:
                others |= self._as_numbers(name)
        self._set(**others)
        self._make(**others)

    def choose(
        self,
        *,
        pose: npt.ArrayLike,
        goal: npt.ArrayLike,
        twist: npt.ArrayLike = (0.0, 0.0, 0.0),
        path: npt.ArrayLike | None = None,
        people: npt.ArrayLike = (),
        walls: Sequence[npt.ArrayLike] = (),
        map: StaticMap | None = None,
        radius: float = 0.25,
        max_speed: float = 1.0,
        control_period: float = 0.1,
        plan: npt.ArrayLike | None = None,
        call: int = 0,
        seed: int = 0,
    ) -> TwistChoice:
        """Return the twist that the law commands from one place: for a robot, or to compare with other programs.

        Parameters
        ----------
        pose : array_like of shape (3,)
            Position in m and heading in rad.
        goal : array_like of shape (2,)
            Goal in m.
        twist : array_like of shape (3,)
            Present velocity forward and to the left in m/s, turn rate in rad/s.
        path : array_like of shape (n, 2) or None
            Way to the goal in m; ``None``: straight.
        people : array_like of shape (n, 5)
            Rows (x, y, vx, vy, radius) in m and m/s, as measured.
        walls : sequence of array_like of shape (n, 2)
            Polylines in m.
        map : StaticMap or None
            Map beside them.
        radius, max_speed, control_period : float
            Of the robot, in m, m/s and s.
        plan : array_like of shape (n, 3) or None
            Plan from which `PathIntegral` starts; ``None``: zeros.
        call, seed : int
            Number of the call and seed, from which `PathIntegral` draws.

        Returns
        -------
        TwistChoice
            The twist.

        Raises
        ------
        InvalidParameterError
            If a number is not finite or out of range, or the path is empty.
        ShapeError
            If an array has another shape.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> person = (2.0, 0.2, -1.0, 0.0, 0.25)
        >>> choice = nav.RegulatedPurePursuit().choose(pose=(0, 0, 0), goal=(5, 0), people=[person])
        >>> choice.forward, choice.mode
        (0.5, 'track')
        """
        given = {name: _row(name, value, 3) for name, value in (("pose", pose), ("twist", twist))}
        way = [] if path is None else _rows("path", path, 2)
        if path is not None and not way:
            raise InvalidParameterError("path", "be one point or more", path)
        around = _rows("people", people, 5)
        for index, (*_, size) in enumerate(around):
            positive(f"people[{index}] radius", size)
        lines = [
            _rows(f"walls[{index}]", wall, 2) for index, wall in enumerate(sequence("walls", "be polylines", walls))
        ]
        if map is not None:
            instance("map", map, StaticMap)
        found = _hrsafety.choose_twist(
            self._native,
            **given,
            goal=finite_pair("goal", goal),
            path=way,
            people=around,
            walls=lines,
            map=None if map is None else map._native,
            radius=positive("radius", radius),
            max_speed=positive("max_speed", max_speed),
            control_period=positive("control_period", control_period),
            plan=[] if plan is None else _rows("plan", plan, 3),
            call=count("call", call, least=0, most=2**32 - 1),
            seed=checked_seed("seed", seed),
        )
        forward, left, turn_rate = (float(value) for value in found["twist"])
        return TwistChoice(forward, left, turn_rate, found["score"], found["mode"], found["plan"])


def _row(name: str, value: npt.ArrayLike, size: int) -> list[float]:
    array = numbers(name, value)
    if array.shape != (size,):
        raise ShapeError(name, f"({size},)", array.shape)
    return _finite(name, array)


def _rows(name: str, value: npt.ArrayLike, size: int) -> list[list[float]]:
    array = numbers(name, value)
    if array.size == 0:
        return []
    if array.ndim != 2 or array.shape[1] != size:
        raise ShapeError(name, f"(n, {size})", array.shape)
    return _finite(name, array)


def _finite(name: str, array: Array) -> list[Any]:
    if not np.isfinite(array).all():
        raise InvalidParameterError(name, "be finite numbers", array)
    rows: list[Any] = array.tolist()
    return rows
