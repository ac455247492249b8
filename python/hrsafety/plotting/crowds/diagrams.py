"""The fundamental diagram: how fast people walk, the denser they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import vector
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plotting import floor, notes, style
from hrsafety.plotting.axis_numbers import blank_where_infinite

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hrsafety.plotting.inputs import Array

__all__ = ["fundamental_diagram"]

HEIGHT = 4.4  # in
MARKERS = ("o", "s", "^", "D", "v")


@notes.picture
def fundamental_diagram(
    density: npt.ArrayLike,
    speeds: Mapping[str, npt.ArrayLike],
    *,
    reference: npt.ArrayLike | None = None,
    reference_label: str = "Weidmann 1993",
    title: str | None = None,
) -> Figure:
    """Draw mean speeds of people over their density, beside a reference.

    Parameters
    ----------
    density : array_like, shape (n,)
        People for each square meter, increasing.
    speeds : mapping of str to array_like, shape (n,)
        Mean speeds in m/s by the name of the model; NaN where there is none.
    reference : array_like, shape (n,), or None
        Speeds in m/s that were measured.
    reference_label : str
        Where they are from.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If densities are not positive and increasing, or nothing is to be drawn.
    ShapeError
        If lengths differ.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.crowds.fundamental_diagram([0.5, 1, 2], {"model": [1.2, 1.0, 0.7]}, reference=[1.3, 1.1, 0.6])
    >>> figure.axes[0].get_xlabel()
    'density (1/m²)'
    """
    places = vector("density", density)
    wrong = not len(places) or not np.isfinite(places).all() or places[0] <= 0.0 or (np.diff(places) <= 0.0).any()
    if wrong:
        raise InvalidParameterError("density", "be positive and increasing", places.tolist())
    places = blank_where_infinite("density", places)
    if not places[-1] > 0.0:
        raise InvalidParameterError("density", "be large enough to be drawn", density)
    if not isinstance(speeds, Mapping) or not (speeds or reference is not None):
        rule = "be a mapping of names to speeds, with one at least"
        raise InvalidParameterError("speeds", rule, Shown(type(speeds).__name__) if speeds else speeds)
    curves = {str(name): _checked(f"speeds[{name!r}]", values, len(places)) for name, values in speeds.items()}
    figure, axes = style.one_panel(HEIGHT, title=title)
    handles = []
    if reference is not None:
        look: style.Properties = {"color": style.NEUTRAL, "linewidth": 5.0, "alpha": 0.45}
        axes.plot(places, _checked("reference", reference, len(places)), zorder=2.0, solid_capstyle="round", **look)
        handles.append(floor.handle(reference_label, linestyle="-", **look))
    for index, (name, values) in enumerate(curves.items()):
        look = style.run_look(index) | {"marker": MARKERS[index % len(MARKERS)], "markersize": 6}
        axes.plot(places, values, zorder=3.0, **look)
        handles.append(floor.handle(name, **look))
    axes.set(xlabel="density (1/m²)", ylabel="mean speed (m/s)")
    axes.set_xlim(0.0, 1.05 * float(places[-1]))
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    style.legend_below(figure, handles, columns=floor.LEGEND_COLUMNS - 1)
    return figure


def _checked(name: str, values: npt.ArrayLike, count: int) -> Array:
    """Return one speed for each density."""
    found = vector(name, values)
    if len(found) != count:
        raise ShapeError(name, f"({count},)", found.shape)
    if np.isinf(found).any():
        raise InvalidParameterError(name, "be finite or NaN", found.tolist())
    return blank_where_infinite(name, found)
