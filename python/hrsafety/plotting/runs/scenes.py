"""The paths of runs through a scene, seen from above."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety.plotting import floor, inputs, notes, shapes, style, walls
from hrsafety.plotting import labels as placing

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["paths"]

MARGIN = 0.35  # free space around what must be in view, in m
NARROWEST, STEP_OF_WIDTH = 1.5, 2.4  # pt, widths of paths that lie on each other
CLOSE_PATHS = 0.008  # of the extent of both paths: about the width of a line
SHARE_ON_EACH_OTHER = 0.4
MOST_COMPARED = 400  # points of a path
NUMBER_COLOR = "#6B3E00"
SAME_PLACE = 0.5  # radii of an obstacle between two places that are drawn once


@notes.picture
def paths(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    labels: Sequence[str] | None = None,
    regions: bool = True,
    view: str = "scene",
    title: str | None = None,
) -> Figure:
    """Draw the paths of one or several runs through one scene.

    A marker on each path points in the direction of motion every second. Stationary obstacles
    are shown with their active and critical regions, and so are the maps that laws and lidars know.
    A moving obstacle leaves a dotted path.
    If the robot entered its active region, it is shown, with its regions, where it was when
    the robot came closest, together with the robot and a line between the two; with several
    runs, edged in the color of the run, and once where it hardly moved between them. Of more than six obstacles the
    moving ones are shown without regions, but with their number; the dotted paths are only of
    those that came near. Runs whose paths lie on each other are lines of decreasing width, so
    that each can be seen. A first contact is marked by a cross.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        Runs with the same goal and the same obstacles (or none).
    labels : sequence of str or None
        One name for each run; numbered when ``None``.
    regions : bool
        Whether active and critical regions are drawn.
    view : {"scene", "paths"}
        Whether the stationary obstacles are in view, with up to six moving ones that came as near as the
        path is long, or only the paths and what is near them.
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
    limits = _limits_of_runs(runs, regions=regions, whole=inputs.checked_view(view))
    scenario = runs[0].scenario
    looks = _run_looks(runs)
    handles = _path_handles(runs, names, looks, limits, regions=regions)
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=title)
    walls.add_maps(axes, walls.maps_of(runs))
    named: list[Annotation] = []
    for index, (obstacle, look) in enumerate(zip(scenario.obstacles, shapes.looks(scenario.obstacles), strict=True)):
        if shapes.is_mobile(obstacle):
            named += _draw_encounters(axes, runs, index, look, regions=regions)
        else:
            shapes.add_obstacle(axes, obstacle, shapes.center(obstacle), look.color, regions=regions)
    for index, run in enumerate(runs):
        floor.events(axes, run, looks[index])
    shapes.add_start_and_goal(axes, scenario, sorted({run.scenario.start for run in runs}))
    return floor.finish(figure, handles, runs=runs, named=named)


def _run_looks(runs: Sequence[Trajectory]) -> list[style.Properties]:
    """Return the look of each run: lines of decreasing width where paths lie on each other."""
    looks = [style.run_look(index) for index in range(len(runs))]
    if any(_coincide(run, other) for index, run in enumerate(runs) for other in runs[:index]):
        for index, look in enumerate(looks):
            look |= {"linewidth": NARROWEST + STEP_OF_WIDTH * (len(runs) - 1 - index), "linestyle": "-"}
    return looks


def _coincide(run: Trajectory, other: Trajectory) -> bool:
    """Return whether a good part of two paths can hardly be told apart."""
    some = run.position[:: max(1, len(run.position) // MOST_COMPARED)]
    all_others = other.position[:: max(1, len(other.position) // MOST_COMPARED)]
    away = np.sqrt(((some[:, np.newaxis] - all_others) ** 2).sum(axis=2)).min(axis=1)
    extent = float(np.ptp(np.concatenate([run.position, other.position]), axis=0).max())
    return bool(np.count_nonzero(away < CLOSE_PATHS * extent) > SHARE_ON_EACH_OTHER * len(some))


def _limits_of_runs(runs: Sequence[Trajectory], *, regions: bool, whole: bool) -> style.Limits:
    """Return limits that hold all paths, the obstacles that matter to them and, if wanted, the whole scene."""
    points: list[Any] = shapes.scene_points(runs[0].scenario.obstacles) if whole else []
    points += walls.points_of(walls.maps_of(runs)) if whole else []
    for run in runs:
        points += [run.position, run.scenario.start, run.scenario.goal]
        few = len(run.scenario.obstacles) <= shapes.MOST_COLORS
        extent = float(np.ptp(run.position, axis=0).max())
        for index, obstacle in enumerate(run.scenario.obstacles):
            row = inputs.closest_row(run, index)
            if row is None:
                continue
            active, critical = shapes.region_radii(obstacle)
            place, distance = run.obstacle_position[row, index], run.distance[row, index]
            mobile, felt = shapes.is_mobile(obstacle), distance < active
            if felt or (whole and few and mobile and distance <= extent):
                points.append(shapes.body(obstacle, place).get_extents().get_points())
            if felt:
                radius = (critical if mobile else active) if regions else 0.0
                points.append(shapes.region(obstacle, place, radius).get_extents().get_points())
    return inputs.view_limits(points, margin=MARGIN)


def _draw_encounters(
    axes: Axes, runs: Sequence[Trajectory], index: int, look: shapes.Look, *, regions: bool
) -> list[Annotation]:
    """Draw a moving obstacle's path, and where it was at the closest approach of each run; return labels."""
    longest = max((run for run in runs if run.scenario.obstacles), key=lambda run: float(run.time[-1]))
    several, many = len(runs) > 1, len(longest.scenario.obstacles) > shapes.MOST_COLORS
    met = list(_encounters(runs, index))
    if met or not many:
        trace = longest.obstacle_position[:, index]
        floor.line(axes, trace, zorder=2.5, linestyle=":", color=look.color, linewidth=1.0 if many else 1.6)
    named: list[Annotation] = []
    drawn: list[inputs.Array] = []
    for number, run, row in met:
        obstacle, place, robot = run.scenario.obstacles[index], run.obstacle_position[row, index], run.position[row]
        color = style.run_look(number)["color"]
        radius = float(getattr(obstacle, "radius", 0.0))
        if all(np.hypot(*(place - other)) > SAME_PLACE * radius for other in drawn):
            edge = str(color) if several else None
            if regions and not many:
                shapes.add_regions(axes, obstacle, place, edge or look.color, filled=not several)
            ring: style.Properties = {"facecolor": look.color, "alpha": 0.55 if several else 0.9}
            ring |= {"edgecolor": edge or "white", "linewidth": 1.6, "zorder": 3.2}
            if many:  # faint, so that paths and other people can be seen through it
                ring |= {"alpha": 0.3, "edgecolor": look.color, "linewidth": 1.0}
            shapes.add(axes, [shapes.body(obstacle, place, **ring)])
            drawn.append(place)
            if many:
                back: style.Properties = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
                words = placing.label(axes, look.name.split()[-1], tuple(place), color=NUMBER_COLOR, bbox=back)
                named.append(words)
        body, ring = run.scenario.robot, {"fill": False, "color": color, "zorder": 3.5}
        axes.add_patch(shapes.robot(body, robot, float(run.heading[row]), **ring))
        axes.plot([place[0], robot[0]], [place[1], robot[1]], color=color, linewidth=0.8, zorder=3.4)
    return named


def _encounters(runs: Sequence[Trajectory], index: int) -> Iterator[tuple[int, Trajectory, int]]:
    """Yield number, run and row of the closest approach of the runs that entered the active region."""
    for number, run in enumerate(runs):
        row = inputs.closest_row(run, index) if run.scenario.obstacles else None
        if row is not None and run.distance[row, index] < shapes.region_radii(run.scenario.obstacles[index])[0]:
            yield number, run, row


def _in_view(runs: Sequence[Trajectory], limits: style.Limits) -> list[int]:
    """Return which obstacles, or their ways, are at least partly in view."""
    longest = max(runs, key=lambda run: (len(run.scenario.obstacles), float(run.time[-1])))
    many = len(longest.scenario.obstacles) > shapes.MOST_COLORS
    low, high = np.array(limits).T
    found = []
    for index, obstacle in enumerate(longest.scenario.obstacles):
        if shapes.is_mobile(obstacle):
            trace = longest.obstacle_position[:, index]
            seen = ((trace > low) & (trace < high)).all(axis=1).any() and (not many or any(_encounters(runs, index)))
        else:
            box = shapes.body(obstacle, shapes.center(obstacle)).get_extents()
            seen = bool((box.max > low).all() and (box.min < high).all())
        if seen:
            found.append(index)
    return found


def _path_handles(
    runs: Sequence[Trajectory],
    names: Sequence[str],
    looks: Sequence[style.Properties],
    limits: style.Limits,
    *,
    regions: bool,
) -> list[Artist]:
    """Return the legend of a picture of paths: only what is in view."""
    handles: list[Artist] = [floor.handle(name, **look) for name, look in zip(names, looks, strict=True)]
    handles.append(floor.handle("each second", marker=(3, 0, -90.0), markersize=8))
    handles += shapes.start_and_goal_handles() + walls.handles(walls.maps_of(runs))
    if any(not np.isfinite(run.arrival_time) for run in runs):
        handles.append(floor.handle("end, not arrived", marker="s", markersize=7))
    if any(inputs.contact_times(run).size for run in runs):
        handles.append(floor.handle("first contact", **floor.CONTACT))
    obstacles = next((run.scenario.obstacles for run in runs if run.scenario.obstacles), ())
    seen = _in_view(runs, limits)
    met = [index for index in seen if shapes.is_mobile(obstacles[index]) and any(_encounters(runs, index))]
    few = len(obstacles) <= shapes.MOST_COLORS
    regional = regions and any(not shapes.is_mobile(obstacles[index]) or (few and index in met) for index in seen)
    handles += shapes.obstacle_handles(obstacles, regions=regional, shown=seen)
    if met:
        closest: style.Properties = {"linestyle": "-", "linewidth": 0.8, "marker": "o"}
        handles.append(floor.handle("closest approach", markerfacecolor="none", markersize=9, **closest))
    return handles
