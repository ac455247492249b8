"""The worst episode of a search for a person against whom a law breaks a property."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import instance
from hrsafety.navigation.pursuits import Falsification
from hrsafety.navigation.robots.bodies import least_reach
from hrsafety.plotting import floor, inputs, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

    from hrsafety.navigation.crowd.world import World
    from hrsafety.navigation.scenario import Scenario

__all__ = ["worst_pursuit"]

MARGIN = 0.4
"""Free space around what must be in view, in m."""
SECOND = 1.0
CLOSE = 0.1
"""A contact between two rows is this close at one of them, in m."""


@notes.picture
def worst_pursuit(found: Falsification, scenario: Scenario | World, *, title: str | None = None) -> Figure:
    """Draw the worst episode of a search: ways with a dot each second, and the first overlap or the nearest pass.

    Robot and person are drawn at that row of the episode, a control period. Crosses mark the row of a contact with the
    person, and that of the first one with walls of the scene.

    Parameters
    ----------
    found : Falsification
        Of `hrsafety.navigation.falsify`.
    scenario : Scenario or World
        Where it searched. Of a world the robot, its walls and the pursuer are drawn, not the other people.
    title : str or None
        Title of the figure; the property and its least margin when ``None``.

    Returns
    -------
    matplotlib.figure.Figure
        Floor seen from above, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If an argument is of another kind, or a world has not one robot.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting
    >>> scene = nav.Scenario(start=(0, 0), goal=(6, 0), time_limit=12.0)
    >>> found = nav.falsify(scene, nav.VirtualForceField(), episodes=20)
    >>> len(plotting.worst_pursuit(found, scene).axes)
    1
    """
    worst = instance("found", found, Falsification).worst
    scene = inputs.checked_scenario(scenario)
    maps = [] if scene.walls is None else [scene.walls]
    there = np.isfinite(worst.person_position[:, 0])
    ways = [worst.position, worst.person_position[there]]
    colors = [style.RUN_COLORS[0], style.PERSON_COLORS[0]]
    limits = inputs.view_limits([*ways, scene.start, scene.goal, *walls.points_of(maps)], margin=MARGIN)
    handles: list[Artist] = [
        floor.handle(name, color=color, linestyle="-", linewidth=1.8, marker="o", markersize=5)
        for name, color in zip(("robot", "person"), colors, strict=True)
    ]
    touched = worst.contacts_toward + worst.contacts_away + worst.contacts_standing
    handles += [floor.handle("contact", **floor.CONTACT)] if touched else []
    handles += [*shapes.start_and_goal_handles(), *walls.handles(maps)]
    said = f"{found.property_name}, least margin {float(found.margin.min()):.3g}" if title is None else title
    figure, (axes,) = floor.panels(limits, entries=len(handles), title=said)
    walls.add_maps(axes, maps)
    for obstacle, look in zip(scene.obstacles, shapes.looks(scene.obstacles), strict=True):
        if not shapes.is_mobile(obstacle):
            shapes.add_obstacle(axes, obstacle, shapes.center(obstacle), look.color, regions=False)
    seconds = np.searchsorted(worst.time, np.arange(worst.time[0], worst.time[-1] + 1e-9, SECOND))
    for way, color in zip((worst.position, worst.person_position), colors, strict=True):
        floor.line(axes, way, zorder=5.0, color=color, linewidth=1.6)
        floor.line(axes, way[seconds], zorder=5.2, color=color, linestyle="none", marker="o", markersize=4)
    apart = np.hypot(*(worst.person_position - worst.position).T)
    if there.any():
        overlaps = apart <= scene.robot.radius + found.person_radius
        row = int(np.argmax(overlaps) if overlaps.any() else np.nanargmin(apart))
        towards = worst.velocity[row]
        heading = math.atan2(towards[1], towards[0]) if towards.any() else scene.heading
        shapes.add_robot(axes, scene, worst.position[row], colors[0], heading=heading)
        floor.disc(axes, worst.person_position[row], found.person_radius, colors[1], face=0.4)
        ends = [worst.position[row], worst.person_position[row]]
        floor.line(axes, ends, zorder=5.4, color="black", linewidth=0.9)
        if touched > worst.wall_contacts and apart[row] < scene.robot.radius + found.person_radius + CLOSE:
            axes.plot(*worst.position[row], zorder=7.0, **floor.CONTACT)
    within = [np.asarray(each.clearance(worst.position)) <= least_reach(scene.robot) for each in maps]
    if worst.wall_contacts and np.any(within):
        axes.plot(*worst.position[int(np.argmax(np.any(within, axis=0)))], zorder=7.0, **floor.CONTACT)
    shapes.add_start_and_goal(axes, scene)
    return floor.finish(figure, handles, runs=[found])
