"""The guide: a plan through a static map, local goals for a law, and when they are taken over."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, Parameters, instance, number, pair, sequence
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.parts import checked_place, checked_points
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.maps.unknown import over_unknown
from hrsafety.plausibility import ResultWarning

__all__ = ["Guide", "LocalGoal", "Plan"]


@displayed
class LocalGoal(NamedTuple):
    """Where a law should go for now.

    Attributes
    ----------
    point : (float, float)
        The point in m: the farthest one of the path that is seen within the look-ahead.
    cost_to_go : float
        Cost from it to the goal, in m.
    is_goal : bool
        Whether it is the goal itself.
    """

    point: Annotated[Pair, "m"]
    cost_to_go: Annotated[float, "m"]
    is_goal: bool


@displayed
@dataclass(frozen=True, slots=True)
class Plan:
    """Cost-to-go of a robot in a static map, for one goal; it has no local minimum.

    Made by `Guide.plan`. Pickled as guide and map: the plan is made again where it is loaded, with the same bits.

    Parameters
    ----------
    goal : (float, float)
        The goal in m.
    radius : float
        Radius of the robot in m.
    warnings : tuple of ResultWarning
        Doubts of the map, and how far the path from the start leads over unknown ground.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> wall = nav.maps.StaticMap.from_polylines([[(2, -1), (2, 1)]])
    >>> plan = nav.Guide().plan(wall, radius=0.2, start=(0.0, 0.0), goal=(4.0, 0.0))
    >>> bool(plan.cost((0.0, 0.0)) > 4.0), plan.local_goal((3.0, 0.0)).is_goal
    (True, True)
    """

    goal: Annotated[Pair, "m"]
    radius: Annotated[float, "m"]
    _native: _hrsafety.Plan = field(repr=False, compare=False)
    _made_from: tuple[Guide, StaticMap, Pair] = field(repr=False, compare=False)
    warnings: tuple[ResultWarning, ...] = field(default=(), compare=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what makes the plan again: its costs may fill many megabytes."""
        guide, map, start = self._made_from
        return _planned, (guide, map, self.radius, start, self.goal)

    def cost(self, point: npt.ArrayLike) -> Any:
        """Return the cost from points to the goal.

        Parameters
        ----------
        point : array_like, shape (2,) or (n, 2)
            One point or several, in m.

        Returns
        -------
        float or ndarray, shape (n,)
            Costs in m, the length of the path where the map is far; NaN without a plan there.

        Raises
        ------
        InvalidParameterError
            If the points are no points.
        """
        found = self._native.cost(checked_points(point))
        return float(found[0]) if np.ndim(point) == 1 else found

    def local_goal(self, position: npt.ArrayLike) -> LocalGoal | None:
        """Return where a law should go from a position.

        Parameters
        ----------
        position : array_like, shape (2,)
            The position in m.

        Returns
        -------
        LocalGoal or None
            ``None`` without a plan there.

        Raises
        ------
        InvalidParameterError
            If the position is no point.
        """
        found = self._native.local_goal(checked_place("position", position))
        if found is None:
            return None
        (x, y), cost_to_go, is_goal = found
        return LocalGoal((x, y), cost_to_go, is_goal)

    def path(self, start: npt.ArrayLike) -> Array:
        """Return the whole path to the goal.

        Parameters
        ----------
        start : array_like, shape (2,)
            Where it starts, in m.

        Returns
        -------
        ndarray, shape (n, 2)
            Its points in m from the start to the goal; none without a plan there.

        Raises
        ------
        InvalidParameterError
            If the start is no point.
        """
        return self._native.path(checked_place("start", start))


@dataclass(frozen=True, kw_only=True, slots=True)
class Guide(Parameters):
    """Plans through a static map, so that a law does not get stuck in it.

    Dijkstra's algorithm on a grid of nodes with 16 neighbors gives the cost to the goal everywhere, once for a map
    and a goal. A link costs its length times ``1 + 2 max(0, 1 - (c - rho)/0.3)^2``, ``c`` the distance of its
    ends from the map. A path with room of the radius of the robot, the margin and 0.71 spacings is always found.
    Without a map the law has the goal itself, and does what it does alone. Only where the robot has come nearer to it
    by less than 0.1 m in 2 s, and a person or an obstacle stands on the straight way within the look-ahead, the guide
    leads around, until the whole straight way is free.

    Parameters
    ----------
    spacing : float
        Spacing of the nodes in m.
    margin : float
        Room that the plan keeps between robot and map, in m.
    look_ahead : float
        How far along the path the local goal of the law may lie, in m.
    box : ((float, float), (float, float)) or None
        Lower and upper corner of the nodes in m. ``None``: map, start and goal, and the radius of the robot and
        1 m around; in a map outside of whose images nothing is known the images, and no way leads out of them.
    takeover_progress : float or None
        Fall of the cost in m that counts as progress. ``None``: 0.3 m in a map, and without a map 0.6 s times the
        largest speed of the law.
    takeover_window : float or None
        Time without progress in s after which the robot goes to the local goal itself, until the next progress.
        ``None``: 1 s in a map, 0.7 s without.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> trap = nav.maps.StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)]])
    >>> guide = nav.Guide(margin=0.05, box=((-2, -4), (6, 4)))
    >>> round(guide.plan(trap, radius=0.2, start=(0, 0), goal=(5, 0)).cost((0, 0)), 4)
    7.2675
    """

    spacing: float = 0.05
    margin: float = 0.005
    look_ahead: float = 3.0
    box: tuple[Pair, Pair] | None = None
    takeover_progress: float | None = None
    takeover_window: float | None = None
    _native: _hrsafety.Guide = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        given = self._as_numbers("spacing", "margin", "look_ahead")
        if self.box is not None:
            corners = sequence("box", "be a pair of corners (x, y)", self.box)
            if len(corners) != 2:
                raise InvalidParameterError("box", "be a pair of corners (x, y)", self.box)
            lower, upper = pair("lower corner of box", corners[0]), pair("upper corner of box", corners[1])
            self._set(box=(lower, upper))
        told = [name for name in ("takeover_progress", "takeover_window") if getattr(self, name) is not None]
        self._as_numbers(*told)
        _hrsafety.check_takeover(self.takeover_progress, self.takeover_window)
        self._set(_native=_hrsafety.Guide(bounds=self.box, **given))

    def plan(self, map: StaticMap, *, radius: float, start: npt.ArrayLike, goal: npt.ArrayLike) -> Plan:
        """Return the plan of a robot in a map.

        Parameters
        ----------
        map : StaticMap
            What stands.
        radius : float
            Radius of the robot in m.
        start, goal : array_like, shape (2,)
            In m.

        Returns
        -------
        Plan
            Costs and local goals everywhere in the box.

        Raises
        ------
        InvalidParameterError
            If start or goal lie outside of the box, or of the image of the map without one, or nearer to the map than
            the radius, there is no way between them, or the box has too many nodes.
        """
        native = instance("map", map, StaticMap)._native
        size = number("radius", radius)
        ends = checked_place("start", start), checked_place("goal", goal)
        plan = self._native.plan(native, size, *ends)
        doubts = (*map.warnings, *over_unknown(map, plan.path(ends[0]), "the plan"))
        return Plan(ends[1], size, plan, (self, map, ends[0]), doubts)


def _planned(guide: Guide, map: StaticMap, radius: float, start: Pair, goal: Pair) -> Plan:
    return guide.plan(map, radius=radius, start=start, goal=goal)
