"""Pictures of zones around a robot, and of the attack that is worst for them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import Array, instance
from hrsafety.plotting import floor, notes, style
from hrsafety.zones.checking import ZoneCheck
from hrsafety.zones.field_design import ZoneSet
from hrsafety.zones.reach import RobotOutline

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["zone_attack", "zone_fields"]

MOST_PANELS = 12
COLUMNS = 3
ROOM = 0.15
INSTANTS = 5


@notes.picture
def zone_fields(found: ZoneSet | ZoneCheck, *, title: str | None = None) -> Figure:
    """Draw zones around the robot, of a check beside those that are needed.

    Parameters
    ----------
    found : ZoneSet or ZoneCheck
        Of `zones.design` or `zones.check`.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each zone that stops the robot, at most 12.

    Raises
    ------
    InvalidParameterError
        If ``found`` is neither.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, zones
    >>> robot = zones.Conditions(
    ...     footprint=0.22, max_speed=0.5, max_turn_rate=1.0, deceleration=2.5, reaction_time=0.15, error=0.02,
    ...     beam_step=0.0087,
    ... )
    >>> figure = plotting.zone_fields(zones.design(robot))
    """
    instance("found", found, ZoneSet, ZoneCheck)
    if isinstance(found, ZoneSet):
        shown: list[tuple[str, Array, Array | None]] = [(each.name, each.corners, None) for each in found.zones]
    else:
        shown = [(each.name, each.corners, each.needed) for each in found.shapes]
        shown = shown or [("no zone stops", np.zeros((0, 2)), None)]
    shown = shown[:MOST_PANELS]
    body = found.conditions.body
    outline = _outline(body)
    limits = _limits([outline, *(each for _, *polygons in shown for each in polygons if each is not None)])
    names = [name.replace("_", " ") for name, _, _ in shown]
    figure, panels = floor.panels(limits, titles=names, columns=COLUMNS, entries=3, title=title)
    for axes, (_, corners, needed) in zip(panels, shown, strict=True):
        if needed is not None:
            _polygon(axes, needed, style.CONTACT_COLOR, dashed=True)
        if len(corners):
            _polygon(axes, corners, style.RUN_COLORS[0], face=0.15)
        _polygon(axes, outline, style.NEUTRAL, face=0.8)
        axes.plot(*found.conditions.scanner, "^", markersize=5, color="black", markeredgecolor="white", zorder=6.0)
        axes.annotate(
            "", (0.8 * float(outline[:, 0].max()), 0.0), (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": "white"}
        )
    handles = [
        floor.handle("zone", color=style.RUN_COLORS[0], linestyle="-"),
        floor.handle("scanner", marker="^", color="black"),
    ]
    if any(needed is not None for _, _, needed in shown):
        handles.append(floor.handle("zone that holds", color=style.CONTACT_COLOR, linestyle="--"))
    return floor.finish(figure, handles, runs=[found])


@notes.picture
def zone_attack(found: ZoneCheck, *, title: str | None = None) -> Figure:
    """Draw the worst attack on zones: robot, person and gap until the contact, or until the end.

    Parameters
    ----------
    found : ZoneCheck
        Of `zones.check`.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The floor at five instants, and speed and gap over time.

    Raises
    ------
    InvalidParameterError
        If ``found`` is no check.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, zones
    >>> circle = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=0.3)
    >>> monitor = zones.CollisionMonitor(polygons=(circle,))
    >>> figure = plotting.zone_attack(zones.check(monitor, attacks=50, generations=0))
    """
    instance("found", found, ZoneCheck)
    run = found.worst
    last = len(run.time) - 1
    if math.isfinite(run.contact_time):
        last = min(last, int(np.searchsorted(run.time, run.contact_time)))
    else:  # the approach, not what comes after it
        last = min(last, int(np.argmin(run.gap)) + max(1, len(run.time) // 20))
    outline = _outline(found.conditions.body)
    limits = _limits(
        [
            run.person[: last + 1] - 0.1,
            run.person[: last + 1] + 0.1,
            run.pose[: last + 1, :2] + outline.min(),
            run.pose[: last + 1, :2] + outline.max(),
        ]
    )
    figure = style.new_figure(4.4, title=title)
    grid = figure.add_gridspec(1, 2, width_ratios=(1.4, 1.0))
    axes, history = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
    style.frame_scene(axes, limits)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    zone = _zone_of(found, run.command[last])
    for number, row in enumerate(np.linspace(0, last, INSTANTS).round().astype(int)):
        strength = 0.25 + 0.75 * number / (INSTANTS - 1)
        pose = run.pose[row]
        _polygon(axes, _placed(outline, pose), style.RUN_COLORS[0], face=0.6 * strength, strength=strength)
        floor.disc(axes, run.person[row], run.leg_radius, style.PERSON_COLORS[0], strength=strength, face=0.8)
        if number == INSTANTS - 1 and zone is not None:
            _polygon(axes, _placed(zone, pose), style.RUN_COLORS[0], dashed=True)
    floor.line(axes, run.pose[: last + 1, :2], zorder=5.0, color=style.RUN_COLORS[0])
    floor.line(axes, run.person[: last + 1], zorder=5.0, color=style.PERSON_COLORS[0])
    if math.isfinite(run.contact_time):
        axes.plot(*run.person[last], zorder=7.0, **floor.CONTACT)
    time = run.time[: last + 1]
    history.plot(time, np.hypot(run.velocity[: last + 1, 0], run.velocity[: last + 1, 1]), color=style.RUN_COLORS[0])
    history.plot(
        time, np.hypot(run.command[: last + 1, 0], run.command[: last + 1, 1]), color=style.NEUTRAL, linestyle=":"
    )
    history.plot(time, np.maximum(run.gap[: last + 1], 0.0), color=style.PERSON_COLORS[0], linestyle="--")
    history.set_xlabel("time (s)")
    history.set_ylabel("speed (m/s), gap (m)")
    history.set_ylim(bottom=0.0)
    handles = [
        floor.handle("robot, its speed", color=style.RUN_COLORS[0], linestyle="-"),
        floor.handle("command", color=style.NEUTRAL, linestyle=":"),
        floor.handle("leg", color=style.PERSON_COLORS[0], linestyle="-"),
        floor.handle("gap", color=style.PERSON_COLORS[0], linestyle="--"),
    ]
    if math.isfinite(run.contact_time):
        handles.append(floor.handle("contact", **floor.CONTACT))
    return floor.finish(figure, handles, columns=5, runs=[found])


def _outline(body: RobotOutline) -> Array:
    """Return the outline of a body."""
    if len(body.corners) > 1:
        return body.corners
    angles = np.linspace(0.0, 2.0 * math.pi, 65)
    found: Array = body.corners[0] + body.rounding * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return found


def _placed(corners: Array, pose: Array) -> Array:
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    turned: Array = corners @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
    return turned


def _limits(places: Sequence[Array]) -> style.Limits:
    """Return limits with room around points, in m."""
    every = np.concatenate([each for each in places if len(each)])
    low, high = every.min(axis=0) - ROOM, every.max(axis=0) + ROOM
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _zone_of(found: ZoneCheck, command: Array) -> Array | None:
    """Return the shape that stops for a command."""
    for zone in found.monitor.polygons:
        if zone.action != "stop":
            continue
        if zone.type == "circle":
            angles = np.linspace(0.0, 2.0 * math.pi, 65)
            return zone.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        if zone.type == "polygon":
            return zone.corners
        index = int(zone.shapes(command[np.newaxis], np.array([-1]))[0])
        return zone.ranges[index].corners if index >= 0 else None
    return None


def _polygon(
    axes: Axes, corners: Array, color: str, *, face: float = 0.0, strength: float = 1.0, dashed: bool = False
) -> None:
    """Draw a polygon."""
    from matplotlib.patches import Polygon

    if face:
        axes.add_patch(Polygon(corners, closed=True, facecolor=color, alpha=face, linewidth=0))
    line = "--" if dashed else "-"
    axes.add_patch(Polygon(corners, closed=True, fill=False, edgecolor=color, alpha=strength, linestyle=line))
