"""The robot that follows a sound: runs with times, collision rates, laws."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import vector
from hrsafety._bounds import MOST_INSTANTS
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plotting import floor, inputs, labels, notes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

    from hrsafety._statistics import Share
    from hrsafety.reactive import FollowerRun, VirtualImpedance

__all__ = ["follower_rates", "follower_runs", "impedance_forces"]

ROBOT_COLOR, LEADER_COLOR = style.RUN_COLORS[0], style.GOAL_COLOR
STANDING_COLOR = "#8A8A8A"
MOST_COLUMNS = 2
MARGIN = 0.5  # free space around everything, in m
SHORT_BAR = 0.1
DISTANCES = np.linspace(0.0, 2.0, 201)
SPEEDS = np.linspace(0.0, 1.0, 201)


@notes.picture
def follower_runs(
    runs: Mapping[str, FollowerRun], *, times: Sequence[float] | None = None, title: str | None = None
) -> Figure:
    """Draw runs of the follower: path, leader, and everything at a few times.

    Parameters
    ----------
    runs : mapping of str to FollowerRun
        Runs by the titles of their panels.
    times : sequence of float or None
        When robot and obstacles are drawn, in s; four times of the run when ``None``. The end is
        always drawn.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, one axes for each run.

    Raises
    ------
    InvalidParameterError
        If there is no run.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> scene = reactive.FollowerLayouts(kind="one_dynamic").scene(3)
    >>> figure = plotting.reactive.follower_runs({"active": reactive.follow(scene)}, times=[5.0, 10.0])
    """
    inputs.some("runs", runs, "run")
    for name, run in runs.items():
        check_rows(f"runs[{name!r}]", run)
    limits = view_of(list(runs.values()))
    titles = [f"{name}\n{_ending(run)}" for name, run in runs.items()]
    places: dict[str, int] = {"columns": MOST_COLUMNS, "entries": 6, "legend_columns": 3}
    figure, panels = floor.panels(limits, titles=titles, title=title, compressed=False, **places)
    named = [
        label for axes, run in zip(panels, runs.values(), strict=True) for label in _draw_run(axes, run, times, limits)
    ]
    return floor.finish(figure, _handles(list(runs.values()), panels), columns=3, named=named)


def check_rows(name: str, run: FollowerRun) -> None:
    """Refuse a run that ended before its first row."""
    if not len(run.time):
        rule = "have a row at least, which a robot that begins in a contact has not"
        raise InvalidParameterError(name, rule, Shown("a run without rows"))


def view_of(runs: Sequence[FollowerRun]) -> style.Limits:
    """Return what has to be seen: paths, all that stands, and moving obstacles while they are near them."""
    points = [np.vstack([run.position, run.source]) for run in runs]
    for run in runs:
        for mover in run.scene.movers:
            if mover.velocity == (0.0, 0.0):
                points.append(patch_of(mover.shape, np.zeros(2)).get_extents().get_points())
    both = np.vstack(points)
    (left, low), (right, high) = both.min(axis=0), both.max(axis=0)
    reach = max(2.0, high + MARGIN, -low + MARGIN)
    return ((float(left) - MARGIN, float(right) + MARGIN), (-float(reach), float(reach)))


def _ending(run: FollowerRun) -> str:
    if run.collided:
        assert run.contact_bearing is not None
        return f"contact at {run.time[-1]:.1f} s, {abs(math.degrees(run.contact_bearing)):.0f} deg off the front"
    return f"least clearance {run.min_clearance:.2f} m, ends {run.source_distance:.2f} m from the source"


def _draw_run(axes: Axes, run: FollowerRun, times: Sequence[float] | None, limits: style.Limits) -> list[Annotation]:
    """Draw one run and return the labels of its instants."""
    named: list[Annotation] = []
    end = float(run.time[-1])
    chosen = np.linspace(0.0, end, 5)[1:-1] if times is None else vector("times", times)
    if len(chosen) > MOST_INSTANTS:
        raise InvalidParameterError("times", f"be at most {MOST_INSTANTS} instants in s", Shown(f"{len(chosen)}"))
    wanted = chosen[(chosen >= 0.0) & (chosen < end)]
    floor.line(axes, run.source, zorder=2, color=LEADER_COLOR, linewidth=1.2, linestyle="--")
    axes.plot(*run.source[-1], marker="*", color=LEADER_COLOR, markersize=11, linestyle="none", zorder=5)
    floor.line(axes, run.position, zorder=3, color=ROBOT_COLOR)
    shown = _apart(run, [int(np.searchsorted(run.time, each)) for each in wanted])
    for rank, row in enumerate(shown):
        last = rank == len(shown) - 1
        strength = 0.25 + 0.55 * (rank + 1) / len(shown)
        color = style.CONTACT_COLOR if last and run.collided else ROBOT_COLOR
        floor.disc(axes, run.position[row], run.body_radius, color, strength=strength, face=0.35)
        named.append(_label(axes, run.position[row], f"{run.time[row]:.0f} s", color))
        for index, mover in enumerate(run.scene.movers):
            moves = mover.velocity != (0.0, 0.0)
            if not moves and not last:
                continue
            body = patch_of(mover.shape, run.shift[row, index])
            edge = style.PERSON_COLORS[index % 2]
            if moves and not _within(body, limits):
                continue
            body.set(
                facecolor=edge if moves else STANDING_COLOR, alpha=0.55 * strength if moves else 0.8, linewidth=0.8
            )
            axes.add_patch(body)
            if moves:
                center = np.asarray(getattr(mover.shape, "center", (0.0, 0.0))) + run.shift[row, index]
                named.append(_label(axes, center, f"{run.time[row]:.0f} s", "black"))
    return named


def _apart(run: FollowerRun, rows: Sequence[int]) -> list[int]:
    """Return the rows at which a robot stands beside the ones that are drawn already, and the end."""
    end = len(run) - 1
    found: list[int] = []
    for row in rows:
        others = run.position[[*found, end]]
        if np.hypot(*(others - run.position[row]).T).min() > 2.0 * run.body_radius:
            found.append(row)
    return [*found, end]


def _within(body: Any, limits: style.Limits) -> bool:
    """Return whether all of a body is in view."""
    box = body.get_extents()
    (left, right), (bottom, top) = limits
    return bool(box.x0 >= left and box.x1 <= right and box.y0 >= bottom and box.y1 <= top)


def _label(axes: Axes, place: Any, text: str, color: str) -> Annotation:
    return labels.label(axes, text, (float(place[0]), float(place[1])), fontsize=8.5, color=color)


def patch_of(shape: Any, shift: Any) -> Any:
    """Return the shape somewhere else."""
    from matplotlib.patches import Circle, Polygon
    from matplotlib.transforms import Affine2D

    if hasattr(shape, "radius"):
        return Circle(tuple(np.asarray(shape.center) + shift), shape.radius)
    if hasattr(shape, "size"):
        signs = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        turned = Affine2D().rotate(shape.angle).translate(*(np.asarray(shape.center) + shift))
        return Polygon(turned.transform(0.5 * signs * np.asarray(shape.size)))
    ends = np.asarray([shape.start, shape.end]) + shift
    return Polygon(ends, closed=False, fill=False)


def _handles(runs: Sequence[FollowerRun], panels: Iterable[Axes]) -> list[Artist]:
    """Return the legend: only what is drawn."""
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Patch

    star: style.Properties = {"marker": "*", "linestyle": "--", "linewidth": 1.2, "markersize": 10}
    ring: style.Properties = {"marker": "o", "markerfacecolor": "none", "markersize": 10}
    handles: list[Artist] = [
        floor.handle("follower, with times", color=ROBOT_COLOR, linestyle="-", **ring),
        floor.handle("source of the sound", color=LEADER_COLOR, **star),
    ]
    if any(run.collided for run in runs):
        handles.append(floor.handle("contact", color=style.CONTACT_COLOR, **ring))
    drawn = {to_rgb(patch.get_facecolor()) for axes in panels for patch in axes.patches}
    for index, color in enumerate(style.PERSON_COLORS[:2]):
        if to_rgb(color) in drawn:
            handles.append(Patch(facecolor=color, alpha=0.5, label=f"moving obstacle {index + 1}, with times"))
    if to_rgb(STANDING_COLOR) in drawn:
        handles.append(Patch(facecolor=STANDING_COLOR, label="standing obstacle"))
    return handles


@notes.picture
def follower_rates(
    rates: Mapping[str, Mapping[str, Share]],
    *,
    marks: Mapping[str, Mapping[str, float]] | None = None,
    label: str = "collision rate",
    marks_label: str = "reference",
    title: str | None = None,
) -> Figure:
    """Draw rates as bars with their 95 % intervals, settings side by side.

    Parameters
    ----------
    rates : mapping of str to mapping of str to Share
        Setting, then law, for example ``experiment(...).collision_rate``.
    marks : mapping of str to mapping of str to float or None
        Values to compare with, by the same words.
    label, marks_label : str
        What the bars and the marks are.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If there is no rate.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> found = {law: reactive.experiment("one_dynamic", law, layouts=50).collision_rate
    ...          for law in ("conventional", "active")}
    >>> figure = plotting.reactive.follower_rates({"one moving box": found})
    """
    laws = list(dict.fromkeys(law for each in rates.values() for law in each))
    inputs.some("rates", laws, "rate")
    figure, axes = style.one_panel(4.2, title=title)
    width = 0.8 / len(laws)
    for rank, law in enumerate(laws):
        places = np.array([index for index, each in enumerate(rates.values()) if law in each])
        shares = [each[law] for each in rates.values() if law in each]
        value = np.array([share.value for share in shares])
        errors = np.array([[share.value - share.low, share.high - share.value] for share in shares]).T
        at = places - 0.4 + (rank + 0.5) * width
        look: style.Properties = {"capsize": 3, "error_kw": {"linewidth": 1.0}}
        axes.bar(at, value, 0.92 * width, yerr=errors, color=style.RUN_COLORS[rank % 5], alpha=0.8, label=law, **look)
        for x, share in zip(at, shares, strict=True):
            # At the foot of the bar, where neither interval nor mark can be, unless it is short.
            text: style.Properties = {"ha": "center", "va": "bottom", "fontsize": 8.5, "zorder": 6}
            foot = 0.012 if share.low > SHORT_BAR else share.high + 0.012
            axes.text(x, foot, f"{share.value:.3f}", **text)
    _add_marks(axes, rates, marks, laws, marks_label)
    axes.set_xticks(range(len(rates)), list(rates))
    axes.set_ylabel(f"{label}, with 95 % interval")
    axes.set_ylim(0.0, 1.08)
    axes.grid(visible=False, axis="x")
    handles, _ = axes.get_legend_handles_labels()
    style.legend_below(figure, handles, columns=4)
    return figure


def _add_marks(
    axes: Axes,
    rates: Mapping[str, Mapping[str, Share]],
    marks: Mapping[str, Mapping[str, float]] | None,
    laws: Sequence[str],
    label: str,
) -> None:
    width = 0.8 / len(laws)
    points = [
        (index - 0.4 + (laws.index(law) + 0.5) * width, value)
        for index, setting in enumerate(rates)
        for law, value in (marks or {}).get(setting, {}).items()
        if law in laws
    ]
    if points:
        look: style.Properties = {"marker": "D", "linestyle": "none", "color": "black", "markersize": 5}
        axes.plot(*np.array(points).T, label=label, zorder=5, markerfacecolor="white", **look)


@notes.picture
def impedance_forces(laws: Mapping[str, VirtualImpedance], *, title: str | None = None) -> Figure:
    """Draw the repulsion over distance and over approach speed.

    Parameters
    ----------
    laws : mapping of str to VirtualImpedance
        Laws by their labels.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Spring part on the left, damping part at half the safe distance on the right.

    Raises
    ------
    InvalidParameterError
        If there is no law.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> figure = plotting.reactive.impedance_forces({"active": reactive.VirtualImpedance()})
    """
    inputs.some("laws", laws, "law")
    figure = style.new_figure(3.6, title=title)
    left, right = figure.subplots(1, 2)
    for rank, (name, law) in enumerate(laws.items()):
        look = style.run_look(rank)
        left.plot(DISTANCES, law.spring_force(DISTANCES), label=name, **look)
        right.plot(SPEEDS, law.damping_force(0.5 * law.safe_distance, SPEEDS), **look)
    left.set(xlabel="||C|| (m)", ylabel="spring part (N)")
    right.set(xlabel="approach speed (m/s)", ylabel="damping part (N)")
    handles, _ = left.get_legend_handles_labels()
    style.legend_below(figure, handles, columns=4)
    return figure
