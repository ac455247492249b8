"""Pictures of the map that a robot makes of its scans."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import instance
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.run import Run
from hrsafety.plotting import floor, inputs, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hrsafety.navigation.scan_controller import KnownCells

__all__ = ["known_cells"]

MARGIN = 0.5
"""Around what is in view, in m."""
COLORS = ("#C9CDD2", "#FFFFFF", "#2F3B4A")
"""Of unknown, free and occupied cells."""
WAY_COLOR = "#1F77B4"


@notes.picture
def known_cells(run: Run, *, robot: int | None = None, title: str | None = None) -> Figure:
    """Draw the map that a law makes of its scans: what is free, what is occupied, and what nobody has seen.

    Parameters
    ----------
    run : Run
        A run under way whose law makes its own map, such as `ArcRollouts`.
    robot : int or None
        Index of the robot in a world; ``None``: the only one.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Cells with the walls as they are, the footprint where the robot is, its way so far, and the way that it plans.

    Raises
    ------
    InvalidParameterError
        If the law makes no map, or has not decided yet.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> walls = nav.StaticMap.from_polylines([[(1.5, -1.0), (1.5, 1.0)]])
    >>> place = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(3, 0), walls=walls)
    >>> run = nav.Run(place, nav.ArcRollouts(), nav.robots.AsBuilt(sensors=[nav.Lidar(map=walls)]))
    >>> seen = run.step()
    >>> plotting.runs.known_cells(run).axes[0].get_xlabel()
    'x (m)'
    """
    shown = instance("run", run, Run)
    cells = shown.known_cells(robot)
    if cells is None:
        raise InvalidParameterError("run", "be one whose law makes its own map of scans, such as ArcRollouts", run)
    trajectory, index = shown.trajectory, 0 if robot is None else robot
    world = isinstance(shown.scenario, World)
    own = trajectory.robots[index] if world else trajectory
    body, goal = (own.scenario.robot, own.scenario.goal)
    maps = walls.maps_of([own])
    known = _known_corners(cells)
    limits = inputs.view_limits([known, own.position, [goal]], margin=MARGIN, least_ratio=0.5)
    handles = [
        floor.handle("not seen", marker="s", color=COLORS[0], markersize=10, linestyle="none"),
        floor.handle("occupied", marker="s", color=COLORS[2], markersize=10, linestyle="none"),
        floor.handle("way so far", color=style.RUN_COLORS[0], linestyle="-", linewidth=1.8),
        floor.handle("planned way", color=WAY_COLOR, linestyle="--", linewidth=1.6),
        floor.handle("goal", marker="*", color=style.GOAL_COLOR, markersize=12, linestyle="none"),
        *walls.handles(maps),
    ]
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=title)
    axes.set_facecolor(COLORS[0])
    rows, columns = cells.kinds.shape
    (x, y), side = cells.low, cells.cell
    painted = np.array([[int(color[at : at + 2], 16) for at in (1, 3, 5)] for color in COLORS], dtype=np.uint8)
    extent = (x, x + columns * side, y, y + rows * side)
    axes.imshow(painted[cells.kinds], extent=extent, origin="lower", interpolation="nearest", zorder=0.5)
    style.frame_scene(axes, limits)
    walls.add_maps(axes, maps)
    floor.line(axes, own.position, zorder=3.4, color=style.RUN_COLORS[0], linewidth=1.8)
    if len(cells.way):
        floor.line(axes, cells.way, zorder=3.3, color=WAY_COLOR, linewidth=1.6, linestyle="--")
    heading = 0.0 if own.heading is None else float(own.heading[-1])
    axes.add_patch(
        shapes.robot(body, own.position[-1], heading, facecolor=style.RUN_COLORS[0], edgecolor="black", zorder=4.0)
    )
    axes.plot(*goal, "*", markersize=13, color=style.GOAL_COLOR, markeredgecolor="white", zorder=6.0)
    return floor.finish(figure, handles)


def _known_corners(cells: KnownCells) -> inputs.Array:
    """Return lowest and highest corner of the cells that are known."""
    rows, columns = np.nonzero(cells.kinds)
    if not len(rows):
        raise InvalidParameterError("run", "have decided once: nothing is known yet", "a run before its first step")
    ends: inputs.Array = np.array([(columns.min(), rows.min()), (columns.max() + 1, rows.max() + 1)]) * cells.cell
    return ends + cells.low
