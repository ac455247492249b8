"""Forces of contacts over time and over the closing speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy.typing as npt

from hrsafety._arguments import instance, vector
from hrsafety.contact import ContactImpact
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plotting import inputs, notes, style
from hrsafety.plotting.axis_numbers import blank_where_infinite, shown_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["contact_forces", "forces_over_speed"]

MILLI = 1000.0
LIMIT_LOOK: style.Properties = {"color": style.CONTACT_COLOR, "linewidth": 1.1, "linestyle": (0, (5, 3))}


@notes.picture
def contact_forces(
    impacts: Mapping[str, ContactImpact], *, limits: Mapping[str, float] | None = None, title: str | None = None
) -> Figure:
    """Draw the force of collisions over time.

    Parameters
    ----------
    impacts : mapping of str to ContactImpact
        Collisions by label.
    limits : mapping of str to float or None
        Limits of the force in N by label.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; the warnings of the collisions stand below it.

    Raises
    ------
    InvalidParameterError
        If there is no collision.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import contact, plotting
    >>> hit = contact.Contact(robot=8.0, body=0.6, region=75e3).simulate(0.3)
    >>> figure = plotting.contacts.contact_forces({"bare": hit}, limits={"transient": 280.0})
    >>> figure.axes[0].get_ylabel()
    'force (N)'
    """
    inputs.some("impacts", impacts, "collision")
    figure, axes = style.one_panel(3.6, title=title)
    for index, (label, impact) in enumerate(impacts.items()):
        instance(f"impacts[{label!r}]", impact, ContactImpact)
        axes.plot(MILLI * impact.time, impact.force, label=_plain(label), **style.run_look(index))
    _draw_limits(axes, limits)
    axes.set_xlabel("time (ms)")
    _finish(axes)
    return figure


@notes.picture
def forces_over_speed(
    speed: npt.ArrayLike,
    forces: Mapping[str, npt.ArrayLike],
    *,
    limits: Mapping[str, float] | None = None,
    planned: float | None = None,
    title: str | None = None,
) -> Figure:
    """Draw peak forces over the closing speed.

    Parameters
    ----------
    speed : array_like, shape (n,)
        Closing speeds in m/s.
    forces : mapping of str to array_like, shape (n,)
        Peak forces in N by label, such as those of `Contact.simulate_many`.
    limits : mapping of str to float or None
        Limits of the force in N by label.
    planned : float or None
        Planned closing speed in m/s.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ShapeError
        If forces have another length than the speeds.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import contact, plotting
    >>> speeds = [0.1, 0.2, 0.3]
    >>> found = contact.Contact(robot=8.0, body=0.6, region=75e3).simulate_many(speeds)
    >>> figure = plotting.contacts.forces_over_speed(speeds, {"bare": found.peak_force}, planned=0.25)
    """
    over = blank_where_infinite("speed", vector("speed", speed))
    figure, axes = style.one_panel(3.6, title=title)
    for index, (label, values) in enumerate(forces.items()):
        drawn = blank_where_infinite(f"forces[{label!r}]", values)
        if drawn.shape != over.shape:
            raise ShapeError(f"forces[{label!r}]", str(over.shape), drawn.shape)
        axes.plot(over, drawn, label=_plain(label), **style.run_look(index))
    _draw_limits(axes, limits)
    if planned is not None:
        axes.axvline(shown_number("planned", planned), color=style.NEUTRAL, linewidth=1.1, label="planned speed")
    axes.set_xlabel("closing speed (m/s)")
    _finish(axes)
    return figure


def _plain(label: str) -> str:
    """Return a label in which a dollar sign begins no formula."""
    return label.replace("$", r"\$")


def _draw_limits(axes: Axes, limits: Mapping[str, float] | None) -> None:
    """Draw limits, with room for them only where loads come near."""
    top = axes.get_ylim()[1]
    for label, value in (limits or {}).items():
        if not value >= 0.0:
            raise InvalidParameterError(f"limits[{label!r}]", "be a force in N, not negative", value)
        if value <= 2.5 * top:
            axes.axhline(value, **LIMIT_LOOK)
            axes.annotate(
                f"limit {_plain(label)}: {value:g} N",
                (1.0, value),
                xycoords=("axes fraction", "data"),
                ha="right",
                va="bottom",
                fontsize=style.SMALL_FONT_SIZE,
                color=style.CONTACT_COLOR,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
            )


def _finish(axes: Axes) -> None:
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("force (N)")
    axes.legend(**style.LEGEND_BESIDE)
