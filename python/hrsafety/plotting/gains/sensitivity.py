"""Which gain matters, and how flat the performance is around the best gains."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import instance
from hrsafety.errors import ShapeError
from hrsafety.navigation.gains.changes import GainSensitivity
from hrsafety.navigation.gains.results import Flatness
from hrsafety.plotting import inputs, labels, notes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

__all__ = ["flatness", "gain_sensitivity"]

# Gain of a law: symbol and unit; others are shown by their name.
GAINS = {
    "attractive_gain": ("$K_1$", "N/m"),
    "repulsive_gain": ("$K_3$", "N/m"),
    "detour_gain": ("$K_5$", "N/m²"),
    "gain_ratio": ("$b$", "s"),
}
BEST_LOOK: style.Properties = {"marker": "*", "markersize": 13.0, "linestyle": "none", "zorder": 5.0}
MARKERS = ("D", "s", "^", "v", "P")
MARK_COLORS = ("#D55E00", "#CC79A7", "#E69F00", "#000000", "#56B4E9")
BAND_COLOR = "#009E73"
LINEAR_UP_TO = 2.0  # %: changes are spread logarithmically beyond
DEEPEST = 0.1  # share of the best performance below it that is in view
LARGE_SENSITIVITY = 5.0  # %
ROOM = 0.06  # free share of the axis at both ends


@notes.picture
def gain_sensitivity(sensitivity: GainSensitivity, *, title: str | None = None) -> Figure:
    r"""Draw the mean performance and the relative sensitivity over the change of each gain.

    The change has a logarithmic axis on both sides of a linear part up to 2 %, so that every
    row of a published table can be told apart. A change that costs more than a tenth of the
    performance, for example because a run ends in a contact, lies below the axis: an arrow
    with its value stands there.

    Parameters
    ----------
    sensitivity : GainSensitivity
        Result of `hrsafety.navigation.gain_sensitivity`.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels: mean H, and the relative sensitivity of it, both over the change in %.

    Raises
    ------
    InvalidParameterError
        If ``sensitivity`` is something else.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> places = [scenarios.configuration(name) for name in ("c1", "c3")]
    >>> table = nav.gain_sensitivity(places, nav.VirtualForceField(), (-10, 0, 10))
    >>> [axes.get_ylabel() for axes in plotting.gain_sensitivity(table).axes]
    ['mean H', 'relative sensitivity of mean H (%),\naxis logarithmic beyond 1 %']
    """
    found = instance("sensitivity", sensitivity, GainSensitivity)
    changes = np.asarray(found.changes_percent, dtype=np.float64)
    order = np.argsort(changes, kind="stable")
    figure = style.new_figure(6.4, title=title)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for index in range(len(found.gain_names)):
        look = style.run_look(index) | {"marker": "o", "markersize": 4.0}
        upper.plot(changes[order], found.mean_performance[index][order], label=_summary(found, index), **look)
        lower.plot(changes[order], 100.0 * np.abs(found.relative_sensitivity[index][order]), **look)
    _frame_changes(lower, changes[order])
    upper.set_ylim(*_view(np.ravel(found.mean_performance)))
    deep = _mark_deep(upper)
    upper.set_ylabel("mean H")
    uneven = _frame_sensitivity(lower)
    lower.set_ylabel("relative sensitivity of mean H (%)" + uneven)
    lower.set_xlabel(f"change of one gain (%); axis linear up to ±{LINEAR_UP_TO:g} %, logarithmic beyond")
    figure.legend(*upper.get_legend_handles_labels(), loc="outside lower center", ncols=2, columnspacing=1.4)
    figure.align_ylabels()
    labels.clear_labels(figure, deep)
    return figure


@notes.picture
def flatness(
    flatness: Flatness,
    *,
    marks: Mapping[str, tuple[Sequence[float], float]] | None = None,
    quantity: str = "mean H",
    title: str | None = None,
) -> Figure:
    """Draw the objective along each gain through the best set, with the band of near equals.

    Parameters
    ----------
    flatness : Flatness
        Result of ``GainSearch.flatness``.
    marks : mapping of str to (gains, float) or None
        Other gain sets, for example published ones, and the objective that each reaches, by
        name. They lie beside the drawn lines, because all their gains differ from the best.
    quantity : str
        Label of the objective, with unit.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each gain. What loses more than a tenth, or failed, is out of view.

    Raises
    ------
    InvalidParameterError
        If ``flatness`` is something else.
    ShapeError
        If a mark has another number of gains.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> search = nav.optimize_gains(
    ...     [scenarios.configuration("c1")], grid=(3, 3, 3, 3), refinements=0, survivors=5, local_starts=0
    ... )
    >>> figure = plotting.flatness(search.flatness(5), marks={"published": ((4.3, 20.3, 240.7, 0.68), 0.706)})
    >>> figure.axes[0].get_xlabel()
    '$K_1$ (N/m)'
    """
    found = instance("flatness", flatness, Flatness)
    names = found.gain_names
    others = _checked_marks(marks, len(names))
    rows = math.ceil(len(names) / 2)
    figure = style.new_figure(0.9 + 2.5 * rows, title=title)
    panels = figure.subplots(rows, 2, sharey=True, squeeze=False).ravel()
    for axes in panels[len(names) :]:
        axes.remove()
    marked = np.array([value for _, value in others.values()], dtype=np.float64)
    panels[0].set_ylim(*_view(np.concatenate([np.ravel(found.values), marked]), best=found.best_value))
    for index, (axes, name) in enumerate(zip(panels, names, strict=False)):
        _draw_line(axes, found, index)
        _draw_marks(axes, {label: (gains[index], value) for label, (gains, value) in others.items()})
        axes.set_xlabel(gain_label(name))
        axes.set_ylabel(quantity if index % 2 == 0 else "")
        low, high = float(found.gains[index].min()), float(found.gains[index].max())
        axes.set_xlim(*_widened(low, high))
    handles, texts = panels[0].get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=2, columnspacing=1.4)
    return figure


def symbol(name: str) -> str:
    """Return the symbol of a gain, or its name in words."""
    return GAINS[name][0] if name in GAINS else name.replace("_", " ")


def gain_label(name: str) -> str:
    """Return the axis label of a gain, with its unit where it is known."""
    return f"{GAINS[name][0]} ({GAINS[name][1]})" if name in GAINS else symbol(name)


def _widened(low: float, high: float) -> tuple[float, float]:
    """Return a range with some room at both ends; around a single value some range."""
    room = 0.03 * (high - low) if high > low else 0.1 * max(abs(high), 0.1)
    return low - room, high + room


def _view(values: inputs.Array, *, best: float | None = None) -> tuple[float, float]:
    """Return the limits of an axis that shows values down to a tenth below the best."""
    finite = values[np.isfinite(values)]
    if best is not None and math.isfinite(best):
        finite = np.append(finite, best)
    if len(finite) == 0:
        return 0.0, 1.0
    top = float(finite.max())
    bottom = float(finite[finite >= top - DEEPEST * abs(top)].min())
    room = ROOM * max(top - bottom, 1e-3 * max(abs(top), 1e-3))
    return bottom - room, top + room


def _summary(found: GainSensitivity, index: int) -> str:
    """Return a gain with its average and largest sensitivity."""
    average, largest = 100.0 * found.average_sensitivity()[index], 100.0 * found.largest_sensitivity()[index]
    if math.isnan(average):
        return symbol(found.gain_names[index])
    return f"{symbol(found.gain_names[index])}: {average:.2f} % on average, {largest:.2f} % at most"


def _frame_sensitivity(axes: Axes) -> str:
    """Give sensitivities in % an axis from zero, logarithmic beyond 1 % where some are large; return what to say."""
    top = axes.get_ylim()[1]
    if top > LARGE_SENSITIVITY:
        axes.set_yscale("symlog", linthresh=1.0, linscale=0.7)
        ticks = [tick for tick in (0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0) if tick <= top]
        axes.set_yticks(ticks, labels=[f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
    axes.set_ylim(0.0, top)
    return ",\naxis logarithmic beyond 1 %" if top > LARGE_SENSITIVITY else ""


def _mark_deep(axes: Axes) -> list[Annotation]:
    """Tell the values that lie below the axis: an arrow at its foot and the number, in rows."""
    bottom, top = axes.get_ylim()
    row = 0.07 * (top - bottom)
    deep = [line for line in axes.lines if np.nanmin(np.asarray(line.get_ydata(), dtype=np.float64)) < bottom]
    found = []
    for index, line in enumerate(deep):
        height = bottom - (len(deep) - index - 0.5) * row
        for x, y in zip(np.asarray(line.get_xdata()), np.asarray(line.get_ydata()), strict=True):
            if np.isfinite(y) and y < bottom:
                axes.plot([x], [height], marker="v", markersize=5.0, color=line.get_color(), linestyle="none")
                found.append(labels.label(axes, f"{y:.2f}", (float(x), height), color=line.get_color()))
    axes.set_ylim(bottom - len(deep) * row, top)
    return found


def _frame_changes(axes: Axes, changes: inputs.Array) -> None:
    """Give changes in % an axis that is linear near zero and logarithmic beyond."""
    axes.set_xscale("symlog", linthresh=LINEAR_UP_TO, linscale=0.6)
    axes.set_xticks(changes, labels=[f"{change:+g}" if change else "0" for change in changes])
    axes.minorticks_off()
    axes.tick_params(axis="x", labelsize=style.SMALL_FONT_SIZE)
    reach = 1.15 * max(float(np.abs(changes).max()), LINEAR_UP_TO)
    left = -reach if changes.min() < 0.0 else -LINEAR_UP_TO / 4.0
    axes.set_xlim(left, reach if changes.max() > 0.0 else LINEAR_UP_TO / 4.0)


def _checked_marks(marks: Any, count: int) -> dict[str, tuple[inputs.Array, float]]:
    """Return the marked gain sets as arrays with their objectives."""
    checked: dict[str, tuple[inputs.Array, float]] = {}
    for name, (gains, value) in (marks or {}).items():
        array: npt.NDArray[np.float64] = np.asarray(gains, dtype=np.float64)
        if array.shape != (count,):
            raise ShapeError(f"marks[{name!r}]", f"({count},)", array.shape)
        checked[str(name)] = (array, float(value))
    return checked


def _draw_line(axes: Axes, found: Flatness, index: int) -> None:
    """Draw one panel: the line along a gain, the band of near equals, the optimum."""
    lowest = found.best_value - found.tolerance * abs(found.best_value)
    share = (
        "" if math.isnan(found.near_best_share) else f": {100.0 * found.near_best_share:.0f} % of the best grid points"
    )
    words = f"within {100.0 * found.tolerance:g} % of the best{share}"
    band: style.Properties = {"color": BAND_COLOR, "alpha": 0.16, "linewidth": 0, "zorder": 0.6}
    axes.axhspan(lowest, found.best_value, label=words, **band)
    values = np.where(np.isfinite(found.values[index]), found.values[index], np.nan)
    axes.plot(found.gains[index], values, label="other gains as in the best set", **style.run_look(0))
    for end in (found.low[index], found.high[index]):
        axes.axvline(end, color=BAND_COLOR, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1.0)
    label = f"best set, {found.best_value:.4f}"
    axes.plot([found.best_gains[index]], [found.best_value], color=style.RUN_COLORS[0], label=label, **BEST_LOOK)


def mark_look(index: int) -> style.Properties:
    """Return the look of a marked gain set."""
    return {
        "marker": MARKERS[index % len(MARKERS)],
        "color": MARK_COLORS[index % len(MARK_COLORS)],
        "markersize": 7.0,
        "linestyle": "none",
        "zorder": 5.0,
    }


def _draw_marks(axes: Axes, marks: Mapping[str, tuple[float, float]]) -> None:
    for index, (name, (gain, value)) in enumerate(marks.items()):
        bottom = axes.get_ylim()[0]
        below = "" if value >= bottom else ", below the axis"
        look = mark_look(index) | {"clip_on": False}
        axes.plot([gain], [max(value, bottom)], label=f"{name}, {value:.4f}{below}", **look)
