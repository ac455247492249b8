"""Distances and the Lyapunov function of runs over time."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.plotting import inputs, notes, shapes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["distances", "lyapunov"]

PANEL_HEIGHT = 2.3
HEADROOM = 1.12  # upper limit of distances over the largest distance that matters
OTHER_COLOR = "#C4C4C4"
EMPTY_LOG_LIMITS = (1.0, 10.0)
GOAL_LINE: style.Properties = {"color": style.RUN_COLORS[0], "linewidth": 2.0}


@notes.picture
def distances(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the distances to the goal and to each obstacle over time, one panel for each run.

    Dashed and dotted lines in the color of an obstacle are the radii r_2 and r_3 of its
    active and critical region; in grey where several obstacles share one. Of more than six
    obstacles only those whose active region was entered, and of them the six closest (between
    the surfaces), have a color and a name; the others are grey. Distances far beyond the goal and all regions leave
    the panel at the top.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        The runs.
    labels : sequence of str or None
        One name for each run; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, one axes for each run, in s and m.

    Raises
    ------
    InvalidParameterError
        If there is no run or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> plotting.distances(run).axes[0].get_ylabel()
    'distance (m)'
    """
    runs = inputs.checked_runs(trajectories)
    names = inputs.checked_labels(labels, len(runs))
    height = 0.6 + (PANEL_HEIGHT + 0.3) * len(runs) + (0.4 if len(runs) == 1 else 0.0)
    figure = style.new_figure(height, title=title)
    panels = figure.subplots(len(runs), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    tops, shown = [], None
    for axes, run in zip(panels, runs, strict=True):
        top, handles = _draw_distances(axes, run)
        tops.append(top)
        entries = [(handle.get_label(), handle.get_color()) for handle in handles]
        if entries != shown:  # said once as long as it holds
            axes.legend(handles=handles, **style.LEGEND_BESIDE)
            shown = entries
    for axes, run, name in zip(panels, runs, names, strict=True):
        axes.set_ylabel("distance (m)")
        if labels is not None or len(runs) > 1:
            axes.set_title(name, loc="left")
        _mark_arrival(axes, run, 0.006 * inputs.time_limit(runs))
    panels[0].set_ylim(0.0, max(tops))
    panels[0].set_xlim(0.0, inputs.time_limit(runs))
    panels[-1].set_xlabel("time (s)")
    return figure


def _draw_distances(axes: Axes, run: Trajectory) -> tuple[float, list[Line2D]]:
    """Draw the distances of one run; return the upper limit that suits it and its legend."""
    to_goal = np.hypot(*(np.asarray(run.scenario.goal) - run.position).T)
    obstacles = run.scenario.obstacles
    chosen = _closest(run)
    rest = [index for index in range(len(obstacles)) if index not in chosen]
    axes.plot(run.time, run.distance[:, rest], color=OTHER_COLOR, linewidth=1.0, zorder=2.0)
    handles = list(axes.plot(run.time, to_goal, label="goal, e", zorder=4.0, **GOAL_LINE))
    all_names = [look.name for look in shapes.looks(obstacles)]
    palette = [look.color for look in shapes.looks([obstacles[index] for index in chosen])]
    for index, color in zip(chosen, palette, strict=True):
        line = axes.plot(run.time, run.distance[:, index], color=color, label=f"{all_names[index]}, d", zorder=3.0)
        handles += line
        _mark_contact(axes, run, float(run.contact_time[index]), run.distance[:, index])
    _mark_contact(axes, run, run.map_contact_time, to_goal)
    radii = [shapes.region_radii(obstacles[index]) for index in chosen]
    _draw_radii(axes, radii, palette)
    handles += _more_handles(run, rest=bool(rest), radii=bool(radii))
    return HEADROOM * max([float(to_goal.max()), *(active for active, _ in radii)]), handles


def _mark_contact(axes: Axes, run: Trajectory, instant: float, values: inputs.Array) -> None:
    """Mark a first contact on a curve, if there was one."""
    if math.isfinite(instant):
        row = inputs.row_at(run, instant)
        cross: style.Properties = {"marker": "X", "color": style.CONTACT_COLOR, "markersize": 10}
        axes.plot(run.time[row], values[row], linestyle="none", zorder=6.0, markeredgecolor="white", **cross)


def _closest(run: Trajectory) -> list[int]:
    """Return which obstacles get a color: all of a few, else the closest whose active region was entered."""
    obstacles = run.scenario.obstacles
    met = [index for index, least in enumerate(run.min_distance) if np.isfinite(least)]
    if len(obstacles) > shapes.MOST_COLORS:
        met = [index for index in met if run.min_distance[index] < shapes.region_radii(obstacles[index])[0]]
    return sorted(sorted(met, key=lambda index: float(run.min_clearance[index]))[: shapes.MOST_COLORS])


def _draw_radii(axes: Axes, radii: Sequence[tuple[float, float]], colors: Sequence[str]) -> None:
    """Draw radii of regions as horizontal lines, each radius once."""
    for which, dashes in ((0, "--"), (1, ":")):
        values = [pair[which] for pair in radii]
        shared = Counter(values)
        for value in shared:
            color = colors[values.index(value)] if shared[value] == 1 else style.NEUTRAL
            axes.axhline(value, color=color, linestyle=dashes, linewidth=1.1, zorder=1.5)


def _more_handles(run: Trajectory, *, rest: bool, radii: bool) -> list[Line2D]:
    """Return legend entries for what has no line of its own name."""
    from matplotlib.lines import Line2D

    handles: list[Line2D] = []
    if rest:
        handles.append(Line2D([], [], color=OTHER_COLOR, linewidth=1.0, label="others, d"))
    if radii:
        handles.append(Line2D([], [], color=style.NEUTRAL, linestyle="--", linewidth=1.1, label="active, $r_2$"))
        handles.append(Line2D([], [], color=style.NEUTRAL, linestyle=":", linewidth=1.1, label="critical, $r_3$"))
    if inputs.contact_times(run).size:
        cross: style.Properties = {"marker": "X", "color": style.CONTACT_COLOR, "markersize": 9, "linestyle": "none"}
        handles.append(Line2D([], [], label="first contact", **cross))
    return handles


def _mark_arrival(axes: Axes, run: Trajectory, gap: float) -> None:
    """Mark the instant of arrival, if there is one, with its time a gap in s before it."""
    if np.isfinite(run.arrival_time):
        touched = run.outcome == "collided"
        color = style.CONTACT_COLOR if touched else style.GOAL_COLOR
        axes.axvline(run.arrival_time, color=color, linewidth=1.2, zorder=1.6)
        look: style.Properties = {"color": color, "fontsize": style.SMALL_FONT_SIZE}
        look |= {
            "ha": "right",
            "va": "top",
            "bbox": {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.0},
        }
        text = f"arrival {run.arrival_time:.2f} s{', after a contact' if touched else ''}"
        axes.text(run.arrival_time - gap, 0.97, text, transform=axes.get_xaxis_transform(), zorder=5.0, **look)


@notes.picture
def lyapunov(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the Lyapunov function of runs over time on a logarithmic scale.

    Inside a critical region the function is not defined: the line has a gap there, and a
    strip below the curves in the color of the run shows when.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        The runs.
    labels : sequence of str or None
        One name for each run; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in s and N^2.

    Raises
    ------
    InvalidParameterError
        If there is no run or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> plotting.lyapunov(run).axes[0].get_yscale()
    'log'
    """
    from matplotlib.patches import Patch

    runs = inputs.checked_runs(trajectories, ["lyapunov"])
    names = inputs.checked_labels(labels, len(runs), stem="robot" if len(runs) == 1 else "run")
    figure, axes = style.one_panel(3.8, title=title)
    gaps = False
    for index, (run, name) in enumerate(zip(runs, names, strict=True)):
        look = style.run_look(index)
        axes.plot(run.time, run.lyapunov, drawstyle="steps-post", label=name, **look)
        inside = np.isnan(run.lyapunov)
        gaps |= bool(inside.any())
        strip: style.Properties = {
            "color": look["color"],
            "alpha": 0.5,
            "linewidth": 0.0,
            "transform": axes.get_xaxis_transform(),
        }
        low = 0.035 * index
        axes.fill_between(run.time, low, low + 0.03, where=inside.tolist(), step="post", **strip)
    if not any((run.lyapunov > 0.0).any() for run in runs):
        axes.set_ylim(*EMPTY_LOG_LIMITS)  # a logarithmic axis cannot choose limits for nothing
    axes.set_yscale("log")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("Lyapunov function V (N²)")
    axes.set_xlim(0.0, inputs.time_limit(runs))
    handles: list[Artist] = list(axes.get_lines())
    if gaps:
        handles.append(Patch(color=style.NEUTRAL, alpha=0.5, linewidth=0.0, label="in a critical region"))
    style.legend_below(figure, handles, columns=4)
    return figure
