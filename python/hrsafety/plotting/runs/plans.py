"""The plan of the guide in its map."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import empty, instance, pair
from hrsafety._arguments import points as checked_points
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.guide import Plan
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plotting import floor, inputs, notes, style, walls

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["guide_plan"]

MARGIN = 0.5  # around map, start and goal, in m
FINEST = 160  # points of the cost along the longer side
LEVELS = 24


@notes.picture
def guide_plan(
    map: StaticMap,
    plan: Plan,
    *,
    starts: npt.ArrayLike | Sequence[tuple[float, float]] = (),
    title: str | None = None,
) -> Figure:
    """Draw the costs of a plan in its map, and the paths and local goals from some places.

    Parameters
    ----------
    map : StaticMap
        The map that was planned in.
    plan : Plan
        The plan.
    starts : array_like, shape (n, 2)
        Places from which path and local goal are shown, in m.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If an argument is of another kind, or there is no plan from a start.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> trap = nav.maps.StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)]])
    >>> plan = nav.Guide().plan(trap, radius=0.2, start=(0, 0), goal=(5, 0))
    >>> plotting.runs.guide_plan(trap, plan, starts=[(2.6, 0.5)]).axes[0].get_xlabel()
    'x (m)'
    """
    drawn, shown = instance("map", map, StaticMap), instance("plan", plan, Plan)
    places = checked_points("starts", starts) if not empty("starts", starts) else np.empty((0, 2))
    limits = inputs.view_limits([*walls.points_of([drawn]), places, [pair("goal", shown.goal)]], margin=MARGIN)
    handles = walls.handles([drawn])
    handles.append(floor.handle("goal", marker="*", color=style.GOAL_COLOR, markersize=12, linestyle="none"))
    if len(places):
        handles.append(floor.handle("path", color=style.RUN_COLORS[0], linestyle="-", linewidth=1.8))
        handles.append(floor.handle("local goal", marker="o", color=style.RUN_COLORS[0], linestyle="none"))
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=title)
    _add_costs(axes, shown, limits)
    walls.add_maps(axes, [drawn])
    for index, place in enumerate(places):
        _add_path(axes, shown, index, place)
    axes.plot(*shown.goal, "*", markersize=13, color=style.GOAL_COLOR, markeredgecolor="white", zorder=6.0)
    return floor.finish(figure, handles)


def _add_costs(axes: Axes, plan: Plan, limits: style.Limits) -> None:
    """Shade the cost, with a scale."""
    (left, right), (low, high) = limits
    step = max(right - left, high - low) / FINEST
    x, y = np.arange(left, right + step, step), np.arange(low, high + step, step)
    places = np.stack(np.meshgrid(x, y), axis=-1)
    cost = np.ma.masked_invalid(plan.cost(places.reshape(-1, 2)).reshape(len(y), len(x)))
    shaded = axes.contourf(x, y, cost, levels=LEVELS, cmap="Blues_r", alpha=0.65, zorder=1.0)
    axes.set(xlim=limits[0], ylim=limits[1])
    figure = axes.get_figure()
    if figure is not None:
        figure.colorbar(shaded, ax=axes, label="cost to the goal (m)", shrink=0.8)


def _add_path(axes: Axes, plan: Plan, index: int, place: inputs.Array) -> None:
    path, goal = plan.path(place), plan.local_goal(place)
    if goal is None:
        raise InvalidParameterError(f"starts[{index}]", "be a place with a plan", tuple(place.tolist()))
    color = style.RUN_COLORS[0]
    floor.line(axes, path, zorder=4.0, color=color, linewidth=1.8)
    axes.plot(*goal.point, "o", color=color, markeredgecolor="white", markersize=8, zorder=4.5)
    axes.plot(*place, "o", markersize=7, markerfacecolor="white", markeredgecolor="black", zorder=5.0)
