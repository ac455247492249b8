"""A wheel after its reference, and a wheel in open-loop tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import instance, sequence
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.robots.wheel_identification import WheelFit
from hrsafety.plotting import inputs, notes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.robots.wheel_identification import OpenLoopTest
    from hrsafety.navigation.robots.wheels import WheelRun

__all__ = ["wheel_identification", "wheel_tracking"]

MILLI = 1000.0
WANTED_LOOK: style.Properties = {"color": style.NEUTRAL, "linewidth": 3.5, "alpha": 0.45}
THIN = 1.1


@notes.picture
def wheel_tracking(
    runs: WheelRun | Sequence[WheelRun],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the speed, the error of the angle and the current of one wheel in several runs.

    Parameters
    ----------
    runs : WheelRun or sequence of WheelRun
        The runs; the wanted speed drawn is that of the first.
    labels : sequence of str or None
        One name for each run; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Three panels over time in s: rad/s, mrad, A. The last run lies on top.

    Raises
    ------
    InvalidParameterError
        If there is no run or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> run = nav.robots.follow_wheel(nav.robots.HOLONOMIC_WHEELS[0], nav.robots.WheelReference.sine(duration=4.0))
    >>> plotting.robots.wheel_tracking(run).axes[1].get_ylabel()
    'angle error (mrad)'
    """
    all_runs = sequence("runs", "be runs of wheels", runs if isinstance(runs, (list, tuple)) else [runs])
    inputs.some("runs", all_runs, "run")
    names = inputs.checked_labels(labels, len(all_runs))
    figure = style.new_figure(6.6, title=title)
    speed, error, current = figure.subplots(3, 1, sharex=True)
    speed.plot(all_runs[0].time, all_runs[0].wanted_speed, label="wanted", **WANTED_LOOK)
    for index, (run, name) in enumerate(zip(all_runs, names, strict=True)):
        look = style.run_look(index) | {"linestyle": "-", "linewidth": THIN}
        speed.plot(run.time, run.speed, label=name, **look)
        error.plot(run.time, MILLI * run.angle_error, **look)
        current.plot(run.time, run.current, **look)
    speed.set_ylabel("speed (rad/s)")
    error.set_ylabel("angle error (mrad)")
    current.set_ylabel("current (A)")
    current.set_xlabel("time (s)")
    speed.set_xlim(0.0, float(all_runs[0].time[-1]))
    handles, _ = speed.get_legend_handles_labels()
    style.legend_below(figure, handles, columns=min(4, len(handles)))
    return figure


@notes.picture
def wheel_identification(tests: Sequence[OpenLoopTest], fit: WheelFit, *, title: str | None = None) -> Figure:
    """Draw open-loop tests, the response of the wheel that is identified from them, and its line.

    Parameters
    ----------
    tests : sequence of OpenLoopTest
        The tests that were fitted.
    fit : WheelFit
        What was found.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Angle in rad and what is left of it in mrad over time in s, one color for each command;
        accelerations of the tests in rad/s^2 over their commands in V with the fitted line.

    Raises
    ------
    InvalidParameterError
        If the tests are not those of the fit.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> tests = nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0])
    >>> plotting.robots.wheel_identification(tests, nav.robots.identify_wheel(tests)).axes[0].get_ylabel()
    'angle (rad)'
    """
    each = sequence("tests", "be the tests of the fit", tests)
    instance("fit", fit, WheelFit)
    if [test.command for test in each] != fit.command.tolist():
        raise InvalidParameterError("tests", "be the tests of the fit", Shown(f"{len(each)} tests"))
    figure = style.new_figure(4.8, title=title)
    grid = figure.add_gridspec(2, 2, height_ratios=(2.0, 1.0), width_ratios=(1.25, 1.0))
    angle = figure.add_subplot(grid[0, 0])
    left = figure.add_subplot(grid[1, 0], sharex=angle)
    line = figure.add_subplot(grid[:, 1])
    levels = sorted(set(np.abs(fit.command).tolist()))
    for test in each:
        color = _color(levels.index(abs(test.command)), len(levels))
        predicted = fit.angle(test.command, test.time)
        angle.plot(test.time, predicted, color=color)
        every = slice(0, None, max(1, len(test.time) // 12))
        angle.plot(test.time[every], test.angle[every], "o", color=color, markersize=3.5, markerfacecolor="white")
        left.plot(test.time, MILLI * (test.angle - predicted), color=color, linewidth=0.5)
    angle.set_ylabel("angle (rad)")
    angle.tick_params(labelbottom=False)
    left.set_ylabel("left (mrad)")
    left.set_xlabel("time (s)")
    _draw_line(line, fit, levels)
    style.legend_below(figure, _identification_handles(fit), columns=4)
    return figure


def _identification_handles(fit: WheelFit) -> list[Artist]:
    """Return the legend; colors are commands, as on the right."""
    from matplotlib.lines import Line2D

    ring: style.Properties = {"marker": "o", "markerfacecolor": "white", "color": style.NEUTRAL, "linestyle": "none"}
    handles: list[Artist] = [
        Line2D([], [], label="read", **ring),
        Line2D([], [], color=style.NEUTRAL, label="identified wheel"),
        Line2D([], [], marker="o", color=style.NEUTRAL, linestyle="none", label="acceleration of a test"),
    ]
    if not fit.moved.all():
        cross: style.Properties = {"marker": "x", "color": style.CONTACT_COLOR, "linestyle": "none"}
        handles.append(Line2D([], [], label="did not move", **cross))
    return handles


def _color(index: int, count: int) -> tuple[float, float, float, float]:
    from matplotlib import colormaps

    color: tuple[float, float, float, float] = colormaps["viridis"](0.9 * index / max(1, count - 1))
    return color


def _draw_line(axes: Axes, fit: WheelFit, levels: list[float]) -> None:
    """Draw the accelerations of the tests over their commands, and the fitted line from where it moves."""
    ends = np.array([fit.static_friction, 1.04 * levels[-1]])
    axes.plot(ends, fit.command_gain * ends - fit.friction_deceleration, color=style.RUN_COLORS[0], zorder=2.0)
    for command, acceleration in zip(np.abs(fit.command), fit.acceleration, strict=True):
        color = _color(levels.index(float(command)), len(levels))
        axes.plot(command, acceleration, "o", color=color, zorder=3.0)
    for command in np.abs(fit.command[~fit.moved]):
        axes.plot(command, 0.0, "x", color=style.CONTACT_COLOR, zorder=3.0)
    axes.axvline(fit.static_friction, color=style.NEUTRAL, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.annotate(
        f" friction {fit.static_friction:.3f} V",
        (fit.static_friction, 0.97),
        xycoords=("data", "axes fraction"),
        va="top",
        fontsize=style.SMALL_FONT_SIZE,
        color=style.NEUTRAL,
    )
    axes.set_xlim(left=0.0)
    axes.set_xlabel("command (V)")
    axes.set_ylabel("acceleration A (rad/s$^2$)")
