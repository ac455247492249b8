"""Pictures of sweeps over one axis and over two."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import instance, word
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plotting import notes, style
from hrsafety.plotting.axis_numbers import along_axis, blank_where_infinite
from hrsafety.plotting.inputs import Array
from hrsafety.sweep import Axis, Column, Grid, SweepResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import YAxis
    from matplotlib.colorbar import Colorbar
    from matplotlib.figure import Figure

__all__ = ["sweep_lines", "sweep_map"]

MOST_CASES = 6
PANELS_BESIDE = 3
# Values that differ by a smaller share are one number, and the rest is rounding.
ALIKE = 1e-12


@notes.picture
def sweep_lines(result: SweepResult, column: str, *, title: str | None = None) -> Figure:
    """Draw a column of a sweep over its only axis, a line for each case.

    Parameters
    ----------
    result : SweepResult
        Of a design in which one axis has several values.
    column : str
        A column of numbers.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; values that are not finite leave a gap and are counted. Of more than six cases the mean is
        drawn.

    Raises
    ------
    InvalidParameterError
        If there is no such column of numbers, or several axes vary.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import impact, plotting, sweep
    >>> study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    >>> speeds = sweep.Grid([sweep.Axis(name="closing_speed", low=0.1, high=2.0, points=20)])
    >>> figure = plotting.sweep_lines(sweep.run(speeds, study), "peak_contact_force")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('closing speed (m/s)', 'peak contact force (N)')
    """
    drawn = drawn_column(result, column)
    (axis,) = varying_axes(result, 1)
    found = result.to_numpy([axis.name, column])
    along, values = (finite(found[name], name).reshape(-1, max(len(result.cases), 1)) for name in (axis.name, column))
    order = np.argsort(along[:, 0], kind="stable")
    figure, axes = style.one_panel(4.2, title=title)
    for index, (name, line) in enumerate(by_case(result, values)):
        marker = "o" if len(order) <= 30 else ""
        axes.plot(along[order, 0], line[order], marker=marker, ms=4, label=name, **style.run_look(index))
    if len(result.cases) > 1:
        figure.legend(loc="outside lower center", ncols=MOST_CASES)
    label_axis(axes, axis, "x")
    axes.set_ylabel(drawn.label + without_value([line for _, line in by_case(result, values)]))
    label_constant(axes.yaxis, values)
    return figure


@notes.picture
def sweep_map(result: SweepResult, column: str, *, title: str | None = None) -> Figure:
    """Draw a column of a grid over two axes as colors, a panel for each case.

    Parameters
    ----------
    result : SweepResult
        Of a complete grid in which two axes have several values.
    column : str
        A column of numbers.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; values that are not finite are left blank and counted. Of more than six cases the mean
        is drawn.

    Raises
    ------
    InvalidParameterError
        If there is no such column of numbers, or the result is of another kind.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import impact, plotting, sweep
    >>> design = sweep.Grid([
    ...     sweep.Axis(name="foam_stiffness", low=5e3, high=60e3, points=12),
    ...     sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=8),
    ... ])
    >>> study = sweep.ImpactStudy(
    ...     manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25}
    ... )
    >>> figure = plotting.sweep_map(sweep.run(design, study), "peak_head_acceleration_g")
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('foam stiffness (N/m)', 'foam damping (N s/m)')
    """
    drawn = drawn_column(result, column)
    if not isinstance(result.design, Grid) or not result.complete:
        raise InvalidParameterError("result", "be a complete grid", result)
    first, second = varying_axes(result, 2)
    across, up = first.levels(), second.levels()
    panels = by_case(result, finite(result[column], column).reshape(len(across), len(up), -1))
    shown = np.concatenate([panel[np.isfinite(panel)] for _, panel in panels])
    low, high = (float(shown.min()), float(shown.max())) if len(shown) else (0.0, 1.0)
    columns = panels_beside(len(panels))
    rows = math.ceil(len(panels) / columns)
    figure = style.new_figure(0.6 + rows * (4.4 if columns == 1 else 3.0), title=title)
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    right, top = np.argsort(across), np.argsort(up)
    for axes, (name, panel) in zip(grid.flat, panels, strict=False):
        colors = axes.pcolormesh(
            across[right], up[top], panel[np.ix_(right, top)].T, shading="nearest", vmin=low, vmax=high, rasterized=True
        )
        axes.grid(visible=False)
        axes.set_title(name)
        label_axis(axes, first, "x")
        label_axis(axes, second, "y")
    for place, axes in enumerate(grid.flat[: len(panels)]):
        axes.label_outer()
        if place + columns >= len(panels):
            axes.xaxis.set_tick_params(labelbottom=True)
            axes.set_xlabel(first.label)
    label_constant(
        figure.colorbar(colors, ax=grid, label=drawn.label + without_value([panel for _, panel in panels])), shown
    )
    return figure


# ---- parts ------------------------------------------------------------------------------------------


def drawn_column(result: SweepResult, column: str) -> Column:
    """Return the column to draw."""
    instance("result", result, SweepResult)
    numbers = {each.name: each for each in result.found if each.kind != "word"}
    return numbers[word("column", column, tuple(numbers))]


def varying_axes(result: SweepResult, number: int | None = None) -> list[Axis]:
    """Return the axes with more than one value, a certain number of them."""
    varying = [axis for axis in result.axes if axis.values is None or len(axis.values) > 1]
    if not varying or number not in (None, len(varying)):
        least = "at least one axis" if number is None else ("one axis" if number == 1 else f"{number} axes")
        remedy = "draw sweep_scatter or sweep_parallel, which show any number of axes" if varying else None
        found = Shown(", ".join(axis.name for axis in varying) or "none")
        raise InvalidParameterError("result", f"vary {least}", found, remedy)
    for axis in varying:
        along_axis(f"axis {axis.name!r}", ends(axis), rising=False)
    return varying


def by_case(result: SweepResult, values: Array) -> list[tuple[str, Array]]:
    """Return the values of each case by name, or their mean if there are too many cases."""
    if len(result.cases) > MOST_CASES:
        return [(f"mean of {len(result.cases)} cases", values.mean(axis=-1))]
    return [(name, values[..., index]) for index, name in enumerate(result.cases or ("",))]


def finite(values: Array, name: str) -> Array:
    """Return values of a column as numbers, NaN where they are not finite; too large ones are refused."""
    return blank_where_infinite(f"column {name!r}", values)


def without_value(drawn: Sequence[Array]) -> str:
    """Return the words for how many of the values of a picture are left blank, empty if none are."""
    missing = sum(int(np.count_nonzero(~np.isfinite(values))) for values in drawn)
    return f"\n{missing:,} of {sum(values.size for values in drawn):,} without value" if missing else ""


def panels_beside(panels: int) -> int:
    """Return how many panels stand beside each other: rows are filled evenly."""
    return 2 if panels == 4 else min(panels, PANELS_BESIDE)


def ends(axis: Axis) -> tuple[float, float]:
    """Return the lowest and highest value of an axis."""
    if axis.values is not None:
        return min(axis.values), max(axis.values)
    return float(axis.low or 0.0), float(axis.high or 0.0)


def label_constant(scale: YAxis | Colorbar, values: Array) -> None:
    """Give a scale of values that are all the same this one number: others would be digits that nothing has."""
    known = values[np.isfinite(values)]
    if known.size and np.ptp(known) <= ALIKE * np.abs(known).max():
        value = float(known.flat[0])
        scale.set_ticks([value], labels=[f"{value + 0.0:g}"])


def label_axis(axes: Axes, axis: Axis, which: str) -> None:
    """Give one direction of axes the label and the scale of an axis of the design."""
    set_label = axes.set_xlabel if which == "x" else axes.set_ylabel
    set_label(axis.label)
    if axis.scale != "log":
        return
    low, high = ends(axis)
    ticks, labels = style.log_ticks(low, high)
    if which == "x":
        axes.set_xscale("log")
        axes.set_xticks(ticks, labels=labels)
    else:
        axes.set_yscale("log")
        axes.set_yticks(ticks, labels=labels)
    axes.minorticks_off()
