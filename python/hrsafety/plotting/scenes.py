"""The paths of runs through a scene, seen from above."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety.plotting import inputs, shapes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.obstacles import Obstacle
    from hrsafety.navigation.simulation import Trajectory

__all__ = ["paths"]

MARGIN = 0.35  # free space around what must be in view, in m
SECOND = 1.0
SLOWEST_WITH_DIRECTION = 0.02  # m/s, below which a direction marker would point anywhere
LEGEND_COLUMNS = 4


@style.styled
def paths(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    labels: Sequence[str] | None = None,
    regions: bool = True,
    title: str | None = None,
) -> Figure:
    """Draw the paths of one or several runs through one scene.

    A marker on each path points in the direction of motion every second. Stationary obstacles
    are shown with their active and critical regions. A moving obstacle leaves a dotted path.
    If the robot entered its active region, it is shown, with its regions, where it was when
    the robot came closest, together with the robot and a line between the two; with several
    runs, once for each run and edged in the color of that run. Of more than six obstacles the
    moving ones are shown without regions, but with their number. A first contact is marked by
    a cross.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        Runs with the same goal and the same obstacles (or none).
    labels : sequence of str or None
        One name for each run; numbered when ``None``.
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
        If there is no run, the runs belong to different scenes, or the number of labels is
        wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c2"), nav.VirtualForceField())
    >>> figure = plotting.paths(run, title="A person comes the other way")
    >>> figure.axes[0].get_xlabel()
    'x (m)'
    """
    runs = inputs.checked_runs(trajectories)
    names = inputs.checked_labels(labels, len(runs), stem="robot" if len(runs) == 1 else "run")
    inputs.check_same_scene(runs)
    limits = _limits_of_runs(runs, regions=regions)
    scenario = runs[0].scenario
    handles = _path_handles(runs, names, regions=regions)
    legend_rows = math.ceil(len(handles) / LEGEND_COLUMNS)
    height = style.scene_height(limits, legend_rows=legend_rows, titled=title is not None)
    figure = style.new_figure(height, title=title, compressed=True)
    axes = figure.subplots()
    style.frame_scene(axes, limits)
    for index, (obstacle, look) in enumerate(zip(scenario.obstacles, shapes.looks(scenario.obstacles), strict=True)):
        if shapes.is_mobile(obstacle):
            _draw_encounters(axes, runs, index, look, regions=regions)
        else:
            shapes.add_obstacle(axes, obstacle, shapes.center(obstacle), look.color, regions=regions)
    for index, run in enumerate(runs):
        _draw_path(axes, run, style.run_look(index))
    shapes.add_start_and_goal(axes, scenario, sorted({run.scenario.start for run in runs}))
    style.legend_below(figure, handles, columns=LEGEND_COLUMNS)
    return figure


def _limits_of_runs(runs: Sequence[Trajectory], *, regions: bool) -> style.Limits:
    """Return limits that hold all paths and the obstacles that matter to them."""
    points: list[Any] = []
    for run in runs:
        points += [run.position, run.scenario.start, run.scenario.goal]
        for index, obstacle in enumerate(run.scenario.obstacles):
            active, critical = shapes.region_radii(obstacle)
            row = inputs.closest_row(run, index)
            if row is None or run.distance[row, index] >= active:
                continue
            radius = (critical if shapes.is_mobile(obstacle) else active) if regions else 0.0
            place = run.obstacle_position[row, index]
            points.append(shapes.body(obstacle, place).get_extents().get_points())
            points.append(shapes.region(obstacle, place, radius).get_extents().get_points())
    return inputs.view_limits(points, margin=MARGIN)


def _draw_encounters(axes: Axes, runs: Sequence[Trajectory], index: int, look: shapes.Look, *, regions: bool) -> None:
    """Draw a moving obstacle's path, and where it was at the closest approach of each run."""
    from matplotlib.patches import Circle

    longest = max((run for run in runs if run.scenario.obstacles), key=lambda run: float(run.time[-1]))
    trace = longest.obstacle_position[:, index]
    axes.plot(trace[:, 0], trace[:, 1], ":", color=look.color, linewidth=1.6, zorder=2.5)
    several, many = len(runs) > 1, len(longest.scenario.obstacles) > shapes.MOST_COLORS
    for number, run in enumerate(runs):
        row = inputs.closest_row(run, index) if run.scenario.obstacles else None
        obstacle = runs[0].scenario.obstacles[index] if row is None else run.scenario.obstacles[index]
        if row is None or run.distance[row, index] >= shapes.region_radii(obstacle)[0]:
            continue
        place, robot = run.obstacle_position[row, index], run.position[row]
        edge = str(style.run_look(number)["color"]) if several else None
        if regions and not many:
            shapes.add(axes, shapes.region_patches(obstacle, place, edge or look.color, filled=not several))
        alpha = 0.55 if several else 0.9
        ring: style.Properties = {
            "facecolor": look.color,
            "edgecolor": edge or "white",
            "linewidth": 1.6,
            "zorder": 3.2,
        }
        shapes.add(axes, [shapes.body(obstacle, place, alpha=alpha, **ring)])
        if many:
            letters: style.Properties = {"color": "white", "fontsize": style.SMALL_FONT_SIZE, "clip_on": True}
            axes.text(
                place[0], place[1], look.name.split()[-1], ha="center", va="center_baseline", zorder=5.8, **letters
            )
        line_color = edge or style.run_look(number)["color"]
        axes.add_patch(
            Circle((robot[0], robot[1]), run.scenario.robot.radius, fill=False, color=line_color, zorder=3.5)
        )
        axes.plot([place[0], robot[0]], [place[1], robot[1]], color=line_color, linewidth=0.8, zorder=3.4)


def _draw_path(axes: Axes, run: Trajectory, look: style.Properties) -> None:
    """Draw the path of a robot, with direction markers each second, contacts and an end without arrival."""
    axes.plot(run.position[:, 0], run.position[:, 1], zorder=5.0, **look)
    for instant in np.arange(SECOND, run.time[-1], SECOND):
        row = inputs.row_at(run, float(instant))
        velocity = run.velocity[row]
        if np.hypot(*velocity) >= SLOWEST_WITH_DIRECTION:
            marker = (3, 0, math.degrees(math.atan2(velocity[1], velocity[0])) - 90.0)
            shape: style.Properties = {
                "marker": marker,
                "markersize": 8.5,
                "markeredgecolor": "white",
                "markeredgewidth": 0.7,
            }
            axes.plot(*run.position[row], color=look["color"], linestyle="none", zorder=5.5, **shape)
    for instant in run.contact_time[np.isfinite(run.contact_time)]:
        x, y = run.position[inputs.row_at(run, float(instant))]
        axes.plot(x, y, **_CONTACT, zorder=7.0)
    if not np.isfinite(run.arrival_time):
        axes.plot(*run.position[-1], "s", markersize=7, color=look["color"], markeredgecolor="white", zorder=5.6)


_CONTACT: style.Properties = {
    "marker": "X",
    "markersize": 11,
    "color": style.CONTACT_COLOR,
    "markeredgecolor": "white",
    "linestyle": "none",
}


def _has_regions(obstacles: Sequence[Obstacle]) -> bool:
    """Return whether regions of any of these obstacles are drawn."""
    few = len(obstacles) <= shapes.MOST_COLORS
    return few or any(not shapes.is_mobile(obstacle) for obstacle in obstacles)


def _path_handles(runs: Sequence[Trajectory], names: Sequence[str], *, regions: bool) -> list[Artist]:
    """Return the legend of a picture of paths."""
    from matplotlib.lines import Line2D

    handles: list[Artist] = [Line2D([], [], label=name, **style.run_look(i)) for i, name in enumerate(names)]
    mark: style.Properties = {"marker": (3, 0, -90.0), "color": style.NEUTRAL, "markersize": 8, "linestyle": "none"}
    handles.append(Line2D([], [], label="each second", **mark))
    handles += shapes.start_and_goal_handles()
    if any(not np.isfinite(run.arrival_time) for run in runs):
        end: style.Properties = {"marker": "s", "color": style.NEUTRAL, "markersize": 7, "linestyle": "none"}
        handles.append(Line2D([], [], label="end, not arrived", **end))
    if any(np.isfinite(run.contact_time).any() for run in runs):
        handles.append(Line2D([], [], label="first contact", **_CONTACT))
    obstacles = next((run.scenario.obstacles for run in runs if run.scenario.obstacles), ())
    handles += shapes.obstacle_handles(obstacles, regions=regions and _has_regions(obstacles))
    if any(shapes.is_mobile(obstacle) for obstacle in obstacles):
        closest: style.Properties = {
            "color": style.NEUTRAL,
            "linewidth": 0.8,
            "marker": "o",
            "markerfacecolor": "none",
            "markersize": 9,
        }
        handles.append(Line2D([], [], label="closest approach", **closest))
    return handles
