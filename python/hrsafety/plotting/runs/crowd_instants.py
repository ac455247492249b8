"""A robot among people at one instant, seen from above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.navigation.obstacles import Disc, Rectangle
from hrsafety.plotting import floor, inputs, shapes, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hrsafety.navigation.crowd.world import WallShape

__all__ = ["crowd_instant"]

Place = tuple[float, float]
Body = tuple[Place, float]

_FAR = 30.0  # m from robot and goal; corners of walls beyond are not in the picture


@style.styled
def crowd_instant(
    *,
    robot: Body,
    goal: Place,
    people: Sequence[Body],
    robots: Sequence[Body],
    walls: Sequence[WallShape | Sequence[Place]],
    start: Place,
) -> Figure:
    """Return a picture of a robot, its goal, people, other robots and walls.

    Parameters
    ----------
    robot : ((float, float), float)
        Position and radius in m of the robot that is driven.
    goal, start : tuple of float
        Its goal and its start, in m.
    people, robots : sequence of ((float, float), float)
        Positions and radii of the people and of other robots, in m.
    walls : sequence of Disc, Rectangle or sequence of points
        What stands.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.
    """
    lines = [np.asarray(wall, dtype=np.float64) for wall in walls if not isinstance(wall, (Disc, Rectangle))]
    corners = [line[np.abs(line - start).max(axis=1) < _FAR] for line in lines]
    ends = np.array([goal, start], dtype=np.float64)
    seen = [ends - 0.5, ends + 0.5, *(line for line in corners if len(line))]
    if not len(lines):
        # Nothing bounds the floor: as wide as long.
        half = 0.5 * float(np.abs(ends[0] - ends[1]).max())
        seen += [ends.mean(axis=0) - half, ends.mean(axis=0) + half]
    points = [np.atleast_2d(each) for each in seen]
    figure, (axes,) = floor.panels(inputs.view_limits(points, margin=0.5), entries=0)
    for line in lines:
        floor.line(axes, line, zorder=2, color=style.NEUTRAL)
    for wall in walls:
        if isinstance(wall, (Disc, Rectangle)):
            axes.add_patch(shapes.body(wall, wall.center, facecolor=style.STATIONARY_COLORS[1]))
    for bodies, color in ((people, style.PERSON_COLORS[0]), (robots, style.MOVING_COLORS[0])):
        for place, radius in bodies:
            floor.disc(axes, place, radius, color, face=0.8)
    floor.disc(axes, robot[0], robot[1], style.RUN_COLORS[0], face=0.9)
    axes.plot(*goal, marker="*", markersize=14, color=style.GOAL_COLOR, zorder=3)
    return figure
