"""Small pictures of one scene at chosen instants."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import count
from hrsafety._bounds import MOST_INSTANTS
from hrsafety.errors import InvalidParameterError
from hrsafety.plotting import floor, inputs, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["time_sequence"]

MARGIN = 0.6  # free space around the path of the robot, in m
COLUMNS = 3
ROBOT_COLOR = style.RUN_COLORS[0]


@notes.picture
def time_sequence(
    trajectory: Trajectory,
    *,
    instants: int | Sequence[float] = 6,
    regions: bool = True,
    view: str = "scene",
    title: str | None = None,
) -> Figure:
    """Draw the scene of one run at several instants, side by side.

    Each panel shows the robot, its path so far and every obstacle that is present, with arrows for the way of one
    second at the present velocity (that of an obstacle by differences of its positions), and of a run with a lidar
    the points that it hits. Among more than six obstacles the moving ones may be out of view.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    instants : int or sequence of float
        How many instants, evenly spaced from begin to end, or which, in s. The nearest row of
        the run is drawn, and its time written above the panel.
    regions : bool
        Whether active and critical regions are drawn; those of a moving obstacle only while
        the robot is inside its active region.
    view : {"scene", "paths"}
        Whether everything that stands is in view, and of up to six obstacles those that move, or
        only the path.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, one axes for each instant.

    Raises
    ------
    InvalidParameterError
        If an instant lies outside the run, or there are none or more than 24.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c4"), nav.VirtualForceField())
    >>> [axes.get_title() for axes in plotting.time_sequence(run, instants=[0.0, 2.5]).axes]
    ['t = 0.00 s', 't = 2.50 s']
    """
    run = inputs.checked_trajectory("trajectory", trajectory)
    chosen = _checked_instants(run, instants)
    limits = _limits(run, chosen, whole=inputs.checked_view(view))
    handles, scan = _handles(run, regions=regions), shapes.scan_of(run)
    if scan is not None:
        handles.append(floor.handle("scan", **(shapes.SCAN | {"markersize": 6})))
    rows = [inputs.row_at(run, instant) for instant in chosen]
    titles = [f"t = {run.time[row]:.2f} s" for row in rows]
    figure, panels = floor.panels(limits, titles=titles, columns=COLUMNS, entries=len(handles), title=title)
    for axes, row in zip(panels, rows, strict=True):
        _draw_instant(axes, run, row, regions=regions)
        if scan is not None:
            axes.plot(*scan(row).T, zorder=2.95, **shapes.SCAN)
    return floor.finish(figure, handles, runs=[run])


def _limits(run: Trajectory, instants: Sequence[float], *, whole: bool) -> style.Limits:
    """Return limits that hold the path and, if wanted, the scene at all instants."""
    points: list[Any] = [run.position, run.scenario.start, run.scenario.goal]
    obstacles = run.scenario.obstacles
    if whole:
        points += shapes.scene_points(obstacles) + walls.points_of(walls.maps_of([run]))
        rows = [inputs.row_at(run, instant) for instant in instants]
        for index, obstacle in enumerate(obstacles if len(obstacles) <= shapes.MOST_COLORS else ()):
            places = run.obstacle_position[rows, index]
            if shapes.is_mobile(obstacle):
                found = places[np.isfinite(places).all(axis=1)]
                points += [shapes.body(obstacle, place).get_extents().get_points() for place in found]
    return inputs.view_limits(points, margin=MARGIN, least_ratio=0.75)


def _checked_instants(run: Trajectory, instants: int | Sequence[float]) -> list[float]:
    """Return the instants in s."""
    end = float(run.time[-1])
    if isinstance(instants, (int, np.integer)) and not isinstance(instants, bool):
        return [float(instant) for instant in np.linspace(0.0, end, count("instants", instants, most=MOST_INSTANTS))]
    try:
        chosen = np.asarray(instants, dtype=np.float64)
    except (TypeError, ValueError):
        chosen = np.empty((0, 0))
    if chosen.ndim != 1 or not 1 <= len(chosen) <= MOST_INSTANTS:
        raise InvalidParameterError(
            "instants", f"be a number or a sequence of 1 to {MOST_INSTANTS} times in s", instants
        )
    for index, instant in enumerate(chosen.tolist()):
        if not 0.0 <= instant <= end:
            raise InvalidParameterError(f"instants[{index}]", f"be from 0 to the end of the run at {end:g} s", instant)
    return [float(instant) for instant in chosen]


def _draw_instant(axes: Axes, run: Trajectory, row: int, *, regions: bool) -> None:
    """Draw everything that is there at one row of a run."""
    scenario = run.scenario
    walls.add_maps(axes, walls.maps_of([run]))
    for index, (obstacle, look) in enumerate(zip(scenario.obstacles, shapes.looks(scenario.obstacles), strict=True)):
        place = run.obstacle_position[row, index]
        if not np.isfinite(place).all():
            continue
        active, _ = shapes.region_radii(obstacle)
        shown = regions and (not shapes.is_mobile(obstacle) or bool(run.distance[row, index] < active))
        shapes.add_obstacle(axes, obstacle, place, look.color, regions=shown)
        if shapes.is_mobile(obstacle):
            floor.velocity(axes, place, floor.obstacle_velocity(run, row, index))
    floor.line(axes, run.position[: row + 1], zorder=3.8, color=ROBOT_COLOR, linewidth=1.5)
    shapes.add_robot(axes, scenario, run.position[row], ROBOT_COLOR, heading=float(run.heading[row]))
    floor.velocity(axes, run.position[row], run.velocity[row])
    shapes.add_start_and_goal(axes, scenario)


def _handles(run: Trajectory, *, regions: bool) -> list[Artist]:
    """Return the legend of a time sequence."""
    from matplotlib.lines import Line2D

    robot: style.Properties = {"marker": "o", "markersize": 9, "color": ROBOT_COLOR, "linewidth": 1.5}
    arrow: style.Properties = {"marker": ">", "color": "black", "markersize": 7, "markevery": [1]}
    return [
        Line2D([], [], label="robot, path so far", **robot),
        Line2D([0, 1], [0, 0], label="way of 1 s", **arrow),
        *shapes.start_and_goal_handles(),
        *walls.handles(walls.maps_of([run])),
        *shapes.obstacle_handles(run.scenario.obstacles, regions=regions),
    ]
