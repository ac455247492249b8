"""Where people and robots of a world walk, seen from above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import number
from hrsafety.errors import InvalidParameterError
from hrsafety.plotting import floor, inputs, notes, shapes, style
from hrsafety.plotting.crowds import world_scenes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["crowd_paths"]

FEW = 12  # people whose paths are drawn as strong as those of robots
FAINT = 0.3  # strength of the oldest part of a path
MOST_PIECES = 80  # of a path that fades
SO_FAR, TO_COME = "-", (0, (1.0, 1.6))


@notes.picture
def crowd_paths(
    run: Trajectory,
    *,
    at: float | None = None,
    color_by: str = "model",
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw everybody in a world at one instant, with the paths so far, which fade, and to come.

    Where the floor repeats itself, one cell of it is shown between dashed edges.

    Parameters
    ----------
    run : Trajectory
        What happened.
    at : float or None
        The instant in s; ``None``: when a robot was nearest to a person, half of the time without robots.
    color_by : {"model", "group"}
        What the colors of people tell.
    labels : sequence of str or None
        A name for each robot; numbered when ``None``.
    title : str or None
        Title of the figure, before the instant.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If the instant is outside the run, a word is unknown, or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> law = nav.OptimalReciprocalCollisionAvoidance()
    >>> run = nav.simulate(scenarios.circle_crossing(3, law=law))
    >>> figure = plotting.crowds.crowd_paths(run, at=5.0)
    >>> figure.get_suptitle()
    't = 5.00 s'
    """
    run = world_scenes.checked_crowd(run)
    names = inputs.checked_labels(labels, len(run.scenario.robots), stem="robot")
    row = _row(run, at)
    place = world_scenes.Floor.of(run)
    kinds = world_scenes.kinds_of_people(run, color_by)
    touched = world_scenes.contacts(run)
    handles = _handles(run, names, kinds, touched=bool(touched))
    words = f"t = {run.time[row]:.2f} s" if title is None else f"{title}, t = {run.time[row]:.2f} s"
    figure, (axes,) = floor.panels(place.limits, entries=len(handles), legend_columns=3, title=words)
    world_scenes.add_walls(axes, run.scenario, place)
    _draw_people(axes, run, row, place, kinds)
    _draw_robots(axes, run, row, place)
    world_scenes.add_goals(axes, run.scenario)
    for instant, robot in touched:
        axes.plot(*run.robot_position[instant, robot], zorder=7.0, **floor.CONTACT)
    return floor.finish(figure, handles, columns=3, runs=[run])


def _row(run: Trajectory, at: float | None) -> int:
    """Return the row of the instant that is shown."""
    end = float(run.time[-1])
    if at is not None:
        instant = number("at", at)
        if not 0.0 <= instant <= end:
            raise InvalidParameterError("at", f"be from 0 to the end of the run at {end:g} s", at)
        return int(np.abs(run.time - instant).argmin())
    if not run.scenario.robots or not run.obstacle_position.shape[1]:
        return len(run.time) // 2
    gap = [world_scenes.gaps(run, robot).min(axis=1) for robot in range(len(run.scenario.robots))]
    return int(np.min(gap, axis=0).argmin())


def _draw_people(axes: Axes, run: Trajectory, row: int, place: world_scenes.Floor, kinds: Sequence[str]) -> None:
    """Draw people and their paths; of many people fainter ones."""
    colors = world_scenes.color_of(kinds)
    strength = 0.9 if len(kinds) <= FEW else 0.35
    for person, kind in enumerate(kinds):
        color = colors[kind]
        coming = place.path(run.obstacle_position[row:, person])
        look: style.Properties = {"color": color, "linewidth": 1.1, "alpha": 0.6 * strength, "linestyle": TO_COME}
        floor.line(axes, coming, zorder=2.5, **look)
        _fading(axes, place.path(run.obstacle_position[: row + 1, person]), color, strength)
        body: style.Properties = {"facecolor": color, "edgecolor": "white", "linewidth": 0.8, "zorder": 3.2}
        world_scenes.draw_body(
            axes, place, run.obstacle_position[row, person], float(run.obstacle_radius[person]), alpha=0.85, **body
        )


def _fading(axes: Axes, path: inputs.Array, color: str, strength: float) -> None:
    """Draw the path so far, fainter the longer ago."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    rows = np.unique(np.linspace(0, len(path) - 1, MOST_PIECES).astype(int))
    kept = np.unique(np.concatenate([rows, np.flatnonzero(np.isnan(path[:, 0]))]))
    ends = path[kept]
    pieces = np.stack([ends[:-1], ends[1:]], axis=1)
    fade = FAINT + (1.0 - FAINT) * np.linspace(0.0, 1.0, len(pieces))
    known = np.isfinite(pieces).all(axis=(1, 2))
    colors = np.column_stack([np.tile(to_rgb(color), (len(pieces), 1)), strength * fade])
    axes.add_collection(LineCollection(list(pieces[known]), colors=colors[known], linewidths=1.6, zorder=2.6))


def _draw_robots(axes: Axes, run: Trajectory, row: int, place: world_scenes.Floor) -> None:
    """Draw robots and their paths, which do not begin again where the floor repeats itself: goals do not either."""
    for index, look in enumerate(world_scenes.robot_looks(len(run.scenario.robots))):
        robot = run.scenario.robots[index]
        path, color = run.robot_position[:, index], str(look["color"])
        floor.line(axes, path[: row + 1], zorder=5.0, color=color, linewidth=2.0)
        floor.line(axes, path[row:], zorder=4.9, color=color, linewidth=1.6, linestyle=TO_COME)
        body: style.Properties = {"facecolor": color, "edgecolor": "white", "linewidth": 0.8, "zorder": 4.5}
        angle = float(run.robot_heading[row, index])
        for copy in place.copies(path[row], robot.body.radius) if np.isfinite(path[row]).all() else ():
            axes.add_patch(shapes.robot(robot.body, copy, angle, **body))


def _handles(run: Trajectory, names: Sequence[str], kinds: Sequence[str], *, touched: bool) -> list[Artist]:
    """Return the legend."""
    robots = len(names)
    looks = world_scenes.robot_looks(robots)
    shown = list(names) if robots <= world_scenes.MOST_ROBOTS else ["robot"]
    look: style.Properties = {"marker": "o", "markersize": 9, "linestyle": "-", "linewidth": 2.0}
    handles: list[Artist] = [
        floor.handle(name, **look, color=looks[index]["color"]) for index, name in enumerate(shown)
    ]
    handles += world_scenes.people_handles(kinds)
    if robots or kinds:
        handles.append(floor.handle("path so far", linestyle=SO_FAR, linewidth=1.4))
        handles.append(floor.handle("path to come", linestyle=TO_COME, linewidth=1.4))
    handles += world_scenes.scene_handles(run.scenario)
    if touched:
        handles.append(floor.handle("first contact", **floor.CONTACT))
    return handles
