"""A judged log: the whole way, and its worst moments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import instance
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.judging.judgement import Judgement, Moment
from hrsafety.plotting import floor, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["judged_way", "worst_moments"]

AROUND = 2.0
"""Before and after a moment, in s."""
HALF = 3.0
"""Half the width of a panel of a moment, in m."""
MOST_PEOPLE = 40
"""So many people are drawn, those who came nearest."""


@notes.picture
def judged_way(judgement: Judgement) -> Figure:
    """Draw the way of a judged robot, the people who came nearest, contacts, and what is not judged.

    Parameters
    ----------
    judgement : Judgement
        Of `hrsafety.navigation.metrics.judge`.

    Returns
    -------
    matplotlib.figure.Figure
        Floor seen from above.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> import numpy as np
    >>> from hrsafety import datasets, navigation as nav, plotting
    >>> time = np.arange(81) / 10
    >>> walk = datasets.Recording(time_s=time, person=[7] * 81, position=[(8.0 - t, 0.9) for t in time])
    >>> straight = np.stack([0.5 * time, 0.0 * time], axis=1)
    >>> log = SimpleNamespace(time=time, position=straight, heading=0.0 * time, people=walk)
    >>> len(plotting.judged_way(nav.metrics.judge(log, robot_radius=0.3)).axes)
    1
    """
    instance("judgement", judgement, Judgement)
    known = judgement.position[np.isfinite(judgement.position[:, 0])]
    low, high = known.min(axis=0) - 2.0, known.max(axis=0) + 2.0
    limits = ((float(low[0]), float(high[0])), (float(low[1]), float(high[1])))
    least = np.nanmin(np.where(np.isnan(judgement.clearance), np.inf, judgement.clearance), axis=0, initial=np.inf)
    drawn = np.argsort(least, kind="stable")[:MOST_PEOPLE].tolist()
    with np.errstate(invalid="ignore"):
        within = ((judgement.obstacle_position >= low) & (judgement.obstacle_position <= high)).all(axis=2).any(axis=0)
    handles = _handles(judgement, {column for column in drawn if within[column]})
    figure, (axes,) = floor.panels(limits, entries=len(handles))
    _add_walls(axes, judgement)
    for column in drawn:
        look: style.Properties = {"color": style.PERSON_COLORS[0], "linewidth": 0.8}
        floor.line(axes, judgement.obstacle_position[:, column], zorder=3.0, **look)
    floor.line(axes, judgement.position, zorder=5.0, color=style.RUN_COLORS[0], linewidth=1.8)
    for part in judgement.not_judged:
        if part.reason in ("smoothing_edge", "outside_map", "clock"):
            continue
        rows = (judgement.time >= part.begin - 1e-9) & (judgement.time <= part.end + 1e-9)
        look = {"color": style.NEUTRAL, "linewidth": 5.0, "alpha": 0.4}
        floor.line(axes, judgement.position[rows], zorder=4.5, **look)
    for touch in (*judgement.contacts, *judgement.possible_contacts):
        row = int(np.clip(np.searchsorted(judgement.time, touch.begin), 0, len(judgement.time) - 1))
        face: style.Properties = floor.CONTACT | ({} if touch in judgement.contacts else {"color": "white"})
        axes.plot(*judgement.position[row], zorder=7.0, **face)
    for number, moment in enumerate(judgement.moments, start=1):
        place = judgement.position[_row(judgement, moment)]
        axes.annotate(str(number), place, xytext=(6, 6), textcoords="offset points", zorder=8.0)
    return floor.finish(figure, handles, runs=[judgement])


@notes.picture
def worst_moments(judgement: Judgement) -> Figure:
    """Draw the worst moments of a judged robot with the ways of 2 s before and after them.

    Parameters
    ----------
    judgement : Judgement
        Of `hrsafety.navigation.metrics.judge`, with one moment or more.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each moment, around the robot, which stands at (0, 0).

    Raises
    ------
    InvalidParameterError
        If there is no moment.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> import numpy as np
    >>> from hrsafety import datasets, navigation as nav, plotting
    >>> time = np.arange(81) / 10
    >>> walk = datasets.Recording(time_s=time, person=[7] * 81, position=[(8.0 - t, 0.9) for t in time])
    >>> straight = np.stack([0.5 * time, 0.0 * time], axis=1)
    >>> log = SimpleNamespace(time=time, position=straight, heading=0.0 * time, people=walk)
    >>> len(plotting.worst_moments(nav.metrics.judge(log, robot_radius=0.3)).axes)
    3
    """
    moments = instance("judgement", judgement, Judgement).moments
    if not moments:
        raise InvalidParameterError("judgement.moments", "hold one moment or more", Shown("none"))
    titles = [
        f"{number}: {each.time:.1f} s, person {each.person}\n{each.clearance:.2f} m, robot {each.robot_speed:.2f} m/s"
        for number, each in enumerate(moments, start=1)
    ]
    shown = {column for each in moments for column in _near(judgement, _row(judgement, each), HALF)}
    handles = _handles(judgement, shown)[:2]
    limits = ((-HALF, HALF), (-HALF, HALF))
    figure, grid = floor.panels(limits, titles=titles, columns=3, entries=len(handles), compressed=False)
    for axes, moment in zip(grid, moments, strict=True):
        _add_moment(axes, judgement, moment)
    return floor.finish(figure, handles)


def _add_moment(axes: Axes, judgement: Judgement, moment: Moment) -> None:
    row = _row(judgement, moment)
    origin = judgement.position[row]
    rows = np.abs(judgement.time - moment.time) <= AROUND + 1e-9
    floor.line(axes, judgement.position[rows] - origin, zorder=5.0, color=style.RUN_COLORS[0], linewidth=1.5)
    if judgement.footprint is None:
        floor.disc(axes, (0.0, 0.0), judgement.robot_radius, style.RUN_COLORS[0], face=0.4)
    else:
        corners = shapes.turned(judgement.footprint.corners, float(judgement.heading[row]))
        axes.fill(*corners.T, facecolor=(style.RUN_COLORS[0], 0.4), edgecolor=style.RUN_COLORS[0], zorder=4.0)
    floor.velocity(axes, np.zeros(2), judgement.velocity[row])
    for column in _near(judgement, row, HALF + 1.0):
        place = judgement.obstacle_position[:, column] - origin
        worst = judgement.people[column].item() == moment.person
        color = style.PERSON_COLORS[0] if worst else style.NEUTRAL
        floor.line(axes, place[rows], zorder=4.0, color=color, linewidth=1.2)
        floor.disc(axes, place[row], judgement.person_radius, color, face=0.4)
    axes.set(xlim=(-HALF, HALF), ylim=(-HALF, HALF))


def _near(judgement: Judgement, row: int, half: float) -> list[int]:
    """Return the people in a square about the robot at an instant."""
    away = np.abs(judgement.obstacle_position[row] - judgement.position[row]).max(axis=1)
    with np.errstate(invalid="ignore"):
        found: list[int] = np.flatnonzero(away <= half).tolist()
    return found


def _row(judgement: Judgement, moment: Moment) -> int:
    return int(np.argmin(np.abs(judgement.time - moment.time)))


def _add_walls(axes: Axes, judgement: Judgement) -> None:
    if judgement.walls is not None:
        walls.add_maps(axes, [judgement.walls])


def _handles(judgement: Judgement, shown: set[int]) -> list[Artist]:
    """Return the legend; ``shown``: people who are in the picture, the others are counted."""
    hidden = len(judgement.people) - len(shown)
    people = f"people ({hidden} of {len(judgement.people)} are not shown)" if hidden else "people"
    look: dict[str, Any] = {"linestyle": "-", "linewidth": 1.8}
    found: list[Artist] = [
        floor.handle("robot", **(look | {"color": style.RUN_COLORS[0]})),
        floor.handle(people, **(look | {"color": style.PERSON_COLORS[0]})),
    ]
    if any(each.reason not in ("smoothing_edge", "outside_map", "clock") for each in judgement.not_judged):
        found.append(floor.handle("not judged", **(look | {"color": style.NEUTRAL, "linewidth": 5.0, "alpha": 0.4})))
    if judgement.contacts or judgement.possible_contacts:
        found.append(floor.handle("contact", **floor.CONTACT))
    return [*found, *(walls.handles([judgement.walls]) if judgement.walls is not None else [])]
