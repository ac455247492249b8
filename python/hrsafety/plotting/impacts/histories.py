"""Impacts between a manipulator with foam and a head: histories, measured peaks, studies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import pair
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plotting import inputs, notes, style
from hrsafety.plotting import labels as placing
from hrsafety.plotting.axis_numbers import along_axis, blank_where_infinite, near_axis, shown_number
from hrsafety.plotting.impacts.boundaries import BEYOND_MARKS, STATUS_WORDS

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.impact import ImpactResponse
    from hrsafety.impact.joints import DirectDriveResponse

    Response = ImpactResponse | DirectDriveResponse

__all__ = ["impact_histories", "impact_study", "measured_impact"]

STANDARD_GRAVITY = 9.80665  # m/s^2, only to label accelerations in g
MILLI = 1000.0
# Quantity of a response: label with unit, and how many of that unit an SI unit is.
QUANTITIES = {
    "contact_force": ("contact force (N)", 1.0),
    "head_acceleration": ("head acceleration (g)", 1.0 / STANDARD_GRAVITY),
    "compression": ("compression (mm)", MILLI),
    "manipulator_position": ("manipulator position (mm)", MILLI),
    "manipulator_velocity": ("manipulator velocity (m/s)", 1.0),
    "head_position": ("head position (mm)", MILLI),
    "head_velocity": ("head velocity (m/s)", 1.0),
}
LIMIT_LOOK: style.Properties = {"color": style.CONTACT_COLOR, "linewidth": 1.1, "linestyle": (0, (5, 3))}
LIMIT_GID = "limit"  # tells the lines of limits from others
PEAK_LOOK: style.Properties = {"marker": "*", "markersize": 11.0, "linestyle": "none"}
MEASURED_COLOR = "#D55E00"


@notes.picture
def impact_histories(
    responses: Response | Sequence[Response],
    *,
    labels: Sequence[str] | None = None,
    quantities: Sequence[str] = ("contact_force", "head_acceleration"),
    peaks: Sequence[int] = (),
    limits: Mapping[str, float] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw quantities of one or several impacts over time, one panel for each quantity.

    Parameters
    ----------
    responses : ImpactResponse, DirectDriveResponse or sequence of them
        The impacts. A quantity that an impact does not have (the head of a constrained
        impact) is left out of its panel.
    labels : sequence of str or None
        One name for each impact; numbered when ``None``.
    quantities : sequence of str
        Names of fields of the responses; accelerations are drawn in g, lengths in mm.
    peaks : sequence of int
        Indices of the impacts whose largest value within the impact period gets an asterisk,
        which the legend explains.
    limits : mapping of str to float or None
        Limit of a quantity in the unit of its axis, drawn as a dashed line.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If there is no response, a quantity is unknown or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import impact, plotting
    >>> run = impact.simulate(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.25)
    >>> [axes.get_ylabel() for axes in plotting.impact_histories(run).axes]
    ['contact force (N)', 'head acceleration (g)']
    """
    runs = _checked_responses(responses)
    names = inputs.checked_labels(labels, len(runs), stem="impact")
    wanted = _checked_quantities(quantities)
    marked = _checked_indices(peaks, len(runs))
    figure = style.new_figure(0.8 + 2.9 * len(wanted), title=title)
    panels = figure.subplots(len(wanted), 1, sharex=True, squeeze=False)[:, 0]
    for axes, quantity in zip(panels, wanted, strict=True):
        for index, (run, name) in enumerate(zip(runs, names, strict=True)):
            values = _values(run, quantity)
            if values is None:
                continue
            look = style.run_look(index)
            axes.plot(MILLI * run.time, values, label=name, **look)
            _mark_beyond(axes, run, values, look["color"])
            if index in marked:
                _mark_peak(axes, run, values, look["color"])
        _finish(axes, quantity, limits)
    handles = _history_handles(runs, names if len(runs) > 1 or labels is not None else [], list(panels))
    if handles:
        style.legend_below(figure, handles, columns=min(len(handles), 3))
    panels[-1].set_xlabel("time (ms)")
    panels[-1].set_xlim(0.0, MILLI * max(float(run.time[-1]) for run in runs))
    figure.align_ylabels()
    notes.add_warnings(figure, *(source for run in runs for source in (run, getattr(run, "metrics", None))))
    return figure


@notes.picture
def measured_impact(
    response: ImpactResponse,
    *,
    peak_head_acceleration_g: npt.ArrayLike,
    impact_duration: npt.ArrayLike,
    max_compression: npt.ArrayLike,
    title: str | None = None,
) -> Figure:
    """Draw a simulated impact with the measured peaks of repeated experiments as markers.

    Peaks are drawn at the time of the simulated peak, because tables of experiments give no
    time for them; ends of the impact period stand on the line of zero acceleration.

    Parameters
    ----------
    response : ImpactResponse
        The simulated impact.
    peak_head_acceleration_g : array_like, shape (n,)
        Measured peaks of the head acceleration in g.
    impact_duration : array_like, shape (n,)
        Measured impact periods in s.
    max_compression : array_like, shape (n,)
        Measured largest compressions in m.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels: acceleration and compression.

    Raises
    ------
    InvalidParameterError
        If ``response`` is no response with a head.
    ShapeError
        If the measured values are not one-dimensional.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import impact, plotting
    >>> run = impact.simulate(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.apparatus(), closing_speed=1.25)
    >>> peaks = {"peak_head_acceleration_g": [6.5, 6.57], "max_compression": [0.0112, 0.0113]}
    >>> figure = plotting.measured_impact(run, impact_duration=[0.040, 0.036], **peaks)
    """
    (run,) = _checked_responses(response)
    peaks = _measured("peak_head_acceleration_g", peak_head_acceleration_g)
    ends = _measured("impact_duration", impact_duration)
    depths = _measured("max_compression", max_compression)
    figure = style.new_figure(3.6, title=title)
    left, right = figure.subplots(1, 2)
    look: style.Properties = {"linestyle": "none", "markersize": 6.5, "fillstyle": "none", "color": MEASURED_COLOR}
    for axes, quantity, found in ((left, "head_acceleration", peaks), (right, "compression", MILLI * depths)):
        values = _values(run, quantity)
        if values is None:
            raise InvalidParameterError("response", "have a head that moves", Shown("a constrained impact"))
        axes.plot(MILLI * run.time, values, label="simulated", **style.run_look(0))
        instant = float(run.time[_peak_row(run, values)])
        axes.plot(np.full(len(found), MILLI * instant), found, marker="o", label="measured peak", **look)
        _finish(axes, quantity, None)
        axes.set_xlabel("time (ms)")
        axes.set_xlim(0.0, MILLI * max(float(run.time[-1]), 1.05 * float(ends.max(initial=0.0))))
    left.plot(
        MILLI * ends,
        np.zeros(len(ends)),
        marker="|",
        label="measured end",
        **(look | {"markersize": 12.0, "markeredgewidth": 1.6}),
    )
    handles, texts = left.get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=3)
    notes.add_warnings(figure, run, run.metrics)
    return figure


@notes.picture
def impact_study(
    values: npt.ArrayLike,
    curves: Mapping[str, npt.ArrayLike],
    *,
    parameter: str,
    quantity: str = "peak head acceleration (g)",
    limit: float | None = None,
    marks: Mapping[str, tuple[float, float]] | None = None,
    log_parameter: bool = False,
    title: str | None = None,
) -> Figure:
    """Draw a metric over one parameter, one curve for each case.

    Parameters
    ----------
    values : array_like, shape (n,)
        Values of the parameter in the unit that its label names.
    curves : mapping of str to array_like, shape (n,)
        Metric of each case; NaN leaves a gap.
    parameter, quantity : str
        Labels of the axes, with units.
    limit : float or None
        Safety limit in the unit of ``quantity``.
    marks : mapping of str to (float, float) or None
        Points to mark, with their names.
    log_parameter : bool
        Whether the parameter has a logarithmic axis.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If there is no curve.
    ShapeError
        If a curve has another length than ``values``.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.impact_study([5.0, 10.0, 20.0], {"Foam 1": [5.9, 6.6, 7.1]}, parameter="mass (kg)")
    """
    lines = {name: blank_where_infinite(f"curves[{name!r}]", curve) for name, curve in curves.items()}
    inputs.some("curves", lines, "curve")
    grid = along_axis("values", values, log=log_parameter, rising=False)
    for name, line in lines.items():
        if line.shape != grid.shape:
            raise ShapeError(f"curves[{name!r}]", f"({len(grid)},)", line.shape)
    figure, axes = style.one_panel(4.4, title=title)
    for index, (name, line) in enumerate(lines.items()):
        axes.plot(grid, line, label=name, **style.run_look(index))
    if limit is not None:
        axes.axhline(shown_number("limit", limit), label=f"limit {limit:g}", **LIMIT_LOOK)
    named = []
    for name, place in (marks or {}).items():
        x, y = (shown_number(f"marks[{name!r}]", each) for each in pair(f"marks[{name!r}]", place))
        near_axis(f"marks[{name!r}]", x, grid)
        axes.plot([x], [y], marker="*", markersize=12.0, color="black", linestyle="none", zorder=5.0)
        named.append(placing.label(axes, name, (x, y)))
    if log_parameter:
        axes.set_xscale("log")
        ticks, texts = style.log_ticks(float(grid.min()), float(grid.max()))
        axes.set_xticks(ticks, labels=texts)
        axes.minorticks_off()
    axes.set_xlim(float(grid.min()), float(grid.max()))
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(parameter)
    axes.set_ylabel(quantity)
    handles, texts = axes.get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=min(3, len(handles)))
    placing.clear_labels(figure, named)
    return figure


def _checked_responses(responses: Any) -> list[Any]:
    """Return one or several responses as a list."""
    runs = list(responses) if isinstance(responses, (list, tuple)) else [responses]
    inputs.some("responses", runs, "ImpactResponse")
    for index, run in enumerate(runs):
        if not all(hasattr(run, name) for name in ("time", "contact_force", "compression")):
            raise InvalidParameterError(f"responses[{index}]", "be an ImpactResponse", Shown(type(run).__name__))
    return runs


def _checked_quantities(quantities: Sequence[str]) -> list[str]:
    if isinstance(quantities, str) or not quantities:
        raise InvalidParameterError("quantities", "be a sequence of names of quantities", repr(quantities))
    for quantity in quantities:
        if quantity not in QUANTITIES:
            raise InvalidParameterError("quantities", f"be among {', '.join(QUANTITIES)}", quantity)
    return list(quantities)


def _checked_indices(peaks: Sequence[int], count: int) -> frozenset[int]:
    for index in peaks:
        if not 0 <= index < count:
            raise InvalidParameterError("peaks", f"hold indices from 0 to {count - 1}", index)
    return frozenset(peaks)


def _measured(name: str, values: npt.ArrayLike) -> inputs.Array:
    """Return values as one-dimensional numbers."""
    array = blank_where_infinite(name, values)
    if array.ndim != 1 or array.size == 0:
        raise ShapeError(name, "(n,)", array.shape)
    return array


def _values(run: Any, quantity: str) -> inputs.Array | None:
    """Return a quantity of a response in the unit of its axis, or ``None`` where it has none."""
    found = getattr(run, quantity)
    if found is None or np.isnan(found).all():
        return None
    scaled: inputs.Array = QUANTITIES[quantity][1] * np.asarray(found, dtype=np.float64)
    return scaled


def _peak_row(run: Any, values: inputs.Array) -> int:
    """Return the row of the largest value within the impact period."""
    duration = getattr(run, "metrics", run).impact_duration
    inside = run.time <= duration if np.isfinite(duration) else np.ones(len(values), dtype=bool)
    return int(np.argmax(np.where(inside, values, -np.inf)))


def _mark_peak(axes: Axes, run: Any, values: inputs.Array, color: str) -> None:
    row = _peak_row(run, values)
    axes.plot([MILLI * run.time[row]], [values[row]], color=color, zorder=4.0, **PEAK_LOOK)


def _mark_beyond(axes: Axes, run: Any, values: inputs.Array, color: str) -> None:
    """Mark the deepest compression of an impact that a linear foam does not describe."""
    status = _status(run)
    if status in BEYOND_MARKS:
        row = int(np.nanargmax(run.compression))
        look = {**BEYOND_MARKS[status], "markeredgecolor": color, "markersize": 9.0, "zorder": 5.0}
        axes.plot([MILLI * run.time[row]], [values[row]], linestyle="none", **look)


def _status(run: Any) -> str:
    """Return the status word of a response; empty without one."""
    return str(getattr(getattr(run, "metrics", run), "status", ""))


def _history_handles(runs: Sequence[Any], names: Sequence[str], panels: Sequence[Axes]) -> list[Artist]:
    """Return the legend: each named impact, then every mark and limit that is drawn."""
    from matplotlib.lines import Line2D

    handles: list[Artist] = [Line2D([], [], label=name, **style.run_look(i)) for i, name in enumerate(names)]
    lines = [line for axes in panels for line in axes.lines]
    if any(line.get_marker() == "*" for line in lines):
        handles.append(Line2D([], [], label="largest within the impact period", color=style.NEUTRAL, **PEAK_LOOK))
    for status in dict.fromkeys(_status(run) for run in runs):
        if status in BEYOND_MARKS:
            look = {**BEYOND_MARKS[status], "markeredgecolor": style.NEUTRAL, "markersize": 9.0}
            label = f"deepest, {STATUS_WORDS[status]}: no limit counts as kept"
            handles.append(Line2D([], [], label=label, linestyle="none", **look))
    if any(line.get_gid() == LIMIT_GID for line in lines):
        handles.append(Line2D([], [], label="limit", **LIMIT_LOOK))
    return handles


def _finish(axes: Axes, quantity: str, limits: Mapping[str, float] | None) -> None:
    """Label the axis of a quantity and draw its limit."""
    axes.set_ylabel(QUANTITIES[quantity][0])
    axes.axhline(0.0, color=style.NEUTRAL, linewidth=0.8)
    if limits is not None and quantity in limits:
        axes.axhline(shown_number(f"limits[{quantity!r}]", limits[quantity]), gid=LIMIT_GID, **LIMIT_LOOK)
