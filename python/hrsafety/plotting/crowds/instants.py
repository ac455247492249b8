"""A robot among people at one instant, seen from above: a frame of an environment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety.plotting import floor, notes, style
from hrsafety.plotting.crowds import world_scenes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

    from hrsafety.navigation.crowd.world import World

__all__ = ["crowd_instant"]

FAR = 15.0  # m around robots; walls beyond are not in view
Body = tuple[tuple[float, float], float]

PERSON_COLOR, OTHER_COLOR, ROBOT_COLOR = world_scenes.PEOPLE_COLORS[0], style.RUN_COLORS[4], style.RUN_COLORS[0]


@notes.picture
def crowd_instant(
    world: World,
    *,
    time: float,
    robot: Body,
    people: Sequence[Body],
    robots: Sequence[Body],
    headings: Sequence[float],
    paths: Sequence[npt.NDArray[np.float64]] = (),
    rays: npt.NDArray[np.float64] | None = None,
) -> Figure:
    """Return a picture of a robot, people, other robots and walls; all of one world have the same view.

    Parameters
    ----------
    world : World
        Its first robot is the one that is driven.
    time : float
        The instant in s.
    robot : ((float, float), float)
        Position and radius in m of the robot that is driven.
    people, robots : sequence of ((float, float), float)
        Positions and radii of the people and of other robots, in m.
    headings : sequence of float
        Of all robots in rad, that of the driven one first: outlines are drawn as they look.
    paths : sequence of ndarray, shape (n, 2)
        Ways so far in m, that of the robot first, then those of the people.
    rays : ndarray of shape (m, 2), or None
        Ends of the rays of the robot in m.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.
    """
    from matplotlib.collections import LineCollection

    driven = world.robots[0]
    ends = np.array([driven.start, driven.goal], dtype=np.float64)
    # Where nothing bounds the floor, as wide as long, with room for detours.
    half = (0.5 if world.wall_shapes else 0.65) * max(float(np.abs(ends[0] - ends[1]).max()), 1.0)
    square = np.array([ends.mean(axis=0) - half, ends.mean(axis=0) + half])
    place = world_scenes.Floor.cell(world).showing(world, square, near=FAR)
    handles = _handles(world)
    title = f"t = {time:.2f} s"
    figure, (axes,) = floor.panels(place.limits, entries=len(handles), legend_columns=3, title=title)
    world_scenes.add_walls(axes, world, place)
    world_scenes.add_goals(axes, world)
    if rays is not None:
        ends = np.stack([np.broadcast_to(robot[0], rays.shape), rays], axis=1)
        axes.add_collection(LineCollection(list(ends), colors=style.NEUTRAL, linewidths=0.5, alpha=0.5, zorder=2.0))
    for number, way in enumerate(paths):
        axes.plot(*way.T, color=PERSON_COLOR if number else ROBOT_COLOR, linewidth=1.2, alpha=0.6, zorder=2.5)
    made = list(zip(world.robots, headings, strict=True))
    drawn = (
        (people, [(None, 0.0)] * len(people), PERSON_COLOR, 3.2),
        (robots, made[1:], OTHER_COLOR, 4.4),
        ([robot], made[:1], ROBOT_COLOR, 4.5),
    )
    for bodies, made_as, color, zorder in drawn:
        look: style.Properties = {"facecolor": color, "edgecolor": "white", "linewidth": 0.8, "zorder": zorder}
        for (where, radius), (own, heading) in zip(bodies, made_as, strict=True):
            world_scenes.draw_body(axes, place, np.asarray(where), radius, own, heading, **look)
    return floor.finish(figure, handles, columns=3)


def _handles(world: World) -> list[Artist]:
    """Return the legend."""
    look: style.Properties = {"marker": "o", "markersize": 9}
    handles: list[Artist] = [floor.handle("robot", color=ROBOT_COLOR, **look)]
    if len(world.robots) > 1:
        handles.append(floor.handle("other robot", color=OTHER_COLOR, **look))
    if world.people or world.sources:
        handles.append(floor.handle("person", color=PERSON_COLOR, **look))
    return handles + world_scenes.scene_handles(world)
