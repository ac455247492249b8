"""Which foams fit a manipulator: boundary curves and maps in the plane of damping and stiffness."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import ShapeError
from hrsafety.plotting import inputs, labels, notes, style
from hrsafety.plotting.axis_numbers import along_axis, blank_where_infinite, near_axis, shown_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

    from hrsafety.impact import Foam, FoamBoundary

__all__ = ["foam_boundaries", "foam_map", "refined"]

KILO = 1000.0
UPPER_COLOR, LOWER_COLOR, BETWEEN_COLOR = "#D55E00", "#0072B2", "#009E73"
# What a point of a curve means; other words count as an ordinary root.
STATUS_STYLES: dict[str, Any] = {
    "jump": (0, (1.2, 1.4)),
    "end_of_impact_period": (0, (5, 2)),
    "initial_step": (0, (4, 1.5, 1, 1.5)),
    "beyond_linear_range": (0, (1, 3)),
    "bottomed": (0, (1, 5)),
}
_ROUNDS = 8  # halvings of the step of the damping where a curve changes its meaning
STATUS_WORDS = {
    "jump": "a jump of the impact period",
    "end_of_impact_period": "at the end of the impact period",
    "initial_step": "at first contact",
    "beyond_linear_range": "beyond the linear range",
    "bottomed": "bottomed",
}
# Foams that a linear model does not describe: no verdict of the limits, whatever the numbers say.
BEYOND_MARKS: dict[str, style.Properties] = {
    "beyond_linear_range": {"marker": "^", "color": "#E69F00"},
    "bottomed": {"marker": "v", "color": "black"},
}
ACCEPTED, REJECTED = "#00795C", style.CONTACT_COLOR
DAMPING_LABEL, STIFFNESS_LABEL = "foam damping (N s/m)", "foam stiffness (kN/m)"


@notes.picture
def foam_boundaries(
    damping: npt.ArrayLike,
    upper: FoamBoundary | None,
    lower: FoamBoundary | None,
    *,
    foams: Mapping[str, Foam] | None = None,
    accepted: Mapping[str, bool] | None = None,
    statuses: Mapping[str, str] | None = None,
    results: Sequence[object] = (),
    fitting: tuple[npt.ArrayLike, npt.ArrayLike] | None = None,
    upper_label: str = "upper: head acceleration",
    lower_label: str = "lower: compression",
    title: str | None = None,
) -> Figure:
    """Draw the upper and lower boundary of the foam stiffness over the damping.

    A part of a curve that is no ordinary root is dashed (end of the impact period) or dotted
    (jump); where a boundary does not exist the curve has a gap.

    Parameters
    ----------
    damping : array_like, shape (n,)
        Foam damping of the points of both curves in N s/m, rising.
    upper, lower : FoamBoundary or None
        Stiffness in N/m and a status word for each point; ``None`` where nothing is limited.
    foams : mapping of str to Foam or None
        Foams to mark, by name.
    fitting : (array_like, array_like) or None
        Least and largest stiffness that fit at each damping, see `FoamDesign.stiffness_range`, to shade; NaN where
        none does. What is between the boundaries when ``None``.
    accepted : mapping of str to bool or None
        Whether a foam meets all limits: a filled circle, or a cross. Foams that are not named
        here are open circles.
    statuses : mapping of str to str or None
        Status of the impact with a foam: ``"beyond_linear_range"`` and ``"bottomed"`` are marked
        by triangles of their own, since no limit counts as kept there.
    results : sequence of object
        What else the picture shows, for example the design: their warnings stand below it, as
        those of the boundaries do.
    upper_label, lower_label : str
        What the curves keep.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ShapeError
        If a boundary has another length than ``damping``.
    InvalidParameterError
        If ``damping`` does not rise.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import impact, plotting
    >>> damping = [0.0, 75.0, 150.0]
    >>> upper = impact.foam_stiffness_upper(impact.MANIPULATOR_1, damping=damping, closing_speed=1.25)
    >>> lower = impact.foam_stiffness_lower(impact.MANIPULATOR_1, damping=damping, closing_speed=1.25)
    >>> figure = plotting.foam_boundaries(damping, upper, lower, foams={"Foam 1": impact.FOAM_1})
    """
    grid = _rising(damping)
    tops, bottoms = _stiffness("upper", upper, grid), _stiffness("lower", lower, grid)
    figure, axes = style.one_panel(4.8, title=title)
    shown = [curve[np.isfinite(curve)].max(initial=0.0) for curve in (tops, bottoms)]
    shown += [foam.stiffness / KILO for foam in (foams or {}).values()]
    height = 1.12 * max(shown) or 1.0
    if fitting is None:
        _fill(axes, grid, _edge(upper, tops, height), _edge(lower, bottoms, 0.0))
    else:
        least, largest = (np.asarray(each, dtype=np.float64) / KILO for each in fitting)
        _fill(axes, grid, np.minimum(largest, height), least)
    if upper is not None:
        _curve(axes, grid, tops, _words(upper), UPPER_COLOR, upper_label)
    if lower is not None:
        _curve(axes, grid, bottoms, _words(lower), LOWER_COLOR, lower_label)
    named = _foams(axes, foams or {}, accepted or {}, statuses or {})
    axes.set_xlim(grid[0], grid[-1])
    axes.set_ylim(0.0, height)
    axes.set_xlabel(DAMPING_LABEL)
    axes.set_ylabel(STIFFNESS_LABEL)
    handles, texts = axes.get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=2, columnspacing=1.4)
    notes.add_warnings(figure, upper, lower, *results, *(foams or {}).values())
    labels.clear_labels(figure, named)
    return figure


@notes.picture
def foam_map(
    damping: npt.ArrayLike,
    stiffness: npt.ArrayLike,
    value: npt.ArrayLike,
    *,
    quantity: str,
    limit: float | None = None,
    foams: Mapping[str, Foam] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw a metric over the plane of foam damping and stiffness as colors.

    Parameters
    ----------
    damping : array_like, shape (n,)
        Foam damping in N s/m, rising.
    stiffness : array_like, shape (k,)
        Foam stiffness in N/m, rising.
    value : array_like, shape (k, n)
        Metric; a row for each stiffness. What is not finite is left blank.
    quantity : str
        Label of the color bar, with unit.
    limit : float or None
        Limit in the unit of ``value``: a white line where it is met.
    foams : mapping of str to Foam or None
        Foams to mark, by name, on the map or near it.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ShapeError
        If ``value`` has another shape.
    InvalidParameterError
        If an axis does not rise, a number cannot be drawn, or a foam is far from the map.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.foam_map([0.0, 100.0], [1e4, 2e4], [[3.0, 2.8], [5.0, 4.6]], quantity="peak (g)")
    """
    columns, rows = _rising(damping), _rising(stiffness, "stiffness")
    table = blank_where_infinite("value", value)
    if table.shape != (len(rows), len(columns)):
        raise ShapeError("value", f"({len(rows)}, {len(columns)})", table.shape)
    figure, axes = style.one_panel(4.8, title=title)
    colors = axes.pcolormesh(columns, rows / KILO, table, shading="gouraud" if np.isfinite(table).all() else "nearest")
    bar = figure.colorbar(colors, ax=axes, label=quantity)
    known = table[np.isfinite(table)]
    if limit is not None and known.size and known.min() < shown_number("limit", limit) < known.max():
        axes.contour(columns, rows / KILO, table, levels=[limit], colors="white", linewidths=1.8)
        bar.ax.axhline(limit, color="white", linewidth=1.8)
    named = []
    for name, foam in (foams or {}).items():
        near_axis(f"foams[{name!r}].damping", foam.damping, columns)
        near_axis(f"foams[{name!r}].stiffness", foam.stiffness, rows)
        axes.plot([foam.damping], [foam.stiffness / KILO], "o", color="white", markeredgecolor="black", clip_on=False)
        named.append(labels.label(axes, name, (foam.damping, foam.stiffness / KILO), color="white", **_shadow()))
    axes.grid(visible=False)
    axes.set_xlabel(DAMPING_LABEL)
    axes.set_ylabel(STIFFNESS_LABEL)
    axes.set_xlim(columns[0], columns[-1])
    axes.set_ylim(rows[0] / KILO, rows[-1] / KILO)
    notes.add_warnings(figure, *(foams or {}).values())
    labels.clear_labels(figure, named)
    return figure


def refined(damping: npt.ArrayLike, curves: Sequence[Callable[[inputs.Array], FoamBoundary]]) -> inputs.Array:
    """Return a damping with more points where a boundary changes its meaning, begins or ends.

    Without them a picture shows the step of the damping there: slanted edges in place of steep ones,
    and a curve that ends up to one step too early.

    Parameters
    ----------
    damping : array_like, shape (n,)
        Foam damping in N s/m, rising.
    curves : sequence of callable
        The boundaries as functions of the damping, for example ``FoamDesign.upper``.

    Returns
    -------
    ndarray
        ``damping`` and the points between; the last step is 1/256 of the one that was given.

    Examples
    --------
    >>> from hrsafety import impact
    >>> from hrsafety.plotting.impacts.boundaries import refined
    >>> design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
    >>> len(refined([250.0, 300.0, 340.0], [design.lower])) > 3
    True
    """
    grid = _rising(damping)
    for curve in curves:
        meanings = _meanings(curve(grid))
        for _ in range(_ROUNDS):
            changes = np.flatnonzero(meanings[1:] != meanings[:-1])
            if not changes.size:
                break
            between = (grid[changes] + grid[changes + 1]) / 2.0
            grid = np.insert(grid, changes + 1, between)
            meanings = np.insert(meanings, changes + 1, _meanings(curve(between)))
    return grid


def _meanings(boundary: FoamBoundary) -> npt.NDArray[np.object_]:
    """Return what each point of a boundary means: whether it exists, and how it is drawn."""
    known = np.isfinite(np.atleast_1d(boundary.stiffness))
    return np.array([f"{exists} {_look(word)}" for exists, word in zip(known, _words(boundary), strict=True)], object)


def _shadow() -> style.Properties:
    """Return what makes white words readable on every color."""
    from matplotlib.patheffects import withStroke

    return {"path_effects": [withStroke(linewidth=2.0, foreground="#303030")]}


def _rising(values: npt.ArrayLike, name: str = "damping") -> inputs.Array:
    return along_axis(name, values)


def _stiffness(name: str, boundary: FoamBoundary | None, grid: inputs.Array) -> inputs.Array:
    """Return the curve of a boundary in kN/m; NaN without one."""
    if boundary is None:
        return np.full(grid.shape, np.nan)
    curve = np.asarray(boundary.stiffness, dtype=np.float64) / KILO
    if curve.shape != grid.shape:
        raise ShapeError(f"{name}.stiffness", f"({len(grid)},)", curve.shape)
    return curve


def _words(boundary: FoamBoundary) -> list[str]:
    return [str(word) for word in np.atleast_1d(boundary.status)]


def _edge(boundary: FoamBoundary | None, curve: inputs.Array, unlimited: float) -> inputs.Array:
    """Return the edge of what fits: the curve, or a border of the picture where every foam keeps the limit."""
    if boundary is None:
        return np.full(curve.shape, unlimited)
    always = np.isnan(curve) & np.asarray(boundary.holds_below) & np.asarray(boundary.holds_above)
    edge: inputs.Array = np.where(always, unlimited, curve)
    return edge


def _fill(axes: Axes, grid: inputs.Array, upper: inputs.Array, lower: inputs.Array) -> None:
    """Shade the foams between the edges."""
    known = np.isfinite(upper) & np.isfinite(lower)
    fits = known & (np.where(known, upper, 0.0) > np.where(known, lower, 0.0))
    if fits.any():
        look: style.Properties = {"color": BETWEEN_COLOR, "alpha": 0.13, "linewidth": 0}
        axes.fill_between(grid, lower, upper, where=list(fits), label="foams that fit", **look)


def _curve(axes: Axes, grid: inputs.Array, values: inputs.Array, words: list[str], color: str, label: str) -> None:
    """Draw a curve piece by piece, each with the line style of its status."""
    named: set[str] = set()
    start = 0
    for end in range(1, len(grid) + 1):
        if end < len(grid) and _look(words[end]) == _look(words[start]):
            continue
        look = _look(words[start])
        last = end + 1 if end < len(grid) else end  # pieces meet: the next one begins at this one's end
        words_of_piece = STATUS_WORDS.get(look, "")
        text = f"{label}, {words_of_piece}" if words_of_piece else label
        if np.isfinite(values[start:end]).any():
            axes.plot(
                grid[start:last],
                values[start:last],
                color=color,
                linestyle=STATUS_STYLES.get(look, "-"),
                label="_" if text in named else text,
            )
            named.add(text)
        start = end


def _look(word: str) -> str:
    return word if word in STATUS_STYLES else "root"


def _foams(
    axes: Axes, foams: Mapping[str, Foam], accepted: Mapping[str, bool], statuses: Mapping[str, str]
) -> list[Annotation]:
    """Mark foams by their verdict, and return their labels."""
    found = []
    for name, foam in foams.items():
        fits, status = accepted.get(name), statuses.get(name, "")
        look: style.Properties = {"markersize": 8.5, "linestyle": "none", "zorder": 4.0}
        verdict = {None: "", True: ": fits", False: ": does not fit"}[fits]
        if status in BEYOND_MARKS:
            look |= {**BEYOND_MARKS[status], "markeredgecolor": "black", "markersize": 10.0}
            verdict = f": {STATUS_WORDS[status]}"
        elif fits is None:
            look |= {"marker": "o", "color": "black", "fillstyle": "none"}
        elif fits:
            look |= {"marker": "o", "color": ACCEPTED}
        else:
            look |= {"marker": "X", "color": REJECTED}
        x, y = foam.damping, foam.stiffness / KILO
        axes.plot([x], [y], **look)
        found.append(labels.label(axes, f"{name}{verdict}", (x, y)))
    return found
