"""How a search for gains went, and what its objectives cost each other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import instance
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.gains.results import GainSearch, ParetoFront
from hrsafety.plotting import inputs, notes, style
from hrsafety.plotting.gains.sensitivity import gain_label, mark_look

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

__all__ = ["pareto_front", "search_history"]

# Metric: axis label with unit.
METRICS = {
    "performance": "mean H",
    "performance_arrival_time": "mean H_T",
    "performance_avoidance": "mean H_D",
    "performance_energy_saving": "mean H_E",
    "arrival_time": "arrival time (s)",
    "energy": "energy (J)",
    "path_length": "path length (m)",
    "min_clearance": "least clearance (m)",
}
SURVIVORS_COLOR, BOX_COLOR = "#0072B2", "#D9D9D9"
LOCAL_COLOR = "#D55E00"
BAR_HEIGHT = 0.5


@notes.picture
def search_history(search: GainSearch, *, quantity: str = "mean H", title: str | None = None) -> Figure:
    """Draw how a search closed in: best and worst survivor, and the ranges of the gains by round.

    Without grids, as after differential evolution, the best objective so far is drawn over the
    number of gain sets.

    Parameters
    ----------
    search : GainSearch
        Result of `hrsafety.navigation.optimize_gains`.
    quantity : str
        Label of the objective, with unit.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Objective by round above; below a panel for each gain: the range of the grid in grey,
        the range of the survivors in blue, the best gain set as a star.

    Raises
    ------
    InvalidParameterError
        If ``search`` is something else.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> search = nav.optimize_gains(
    ...     [scenarios.configuration("c1")], grid=(3, 3, 3, 3), refinements=1, survivors=5, local_starts=1
    ... )
    >>> figure = plotting.search_history(search)
    >>> [axes.get_xlabel() for axes in figure.axes][1:]
    ['$K_1$ (N/m)', '$K_3$ (N/m)', '$K_5$ (N/m²)', '$b$ (s)']
    """
    instance("search", search, GainSearch)
    if not search.grids:
        return _convergence(search, quantity, title)
    rounds = len(search.grids)
    figure = style.new_figure(3.9 + 0.42 * (rounds + 1), title=title)
    places = figure.add_gridspec(2, 1, height_ratios=(2.9, 0.6 + 0.42 * (rounds + 1)))
    _draw_values(figure.add_subplot(places[0]), search, quantity)
    _draw_ranges(figure, places[1], search)
    handles, texts = (list(parts) for parts in figure.axes[0].get_legend_handles_labels())
    for parts, more in zip((handles, texts), figure.axes[1].get_legend_handles_labels(), strict=True):
        parts += more
    figure.legend(handles, texts, loc="outside lower center", ncols=3, columnspacing=1.4)
    return figure


@notes.picture
def pareto_front(
    front: ParetoFront,
    *,
    knee: int | None = None,
    marks: Mapping[str, Sequence[float]] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the gain sets that no other one beats, projected onto each pair of objectives.

    A step line joins the points that are best in the pair alone; the others owe their place to
    an objective that the panel does not show.

    Parameters
    ----------
    front : ParetoFront
        Result of `hrsafety.navigation.gains.pareto_front`.
    knee : int or None
        Index of a point to mark as the knee, by whatever definition; none when ``None``.
    marks : mapping of str to sequence of float, or None
        Objectives of other gain sets, for example published ones, by name.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each pair of objectives. With three objectives, colors show the third.

    Raises
    ------
    InvalidParameterError
        If ``front`` is something else, is empty or has a single objective, or there is no
        point ``knee``.
    ShapeError
        If a mark has another number of objectives.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> front = nav.gains.pareto_front([scenarios.configuration("c1")], grid=(3, 3, 3, 3), refinements=0)
    >>> plotting.pareto_front(front).axes[0].get_xlabel()
    'arrival time (s)'
    """
    others = _checked_front(front, knee, marks)
    count = len(front.objectives)
    pairs = list(itertools.combinations(range(count), 2))
    columns = min(len(pairs), 3)
    rows = math.ceil(len(pairs) / columns)
    width = {1: 6.0, 2: 8.0, 3: 10.5}[columns]
    figure = style.new_figure(0.9 + 3.3 * rows, width=width, title=title)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels[len(pairs) :]:
        axes.remove()
    for axes, (x, y) in zip(panels, pairs, strict=False):
        third = ({0, 1, 2} - {x, y}).pop() if count == 3 else None
        _draw_projection(figure, axes, front, (x, y), third)
        _draw_points(axes, front, (x, y), knee, others)
    handles, texts = panels[0].get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=min(len(handles), 2 + columns), columnspacing=1.4)
    return figure


def metric_label(objective: object) -> str:
    """Return the axis label of an objective, with its unit where it is known."""
    return METRICS.get(objective, "objective") if isinstance(objective, str) else "objective"


# ---- history ----------------------------------------------------------------------------------------


def _convergence(search: GainSearch, quantity: str, title: str | None) -> Figure:
    """Return the picture of a search without grids."""
    figure, axes = style.one_panel(3.8, title=title)
    counts, values = np.asarray(search.convergence, dtype=np.float64).reshape(-1, 2).T
    known = np.isfinite(values)
    axes.step(counts[known], values[known], where="post", label="best so far", **style.run_look(0))
    axes.set_xlabel("gain sets evaluated")
    axes.set_ylabel(quantity)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center")
    return figure


def _draw_values(axes: Axes, search: GainSearch, quantity: str) -> None:
    """Draw best and worst survivor of each round, and where the local searches led."""
    grids, local = search.grids, search.local
    places = np.arange(1, len(grids) + 1)
    best = np.array([entry.best_value for entry in grids])
    worst = np.array([entry.worst_survivor for entry in grids])
    for values, label, index in ((best, "best of the grid", 0), (worst, "worst survivor", 1)):
        shown = np.where(np.isfinite(values), values, np.nan)
        axes.plot(places, shown, marker="o", label=label, **style.run_look(index))
    labels = [f"{entry.name}\n{entry.evaluations:,}" for entry in grids]
    if local:
        values = np.array([entry.best_value for entry in local])
        spread = places[-1] + 1.0 + np.linspace(-0.22, 0.22, len(values))
        look: style.Properties = {"linestyle": "none", "marker": "o", "markersize": 4.5, "color": LOCAL_COLOR}
        axes.plot(spread, np.where(np.isfinite(values), values, np.nan), label="local searches", **look)
        labels.append(f"local\n{sum(entry.evaluations for entry in local):,}")
    axes.set_xticks(np.arange(1, len(labels) + 1), labels=labels)
    axes.set_xlim(0.6, len(labels) + 0.4)
    axes.set_xlabel("stage, number of gain sets")
    axes.set_ylabel(quantity)


def _draw_ranges(figure: Figure, place: SubplotSpec, search: GainSearch) -> None:
    """Draw the range of each gain in each round, one panel for each gain."""
    rounds = search.grids
    names = search.nearest.GAIN_NAMES
    columns = place.subgridspec(1, len(names))
    for index, name in enumerate(names):
        axes = figure.add_subplot(columns[index])
        for row, entry in enumerate(rounds, start=1):
            low, high = float(entry.axes[index][0]), float(entry.axes[index][-1])
            axes.barh(row, high - low, BAR_HEIGHT, left=low, color=BOX_COLOR, label=_first("range of the grid", row))
            low, high = float(entry.survivor_low[index]), float(entry.survivor_high[index])
            look: style.Properties = {"color": SURVIVORS_COLOR, "alpha": 0.65}
            axes.barh(row, high - low, 0.45 * BAR_HEIGHT, left=low, label=_first("range of the survivors", row), **look)
            if math.isfinite(entry.best_value):
                label = _first("best gain set", row)
                axes.plot([entry.best_gains[index]], [row], label=label, **_star(style.RUN_COLORS[3]))
        labels = [entry.name for entry in rounds]
        if search.local:
            axes.plot([search.nearest.gains[index]], [len(rounds) + 1], **_star(LOCAL_COLOR))
            labels.append("local")
        axes.set_yticks(range(1, len(labels) + 1), labels=labels if index == 0 else [""] * len(labels))
        axes.set_ylim(len(labels) + 0.6, 0.4)
        axes.grid(visible=False, axis="y")
        axes.set_xlabel(gain_label(name))


def _first(label: str, row: int) -> str:
    """Return a label for the first row only, so that a legend has it once."""
    return label if row == 1 else f"_{label}"


def _star(color: str) -> style.Properties:
    return {"marker": "*", "markersize": 11.0, "linestyle": "none", "color": color, "zorder": 4.0, "clip_on": False}


# ---- front ------------------------------------------------------------------------------------------


def _checked_front(front: Any, knee: int | None, marks: Any) -> dict[str, inputs.Array]:
    """Check a front and return the marked points."""
    instance("front", front, ParetoFront)
    count = len(front.objectives)
    if count < 2:
        raise InvalidParameterError("front", "have at least two objectives", count)
    if len(front) == 0:
        raise InvalidParameterError("front", "hold at least one gain set", Shown("none"))
    if knee is not None and not 0 <= knee < len(front):
        raise InvalidParameterError("knee", f"be None or an index from 0 to {len(front) - 1}", knee)
    checked: dict[str, inputs.Array] = {}
    for name, values in (marks or {}).items():
        array: inputs.Array = np.asarray(values, dtype=np.float64)
        if array.shape != (count,):
            raise ShapeError(f"marks[{name!r}]", f"({count},)", array.shape)
        checked[str(name)] = array
    return checked


def _draw_projection(figure: Figure, axes: Axes, front: ParetoFront, pair: tuple[int, int], third: int | None) -> None:
    """Draw all points of a front over two of its objectives."""
    x, y = (front.values[:, index] for index in pair)
    edge = _edge(x, y, [front.maximized[index] for index in pair])
    axes.step(x[edge], y[edge], where="post", color=style.NEUTRAL, linewidth=1.0, zorder=1.5, label="best in the pair")
    look: style.Properties = {"s": 26.0, "linewidths": 0.4, "edgecolors": "black", "zorder": 3.0}
    if third is None:
        axes.scatter(x, y, color=style.RUN_COLORS[0], label="gain sets of the front", **look)
    else:
        points = axes.scatter(x, y, c=front.values[:, third], label="gain sets of the front", **look)
        bar = figure.colorbar(points, ax=axes, location="top", shrink=0.9, pad=0.02)
        bar.set_label(metric_label(front.objectives[third]), fontsize=style.SMALL_FONT_SIZE)
        bar.ax.tick_params(labelsize=style.SMALL_FONT_SIZE - 0.5)
    axes.set_xlabel(metric_label(front.objectives[pair[0]]))
    axes.set_ylabel(metric_label(front.objectives[pair[1]]))


def _edge(x: inputs.Array, y: inputs.Array, maximized: Sequence[bool]) -> list[int]:
    """Return the points that are best in two objectives alone, along the first."""
    first, second = (-value if large else value for value, large in zip((x, y), maximized, strict=True))
    edge: list[int] = []
    for row in np.lexsort((second, first)):
        if not edge or second[row] < second[edge[-1]]:
            edge.append(int(row))
    return edge


def _draw_points(
    axes: Axes, front: ParetoFront, pair: tuple[int, int], knee: int | None, others: Mapping[str, inputs.Array]
) -> None:
    """Mark the best point of each objective, the knee and other gain sets."""
    x, y = pair
    for index, objective in enumerate(front.objectives):
        column = front.values[:, index]
        row = int(np.argmax(column) if front.maximized[index] else np.argmin(column))
        look: style.Properties = {"color": style.CONTACT_COLOR, "linestyle": "none", "zorder": 4.0, "fillstyle": "none"}
        name = metric_label(objective).split(" (")[0]
        look |= {"marker": ("o", "s", "^", "v", "D")[index % 5], "markersize": 11.0, "markeredgewidth": 1.5}
        axes.plot([front.values[row, x]], [front.values[row, y]], label=f"best {name}", **look)
    if knee is not None:
        axes.plot([front.values[knee, x]], [front.values[knee, y]], label="knee", **_star("black"))
    for index, (label, values) in enumerate(others.items()):
        axes.plot([values[x]], [values[y]], label=label, **mark_look(index))
