"""Pictures of sweeps over many axes: points over each, lines across all."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import count
from hrsafety._bounds import MOST_DRAWN
from hrsafety.plotting import notes, style
from hrsafety.plotting.inputs import Array
from hrsafety.plotting.sweeps.lines import (
    MOST_CASES,
    by_case,
    drawn_column,
    ends,
    finite,
    label_axis,
    label_constant,
    panels_beside,
    varying_axes,
    without_value,
)
from hrsafety.sweep import Axis, SweepResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["sweep_parallel", "sweep_scatter"]

MOST_POINTS = 20_000
MOST_LINES = 400
DENSE = 2_000
"""More values of one case than this are shown as a density."""
HEXAGONS = 40


@notes.picture
def sweep_scatter(result: SweepResult, column: str, *, most: int = MOST_POINTS, title: str | None = None) -> Figure:
    """Draw a column of a sweep over each of its axes as points, a panel for each axis.

    Of one case with more than 2,000 values the panels show how many lie in each hexagon.

    Parameters
    ----------
    result : SweepResult
        Of any design.
    column : str
        A column of numbers.
    most : int
        About the most points of a panel, up to 1,000,000; longer results are drawn from by chance.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; values that are not finite are left out and counted.

    Raises
    ------
    InvalidParameterError
        If there is no such column of numbers, or no axis varies.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import impact, plotting, sweep
    >>> design = sweep.LatinHypercube([
    ...     sweep.Axis(name="foam_stiffness", low=5e3, high=60e3), sweep.Axis(name="foam_damping", low=0.0, high=150.0)
    ... ], 100)
    >>> study = sweep.ImpactStudy(
    ...     manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25}
    ... )
    >>> figure = plotting.sweep_scatter(sweep.run(design, study), "hic15")
    >>> [axes.get_xlabel() for axes in figure.axes]
    ['foam stiffness (N/m)', 'foam damping (N s/m)']
    """
    drawn, varying = drawn_column(result, column), varying_axes(result)
    points = _thinned(result, [*(axis.name for axis in varying), column], count("most", most, most=MOST_DRAWN))
    cases = by_case(result, points[column])
    columns = panels_beside(len(varying))
    rows = math.ceil(len(varying) / columns)
    figure = style.new_figure(0.5 + 3.0 * rows, title=title)
    grid = figure.subplots(rows, columns, squeeze=False, sharey=True)
    for axes in grid.flat[len(varying) :]:
        axes.set_visible(False)
    dense = len(cases) == 1 and np.count_nonzero(np.isfinite(points[column])) > DENSE
    blank = without_value([values for _, values in cases])
    size = 14.0 if points[column].size < 500 else 4.0
    for place, (axes, axis) in enumerate(zip(grid.flat, varying, strict=False)):
        for index, (name, values) in enumerate(cases):
            color = style.run_look(index)["color"]
            along = points[axis.name][:, 0]
            if dense:
                _draw_density(figure, axes, along, values, log=axis.scale == "log")
            else:
                axes.scatter(along, values, s=size, alpha=0.5, linewidths=0, color=color, label=name)
        label_axis(axes, axis, "x")
        if place % columns == 0:
            axes.set_ylabel(drawn.label + _part(points[column].size, len(result)) + blank)
            label_constant(axes.yaxis, points[column])
    if len(cases) > 1:
        handles, labels = grid[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=MOST_CASES, markerscale=18.0 / size)
    return figure


def _draw_density(figure: Figure, axes: Axes, along: Array, values: Array, *, log: bool) -> None:
    """Draw how many values lie in each hexagon of a panel."""
    known = np.isfinite(values)
    scale: Any = {"xscale": "log"} if log else {}
    look: style.Properties = {"gridsize": (HEXAGONS, HEXAGONS // 2), "bins": "log", "mincnt": 1, "linewidths": 0.1}
    drawn = axes.hexbin(along[known], values[known], cmap="viridis", **scale, **look)
    figure.colorbar(drawn, ax=axes, label="rows")


@notes.picture
def sweep_parallel(result: SweepResult, column: str, *, most: int = MOST_LINES, title: str | None = None) -> Figure:
    """Draw rows of a sweep as lines across parallel axes, colored by a column.

    Parameters
    ----------
    result : SweepResult
        Of any design.
    column : str
        A column of numbers.
    most : int
        About the most lines, up to 1,000,000; longer results are drawn from by chance.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture: each axis from its lowest to its highest value, large values of the column
        on top. Rows whose value is not finite are left out and counted; of several cases the mean counts.

    Raises
    ------
    InvalidParameterError
        If there is no such column of numbers, or no axis varies.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, scenarios, sweep
    >>> design = sweep.Sobol([
    ...     sweep.Axis(name="detour_gain", low=10.0, high=250.0), sweep.Axis(name="gain_ratio", low=0.2, high=0.8)
    ... ], 16)
    >>> result = sweep.run(design, sweep.NavigationStudy(scenarios=scenarios.configuration("c1")))
    >>> figure = plotting.sweep_parallel(result, "performance_total")
    >>> figure.axes[1].get_ylabel()
    'performance total'
    """
    from matplotlib.collections import LineCollection

    drawn, varying = drawn_column(result, column), varying_axes(result)
    number = count("most", most, most=MOST_DRAWN)
    points = _thinned(result, [*(axis.name for axis in varying), column], number * max(len(result.cases), 1))
    values = points[column].mean(axis=1)
    shown = np.flatnonzero(np.isfinite(values))
    order = shown[np.argsort(values[shown], kind="stable")]
    figure, axes = style.one_panel(4.6, title=title)
    heights = np.stack([_along(points[axis.name][order, 0], axis) for axis in varying], axis=1)
    places = np.arange(len(varying), dtype=np.float64)
    if len(varying) == 1:
        places, heights = np.array([0.0, 1.0]), np.repeat(heights, 2, axis=1)
    lines = LineCollection(
        [np.column_stack([places, row]) for row in heights], cmap="viridis", linewidths=1.0, alpha=0.7
    )
    lines.set_array(values[order])
    axes.add_collection(lines)
    for place, axis in enumerate(varying):
        low, high = ends(axis)
        axes.plot([place, place], [0.0, 1.0], color=style.NEUTRAL, linewidth=1.0)
        for height, value, side in ((-0.03, low, "top"), (1.03, high, "bottom")):
            axes.text(place, height, f"{value:g}", ha="center", va=side, fontsize=style.SMALL_FONT_SIZE)
    axes.set_xlim(-0.25, max(len(varying) - 1, 1) + 0.25)
    axes.set_ylim(-0.12, 1.12)
    axes.set_xticks(range(len(varying)), [_broken(axis.label) for axis in varying])
    axes.set_yticks([])
    axes.grid(visible=False)
    axes.spines[["left", "bottom"]].set_visible(False)
    of_cases = f", mean of {len(result.cases)} cases" if len(result.cases) > 1 else ""
    rows = len(result) // max(len(result.cases), 1)
    words = drawn.label + of_cases + _part(len(values), rows) + without_value([values])
    bar = figure.colorbar(lines, ax=axes, label=words)
    label_constant(bar, values)
    return figure


def _part(drawn: int, every: int) -> str:
    """Return the words that a picture shows some of all rows, whose extremes may be missing."""
    return "" if drawn >= every else f"\n{drawn:,} drawn of {every:,}"


def _thinned(result: SweepResult, names: list[str], most: int) -> dict[str, Array]:
    """Return rows of the design with all their cases, so that about so many values remain.

    Longer results are drawn from by chance, always the same way: every k-th row of a grid would
    show only some of its levels. They are read chunk by chunk.
    """
    cases = max(len(result.cases), 1)
    share = most / max(len(result), 1)
    chance = np.random.default_rng(0)
    parts: dict[str, list[Array]] = {name: [np.empty((0, cases))] for name in names}
    for chunk in result.chunks(names):
        rows = len(chunk[names[0]]) // cases
        kept = chance.random(rows) < share
        for name in names:
            parts[name].append(finite(chunk[name], name).reshape(rows, cases)[kept])
    return {name: np.concatenate(values) for name, values in parts.items()}


def _along(values: Array, axis: Axis) -> Array:
    """Return how far along an axis values lie, from 0 to 1."""
    low, high = ends(axis)
    if axis.scale == "log":
        return np.asarray(np.log(values / low) / math.log(high / low))
    return (values - low) / (high - low)


def _broken(label: str) -> str:
    """Return a label with its unit on a line of its own."""
    return label.replace(" (", "\n(")
