"""Decisions of the parts around a law in one frame: plan of the guide, verdict of the shield, verified way to rest."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import callback, instance
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving_rectangle import Box
from hrsafety.navigation.safety_record import SafetyDecision, SafetyRecord
from hrsafety.plotting import floor, inputs, movies, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["animate_safety", "safety_decision"]

MARGIN = 0.8  # free space around the path of the robot, in m
DPI = 85  # of animations
PATH_COLOR = style.RUN_COLORS[0]
PLAN_COLOR = style.RUN_COLORS[2]
EXPECTED_COLOR = "#6a3d9a"
VERDICTS = {"kept": style.RUN_COLORS[1], "changed": style.PERSON_COLORS[1], "braking": style.CONTACT_COLOR}
INFEASIBLE = {"infeasible": style.CONTACT_COLOR}
"""Of a filter in the place of a shield."""


@notes.picture
def safety_decision(record: SafetyRecord, time: float, *, title: str | None = None) -> Figure:
    """Draw one decision of the parts around a law.

    Shown are the path of the guide through the map alone and the local goal on it (around people who
    stand the law follows another plan), the wanted and the commanded
    velocity as the ways of one second, the ground that the robot sweeps until it rests in the plan
    behind the command, and how far everybody can have come by then. Color and text give the verdict:
    kept, changed, braking or infeasible, with the margin by which the plan is verified.

    Parameters
    ----------
    record : SafetyRecord
        Of `hrsafety.navigation.metrics.record_safety`.
    time : float
        When, in s; the last decision that is not later is drawn.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If the time lies outside of the run.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=1.0))
    >>> record = nav.metrics.record_safety(scenarios.configuration("c2"), law)
    >>> plotting.runs.safety_decision(record, 1.0).axes[0].get_xlabel()
    'x (m)'
    """
    shown = _checked(record)
    decision = shown.at(time)
    handles = _handles(shown)
    figure, (axes,) = floor.panels(_limits(shown, decision), entries=len(handles), title=title)
    _add_scene(axes, shown)
    _add_decision(axes, shown, decision)
    return floor.finish(figure, handles, runs=[shown.trajectory])


@notes.picture
def animate_safety(
    record: SafetyRecord,
    path: str | os.PathLike[str],
    *,
    frames_per_second: float = 15,
    speed: float = 1.0,
    title: str | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write an animation of the decisions of the parts around a law to a GIF or MP4 file.

    Every frame is that of `safety_decision`. The file appears under its name only when it is complete.

    Parameters
    ----------
    record : SafetyRecord
        Of `hrsafety.navigation.metrics.record_safety`.
    path : str or path-like
        Where to write; ``.gif`` needs Pillow, ``.mp4`` the program ffmpeg.
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
        If a number is not positive and finite, the suffix is neither ``.gif`` nor ``.mp4``, the folder
        does not exist, or more than 6000 frames would be needed.
    MissingExtraError
        If matplotlib, Pillow or ffmpeg is needed and missing.
    HrsafetyError
        If ffmpeg fails.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=1.0))
    >>> record = nav.metrics.record_safety(scenarios.configuration("c2"), law)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     plotting.runs.animate_safety(record, pathlib.Path(folder) / "c2.gif", frames_per_second=2).name
    'c2.gif'
    """
    shown = _checked(record)
    target = movies.checked_target(path)
    times = [each.time for each in shown.decisions]
    instants = movies.checked_instants(target, times[-1], frames_per_second, speed)
    rows = [*(np.searchsorted(times, instants + 1e-9, side="right") - 1).tolist(), len(times) - 1]
    frames = _frames(shown, rows, title)
    movies.write(target, movies.counted(frames, len(rows), callback("progress", progress)), frames_per_second)
    return target


def _frames(record: SafetyRecord, rows: list[int], title: str | None) -> Iterator[movies.Frame]:
    """Return the pictures: only what moves is drawn again."""
    limits = _limits(record)
    figure = style.new_figure(
        style.scene_height(limits, titled=title is not None), title=title, dpi=DPI, compressed=True
    )
    axes = figure.subplots()
    style.frame_scene(axes, limits)
    _add_scene(axes, record)
    return movies.drawn_anew(figure, axes, rows, lambda row: _add_decision(axes, record, record.decisions[row]))


def _checked(record: SafetyRecord) -> SafetyRecord:
    """Return a record whose run is that of a scenario."""
    given = instance("record", record, SafetyRecord)
    return replace(given, trajectory=inputs.checked_trajectory("record.trajectory", given.trajectory))


def _seen(record: SafetyRecord, decision: SafetyDecision) -> Iterator[tuple[Obstacle, str, inputs.Array, float]]:
    """Yield obstacles that can move, with color, place and reach at a decision.

    Who was not seen is where the run has it, without a reach.
    """
    run = record.trajectory
    obstacles, now = run.scenario.obstacles, inputs.row_at(run, decision.time)
    for index, (obstacle, look) in enumerate(zip(obstacles, shapes.looks(obstacles), strict=True)):
        place, reach = run.obstacle_position[now, index], 0.0
        known = decision.obstacle_position[index : index + 1]
        if np.isfinite(known).all() and len(known):
            place, reach = known[0], float(decision.obstacle_reach[index])
        if shapes.is_mobile(obstacle) and np.isfinite(place).all():
            yield obstacle, look.color, place, reach


def _limits(record: SafetyRecord, decision: SafetyDecision | None = None) -> style.Limits:
    """Return what is in view: the run and the scene, and all that one decision is about."""
    run = record.trajectory
    points: list[Any] = [run.position, run.scenario.start, run.scenario.goal]
    if decision is not None:
        points += [_corners(obstacle, place, reach) for obstacle, _, place, reach in _seen(record, decision)]
    points += shapes.scene_points(run.scenario.obstacles) + walls.points_of(walls.maps_of([run]))
    return inputs.view_limits(points, margin=MARGIN, least_ratio=0.5)


def _corners(obstacle: Obstacle, place: inputs.Array, reach: float) -> inputs.Array:
    """Return corners around a person who can move and the reach that is drawn."""
    size = 0.0 if isinstance(obstacle, Box) else shapes.least_half_width(obstacle)
    drawn = shapes.region(obstacle, place, size + (reach if np.isfinite(reach) else 0.0))
    return np.asarray(drawn.get_extents().get_points())


def _add_scene(axes: Axes, record: SafetyRecord) -> None:
    """Draw what does not move."""
    run = record.trajectory
    walls.add_maps(axes, walls.maps_of([run]))
    for obstacle, look in zip(run.scenario.obstacles, shapes.looks(run.scenario.obstacles), strict=True):
        if not shapes.is_mobile(obstacle):
            shapes.add_obstacle(axes, obstacle, shapes.center(obstacle), look.color, regions=False)
    shapes.add_start_and_goal(axes, run.scenario)


def _add_decision(axes: Axes, record: SafetyRecord, decision: SafetyDecision) -> None:
    """Draw what is there at one decision."""
    run, color = record.trajectory, (VERDICTS | INFEASIBLE)[decision.status]
    so_far = run.position[: inputs.row_at(run, decision.time) + 1]
    floor.line(axes, so_far, zorder=3.4, color=PATH_COLOR, linewidth=1.5)
    if len(decision.path):
        floor.line(axes, decision.path, zorder=3.3, color=PLAN_COLOR, linewidth=1.6, linestyle="--")
    if decision.local_goal is not None:
        axes.plot(*decision.local_goal, "D", color=PLAN_COLOR, markeredgecolor="white", markersize=8, zorder=4.6)
    _add_foreseen(axes, decision)
    _add_others(axes, record, decision)
    _add_way_to_rest(axes, decision, run.scenario.robot.radius, color)
    shapes.add_robot(axes, run.scenario, decision.position, PATH_COLOR)
    _add_arrow(axes, decision.position, decision.wanted, style.NEUTRAL)
    _add_arrow(axes, decision.position, decision.command, "black")
    box: style.Properties = {"boxstyle": "round,pad=0.3", "facecolor": "white", "edgecolor": color, "linewidth": 2.0}
    place: style.Properties = {"x": 0.015, "y": 0.975, "transform": axes.transAxes, "ha": "left", "va": "top"}
    axes.text(s=_verdict(decision), **place, bbox=box, fontsize=style.FONT_SIZE, zorder=9.0)


def _verdict(decision: SafetyDecision) -> str:
    words = f"{decision.time:.2f} s: {decision.status}"
    if np.isfinite(decision.margin):
        words += f", margin {decision.margin:.2f} m"
    return f"{words}, taken over" if decision.taken_over else words


def _add_others(axes: Axes, record: SafetyRecord, decision: SafetyDecision) -> None:
    """Draw those who can move, and how far they can have come when the robot rests."""
    for obstacle, color, place, reach in _seen(record, decision):
        shapes.add_obstacle(axes, obstacle, place, color, regions=False)
        if 0.0 < reach < np.inf:
            size = 0.0 if isinstance(obstacle, Box) else shapes.least_half_width(obstacle)
            edge: style.Properties = {"edgecolor": color, "linestyle": ":", "linewidth": 1.2, "zorder": 3.1}
            shapes.add(axes, [shapes.region(obstacle, place, size + reach, fill=False, **edge)])


def _add_foreseen(axes: Axes, decision: SafetyDecision) -> None:
    """Draw the way that foresight plans, and where it expects people."""
    if len(decision.foreseen_way):
        floor.line(axes, decision.foreseen_way, zorder=3.35, color=EXPECTED_COLOR, linewidth=1.8, linestyle=":")
    for places in decision.foreseen_people:
        look: style.Properties = {"color": EXPECTED_COLOR, "markersize": 2.5, "linestyle": "none", "zorder": 3.25}
        axes.plot(places[1:, 0], places[1:, 1], "o", **look)


def _add_way_to_rest(axes: Axes, decision: SafetyDecision, radius: float, color: str) -> None:
    """Draw the ground that the robot sweeps until it rests, the way of its center, and where it rests."""
    from matplotlib.collections import PatchCollection
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Circle

    swept = [Circle((x, y), radius) for x, y in decision.plan_position]
    light = tuple(0.4 * part + 0.6 for part in to_rgb(color))
    axes.add_collection(PatchCollection(swept, facecolor=light, edgecolor="none", zorder=2.6), autolim=False)
    floor.line(axes, decision.plan_position, zorder=4.3, color=color, linewidth=2.6)
    x, y = decision.plan_position[-1]
    axes.add_patch(Circle((x, y), radius, fill=False, edgecolor=color, linewidth=1.8, zorder=4.2))


def _add_arrow(axes: Axes, place: inputs.Array, towards: inputs.Array, color: str) -> None:
    """Draw the way of one second as an arrow."""
    from matplotlib.patches import FancyArrowPatch

    if np.hypot(*towards) > floor.LEAST_SPEED:
        look: style.Properties = {"arrowstyle": "-|>", "mutation_scale": 11, "color": color, "linewidth": 1.4}
        axes.add_patch(FancyArrowPatch(tuple(place), tuple(place + towards), zorder=5.2, shrinkA=0, shrinkB=0, **look))


def _handles(record: SafetyRecord) -> list[Artist]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    run, law = record.trajectory, record.law
    handles: list[Artist] = [
        floor.handle("robot, path so far", marker="o", markersize=9, color=PATH_COLOR, linestyle="-"),
        *shapes.start_and_goal_handles(),
    ]
    if law.guide is not None:
        handles.append(floor.handle("path of the guide", color=PLAN_COLOR, linestyle="--", linewidth=1.6))
        handles.append(floor.handle("local goal", color=PLAN_COLOR, marker="D", markersize=8))
    if law.foresight is not None:
        handles.append(floor.handle("way that is expected", color=EXPECTED_COLOR, linestyle=":", linewidth=1.8))
        handles.append(floor.handle("people as expected", color=EXPECTED_COLOR, marker="o", markersize=3))
    handles += [
        Line2D([0, 1], [0, 0], color=color, marker=">", markersize=6, markevery=[1], label=f"{name}, way of 1 s")
        for name, color in (("wanted", style.NEUTRAL), ("commanded", "black"))
    ]
    if law.shield is not None:
        handles += [Patch(facecolor=color, label=f"until rest: {verdict}") for verdict, color in VERDICTS.items()]
        handles.append(floor.handle("reach of others by then", linestyle=":", linewidth=1.2))
    return [
        *handles,
        *walls.handles(walls.maps_of([run])),
        *shapes.obstacle_handles(run.scenario.obstacles, regions=False),
    ]
