"""Allowed speeds of contacts: over a covering, over the distance, and what they hang on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import instance, pair
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plotting import inputs, notes, style
from hrsafety.plotting.axis_numbers import along_axis, blank_where_infinite, shown_number
from hrsafety.standards import SpeedCurve

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["contact_sensitivity", "speed_map", "speed_over_distance"]

MILLI = 1000.0
MODES = {"contact": "contact allowed at this speed", "separation": "stop before contact"}


@notes.picture
def speed_map(
    thickness: npt.ArrayLike,
    strength: npt.ArrayLike,
    speed: npt.ArrayLike,
    *,
    quantity: str = "modulus (Pa)",
    wanted: float | None = None,
    own: tuple[float, float] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the allowed speed over the thickness and a number of the law of a covering.

    Parameters
    ----------
    thickness : array_like, shape (n,)
        In m, rising.
    strength : array_like, shape (k,)
        Number of the law, rising; both axes are logarithmic.
    speed : array_like, shape (n, k)
        Allowed closing speeds in m/s, of `Contact.allowed_speeds`; what is not finite is left blank.
    quantity : str
        Label of the number with its unit.
    wanted : float or None
        Speed in m/s whose contour is drawn.
    own : tuple of two floats or None
        Thickness and number of a covering to mark.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ShapeError
        If ``speed`` has another shape, or an axis has less than two points.
    InvalidParameterError
        If an axis does not rise, or a number cannot be drawn.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.contacts.speed_map([0.01, 0.02], [1e5, 2e5], [[0.3, 0.4], [0.5, 0.6]], wanted=0.45)
    """
    rows, columns = along_axis("thickness", thickness, log=True), along_axis("strength", strength, log=True)
    table = blank_where_infinite("speed", speed)
    if table.shape != (len(rows), len(columns)):
        raise ShapeError("speed", f"({len(rows)}, {len(columns)})", table.shape)
    figure, axes = style.one_panel(4.4, title=title)
    colors = axes.pcolormesh(columns, MILLI * rows, table, shading="nearest", rasterized=False)
    bar = figure.colorbar(colors, ax=axes, label="allowed closing speed (m/s)")
    known = table[np.isfinite(table)]
    if wanted is not None and known.size and known.min() < wanted < known.max():
        axes.contour(columns, MILLI * rows, table, levels=[wanted], colors="white", linewidths=1.8)
        bar.ax.axhline(wanted, color="white", linewidth=1.8)
    if own is not None:
        own = _own(own)
        axes.plot([own[1]], [MILLI * own[0]], "o", color="white", markeredgecolor="black", label="planned covering")
        axes.legend(loc="lower right", frameon=True)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(visible=False)
    axes.set_xlabel(quantity)
    axes.set_ylabel("thickness (mm)")
    for axis, shown in ((axes.xaxis, columns), (axes.yaxis, MILLI * rows)):
        ticks, words = style.log_ticks(float(shown[0]), float(shown[-1]))
        axis.set_ticks(ticks, labels=words)
        axis.set_minor_formatter("")
    return figure


def _own(place: tuple[float, float]) -> tuple[float, float]:
    """Return thickness and number of a covering, which logarithmic axes show."""
    found = pair("own", place)
    for name, value in zip(("own[0]", "own[1]"), found, strict=True):
        if not shown_number(name, value) > 0.0:
            raise InvalidParameterError(name, "be positive, since the axes are logarithmic", value)
    return found


@notes.picture
def speed_over_distance(curve: SpeedCurve, *, title: str | None = None) -> Figure:
    """Draw the speed that is allowed at each distance to a person, v(d).

    Parameters
    ----------
    curve : SpeedCurve
        Of `standards.speed_over_distance`.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; each mode has a line of its own, and the robot's own limit is dotted.

    Raises
    ------
    ShapeError, InvalidParameterError
        If there are less than two distances, or they cannot be drawn.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, standards
    >>> curve = standards.speed_over_distance(
    ...     [0.2, 1.0, 2.0], contact_speed=0.25, max_speed=1.5, reaction_time=0.1, deceleration=3.0
    ... )
    >>> plotting.contacts.speed_over_distance(curve).axes[0].get_xlabel()
    'distance to the person (m)'
    """
    instance("curve", curve, SpeedCurve)
    distance = along_axis("curve.distance", curve.distance, rising=False)
    figure, axes = style.one_panel(3.6, title=title)
    for index, (mode, words) in enumerate(MODES.items()):
        here = (curve.mode == mode) & ~curve.capped
        # A line reaches to the first point of the next one.
        joined = here | np.concatenate([[False], here[:-1]])
        label = "contact not permitted: rest" if mode == "contact" and curve.status == "not_permitted" else words
        if here.any():
            axes.plot(curve.distance, np.where(joined, curve.speed, np.nan), label=label, **style.run_look(index))
    if curve.capped.any():
        drawn = np.where(curve.capped, curve.speed, np.nan)
        axes.plot(curve.distance, drawn, color=style.NEUTRAL, linestyle=(0, (1, 1)), label="largest speed of the robot")
    axes.set_xlabel("distance to the person (m)")
    axes.set_ylabel("speed (m/s)")
    axes.set_xlim(float(distance.min()), float(distance.max()))
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="best")
    return figure


@notes.picture
def contact_sensitivity(values: Mapping[str, float], *, title: str | None = None) -> Figure:
    """Draw what an allowed speed hangs on, the largest first.

    Parameters
    ----------
    values : mapping of str to float
        d ln v/d ln x by name, of `Contact.sensitivity`.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If there is no value, or one cannot be drawn.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.contacts.contact_sensitivity({"force_limit": 1.0, "robot_mass": -0.5})
    """
    inputs.some("values", values, "sensitivity")
    lengths = {name: float(blank_where_infinite(f"values[{name!r}]", value)) for name, value in values.items()}
    names = list(values)[::-1]
    figure, axes = style.one_panel(0.9 + 0.3 * len(names), title=title)
    colors = [style.RUN_COLORS[0] if lengths[name] > 0.0 else style.PERSON_COLORS[0] for name in names]
    axes.barh([name.replace("_", " ") for name in names], [lengths[name] for name in names], color=colors, height=0.65)
    axes.axvline(0.0, color=style.NEUTRAL, linewidth=0.8)
    axes.set_xlabel("change of the allowed speed in % for 1 % more")
    axes.grid(visible=False, axis="y")
    return figure
