"""Robots that follow a reference: their paths, and the error over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plotting import floor, inputs, notes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

__all__ = ["tracking_errors", "tracking_paths"]

Groups = list[tuple[str, list[Trajectory]]]

MARGIN = 0.25  # m around the paths
ARROW = 0.22  # m, for the heading at the start
LEGEND_COLUMNS = 3
FLOOR = 1e-9  # m: errors below are rounding and leave the panel
REFERENCE_LOOK: style.Properties = {"color": style.PERSON_COLORS[0], "linewidth": 1.4, "linestyle": (0, (3, 3))}
BOUND_LOOK: style.Properties = {"color": style.CONTACT_COLOR, "linewidth": 1.2, "linestyle": (0, (5, 3))}


@notes.picture
def tracking_paths(
    runs: Trajectory | Sequence[Trajectory] | Sequence[Sequence[Trajectory]],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the paths of robots that follow references; arrows show the headings at the start.

    The paths of the references are dashed; one that stands is a cross.

    Parameters
    ----------
    runs : Trajectory or sequence of Trajectory or of such sequences
        The runs: one, a few of which each has a color, or groups with a color each.
    labels : sequence of str or None
        One name for each color; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If there is no run or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> circle = nav.tracking.CircleReference(center=(0.0, 0.0), radius=1.0, speed=0.5)
    >>> figure = plotting.robots.tracking_paths(nav.tracking.track(circle, position=(0.2, -0.4), heading=3.0))
    >>> figure.axes[0].get_xlabel()
    'x (m)'
    """
    groups = _groups(runs, labels)
    everyone = [run for _, members in groups for run in members]
    points: list[Any] = [part for run in everyone for part in (run.position, run.reference_position)]
    limits = inputs.view_limits(points, margin=MARGIN)
    figure, (axes,) = floor.panels(limits, entries=len(groups) + 2, legend_columns=LEGEND_COLUMNS, title=title)
    handles: list[Any] = []
    for index, (name, members) in enumerate(groups):
        for run in members:
            line = _draw_path(axes, run, style.run_look(index), thin=len(members) > 1)
        line.set_label(name)
        handles.append(line)
    handles.append(_draw_references(axes, everyone))
    handles.append(floor.handle("start", marker="o", markersize=4))
    return floor.finish(figure, handles, columns=LEGEND_COLUMNS)


@notes.picture
def tracking_errors(
    runs: Trajectory | Sequence[Trajectory] | Sequence[Sequence[Trajectory]],
    *,
    labels: Sequence[str] | None = None,
    rate: float | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the distance between robot and reference over time, on a logarithmic scale.

    Parameters
    ----------
    runs : Trajectory or sequence of Trajectory or of such sequences
        As for `tracking_paths`.
    labels : sequence of str or None
        One name for each color; numbered when ``None``.
    rate : float or None
        Rate in 1/s of an exponential that is drawn from the largest error on.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in s and m.

    Raises
    ------
    InvalidParameterError
        If there is no run, the number of labels is wrong or the rate is not positive.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> still = nav.tracking.LineReference(start=(0.0, 0.0))
    >>> run = nav.tracking.track(still, nav.tracking.ExponentialTracking(), position=(1.0, 0.5), goal=(0.0, 0.0))
    >>> plotting.robots.tracking_errors(run, rate=0.5).axes[0].get_yscale()
    'log'
    """
    groups = _groups(runs, labels)
    if rate is not None and not 0.0 < rate < math.inf:
        raise InvalidParameterError("rate", "be finite and positive", rate)
    figure, axes = style.one_panel(4.2, title=title)
    largest, least, last = FLOOR, math.inf, 0.0
    for index, (name, members) in enumerate(groups):
        look = _thinned(style.run_look(index), len(members) > 1)
        for number, run in enumerate(members):
            error = run.error
            shown: npt.NDArray[np.float64] = np.where(error > FLOOR, error, np.nan)
            axes.plot(run.time, shown, label=name if number == 0 else None, **look)
            largest = max(largest, float(error.max()))
            least = min(least, float(np.nanmin(shown, initial=largest)))
            last = max(last, float(run.time[-1]))
    if rate is not None:
        time = np.linspace(0.0, last, 2)
        axes.plot(time, largest * np.exp(-rate * time), label=f"rate {rate:g} 1/s", zorder=5, **BOUND_LOOK)
    axes.set_yscale("log")
    axes.set_ylim(0.5 * max(least, FLOOR), 2.0 * largest)
    axes.set_xlim(0.0, last)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("distance from the reference (m)")
    handles, _ = axes.get_legend_handles_labels()
    if len(handles) > 1 or labels is not None:
        style.legend_below(figure, handles, columns=LEGEND_COLUMNS)
    return figure


def _groups(runs: object, labels: Sequence[str] | None) -> Groups:
    """Return the runs by color, with the name of each."""
    rule = "be a Trajectory of `tracking.track`, a sequence of them or of such sequences"
    given = [runs] if isinstance(runs, Trajectory) else runs
    if isinstance(given, (str, bytes)) or not isinstance(given, Sequence):
        raise InvalidParameterError("runs", rule, Shown(type(runs).__name__))
    groups = [[member] if isinstance(member, Trajectory) else member for member in given]
    for index, group in enumerate(groups):
        if isinstance(group, (str, bytes)) or not isinstance(group, Sequence) or len(group) == 0:
            raise InvalidParameterError(
                f"runs[{index}]", "be a Trajectory of `tracking.track` or hold at least one", group
            )
        for member in group:
            if not isinstance(member, Trajectory) or member.tracking is None:
                raise InvalidParameterError(f"runs[{index}]", rule, _found(member))
    inputs.some("runs", groups, "Trajectory")
    names = inputs.checked_labels(labels, len(groups))
    return [(name, list(group)) for name, group in zip(names, groups, strict=True)]


def _found(value: object) -> Shown:
    return Shown("the run of a scenario" if isinstance(value, Trajectory) else type(value).__name__)


def _thinned(look: style.Properties, thin: bool) -> style.Properties:
    """Return the look of a run among many."""
    return {**look, "linewidth": 0.9, "alpha": 0.75, "linestyle": "-"} if thin else look


def _draw_path(axes: Axes, run: Trajectory, look: style.Properties, *, thin: bool) -> Line2D:
    """Draw a path and the heading at its start."""
    line = floor.line(axes, run.position, zorder=3, **_thinned(look, thin))
    (x, y), heading = run.position[0], run.heading[0]
    tip = (x + ARROW * math.cos(heading), y + ARROW * math.sin(heading))
    arrow = {"arrowstyle": "-|>", "color": look["color"], "linewidth": 1.3, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", xy=tip, xytext=(x, y), arrowprops=arrow, zorder=4)
    axes.plot([x], [y], "o", color=look["color"], markersize=3.5, zorder=4)
    return line


def _draw_references(axes: Axes, runs: Sequence[Trajectory]) -> Line2D:
    """Draw the path of every reference, or where it stands, and return one for the legend."""
    for run in runs:
        place = run.reference_position
        if np.ptp(place, axis=0).max() > 0.0:
            line = floor.line(axes, place, zorder=3.5, **REFERENCE_LOOK)
        else:
            (line,) = axes.plot(
                *place[0], "x", color=REFERENCE_LOOK["color"], markersize=9, markeredgewidth=2.4, zorder=5
            )
    line.set_label("reference")
    return line
