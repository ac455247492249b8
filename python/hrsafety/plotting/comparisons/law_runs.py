"""Several laws in one scenario: their paths, distances and instants side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import vector
from hrsafety._bounds import MOST_INSTANTS
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plotting import floor, inputs, labels, notes, shapes, style
from hrsafety.plotting.comparisons import law_looks
from hrsafety.plotting.comparisons.law_looks import Runs
from hrsafety.plotting.runs.sequences import COLUMNS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

__all__ = ["comparison_distances", "comparison_paths", "comparison_sequence"]

Rows = npt.NDArray[np.int64]

INSTANT_STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)  # s
MOST_PLACES = 6  # places at which one moving obstacle is drawn
BEYOND_MEDIAN = 2.0  # the time axis ends here, in medians of the durations
BEYOND_REGION = 1.25  # the axis of distances ends here, in reaches of the largest region


@notes.picture
def comparison_paths(
    runs: Mapping[str, Trajectory], *, regions: bool = False, view: str = "scene", title: str | None = None
) -> Figure:
    """Draw the paths of several laws through one scenario.

    Each kind of law has its color; planners are dashed, and a second law of a kind has another
    line style. A triangle on a path points in the direction of motion each second, a square is
    the end of a run without arrival, a cross the first contact with an obstacle. Moving
    obstacles share one color, standing ones another. A moving obstacle is drawn at equal steps
    of time, with the time on it; of more than six obstacles each is drawn once.

    Parameters
    ----------
    runs : mapping of str to Trajectory
        Runs by the names of their laws, all of the same scenario.
    regions : bool
        Whether active and critical regions of stationary obstacles are drawn.
    view : {"scene", "paths"}
        Whether everything that stands is in view, or only the paths and what is near them.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If there is no run, or the runs belong to different scenarios.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> scene = scenarios.configuration("c3")
    >>> laws = {"field": nav.VirtualForceField(), "Masoud": nav.Masoud()}
    >>> figure = plotting.comparison_paths({name: nav.simulate(scene, law) for name, law in laws.items()})
    >>> figure.axes[0].get_xlabel()
    'x (m)'
    """
    given = law_looks.checked_runs(runs)
    looks = law_looks.looks_of(given)
    scenario = law_looks.longest(given).scenario
    limits = law_looks.limits_of(given, whole=inputs.checked_view(view))
    marks = [floor.handle("each second", marker=(3, 0, -90.0), markersize=8), *law_looks.event_handles(given)]
    handles = [*law_looks.law_handles(looks), *marks, *law_looks.scene_handles(given, regions=regions)]
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=title)
    named: list[Annotation] = []
    for index, obstacle in enumerate(scenario.obstacles):
        if shapes.is_mobile(obstacle):
            named += _draw_places(axes, given, index, limits)
        else:
            color = law_looks.obstacle_color(obstacle)
            shapes.add_obstacle(axes, obstacle, shapes.center(obstacle), color, regions=regions)
    for name, run in given.items():
        floor.events(axes, run, looks[name])
    shapes.add_start_and_goal(axes, scenario)
    return floor.finish(figure, handles, runs=given.values(), named=named)


@notes.picture
def comparison_distances(
    runs: Mapping[str, Trajectory], *, obstacle: int | None = None, title: str | None = None
) -> Figure:
    """Draw the distance of the surfaces of robot and obstacles over time, one line for each law.

    A star is the arrival, a cross the first contact. Lines of runs that last much longer than
    the others leave the panel on the right, distances far beyond all regions at the top.

    Parameters
    ----------
    runs : mapping of str to Trajectory
        Runs by the names of their laws, all of the same scenario.
    obstacle : int or None
        Index of an obstacle of the scenario; the nearest one of each instant when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in s and m.

    Raises
    ------
    InvalidParameterError
        If there is no run or no such obstacle, or the runs belong to different scenarios.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> scene = scenarios.configuration("c2")
    >>> laws = {"field": nav.VirtualForceField(), "Masoud": nav.Masoud()}
    >>> runs = {name: nav.simulate(scene, law) for name, law in laws.items()}
    >>> plotting.comparison_distances(runs).axes[0].get_ylabel()
    'distance of the surfaces (m)'
    """
    given = law_looks.checked_runs(runs)
    chosen = _checked_obstacle(given, obstacle)
    looks = law_looks.looks_of(given)
    figure, axes = style.one_panel(4.2, title=title)
    axes.axhspan(-10.0, 0.0, color=style.CONTACT_COLOR, alpha=0.07, zorder=0.5)
    axes.axhline(0.0, color=style.CONTACT_COLOR, linewidth=1.2, zorder=1.5)
    lowest, latest, top = 0.0, 0.0, _highest_shown(given, chosen)
    arrivals: list[float] = []  # in view
    for name, run in given.items():
        nearest = np.fmin.reduce(run.distance[:, chosen] - _radii(run)[chosen], axis=1)
        _draw_nearest(axes, run, nearest, chosen, looks[name])
        lowest = min(lowest, float(np.fmin.reduce(nearest)))
        latest = max([latest, *run.time[nearest <= top][-1:]])
        if nearest[-1] <= top:
            arrivals.append(run.arrival_time)
    handles = law_looks.law_handles(looks)
    latest = min(latest + 0.02 * latest, _latest_shown(given))
    if any(arrival <= latest for arrival in arrivals):
        handles.append(floor.handle("arrival", marker="*", markersize=12))
    if any(np.isfinite(run.contact_time[chosen]).any() for run in given.values()):
        handles.append(law_looks.cross_handle())
    axes.set_xlim(0.0, latest if latest > 0.0 else inputs.time_limit(list(given.values())))
    axes.set_ylim(1.15 * lowest - 0.05, top)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("distance of the surfaces (m)")
    axes.legend(handles=handles, **style.LEGEND_BESIDE)
    return figure


@notes.picture
def comparison_sequence(
    runs: Mapping[str, Trajectory], times: Sequence[float], *, view: str = "scene", title: str | None = None
) -> Figure:
    """Draw the robots of several laws at chosen instants, one panel for each instant.

    Every panel shows the obstacles and, for each law, the disc of the robot and its path so
    far. The arrow at a moving obstacle is its way of one second. A robot whose run has ended
    stays at its end; a cross marks a contact that has happened.

    Parameters
    ----------
    runs : mapping of str to Trajectory
        Runs by the names of their laws, all of the same scenario.
    times : sequence of float
        Instants in s, from 1 to 24 of them. The nearest row of each run is drawn.
    view : {"scene", "paths"}
        Whether everything that stands is in view, or only the paths and what is near them.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, one axes for each instant, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If there is no run, the runs belong to different scenarios, or an instant is not between
        the begin and the end of the longest run.
    ShapeError
        If the instants are not a sequence of numbers.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> scene = scenarios.configuration("unpredictable_human")
    >>> laws = {"field": nav.VirtualForceField(), "velocity obstacles": nav.VelocityObstacle()}
    >>> runs = {name: nav.simulate(scene, law) for name, law in laws.items()}
    >>> [axes.get_title() for axes in plotting.comparison_sequence(runs, [1.0, 2.5]).axes]
    ['t = 1.00 s', 't = 2.50 s']
    """
    given = law_looks.checked_runs(runs)
    chosen = _checked_times(given, times)
    looks = law_looks.looks_of(given)
    limits = law_looks.limits_of(given, whole=inputs.checked_view(view), least_ratio=0.75)
    handles = [
        *law_looks.law_handles(looks, marker="o"),
        *law_looks.event_handles(given, ends=False, until=max(chosen)),
    ]
    handles += law_looks.scene_handles(given, regions=False)
    titles = [f"t = {instant:.2f} s" for instant in chosen]
    figure, panels = floor.panels(limits, titles=titles, columns=COLUMNS, entries=len(handles), title=title)
    for axes, instant in zip(panels, chosen, strict=True):
        _draw_instant(axes, given, looks, instant)
    return floor.finish(figure, handles, runs=given.values())


def _draw_nearest(
    axes: Axes, run: Trajectory, nearest: inputs.Array, chosen: Sequence[int], look: style.Properties
) -> None:
    """Draw the distance of one run, with its first contact and its arrival."""
    axes.plot(run.time, nearest, zorder=4.0, **look)
    first = float(np.fmin.reduce(run.contact_time[list(chosen)]))
    if np.isfinite(first):
        row = inputs.row_at(run, first)
        axes.plot(run.time[row], nearest[row], zorder=6.0, **law_looks.CROSS)
    if np.isfinite(run.arrival_time):
        star: style.Properties = {"color": look["color"], "markeredgecolor": "white", "zorder": 5.0}
        axes.plot(run.time[-1], nearest[-1], "*", markersize=12, **star)


def _checked_obstacle(runs: Runs, obstacle: int | None) -> list[int]:
    """Return the indices of the obstacles that count."""
    number = len(law_looks.longest(runs).scenario.obstacles)
    if number == 0:
        raise InvalidParameterError("runs", "be runs among obstacles", Shown("a scenario without obstacles"))
    if obstacle is None:
        return list(range(number))
    whole = isinstance(obstacle, (int, np.integer)) and not isinstance(obstacle, bool)
    if not whole or not 0 <= obstacle < number:
        raise InvalidParameterError("obstacle", f"be None or an index from 0 to {number - 1}", obstacle)
    return [int(obstacle)]


def _checked_times(runs: Runs, times: Sequence[float]) -> list[float]:
    """Return the instants in s."""
    chosen = vector("times", times).tolist()
    if not 1 <= len(chosen) <= MOST_INSTANTS:
        raise InvalidParameterError("times", f"be from 1 to {MOST_INSTANTS} instants in s", times)
    end = float(law_looks.longest(runs).time[-1])
    for index, instant in enumerate(chosen):
        if not 0.0 <= instant <= end:
            raise InvalidParameterError(f"times[{index}]", f"be from 0 to the last end at {end:g} s", instant)
    return [float(instant) for instant in chosen]


def _radii(run: Trajectory) -> inputs.Array:
    """Return what the distances d hold of robot and obstacles, in m."""
    robot = run.scenario.robot.radius
    return np.array([robot + getattr(obstacle, "radius", 0.0) for obstacle in run.scenario.obstacles])


def _latest_shown(runs: Runs) -> float:
    """Return where the time axis ends, in s."""
    return BEYOND_MEDIAN * float(np.median([run.time[-1] for run in runs.values()]))


def _highest_shown(runs: Runs, chosen: Sequence[int]) -> float:
    """Return where the axis of distances ends, in m."""
    run = law_looks.longest(runs)
    active = np.array([shapes.region_radii(run.scenario.obstacles[index])[0] for index in chosen])
    return BEYOND_REGION * float((active - _radii(run)[chosen]).max()) + 0.3


def _draw_places(axes: Axes, runs: Runs, index: int, limits: style.Limits) -> list[Annotation]:
    """Draw the way of a moving obstacle, and the obstacle while all of it is in view; return labels of times."""
    run = law_looks.longest(runs)
    end = max((other.arrival_time for other in runs.values() if np.isfinite(other.arrival_time)), default=np.inf)
    obstacle, place = run.scenario.obstacles[index], run.obstacle_position[:, index]
    color, radius = law_looks.obstacle_color(obstacle), float(getattr(obstacle, "radius", 0.0))
    shown = np.flatnonzero(np.isfinite(place).all(axis=1) & (run.time <= end))
    axes.plot(place[shown, 0], place[shown, 1], ":", color=color, linewidth=1.4, zorder=2.5)
    low, high = np.array(limits).T
    seen = shown[((place[shown] - radius > low) & (place[shown] + radius < high)).all(axis=1)]
    rows = _chosen_rows(run.time, place, seen, radius)
    if len(run.scenario.obstacles) > shapes.MOST_COLORS:
        rows = rows[len(rows) // 2 :][:1]
    named = []
    for row in rows:
        faint: style.Properties = {"alpha": 0.25, "edgecolor": color, "linewidth": 1.0, "zorder": 2.6}
        shapes.add(axes, [shapes.body(obstacle, place[row], facecolor=color, **faint)])
        named.append(labels.label(axes, f"{run.time[row]:g} s", tuple(place[row]), color=color))
    return named


def _chosen_rows(time: inputs.Array, place: inputs.Array, seen: Rows, radius: float) -> list[int]:
    """Return the rows at which a moving obstacle is drawn: equal steps of time, none over the one before."""
    found: list[int] = []
    if len(seen) == 0:
        return found
    first, last = float(time[seen[0]]), float(time[seen[-1]])
    for step in INSTANT_STEPS:
        found = []
        for instant in np.arange(np.ceil(first / step - 1e-9) * step, last + 1e-9, step):
            row = int(seen[np.argmin(np.abs(time[seen] - instant))])
            if not found or np.hypot(*(place[row] - place[found[-1]])) > radius:
                found.append(row)
        if len(found) <= MOST_PLACES:
            break
    return found[:MOST_PLACES]


def _draw_instant(axes: Axes, runs: Runs, looks: Mapping[str, style.Properties], instant: float) -> None:
    """Draw everything that is there at one instant."""
    run = law_looks.longest(runs)
    row = inputs.row_at(run, instant)
    scenario = run.scenario
    for index, obstacle in enumerate(scenario.obstacles):
        place = run.obstacle_position[row, index]
        shapes.add_obstacle(axes, obstacle, place, law_looks.obstacle_color(obstacle), regions=False)
        if shapes.is_mobile(obstacle):
            floor.velocity(axes, place, floor.obstacle_velocity(run, row, index))
    for name, other in runs.items():
        here = inputs.row_at(other, instant)
        path = other.position[: here + 1]
        floor.line(axes, path, zorder=3.8, **(looks[name] | {"linewidth": 1.2}))
        shapes.add_robot(axes, scenario, path[-1], looks[name]["color"], filled=False)
        axes.plot(*path[-1], "o", color=looks[name]["color"], markersize=3.5, zorder=4.2)
        touches = inputs.contact_times(other)
        for touch in touches[touches <= instant]:
            axes.plot(*other.position[inputs.row_at(other, float(touch))], zorder=7.0, **law_looks.CROSS)
    shapes.add_start_and_goal(axes, scenario)
