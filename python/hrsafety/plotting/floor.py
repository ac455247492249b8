"""The floor seen from above: figures with panels of equal scale, paths, robots at a time, velocities.

Every picture of paths is made of these: runs through scenes, laws side by side, instants, robots as built, robots that
follow a reference or a sound, and robots within a skirt of sensors.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety.plotting import inputs, labels, notes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.text import Annotation

    from hrsafety.navigation.trajectory import Trajectory

__all__ = [
    "CONTACT",
    "FLASH",
    "FLASH_TIME",
    "disc",
    "events",
    "finish",
    "handle",
    "line",
    "obstacle_velocity",
    "panels",
    "velocity",
]

LEGEND_COLUMNS = 4
LEAST_SPEED = 0.02  # m/s, below which an arrow or a marker of direction would point anywhere
SECOND = 1.0
CONTACT: style.Properties = {
    "marker": "X",
    "markersize": 11,
    "color": style.CONTACT_COLOR,
    "markeredgecolor": "white",
    "linestyle": "none",
}

FLASH: style.Properties = {
    **{"marker": "o", "markersize": 34, "markerfacecolor": "none", "linestyle": "none"},
    **{"markeredgecolor": style.CONTACT_COLOR, "markeredgewidth": 2.5},
}
FLASH_TIME = 0.6  # s for which an animation rings a contact


def panels(
    limits: style.Limits,
    *,
    titles: Sequence[str] = ("",),
    columns: int = 1,
    entries: int,
    legend_columns: int = LEGEND_COLUMNS,
    title: str | None = None,
    compressed: bool = True,
) -> tuple[Figure, list[Axes]]:
    """Return a figure and one axes for each title, with equal scales in m and labels at its edges only.

    Parameters
    ----------
    limits : ((float, float), (float, float))
        What all panels show, in m.
    titles : sequence of str
        Above the panels.
    columns : int
        Most panels side by side.
    entries, legend_columns : int
        Entries of the legend that will stand below, and how many of them side by side.
    title : str or None
        Title of the figure.
    compressed : bool
        Whether panels move together where equal scales leave room between them; not below long titles.

    Returns
    -------
    figure : matplotlib.figure.Figure
        Of a height at which the panels fill its width.
    axes : list of matplotlib.axes.Axes
        One for each title.
    """
    columns = min(columns, len(titles))
    rows = math.ceil(len(titles) / columns)
    legend_rows, titled = math.ceil(entries / legend_columns), title is not None
    height = style.scene_height(limits, rows=rows, columns=columns, legend_rows=legend_rows, titled=titled)
    figure = style.new_figure(height, title=title, compressed=compressed)
    grid = list(figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True).flat)
    for number, axes in enumerate(grid):
        if number >= len(titles):
            axes.remove()
            continue
        style.frame_scene(axes, limits)
        axes.label_outer()
        if number + columns >= len(titles):  # nothing below it
            axes.set_xlabel("x (m)")
            axes.tick_params(labelbottom=True)
        if titles[number]:
            long: style.Properties = {"fontsize": style.SMALL_FONT_SIZE} if "\n" in titles[number] else {}
            axes.set_title(titles[number], **long)
    return figure, grid[: len(titles)]


def finish(
    figure: Figure,
    handles: Sequence[Artist],
    *,
    columns: int = LEGEND_COLUMNS,
    runs: Iterable[object] = (),
    named: Sequence[Annotation] = (),
) -> Figure:
    """Put the legend and the warnings of runs below all panels, and labels where they cover nothing.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Drawn.
    handles : sequence of matplotlib.artist.Artist
        Entries of the legend.
    columns : int
        Entries side by side.
    runs : iterable
        Results whose warnings are written.
    named : sequence of matplotlib.text.Annotation
        Labels of places.

    Returns
    -------
    matplotlib.figure.Figure
        The same figure.
    """
    style.legend_below(figure, handles, columns=columns)
    notes.add_warnings(figure, *runs)
    labels.clear_labels(figure, list(named))
    return figure


def handle(label: str, **look: object) -> Line2D:
    """Return an entry of a legend that no line stands for; a marker alone unless a line style is given."""
    from matplotlib.lines import Line2D

    given: style.Properties = {"color": style.NEUTRAL, "linestyle": "none"} | look
    return Line2D([], [], label=label, **given)


def line(axes: Axes, points: npt.ArrayLike, *, zorder: float, **look: object) -> Line2D:
    """Draw a path through points, shape (n, 2) in m."""
    given: style.Properties = dict(look)
    (drawn,) = axes.plot(*np.asarray(points, dtype=np.float64).T, zorder=zorder, **given)
    return drawn


def disc(axes: Axes, place: npt.ArrayLike, radius: float, color: str, *, strength: float = 1.0, face: float) -> None:
    """Draw a robot at one time: its edge as strong as given, its face by a share of that."""
    from matplotlib.patches import Circle

    x, y = np.asarray(place, dtype=np.float64)
    axes.add_patch(Circle((x, y), radius, facecolor=color, alpha=face * strength, linewidth=0))
    axes.add_patch(Circle((x, y), radius, fill=False, edgecolor=color, alpha=strength, zorder=4))


def events(axes: Axes, run: Trajectory, look: Mapping[str, object]) -> None:
    """Draw the path of a run with its direction each second, its first contacts and an end without arrival."""
    color = look["color"]
    line(axes, run.position, zorder=5.0, **look)
    for instant in np.arange(SECOND, run.time[-1], SECOND):
        row = inputs.row_at(run, float(instant))
        towards = run.velocity[row]
        if np.hypot(*towards) >= LEAST_SPEED:
            angle = math.degrees(math.atan2(towards[1], towards[0])) - 90.0
            shape: style.Properties = {"marker": (3, 0, angle), "markersize": 8.5, "linestyle": "none"}
            shape |= {"markeredgecolor": "white", "markeredgewidth": 0.7, "color": color}
            axes.plot(*run.position[row], zorder=5.5, **shape)
    for instant in inputs.contact_times(run):
        axes.plot(*run.position[inputs.row_at(run, float(instant))], zorder=7.0, **CONTACT)
    if not np.isfinite(run.arrival_time):
        end: style.Properties = {"markersize": 7, "color": color, "markeredgecolor": "white"}
        axes.plot(*run.position[-1], "s", zorder=5.6, **end)


def velocity(axes: Axes, place: inputs.Array, towards: inputs.Array) -> None:
    """Draw the way of one second as an arrow."""
    from matplotlib.patches import FancyArrowPatch

    if np.hypot(*towards) > LEAST_SPEED:
        look: style.Properties = {"arrowstyle": "-|>", "mutation_scale": 11, "color": "black", "linewidth": 1.3}
        axes.add_patch(FancyArrowPatch(tuple(place), tuple(place + towards), zorder=7.0, shrinkA=0, shrinkB=0, **look))


def obstacle_velocity(run: Trajectory, row: int, index: int) -> inputs.Array:
    """Return the velocity of an obstacle in m/s by the difference to the next row, else to the row before.

    NaN where neither neighbor holds a position.
    """
    place = run.obstacle_position[:, index]
    for first, second in ((row, row + 1), (row - 1, row)):
        if first >= 0 and second < len(run.time) and np.isfinite(place[first : second + 1]).all():
            found: inputs.Array = (place[second] - place[first]) / (run.time[second] - run.time[first])
            return found
    return np.full(2, np.nan)
