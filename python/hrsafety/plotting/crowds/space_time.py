"""Position along a direction over time: stop-and-go waves, queues, overtaking."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import pair
from hrsafety.errors import InvalidParameterError
from hrsafety.plotting import floor, inputs, notes, style
from hrsafety.plotting.axis_numbers import shown_number
from hrsafety.plotting.crowds import world_scenes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["space_time"]

HEIGHT = 4.6  # in
MOST_ROWS = 600  # instants of a line; more cannot be seen
AXES = {(1.0, 0.0): "x (m)", (0.0, 1.0): "y (m)"}
OTHER_WAY = "position along the direction (m)"


@notes.picture
def space_time(
    run: Trajectory,
    *,
    along: Sequence[float] = (1.0, 0.0),
    origin: Sequence[float] = (0.0, 0.0),
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw where everybody is along a direction over time, colored by speed: who stops is dark.

    Parameters
    ----------
    run : Trajectory
        What happened.
    along : sequence of float
        The direction; its length does not matter. Along an axis in which the world repeats itself the
        diagram does, too.
    origin : sequence of float
        Where the position is 0, in m.
    labels : sequence of str or None
        A name for each robot; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If the direction has no length, a number is not finite, or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.corridor(12, width=0.6, two_way=False, time_limit=10))
    >>> [axes.get_ylabel() for axes in plotting.crowds.space_time(run).axes]
    ['x (m)', 'speed (m/s)']
    """
    run = world_scenes.checked_crowd(run)
    names = inputs.checked_labels(labels, len(run.scenario.robots), stem="robot")
    given = np.array([shown_number("along", each) for each in pair("along", along)])
    length = float(np.hypot(*given))
    if length == 0.0:
        raise InvalidParameterError("along", "be a direction", tuple(given.tolist()))
    direction = given / length
    start = np.array([shown_number("origin", each) for each in pair("origin", origin)])
    period = _period(run, direction)
    figure, axes = style.one_panel(HEIGHT + 0.3 * bool(names), title=title)
    rows = np.unique(np.linspace(0, len(run.time) - 1, MOST_ROWS).astype(int))
    speed = np.hypot(run.obstacle_velocity[..., 0], run.obstacle_velocity[..., 1])
    lines = _draw_people(axes, run.time[rows], (run.obstacle_position[rows] - start) @ direction, speed[rows], period)
    if lines is not None:
        figure.colorbar(lines, ax=axes, label="speed (m/s)", pad=0.01)
    handles = []
    for index, (name, look) in enumerate(zip(names, world_scenes.robot_looks(len(names)), strict=True)):
        place = (run.robot_position[rows, index] - start) @ direction
        # A white edge keeps robots apart from people.
        time, way = _broken(run.time[rows], place, period)
        axes.plot(time, way, color="white", linewidth=4.4, zorder=4.0)
        axes.plot(time, way, linewidth=2.4, zorder=5.0, **look)
        if index == 0 or len(names) <= world_scenes.MOST_ROBOTS:
            one = name if len(names) <= world_scenes.MOST_ROBOTS else "robot"
            handles.append(floor.handle(one, linewidth=2.4, **look))
    axes.set_xlabel("time (s)")
    axes.set_ylabel(OTHER_WAY if start.any() else AXES.get(tuple(direction.tolist()), OTHER_WAY))
    axes.set_xlim(float(run.time[0]), max(float(run.time[-1]), float(run.time[0]) + run.scenario.step))
    if period is not None:
        axes.set_ylim(0.0, period)
    if handles:
        style.legend_below(figure, handles, columns=floor.LEGEND_COLUMNS)
    return figure


def _period(run: Trajectory, direction: inputs.Array) -> float | None:
    """Return the length in m after which positions along a direction repeat themselves."""
    for size, part in zip(run.scenario.period, direction, strict=True):
        if size > 0.0 and abs(part) == 1.0:
            return float(size)
    return None


def _broken(time: inputs.Array, place: inputs.Array, period: float | None) -> tuple[inputs.Array, inputs.Array]:
    """Return a curve that begins again at 0 where the world repeats itself."""
    if period is None:
        return time, place
    inside = np.mod(place, period)
    with np.errstate(invalid="ignore"):
        jumps = np.flatnonzero(np.abs(np.diff(inside)) > 0.5 * period)
    return np.insert(time, jumps + 1, np.nan), np.insert(inside, jumps + 1, np.nan)


def _draw_people(
    axes: Axes, time: inputs.Array, place: inputs.Array, speed: inputs.Array, period: float | None
) -> Any | None:
    """Draw a line for each person, each piece in the color of the speed; return them."""
    from matplotlib.collections import LineCollection

    inside = place if period is None else np.mod(place, period)
    before, after = inside[:-1], inside[1:]
    known = np.isfinite(before) & np.isfinite(after)
    if period is not None:
        known &= np.abs(after - before) <= 0.5 * period
    if not known.any():
        return None
    row, person = np.nonzero(known)
    starts = np.stack([time[row], before[row, person]], axis=1)
    ends = np.stack([time[row + 1], after[row, person]], axis=1)
    lines = LineCollection(np.stack([starts, ends], axis=1).tolist(), linewidths=1.3, zorder=2.5, capstyle="round")
    lines.set_array(speed[row, person])
    lines.set_clim(0.0, float(np.nanmax(speed)) or 1.0)
    axes.add_collection(lines)
    axes.autoscale_view()
    return lines
