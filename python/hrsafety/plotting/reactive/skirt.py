"""Ultrasonic skirt: the ring with its beams, tests among discs, and the studies over many of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety.errors import InvalidParameterError
from hrsafety.plotting import floor, inputs, notes, style
from hrsafety.plotting.axis_numbers import shown_number

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.reactive import SkirtRun, SkirtTest, SmallestSkirt, UltrasonicSkirt

__all__ = ["skirt_clearances", "skirt_ring", "skirt_runs", "skirt_sensor_counts"]

BEAM_COLOR, SENSOR_COLOR, SAFE_COLOR = "#56B4E9", "#0072B2", "#D55E00"
WHEEL_ANGLES = (90.0, 210.0, 330.0)
CHASSIS_COLOR, SEEN_COLOR, UNSEEN_COLOR = "#E9E9E9", "#8A8A8A", "#F0E4D0"
MOST_COLUMNS = 3
_POINTS = 181


@notes.picture
def skirt_ring(
    skirt: UltrasonicSkirt, *, directions: Mapping[str, float] | None = None, title: str | None = None
) -> Figure:
    """Draw the sensors of a skirt with their beams up to the triggering distances, seen from above.

    Parameters
    ----------
    skirt : UltrasonicSkirt
        The skirt.
    directions : mapping of str to float or None
        Motion directions to draw as arrows, in rad, for example ``reactive.skirt.MOTION_DIRECTIONS``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> figure = plotting.reactive.skirt_ring(reactive.UltrasonicSkirt(), directions=reactive.skirt.MOTION_DIRECTIONS)
    """
    reach = skirt.chassis_radius - skirt.sensor_inset + float(skirt.trigger_distances.max())
    size = 1.22 * max(reach, skirt.chassis_radius)
    limits = ((-size, size), (-size, size))
    figure, axes = style.one_panel(7.6, width=6.8, title=title)
    _draw_chassis(axes, skirt)
    _draw_beams(axes, skirt)
    handles = _distance_circles(axes, skirt, size)
    for name, given in (directions or {}).items():
        angle = shown_number(f"directions[{name!r}]", given)
        x, y = (0.55 * skirt.chassis_radius * part for part in (math.cos(angle), math.sin(angle)))
        axes.annotate("", (x, y), (0.0, 0.0), arrowprops={"arrowstyle": "->", "color": style.NEUTRAL, "linewidth": 1.1})
        look: style.Properties = {"fontsize": style.SMALL_FONT_SIZE, "color": style.NEUTRAL}
        axes.text(1.28 * x, 1.28 * y, name, ha="center", va="center", **look)
    style.frame_scene(axes, limits)
    style.legend_below(figure, handles, columns=2)
    return figure


def _draw_chassis(axes: Axes, skirt: UltrasonicSkirt) -> None:
    """Draw the chassis and, where it has room for them, the wheels."""
    from matplotlib.patches import Circle, Rectangle
    from matplotlib.transforms import Affine2D

    axes.add_patch(Circle((0.0, 0.0), skirt.chassis_radius, facecolor=CHASSIS_COLOR, edgecolor="black", linewidth=1.2))
    width, length = 0.115 * skirt.chassis_radius, 0.38 * skirt.chassis_radius
    for degrees in WHEEL_ANGLES:
        wheel = Rectangle((skirt.chassis_radius - width, -0.5 * length), width, length, facecolor="black")
        wheel.set_transform(Affine2D().rotate_deg(degrees) + axes.transData)
        axes.add_patch(wheel)


def _draw_beams(axes: Axes, skirt: UltrasonicSkirt) -> None:
    """Draw each sensor, its number and the part of its beam in which an echo triggers."""
    from matplotlib.patches import Wedge

    half = math.degrees(0.5 * skirt.beam_width)
    sensors = zip(skirt.positions, skirt.bearings, skirt.trigger_distances, strict=True)
    for number, (place, bearing, reach) in enumerate(sensors, start=1):
        middle = math.degrees(bearing)
        axes.add_patch(
            Wedge(tuple(place), reach, middle - half, middle + half, facecolor=BEAM_COLOR, alpha=0.35, linewidth=0)
        )
        axes.plot(*place, marker="s", markersize=6, color=SENSOR_COLOR, zorder=4)
        x, y = place + 0.55 * reach * np.array([math.cos(bearing), math.sin(bearing)])
        axes.text(x, y, str(number), ha="center", va="center", color=SENSOR_COLOR, fontweight="bold")


def _distance_circles(axes: Axes, skirt: UltrasonicSkirt, size: float) -> list[Artist]:
    """Draw the safe distance in use and the one by the geometry, and return the legend."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Circle, Patch

    square: style.Properties = {"marker": "s", "markersize": 6, "linestyle": "none", "color": SENSOR_COLOR}
    handles: list[Artist] = [
        Line2D([], [], label="sensor, with its number", **square),
        Patch(facecolor=BEAM_COLOR, alpha=0.35, label="beam up to the triggering distance"),
    ]
    used = skirt.safe_distance if skirt.safe_distance is not None else skirt.meeting_distance
    dashed: style.Properties = {"linestyle": "--"}
    for words, radius, look in (("in use", used, {}), ("where beams meet", skirt.meeting_distance, dashed)):
        if radius < size:
            axes.add_patch(Circle((0.0, 0.0), radius, fill=False, edgecolor=SAFE_COLOR, **look))
            label = f"safe distance {words}, {radius:.3f} m"
            handles.append(Line2D([], [], color=SAFE_COLOR, label=label, **look))
    return handles


@notes.picture
def skirt_runs(runs: Mapping[str, SkirtRun], *, title: str | None = None) -> Figure:
    """Draw tests of a skirt: path, discs, and the robot where it came nearest to one.

    Parameters
    ----------
    runs : mapping of str to SkirtRun
        Runs by the titles of their panels.
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
    >>> figure = plotting.reactive.skirt_runs({"escape to the north": reactive.skirt_run(direction="N")})
    """
    inputs.some("runs", runs, "run")
    size = max(_extent(run) for run in runs.values())
    limits = ((-size, size), (-size, size))
    titles = [f"{name}\n{_ending(run)}" for name, run in runs.items()]
    places: dict[str, int] = {"columns": MOST_COLUMNS, "entries": 6, "legend_columns": 3}
    figure, panels = floor.panels(limits, titles=titles, title=title, compressed=False, **places)
    for axes, run in zip(panels, runs.values(), strict=True):
        _draw_run(axes, run)
    return floor.finish(figure, _run_handles(list(runs.values())), columns=3)


def _extent(run: SkirtRun) -> float:
    discs = np.abs(run.disc_center).max() + run.disc_radius.max()
    return 1.04 * float(max(discs, np.abs(run.position).max() + run.skirt.chassis_radius))


def _ending(run: SkirtRun) -> str:
    if math.isfinite(run.contact_time):
        return f"contact at {run.contact_time:.1f} s"
    return f"least clearance {run.min_clearance:.2f} m"


def _draw_run(axes: Axes, run: SkirtRun) -> None:
    from matplotlib.patches import Circle

    for center, radius, seen in zip(run.disc_center, run.disc_radius, run.disc_seen, strict=True):
        look = {"facecolor": SEEN_COLOR} if seen else {"facecolor": UNSEEN_COLOR, "hatch": "////"}
        axes.add_patch(Circle(tuple(center), radius, edgecolor="#404040", linewidth=0.8, **look))
    path = np.vstack([[0.0, 0.0], run.position])
    floor.line(axes, path, zorder=2, color=style.RUN_COLORS[0])
    between = np.linalg.norm(run.position[:, np.newaxis] - run.disc_center, axis=2) - run.disc_radius
    nearest = run.position[int(between.min(axis=1).argmin())]
    touched = math.isfinite(run.contact_time)
    color = style.CONTACT_COLOR if touched else style.RUN_COLORS[0]
    radius = run.skirt.chassis_radius
    axes.add_patch(Circle((0.0, 0.0), radius, fill=False, edgecolor=style.NEUTRAL, linestyle=":"))
    floor.disc(axes, nearest, radius, color, face=0.25)


def _run_handles(runs: Sequence[SkirtRun]) -> list[Artist]:
    """Return the legend: only what is drawn."""
    from matplotlib.patches import Patch

    ring: style.Properties = {"marker": "o", "markersize": 11, "markerfacecolor": "none"}
    handles: list[Artist] = [
        floor.handle("path of the robot", color=style.RUN_COLORS[0], linestyle="-"),
        floor.handle("at the start", **ring),
    ]
    touched = [math.isfinite(run.contact_time) for run in runs]
    if not all(touched):
        handles.append(floor.handle("nearest to a disc", color=style.RUN_COLORS[0], **ring))
    if any(touched):
        handles.append(floor.handle("contact", color=style.CONTACT_COLOR, **ring))
    seen = np.concatenate([run.disc_seen for run in runs])
    if seen.any():
        handles.append(Patch(facecolor=SEEN_COLOR, edgecolor="#404040", label="disc"))
    if not seen.all():
        unseen = Patch(facecolor=UNSEEN_COLOR, edgecolor="#404040", hatch="////", label="disc below the sensors")
        handles.append(unseen)
    return handles


@notes.picture
def skirt_clearances(
    tests: Mapping[str, SkirtTest],
    *,
    most: float = 0.4,
    printed: float | None = None,
    title: str | None = None,
) -> Figure:
    """Draw how many tests clear all discs completely, over the limit below which that is close.

    Parameters
    ----------
    tests : mapping of str to SkirtTest
        Tests by the names of their curves.
    most : float
        Largest limit, in m.
    printed : float or None
        Published share of tests that avoid completely, drawn as a line.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; bands are 95 % Wilson intervals. A curve begins at the share without contact.

    Raises
    ------
    InvalidParameterError
        If there is no test, or the largest limit is not finite and positive.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> figure = plotting.reactive.skirt_clearances({"ideal": reactive.skirt_test(layouts=2)}, printed=0.775)
    """
    inputs.some("tests", tests, "test")
    if not 0.0 < most < math.inf:
        raise InvalidParameterError("most", "be finite and positive", most)
    figure, axes = style.one_panel(4.9 + (0.3 if title is not None else 0.0), title=title)
    limits = np.linspace(0.0, most, _POINTS)
    for index, (name, test) in enumerate(tests.items()):
        shares = [test.shares(float(limit)).completely_avoids for limit in limits]
        look = style.run_look(index)
        axes.plot(limits, [share.value for share in shares], label=name, **look)
        band = ([share.low for share in shares], [share.high for share in shares])
        axes.fill_between(limits, *band, color=look["color"], alpha=0.18, linewidth=0)
    if printed is not None:
        axes.axhline(printed, color=SAFE_COLOR, linewidth=1.2, linestyle=(0, (2, 2)), label=f"published, {printed:.3f}")
    axes.set_xlim(0.0, most)
    axes.set_ylim(0.0, 1.02)
    axes.set_xlabel('limit of "closely" (m)')
    axes.set_ylabel("share of the tests that avoid completely")
    style.legend_below(figure, axes.get_legend_handles_labels()[0], columns=2)
    return figure


@notes.picture
def skirt_sensor_counts(studies: Sequence[SmallestSkirt], *, title: str | None = None) -> Figure:
    """Draw the share of tests with contact over the number of sensors.

    Parameters
    ----------
    studies : sequence of SmallestSkirt
        What `hrsafety.reactive.smallest_skirt` returned, for example for several speeds.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; bars are 95 % Wilson intervals, a ring marks the smallest number that is
        enough, and a dashed line is the limit.

    Raises
    ------
    InvalidParameterError
        If there is no study.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> study = reactive.smallest_skirt(0.2, counts=[6, 9, 12], layouts=3)
    >>> figure = plotting.reactive.skirt_sensor_counts([study])
    """
    from matplotlib.lines import Line2D

    inputs.some("studies", studies, "study")
    figure, axes = style.one_panel(4.9 + (0.3 if title is not None else 0.0), title=title)
    for index, study in enumerate(studies):
        _draw_study(axes, study, style.run_look(index))
    for limit in dict.fromkeys(study.contact_share for study in studies):
        axes.axhline(limit, color=SAFE_COLOR, linewidth=1.2, linestyle=(0, (2, 2)), label=f"limit {limit:g}")
    counts = sorted({count for study in studies for count in study.counts})
    axes.set_xticks(counts)
    axes.set_ylim(-0.02, 1.02)
    axes.set_xlabel("number of sensors")
    axes.set_ylabel("share of the tests with contact")
    handles = [*axes.get_legend_handles_labels()[0]]
    if any(study.sensors is not None for study in studies):
        ring: style.Properties = {"marker": "o", "markersize": 11, "markerfacecolor": "none", "linestyle": "none"}
        handles.append(Line2D([], [], color=style.NEUTRAL, label="smallest number that is enough", **ring))
    style.legend_below(figure, handles, columns=2)
    return figure


def _draw_study(axes: Axes, study: SmallestSkirt, look: style.Properties) -> None:
    value: npt.NDArray[np.float64] = np.array([share.value for share in study.contacts])
    beyond = np.array([[share.value - share.low, share.high - share.value] for share in study.contacts]).T
    found = "none is enough" if study.sensors is None else f"{study.sensors} are enough"
    label = f"radius {study.chassis_radius:g} m, {study.speed:g} m/s: {found}"
    axes.errorbar(
        study.counts, value, yerr=np.maximum(beyond, 0.0), marker="o", markersize=4.5, capsize=2.5, label=label, **look
    )
    if study.sensors is not None:
        height = value[study.counts.index(study.sensors)]
        axes.plot(
            study.sensors,
            height,
            marker="o",
            markersize=13,
            markerfacecolor="none",
            markeredgecolor=look["color"],
            linestyle="none",
        )
