"""Pictures of the map that a robot makes of its scans."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hrsafety._arguments import callback, instance
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.run import Run
from hrsafety.navigation.scan_controller import KnownCells
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plotting import floor, inputs, movies, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["animate_known_cells", "known_cells"]

MARGIN = 0.5
"""Around what is in view, in m."""
COLORS = ("#C9CDD2", "#FFFFFF", "#2F3B4A")
"""Of unknown, free and occupied cells."""
WAY_COLOR = "#1F77B4"
DPI = 85  # as animations have it


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
    now = _now(instance("run", run, Run), robot)
    if not now.cells.kinds.any():
        raise InvalidParameterError("run", "have seen something: step it first", run)
    own = run.trajectory.robots[robot or 0]
    handles = _handles(walls.maps_of([own]))
    limits = _limits(now, own)
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=title)
    axes.set_facecolor(COLORS[0])
    style.frame_scene(axes, limits)
    floor.line(axes, own.position, zorder=3.4, color=style.RUN_COLORS[0], linewidth=1.8)
    _add_known(axes, now, own)
    return floor.finish(figure, handles)


@notes.picture
def animate_known_cells(
    run: Run,
    path: str | os.PathLike[str],
    *,
    robot: int | None = None,
    frames_per_second: float = 15,
    speed: float = 1.0,
    title: str | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Step a run to its end, and write an animation of the map that its law makes to a GIF or MP4 file.

    Every frame is that of `known_cells`. The file appears under its name only when it is complete.

    Parameters
    ----------
    run : Run
        A run whose law makes its own map, such as `ArcRollouts`; it is stepped to its end.
    path : str or path-like
        Where to write; ``.gif`` needs Pillow, ``.mp4`` the program ffmpeg.
    robot : int or None
        Index of the robot in a world; ``None``: the only one.
    frames_per_second : float
        Frames in a second of viewing time; at most 50 for a GIF.
    speed : float
        Simulated time over viewing time: 2 plays twice as fast.
    title : str or None
        Title above the scene.
    progress : callable or None
        Called with ``(done, total)`` after each frame that was drawn.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InvalidParameterError
        If the law makes no map, the run has ended, a number is not positive and finite, the suffix is neither ``.gif``
        nor ``.mp4``, or the folder does not exist.
    MissingExtraError
        If matplotlib, Pillow or ffmpeg is needed and missing.
    HrsafetyError
        If ffmpeg fails.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import navigation as nav, plotting
    >>> walls = nav.StaticMap.from_polylines([[(1.5, -1.0), (1.5, 1.0)]])
    >>> place = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(1, 1), walls=walls)
    >>> run = nav.Run(place, nav.ArcRollouts(), nav.robots.AsBuilt(sensors=[nav.Lidar(map=walls)]))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plotting.runs.animate_known_cells(run, pathlib.Path(folder) / "map.gif", frames_per_second=2).name
    'map.gif'
    """
    shown, target = instance("run", run, Run), movies.checked_target(path)
    if shown.finished:
        raise InvalidParameterError("run", "be under way: it is stepped to its end here", run)
    limit = shown.scenario.time_limit
    spacing = float(movies.checked_instants(target, limit, frames_per_second, speed)[1])
    seen: list[_Known] = []
    while not shown.finished:
        shown.step()
        if shown.time >= spacing * len(seen) or shown.finished:
            seen.append(_now(shown, robot))
    own = shown.trajectory.robots[robot or 0]
    limits = _limits(seen[-1], own)
    height = style.scene_height(limits, titled=title is not None)
    figure = style.new_figure(height, title=title, dpi=DPI, compressed=True)
    axes = figure.subplots()
    axes.set_facecolor(COLORS[0])
    style.frame_scene(axes, limits)
    frames = movies.drawn_anew(figure, axes, range(len(seen)), lambda row: _add_known(axes, seen[row], own))
    movies.write(target, movies.counted(frames, len(seen), callback("progress", progress)), frames_per_second)
    return target


class _Known(NamedTuple):
    """What a law knows at an instant, with the pose of its robot."""

    cells: KnownCells
    position: inputs.Array
    heading: float


def _now(run: Run, robot: int | None) -> _Known:
    """Return what the law of a run knows now."""
    cells = run.known_cells(robot)
    if cells is None:
        raise InvalidParameterError("run", "be one whose law makes its own map of scans, such as ArcRollouts", run)
    own = run.trajectory.robots[robot or 0]
    return _Known(cells, own.position[-1], 0.0 if own.heading is None else float(own.heading[-1]))


def _handles(maps: list[StaticMap]) -> list[Artist]:
    """Return the legend."""
    from matplotlib.patches import Patch

    return [
        Patch(facecolor=COLORS[0], edgecolor=style.NEUTRAL, label="not seen"),
        Patch(facecolor=COLORS[2], edgecolor=style.NEUTRAL, label="occupied"),
        floor.handle("way so far", color=style.RUN_COLORS[0], linestyle="-", linewidth=1.8),
        floor.handle("planned way", color=WAY_COLOR, linestyle="--", linewidth=1.6),
        floor.handle("goal", marker="*", color=style.GOAL_COLOR, markersize=12, linestyle="none"),
        *walls.handles(maps)[:1],  # what the map does not know lies below the cells
    ]


def _limits(now: _Known, own: Trajectory) -> style.Limits:
    """Return what is in view: all that is known, the way of the robot and its goal."""
    rows, columns = np.nonzero(now.cells.kinds)
    ends = np.array([(columns.min(), rows.min()), (columns.max() + 1, rows.max() + 1)]) * now.cells.cell
    known = ends + now.cells.low
    return inputs.view_limits([known, own.position, [own.scenario.goal]], margin=MARGIN, least_ratio=0.5)


def _add_known(axes: Axes, now: _Known, own: Trajectory) -> None:
    """Draw everything at an instant: cells change below walls and goal."""
    rows, columns = now.cells.kinds.shape
    (x, y), side = now.cells.low, now.cells.cell
    painted = np.array([[int(color[at : at + 2], 16) for at in (1, 3, 5)] for color in COLORS], dtype=np.uint8)
    extent = (x, x + columns * side, y, y + rows * side)
    view = axes.get_xlim(), axes.get_ylim()
    axes.imshow(painted[now.cells.kinds], extent=extent, origin="lower", interpolation="nearest", zorder=0.5)
    axes.set_xlim(view[0])
    axes.set_ylim(view[1])
    walls.add_maps(axes, walls.maps_of([own]))
    axes.plot(*own.scenario.goal, "*", markersize=13, color=style.GOAL_COLOR, markeredgecolor="white", zorder=6.0)
    if len(now.cells.way):
        floor.line(axes, now.cells.way, zorder=3.3, color=WAY_COLOR, linewidth=1.6, linestyle="--")
    look: style.Properties = {"facecolor": style.RUN_COLORS[0], "edgecolor": "black", "zorder": 4.0}
    axes.add_patch(shapes.robot(own.scenario.robot, now.position, now.heading, **look))
