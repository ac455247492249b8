"""A scenario before any run, seen from above."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety.navigation.obstacles.moving import Human
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.plotting import floor, inputs, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.crowd.world import World
    from hrsafety.navigation.maps.static_map import StaticMap
    from hrsafety.navigation.obstacles.base import Obstacle
    from hrsafety.navigation.scenario import Scenario

__all__ = ["layout"]

MARGIN = 0.35  # free space around what must be in view, in m
SECOND = 1.0
SLOWEST_WITH_DIRECTION = 0.02  # m/s, below which an arrow would point anywhere


@notes.picture
def layout(scenario: Scenario | World, *, regions: bool = True, title: str | None = None) -> Figure:
    """Draw a scenario before any run: start, goal, obstacles, and how they will move.

    An arrow at a moving obstacle shows the way of one second at its initial velocity, a
    dotted line the way to its stop or its recorded path. Recorded obstacles that are absent at
    time 0 are dotted lines only. Of more than six obstacles the moving ones are shown without
    regions.

    Parameters
    ----------
    scenario : Scenario or World
        What to draw; a world of one robot as it starts.
    regions : bool
        Whether active and critical regions are drawn.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If ``scenario`` is neither, or a world has not one robot.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, scenarios
    >>> len(plotting.layout(scenarios.configuration("c4")).axes)
    1
    """
    given, scenario = scenario, inputs.checked_scenario(scenario)
    limits = _limits_of_layout(scenario, regions=regions)
    handles = _layout_handles(scenario, regions=regions)
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=title)
    walls.add_maps(axes, _maps(scenario))
    axes.plot(*zip(scenario.start, scenario.goal, strict=True), color="#B0B0B0", linewidth=1.0, zorder=1.5)
    for obstacle, look in zip(scenario.obstacles, shapes.looks(scenario.obstacles), strict=True):
        place = shapes.first_position(obstacle)
        if place is not None:
            shown = regions and _shows_regions(scenario, obstacle)
            shapes.add_obstacle(axes, obstacle, place, look.color, regions=shown)
        if isinstance(obstacle, Mobile):
            _draw_motion(axes, obstacle, look.color)
    shapes.add_robot(axes, scenario, scenario.start, style.RUN_COLORS[0], heading=scenario.heading)
    shapes.add_start_and_goal(axes, scenario)
    return floor.finish(figure, handles, runs=[given])


def _maps(scenario: Scenario) -> list[StaticMap]:
    """Return the walls of a scenario."""
    return [] if scenario.walls is None else [scenario.walls]


def _shows_regions(scenario: Scenario, obstacle: Obstacle) -> bool:
    """Return whether the regions of an obstacle are drawn."""
    return len(scenario.obstacles) <= shapes.MOST_COLORS or not shapes.is_mobile(obstacle)


def _way(obstacle: Mobile) -> list[tuple[float, float]]:
    """Return where a moving obstacle is known to pass: its recording, or start and stop."""
    if obstacle.path is not None:
        return list(obstacle.path[1])
    start = obstacle.start if isinstance(obstacle, Human) else obstacle.center
    return [start] if obstacle.stop is None else [start, obstacle.stop]


def _arrow(obstacle: Mobile) -> list[tuple[float, float]]:
    """Return both ends of the way of the first second, or nothing for an obstacle that is absent or at rest."""
    start, velocity = shapes.first_position(obstacle), obstacle.velocity
    if start is None:
        return []
    if obstacle.path is not None and len(obstacle.path[0]) > 1:
        time, places = (np.asarray(values) for values in obstacle.path)
        first = min(max(int(np.searchsorted(time, 0.0, side="right")) - 1, 0), len(time) - 2)
        velocity = tuple((places[first + 1] - places[first]) / (time[first + 1] - time[first]))
    if math.hypot(*velocity) <= SLOWEST_WITH_DIRECTION:
        return []
    return [start, (start[0] + velocity[0] * SECOND, start[1] + velocity[1] * SECOND)]


def _limits_of_layout(scenario: Scenario, *, regions: bool) -> style.Limits:
    """Return limits that hold start, goal, obstacles and, of few obstacles, their ways."""
    points: list[Any] = [scenario.start, scenario.goal, *walls.points_of(_maps(scenario))]
    if scenario.robot.footprint is not None:
        points.append(shapes.robot(scenario.robot, scenario.start, scenario.heading).get_extents().get_points())
    for obstacle in scenario.obstacles:
        place = shapes.first_position(obstacle)
        active, critical = shapes.region_radii(obstacle)
        radius = critical if shapes.is_mobile(obstacle) else active
        if place is not None:
            points.append(shapes.body(obstacle, place).get_extents().get_points())
            if regions and _shows_regions(scenario, obstacle):
                points.append(shapes.region(obstacle, place, radius).get_extents().get_points())
        if isinstance(obstacle, Mobile):
            points.append(_arrow(obstacle))
            if len(scenario.obstacles) <= shapes.MOST_COLORS:
                points.append(_way(obstacle))
    return inputs.view_limits(points, margin=MARGIN)


def _draw_motion(axes: Axes, obstacle: Mobile, color: str) -> None:
    """Draw the way of one second as an arrow, and the known way as a dotted line."""
    from matplotlib.patches import FancyArrowPatch

    way = np.asarray(_way(obstacle), dtype=np.float64)
    floor.line(axes, way, zorder=2.5, linestyle=":", color=color, linewidth=1.6)
    if obstacle.stop is not None:
        axes.plot(*obstacle.stop, "|", markersize=12, markeredgewidth=2.0, color=color, zorder=3.2)
    ends = _arrow(obstacle)
    if ends:
        look: style.Properties = {"arrowstyle": "-|>", "mutation_scale": 14, "linewidth": 1.5}
        axes.add_patch(FancyArrowPatch(*ends, color="black", shrinkA=0, shrinkB=0, zorder=4.5, **look))


def _layout_handles(scenario: Scenario, *, regions: bool) -> list[Artist]:
    """Return the legend of a layout."""
    from matplotlib.lines import Line2D

    robot: style.Properties = {"marker": "o", "markersize": 10, "color": style.RUN_COLORS[0], "linestyle": "none"}
    handles: list[Artist] = [Line2D([], [], label="robot", **robot), *shapes.start_and_goal_handles()]
    shown = regions and any(_shows_regions(scenario, obstacle) for obstacle in scenario.obstacles)
    handles += walls.handles(_maps(scenario)) + shapes.obstacle_handles(scenario.obstacles, regions=shown)
    if any(shapes.is_mobile(obstacle) for obstacle in scenario.obstacles):
        arrow: style.Properties = {"marker": ">", "color": "black", "markersize": 7, "markevery": [1]}
        handles.append(Line2D([0, 1], [0, 0], label="way of 1 s", **arrow))
    if any(shapes.is_mobile(each) and each.stop is not None for each in scenario.obstacles):  # type: ignore[attr-defined]  # movers have one
        bar: style.Properties = {"marker": "|", "markersize": 12, "markeredgewidth": 2.0, "color": style.NEUTRAL}
        handles.append(Line2D([], [], linestyle=":", label="way, stop", **bar))
    return handles
