"""Pictures of sensing: errors of a calibrated camera over the floor, estimated velocities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import points as checked_points
from hrsafety._arguments import vector
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plotting import inputs, notes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection
    from matplotlib.figure import Figure

    from hrsafety.navigation.sensing import CalibrationStudy, Observation

__all__ = ["calibration_errors", "velocity_estimates"]

MILLI = 1e-3
MARGIN = 0.35  # around the places, in m
TRUTH: style.Properties = {"color": "#B0B0B0", "linewidth": 4.0, "zorder": 1.5}
COMPONENTS = ("x", "y")


@notes.picture
def calibration_errors(study: CalibrationStudy, *, title: str | None = None) -> Figure:
    """Draw where a calibrated camera measures how far off: its picture, and the floor at each height.

    The first panel is the picture with the calibration points; the others show the mean error of
    patches at one height over all calibrations, in color, and the calibration points from above.

    Parameters
    ----------
    study : CalibrationStudy
        Calibrations with noise.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        One axes in pixels and one for each height of the places in m, with a color bar in mm.

    Raises
    ------
    InvalidParameterError
        If there are no places.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> figure = plotting.robots.calibration_errors(nav.sensing.calibration_study(seeds=2))
    >>> figure.axes[0].get_xlabel()
    'column (pixel)'
    """
    if not len(study.places):
        raise InvalidParameterError("study", "have places", 0)
    heights = np.unique(study.places[:, 2])
    figure = style.new_figure(4.3 + 2.9 * len(heights), title=title, compressed=True)
    ratios = [1.4, *(1.0 for _ in heights)]
    panels = figure.subplots(1 + len(heights), 1, squeeze=False, gridspec_kw={"height_ratios": ratios})[:, 0]
    _draw_picture(panels[0], study)
    mean = study.place_error.mean(axis=0) / MILLI
    limits = (float(mean.min()), float(mean.max()))
    drawn = None
    for axes, height in zip(panels[1:], heights, strict=True):
        own = study.places[:, 2] == height
        drawn = _draw_floor(axes, study, own, mean[own], limits)
        axes.set_title(f"patches at a height of {height:g} m", loc="left")
    if drawn is not None:
        figure.colorbar(drawn, ax=list(panels[1:]), label="mean error (mm)", shrink=0.9)
    return figure


def _draw_picture(axes: Axes, study: CalibrationStudy) -> None:
    width, height = study.camera.image_size_px
    pixels = study.camera.project(study.points)
    raised = study.points[:, 2] > 0.0
    look: style.Properties = {"linestyle": "none", "markersize": 6.5}
    axes.plot(*pixels[~raised].T, marker="o", color=style.RUN_COLORS[0], label="on the floor", **look)
    axes.plot(*pixels[raised].T, marker="^", color=style.PERSON_COLORS[0], label="above the floor", **look)
    axes.plot(*study.camera.image_center_px, marker="+", color="black", label="image center", **look)
    axes.set_xlim(-0.5, width - 0.5)
    axes.set_ylim(height - 0.5, -0.5)  # rows count downwards
    axes.set_aspect("equal")
    axes.set_xlabel("column (pixel)")
    axes.set_ylabel("row (pixel)")
    axes.set_title("picture with the calibration points", loc="left")
    axes.legend(loc="lower left", ncols=3, columnspacing=1.2, handletextpad=0.2)


def _draw_floor(
    axes: Axes,
    study: CalibrationStudy,
    own: npt.NDArray[np.bool_],
    mean: npt.NDArray[np.float64],
    limits: tuple[float, float],
) -> PathCollection:
    places = study.places[own]
    drawn = axes.scatter(
        places[:, 0], places[:, 1], c=mean, marker="s", s=62, linewidths=0.0, vmin=limits[0], vmax=limits[1]
    )
    look: style.Properties = {"linestyle": "none", "markersize": 5.5, "markeredgecolor": "white"}
    raised = study.points[:, 2] > 0.0
    axes.plot(*study.points[~raised, :2].T, marker="o", color=style.RUN_COLORS[0], **look)
    axes.plot(*study.points[raised, :2].T, marker="^", color=style.PERSON_COLORS[0], **look)
    low, high = study.places[:, :2].min(axis=0) - MARGIN, study.places[:, :2].max(axis=0) + MARGIN
    style.frame_scene(axes, ((float(low[0]), float(high[0])), (float(low[1]), float(high[1]))))
    return drawn


@notes.picture
def velocity_estimates(
    time: npt.ArrayLike,
    velocity: npt.ArrayLike,
    observations: Observation | Sequence[Observation],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw estimated velocities over time against the true ones, one panel for each component.

    Parameters
    ----------
    time : array_like of shape (n,)
        Times of the path that was observed, in s.
    velocity : array_like of shape (n, 2)
        True velocities in m/s.
    observations : Observation or sequence of Observation
        What different visions know at these times.
    labels : sequence of str or None
        One name for each; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes in s and m/s.

    Raises
    ------
    InvalidParameterError
        If there is no observation or the number of labels is wrong.
    ShapeError
        If lengths differ.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav, plotting
    >>> time = np.arange(200) * 0.01
    >>> path = np.column_stack([time, 0.0 * time])
    >>> seen = nav.sensing.observe(nav.sensing.Vision(), time, path)
    >>> plotting.robots.velocity_estimates(time, np.gradient(path, time, axis=0), seen).axes[0].get_ylabel()
    'velocity x (m/s)'
    """
    instants, true = vector("time", time), checked_points("velocity", velocity)
    seen = _observations(observations)
    for index, each in enumerate(seen):
        if len(each.velocity) != len(instants):
            raise ShapeError(f"observations[{index}].velocity", f"({len(instants)}, 2)", each.velocity.shape)
    if len(true) != len(instants):
        raise ShapeError("velocity", f"({len(instants)}, 2)", true.shape)
    names = inputs.checked_labels(labels, len(seen), stem="observation")
    figure = style.new_figure(5.2, title=title)
    panels = figure.subplots(2, 1, sharex=True)
    for component, axes in enumerate(panels):
        axes.plot(instants, true[:, component], label="true", **TRUTH)
        for index, (each, name) in enumerate(zip(seen, names, strict=True)):
            look = style.run_look(index) | {"linewidth": 1.3, "drawstyle": "steps-post", "zorder": 3.0 + index}
            axes.plot(instants, each.velocity[:, component], label=name, **look)
        axes.set_ylabel(f"velocity {COMPONENTS[component]} (m/s)")
    panels[-1].set_xlabel("time (s)")
    panels[-1].set_xlim(float(instants[0]), float(instants[-1]))
    style.legend_below(figure, panels[0].get_lines(), columns=min(4, 1 + len(seen)))
    return figure


def _observations(given: Observation | Sequence[Observation]) -> list[Observation]:
    """Return one or several observations as a list; an observation is a tuple of arrays itself."""
    several = [given] if hasattr(given, "measured_at") else list(given)
    inputs.some("observations", several, "observation")
    return several  # type: ignore[return-value]  # told apart by the attribute
