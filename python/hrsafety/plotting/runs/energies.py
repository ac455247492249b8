"""Motor currents and electrical loss of runs over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.plotting import inputs, notes, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["energy"]


@notes.picture
def energy(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the motor currents of each run and, below, the accumulated electrical loss of all.

    The loss is that of the windings, the sum of R_a i^2 over wheels and steps, with the
    winding resistance of the robot.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        The runs.
    labels : sequence of str or None
        One name for each run; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture: one axes of currents in A for each run and one of losses in J.

    Raises
    ------
    InvalidParameterError
        If there is no run or the number of labels is wrong.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> [axes.get_ylabel() for axes in plotting.energy(run).axes]
    ['current (A)', 'loss (J)']
    """
    runs = inputs.checked_runs(trajectories, ["wheel_current"])
    names = inputs.checked_labels(labels, len(runs), stem="robot" if len(runs) == 1 else "run")
    figure = style.new_figure(0.7 + 2.2 * (len(runs) + 1), title=title)
    panels = figure.subplots(len(runs) + 1, 1, sharex=True)
    for axes, run, name in zip(panels, runs, names, strict=False):
        for wheel, current in enumerate(run.wheel_current.T):
            look: style.Properties = {"color": style.WHEEL_COLORS[wheel % len(style.WHEEL_COLORS)], "linewidth": 1.1}
            axes.step(run.time, current, where="pre", label=f"wheel {wheel + 1}", **look)
        axes.set_ylabel("current (A)")
        if labels is not None or len(runs) > 1:
            axes.set_title(name, loc="left")
        if axes is not panels[0]:
            axes.sharey(panels[0])
    most = max(range(len(runs)), key=lambda index: runs[index].wheel_current.shape[1])
    panels[0].legend(*panels[most].get_legend_handles_labels(), **style.LEGEND_BESIDE)
    for index, (run, name) in enumerate(zip(runs, names, strict=True)):
        loss = accumulated_loss(run)
        panels[-1].plot(run.time, loss, label=f"{name}, {loss[-1]:.2f} J", **style.run_look(index))
    panels[-1].legend(**style.LEGEND_BESIDE)
    panels[-1].set_ylabel("loss (J)")
    panels[-1].set_ylim(bottom=0.0)
    panels[-1].set_xlabel("time (s)")
    panels[-1].set_xlim(0.0, inputs.time_limit(runs))
    figure.align_ylabels()
    return figure


def accumulated_loss(run: Trajectory) -> inputs.Array:
    """Return the loss in the windings since the begin of a run in J, shape (n,)."""
    if run.energy_used is not None:
        return run.energy_used
    power = run.scenario.robot.winding_resistance * (run.wheel_current**2).sum(axis=1)
    loss: inputs.Array = np.concatenate([[0.0], np.cumsum(power[1:] * np.diff(run.time))])
    return loss
