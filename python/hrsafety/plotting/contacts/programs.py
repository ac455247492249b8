"""Speeds of a robot program along its path, beside what is allowed there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import vector
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plotting import notes, style
from hrsafety.plotting.axis_numbers import blank_where_infinite

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["speed_over_path"]

ROOM = 1.15
"""Share of the fastest run up to which the picture reaches: allowed speeds far above it tell nothing."""


@notes.picture
def speed_over_path(
    way: npt.ArrayLike,
    speeds: Mapping[str, npt.ArrayLike],
    *,
    allowed: npt.ArrayLike | None = None,
    zones: Sequence[tuple[float, float, float]] = (),
    segments: Mapping[str, tuple[float, float]] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the speed of a tool center point over its way.

    Parameters
    ----------
    way : array_like, shape (n,)
        Way of the tool center point in m.
    speeds : mapping of str to array_like, shape (n,)
        Speeds in m/s by label.
    allowed : array_like, shape (n,) or None
        Speed in m/s that limits of contacts allow, inf where none holds.
    zones : sequence of (float, float, float)
        Way in m where each zone begins and ends, and its speed in m/s.
    segments : mapping of str to (float, float) or None
        Way in m where each segment begins and ends.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    ShapeError
        If speeds have another length than the way.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.contacts.speed_over_path([0.0, 0.5, 1.0], {"planned": [0.0, 0.25, 0.0]}, allowed=[0.2] * 3)
    >>> figure.axes[0].get_xlabel()
    'way of the tool center point (m)'
    """
    along = vector("way", way)
    if not speeds:
        raise InvalidParameterError("speeds", "hold at least one run", Shown("none"))
    figure, axes = style.one_panel(3.8, title=title)
    top = 0.0
    for index, (label, values) in enumerate(speeds.items()):
        drawn = _of_length(f"speeds[{label!r}]", values, along)
        top = max(top, float(np.nanmax(drawn, initial=0.0)))
        axes.plot(along, drawn, label=label.replace("$", r"\$"), **style.run_look(index))
    if allowed is not None:
        drawn = _of_length("allowed", allowed, along)
        axes.plot(along, drawn, label="allowed", color=style.CONTACT_COLOR, linewidth=1.1, linestyle=(0, (5, 3)))
    for index, (first, last, speed) in enumerate(zones):
        told = "zone as typed" if index == 0 else None
        axes.plot([first, last], [speed, speed], color=style.NEUTRAL, linewidth=2.4, label=told)
        top = max(top, min(speed, 2.0 * top))
    for index, (name, (first, last)) in enumerate((segments or {}).items()):
        axes.axvspan(first, last, color=style.NEUTRAL, alpha=0.06 if index % 2 else 0.13, linewidth=0.0)
        axes.annotate(
            name.replace("$", r"\$"),
            (0.5 * (first + last), 1.0),
            xycoords=("data", "axes fraction"),
            ha="center",
            va="bottom",
            fontsize=style.SMALL_FONT_SIZE,
        )
    axes.set_xlim(0.0, float(along[-1]) if len(along) and along[-1] > 0.0 else 1.0)
    axes.set_ylim(0.0, ROOM * top if top > 0.0 else 1.0)
    axes.set_xlabel("way of the tool center point (m)")
    axes.set_ylabel("speed (m/s)")
    axes.legend(**style.LEGEND_BESIDE)
    return figure


def _of_length(name: str, values: npt.ArrayLike, along: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    drawn = blank_where_infinite(name, values)
    if drawn.shape != along.shape:
        raise ShapeError(name, str(along.shape), drawn.shape)
    return drawn
