"""Spread of runs that differ in their seeds only: paths and distances as bands."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.bands import Band
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.plotting import floor, inputs, notes, shapes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.scenario import Scenario
    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["repeated_distances", "repeated_paths"]

MOST_PATHS = 60  # more are a blot
MARGIN = 0.35  # free space around the paths, in m
BAND_ALPHA = 0.25
PATH_LOOK: style.Properties = {"color": style.RUN_COLORS[0], "linewidth": 0.6, "alpha": 0.35}
EXACT_LOOK: style.Properties = {"color": "black", "linewidth": 1.6, "linestyle": (0, (5, 2))}
LEGEND_COLUMNS = 4


class _Kept(NamedTuple):
    """Samples that were kept of runs with paths, see `RunTable`."""

    time: inputs.Array
    position: inputs.Array
    contact_time: inputs.Array


def _checked(runs: RunTable, exact: Trajectory | None) -> _Kept:
    """Return what was kept of the runs of one law in one scenario."""
    if not isinstance(runs, RunTable):
        raise InvalidParameterError("runs", "be a RunTable", Shown(type(runs).__name__))
    single = len(runs.scenarios) == len(runs.laws) == 1
    if runs.time is None or runs.position is None or runs.contact_time is None or not single:
        found = f"{len(runs.laws)} laws in {len(runs.scenarios)} scenarios"
        remedy = "`simulate_many(..., paths=True)` keeps them, `select` picks a law and a scenario"
        raise InvalidParameterError("runs", "be of one law in one scenario, with paths", Shown(found), remedy)
    if exact is not None:
        inputs.checked_trajectory("exact", exact)
    return _Kept(runs.time, runs.position, runs.contact_time)


@notes.picture
def repeated_paths(
    runs: RunTable, *, exact: Trajectory | None = None, share: float = 0.9, title: str | None = None
) -> Figure:
    """Draw the paths of repeated runs from above, the band in which most of them lie and its median.

    The band is taken across the straight way from start to goal. Stationary obstacles are shown
    with their regions; of moving ones see `repeated_distances`. A first contact is a cross.

    Parameters
    ----------
    runs : RunTable
        Runs of one law in one scenario, with their paths.
    exact : Trajectory or None
        A run to compare them with, for example without errors.
    share : float
        Share of the runs inside the band.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If an argument is of another kind, or the share is not above 0 and at most 1.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> noisy = replace(scenarios.configuration("c1"), measurement=nav.Measurement(of="robot"))
    >>> runs = nav.simulate_many(noisy, nav.VirtualForceField(), seeds=20, paths=True)
    >>> plotting.repeated_paths(runs).axes[0].get_xlabel()
    'x (m)'
    """
    kept = _checked(runs, exact)
    band = runs.path_band(share)
    scenario = runs.scenarios[0]
    still = [obstacle for obstacle in scenario.obstacles if not shapes.is_mobile(obstacle)]
    places = kept.position[np.isfinite(kept.position[..., 0])]
    regions = [
        shapes.region(obstacle, shapes.center(obstacle), shapes.region_radii(obstacle)[0]).get_extents().get_points()
        for obstacle in still
    ]
    limits = inputs.view_limits([places, *regions], margin=MARGIN)
    figure, (axes,) = floor.panels(limits, entries=2 * LEGEND_COLUMNS, title=title)
    looks = shapes.looks(scenario.obstacles)
    for obstacle, look in zip(scenario.obstacles, looks, strict=True):
        if not shapes.is_mobile(obstacle):
            shapes.add_obstacle(axes, obstacle, shapes.center(obstacle), look.color, regions=True)
    _draw_paths(axes, (runs.scenarios[0], kept), band, share)
    if exact is not None:
        floor.line(axes, exact.position, zorder=5.0, label="compared with", **EXACT_LOOK)
    shapes.add_start_and_goal(axes, scenario)
    handles, _ = axes.get_legend_handles_labels()
    return floor.finish(figure, [*handles, *shapes.start_and_goal_handles(), *_standing_handles(scenario)], runs=[runs])


def _standing_handles(scenario: Scenario) -> list[Artist]:
    """Return the legend of the obstacles that are drawn: those that stand."""
    obstacles = scenario.obstacles
    standing = [index for index, obstacle in enumerate(obstacles) if not shapes.is_mobile(obstacle)]
    return shapes.obstacle_handles(obstacles, regions=bool(standing), shown=standing)


def _draw_paths(axes: Axes, scene: tuple[Scenario, _Kept], band: Band, share: float) -> None:
    """Draw some paths, the band of all and the first contacts."""
    scenario, kept = scene
    for row in range(min(len(kept.time), MOST_PATHS)):
        label = f"{min(len(kept.time), MOST_PATHS)} of {len(kept.time)} paths" if row == 0 else None
        floor.line(axes, kept.position[row], zorder=3.0, label=label, **PATH_LOOK)
    start, goal = np.asarray(scenario.start), np.asarray(scenario.goal)
    along = (goal - start) / np.hypot(*(goal - start))
    across = np.array([-along[1], along[0]])
    there = band.runs > 0
    low, middle, high = (
        start + np.outer(band.abscissa[there], along) + np.outer(offset[there], across)
        for offset in (band.low, band.middle, band.high)
    )
    edge = np.concatenate([low, high[::-1]])
    axes.fill(
        *edge.T, color=style.RUN_COLORS[0], alpha=BAND_ALPHA, linewidth=0.0, label=f"{100 * share:.0f} % of the runs"
    )
    floor.line(axes, middle, zorder=4.0, color=style.RUN_COLORS[0], linewidth=2.0, label="median")
    touched = np.nanmin(np.where(np.isnan(kept.contact_time), np.inf, kept.contact_time), axis=1, initial=np.inf)
    rows = [(run, int(np.nanargmin(np.abs(kept.time[run] - touched[run])))) for run in np.flatnonzero(touched < np.inf)]
    if rows:
        crosses = np.array([kept.position[run, row] for run, row in rows])
        look: style.Properties = {"marker": "X", "color": style.CONTACT_COLOR, "markersize": 7, "linestyle": "none"}
        axes.plot(*crosses.T, label=f"first contact, {len(rows)} runs", zorder=6.0, **look)


@notes.picture
def repeated_distances(
    runs: RunTable, *, exact: Trajectory | None = None, share: float = 0.9, title: str | None = None
) -> Figure:
    """Draw the distances to the goal and to every obstacle over time as bands with their medians.

    A run counts until it ends; bands end where half of the runs have. Dotted lines are the radii
    r_3 of the critical regions.

    Parameters
    ----------
    runs : RunTable
        Runs of one law in one scenario, with their paths.
    exact : Trajectory or None
        A run to compare them with, dashed.
    share : float
        Share of the runs inside the bands.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture: one axes for the goal and one for each obstacle, in s and m.

    Raises
    ------
    InvalidParameterError
        If an argument is of another kind, or the share is not above 0 and at most 1.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> noisy = replace(scenarios.configuration("c2"), measurement=nav.Measurement())
    >>> runs = nav.simulate_many(noisy, nav.VirtualForceField(side_hysteresis=3.0), seeds=20, paths=True)
    >>> [axes.get_ylabel() for axes in plotting.repeated_distances(runs).axes]
    ['e (m)', 'd, person (m)']
    """
    _checked(runs, exact)
    obstacles = runs.scenarios[0].obstacles
    figure = style.new_figure(0.7 + 2.1 * (1 + len(obstacles)), title=title)
    panels = figure.subplots(1 + len(obstacles), 1, sharex=True, squeeze=False)[:, 0]
    to_goal = None
    if exact is not None:
        to_goal = np.hypot(*(np.asarray(exact.scenario.goal) - exact.position).T)
    looks = [shapes.Look("e", style.RUN_COLORS[0])]
    looks += [shapes.Look(f"d, {look.name}", look.color) for look in shapes.looks(obstacles)]
    for index, (axes, look) in enumerate(zip(panels, looks, strict=True)):
        band = runs.goal_band(share) if index == 0 else runs.distance_band(index - 1, share)
        most = 2 * band.runs >= len(runs)
        low, high = band.low[most], band.high[most]
        words = f"{100 * share:.0f} % of the runs"
        axes.fill_between(
            band.abscissa[most], low, high, color=look.color, alpha=BAND_ALPHA, linewidth=0.0, label=words
        )
        axes.plot(band.abscissa[most], band.middle[most], color=look.color, label="median")
        if exact is not None:
            axes.plot(
                exact.time, to_goal if index == 0 else exact.distance[:, index - 1], label="compared", **EXACT_LOOK
            )
        if index > 0:
            _, critical = shapes.region_radii(obstacles[index - 1])
            axes.axhline(critical, color=look.color, linestyle=":", linewidth=1.1, label="critical, $r_3$")
        axes.set_ylabel(f"{look.name} (m)")
        axes.set_ylim(bottom=0.0)
        axes.legend(**style.LEGEND_BESIDE)
    panels[-1].set_xlabel("time (s)")
    panels[-1].set_xlim(0.0, float(runs.end_time.max()))
    figure.align_ylabels()
    return figure
