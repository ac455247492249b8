"""Worlds of people and robots on axes: who has which color, where the floor repeats, what stands."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import Pair, word
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plotting import floor, inputs, shapes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from hrsafety.navigation.crowd.agents import Person, Robot, Source
    from hrsafety.navigation.crowd.world import WallShape

__all__ = [
    "Floor",
    "add_goals",
    "add_walls",
    "checked_crowd",
    "color_of",
    "contacts",
    "draw_body",
    "draw_walls",
    "gaps",
    "kinds_of_people",
    "people_handles",
    "robot_looks",
    "scene_handles",
    "wall_handles",
]

Array = inputs.Array

COLORINGS = ("model", "group")
# Warm colors that no robot has.
PEOPLE_COLORS = tuple(color for color in style.PERSON_COLORS if color not in style.RUN_COLORS)
MOST_ROBOTS = len(style.RUN_COLORS)  # more share one look
WALL_COLOR = "#3A3A3A"
MARGIN = 0.5  # free space around what must be in view, in m
NEAR = 3.0  # m around everybody's places; what stands beyond is not asked to be in view
TOUCH = 1e-6  # m by which surfaces in contact overlap, as environments have it


def checked_crowd(value: object) -> Trajectory:
    """Return ``value`` if it is the run of a world."""
    if not isinstance(value, Trajectory) or not isinstance(value.scenario, World):
        remedy = "`nav.simulate` returns one"
        kind = "the run of a scenario" if isinstance(value, Trajectory) else type(value).__name__
        raise InvalidParameterError("run", "be the Trajectory of a World", Shown(kind), remedy)
    return value


# ---- who has which color --------------------------------------------------------------------


_MODEL = "person, "
"""Beginning of the words of a model, which stand in a legend where there are several models."""


def kinds_of_people(run: Trajectory, color_by: str) -> list[str]:
    """Return for each person of a run the words of the legend: model or group."""
    grouped = word("color_by", color_by, COLORINGS) == "group"
    world = run.scenario
    kinds = [_group(person) if grouped else _model(person) for person in world.people]
    later = "no group" if grouped else "person from a source"
    if not grouped and len({_model(source) for source in world.sources}) == 1:
        later = _model(world.sources[0])  # which source a person came from is not recorded
    return kinds + [later] * (run.obstacle_position.shape[1] - len(kinds))


def _group(person: Person) -> str:
    return "no group" if person.group is None else f"group {person.group}"


def _model(owner: Person | Source) -> str:
    if getattr(owner, "recording", None) is not None:
        return "recorded person"
    if getattr(owner, "mover", None) is not None:
        return "moves as told"
    return f"{_MODEL}{owner.model.TITLE}"


def color_of(kinds: Iterable[str]) -> dict[str, str]:
    """Return a color for each kind in the order in which they appear; of many kinds some share one."""
    found = [kind for kind in dict.fromkeys(kinds) if kind != "no group"]
    colors = {kind: PEOPLE_COLORS[index % len(PEOPLE_COLORS)] for index, kind in enumerate(found)}
    return colors | {"no group": style.NEUTRAL}


def people_handles(kinds: Sequence[str]) -> list[Artist]:
    """Return an entry of the legend for each color of people."""
    colors = color_of(kinds)
    models = [kind for kind in colors if kind.startswith(_MODEL)]
    short = {kind: "person" for kind in models if len(models) == 1}
    named: dict[str, list[str]] = {}
    for kind in dict.fromkeys(kinds):
        named.setdefault(colors[kind], []).append(short.get(kind, kind))
    look: style.Properties = {"marker": "o", "markersize": 9, "alpha": 0.8}
    return [floor.handle(", ".join(names), color=color, **look) for color, names in named.items()]


def robot_looks(count: int) -> list[style.Properties]:
    """Return color and line style of each robot; of many robots the same."""
    many = count > MOST_ROBOTS
    return [{"color": style.RUN_COLORS[0], "linestyle": "-"} if many else style.run_look(k) for k in range(count)]


# ---- where ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Floor:
    """The part of a world that is shown, and how it repeats itself.

    Parameters
    ----------
    limits : ((float, float), (float, float))
        What is in view, in m.
    low, period : ndarray, shape (2,)
        Corner and size of the cell that repeats itself, in m; infinite where it does not.
    """

    limits: style.Limits
    low: Array
    period: Array

    @classmethod
    def of(cls, run: Trajectory) -> Floor:
        """Return the floor of a run: everywhere that anybody was, and the walls near it."""
        cell = cls.cell(run.scenario)
        places = [cell.wrapped(run.obstacle_position).reshape(-1, 2), run.robot_position.reshape(-1, 2)]
        return cell.showing(run.scenario, np.concatenate(places))

    @classmethod
    def cell(cls, world: World) -> Floor:
        """Return the floor of a world without anything in view."""
        period = np.array([size if size > 0.0 else np.inf for size in world.period])
        places = [each.start for each in world.people] + [each.start for each in world.robots]
        starts = np.array(places, dtype=np.float64).reshape(-1, 2)
        inside = ((starts >= 0.0) & (starts <= period)).all(axis=0)
        return cls(((0.0, 0.0), (0.0, 0.0)), np.where(inside, 0.0, starts.min(axis=0, initial=0.0)), period)

    def showing(self, world: World, places: Array, *, near: float = NEAR) -> Floor:
        """Return the floor with places, ends of robots, its cell and the walls within some m of them in view."""
        ends = [end for robot in world.robots for end in (robot.start, robot.goal)]
        points = np.concatenate([places, np.array(ends, dtype=np.float64).reshape(-1, 2)])
        points = points[np.isfinite(points).all(axis=1)]
        repeated = np.isfinite(self.period)
        if repeated.any():
            middle = points.mean(axis=0) if len(points) else self.low
            first = np.where(repeated, self.low, middle)
            points = np.concatenate([points, [first, np.where(repeated, first + self.period, middle)]])
        standing = wall_points(world.wall_shapes, points, near)
        seen = np.concatenate([points, standing]) if len(points) + len(standing) else np.zeros((1, 2))
        return replace(self, limits=inputs.view_limits([seen], margin=MARGIN))

    def wrapped(self, places: Array) -> Array:
        """Return places in the cell."""
        with np.errstate(invalid="ignore"):
            moved = np.mod(places - self.low, np.where(np.isfinite(self.period), self.period, 1.0)) + self.low
        found: Array = np.where(np.isfinite(self.period), moved, places)
        return found

    def path(self, places: Array) -> Array:
        """Return a path, shape (n, 2), in the cell, with gaps where it leaves it and enters again."""
        inside = self.wrapped(places)
        with np.errstate(invalid="ignore"):
            jumps = np.flatnonzero((np.abs(np.diff(inside, axis=0)) > 0.5 * self.period).any(axis=1))
        return np.insert(inside, jumps + 1, np.nan, axis=0)

    def copies(self, place: Array, radius: float) -> Iterator[Array]:
        """Yield the places in view at which a person stands: several in a world that repeats itself."""
        shifts = [np.zeros(1)] * 2
        for axis, (low, high) in enumerate(self.limits):
            size = self.period[axis]
            if np.isfinite(size):
                first = np.ceil((low - radius - place[axis]) / size)
                shifts[axis] = size * np.arange(first, np.floor((high + radius - place[axis]) / size) + 1.0)
        for x in shifts[0]:
            for y in shifts[1]:
                yield place + np.array([x, y])


def wall_points(walls: Iterable[WallShape | Sequence[Pair]], points: Array, near: float) -> Array:
    """Return points of walls that are within some m of the box around points; all without any."""
    found = [np.empty((0, 2))]
    for wall in walls:
        if isinstance(wall, (Disc, Rectangle)):
            found.append(np.asarray(shapes.body(wall, wall.center).get_extents().get_points()))
        else:
            found.append(np.asarray(wall, dtype=np.float64))
    standing = np.concatenate(found)
    if not len(points):
        return standing
    close = (standing >= points.min(axis=0) - near) & (standing <= points.max(axis=0) + near)
    inside: Array = standing[close.all(axis=1)]
    return inside


def add_walls(axes: Axes, world: World, place: Floor) -> None:
    """Draw what stands, and the edges at which the floor repeats itself."""
    draw_walls(axes, world.wall_shapes)
    for line, axis in ((axes.axvline, 0), (axes.axhline, 1)):
        if np.isfinite(place.period[axis]):
            for edge in (place.low[axis], place.low[axis] + place.period[axis]):
                line(edge, color=style.NEUTRAL, linestyle=(0, (6, 4)), linewidth=0.9, zorder=1.5)


def draw_walls(axes: Axes, walls: Iterable[WallShape | Sequence[Pair]]) -> None:
    """Draw what stands without changing the view."""
    for wall in walls:
        if isinstance(wall, (Disc, Rectangle)):
            shapes.add(axes, [shapes.body(wall, wall.center, facecolor=WALL_COLOR, edgecolor="none", zorder=2.9)])
        else:
            look: style.Properties = {"color": WALL_COLOR, "linewidth": 2.0, "solid_capstyle": "round"}
            limits = axes.get_xlim(), axes.get_ylim()
            floor.line(axes, wall, zorder=2.9, **look)
            axes.set(xlim=limits[0], ylim=limits[1])


def wall_handles(world: World) -> list[Artist]:
    """Return the entries of the legend for what stands and for edges."""
    found: list[Artist] = []
    if world.wall_shapes:
        found.append(floor.handle("wall", color=WALL_COLOR, linestyle="-", linewidth=2.0))
    if any(size > 0.0 for size in world.period):
        found.append(floor.handle("edge, where the floor repeats", linestyle=(0, (6, 4)), linewidth=0.9))
    return found


# ---- robots ---------------------------------------------------------------------------------


def add_goals(axes: Axes, world: World) -> None:
    """Draw starts, goals and tolerances of the robots."""
    from matplotlib.patches import Circle

    for robot in world.robots:
        axes.plot(*robot.start, "o", markersize=7, markerfacecolor="white", markeredgecolor="black", zorder=5.7)
        look: style.Properties = {"facecolor": style.GOAL_COLOR, "alpha": 0.25, "zorder": 2.0}
        axes.add_patch(Circle(robot.goal, robot.arrival_tolerance, **look))
        axes.plot(*robot.goal, "*", markersize=13, color=style.GOAL_COLOR, markeredgecolor="white", zorder=6.0)


def scene_handles(world: World) -> list[Artist]:
    """Return the entries of the legend for starts, goals and walls."""
    return (shapes.start_and_goal_handles() if world.robots else []) + wall_handles(world)


def gaps(run: Trajectory, robot: int) -> Array:
    """Return the distance of the surfaces of a robot and of each person over time, in m; infinite while absent."""
    period = np.array([size if size > 0.0 else np.inf for size in run.scenario.period])
    away = run.obstacle_position - run.robot_position[:, robot, np.newaxis]
    with np.errstate(invalid="ignore"):
        away = away - np.where(np.isfinite(period), period * np.round(away / period), 0.0)
    gap: Array = np.hypot(away[..., 0], away[..., 1]) - run.scenario.robots[robot].body.radius - run.obstacle_radius
    gap[np.isnan(gap)] = np.inf
    return gap


def contacts(run: Trajectory) -> list[tuple[int, int]]:
    """Return row and robot of the first contact of each robot with each person and the walls, in order of time."""
    found = []
    for robot, own in enumerate(run.scenario.robots):
        if own.body.footprint is not None:
            found += [(inputs.row_at(run, float(when)), robot) for when in inputs.contact_times(run.robots[robot])]
            continue
        touching = gaps(run, robot) < -TOUCH
        found += [(int(touching[:, person].argmax()), robot) for person in np.flatnonzero(touching.any(axis=0))]
        walls = run.robots[robot].map_contact_time
        found += [(inputs.row_at(run, walls), robot)] if math.isfinite(walls) else []
    return sorted(found)


def draw_body(
    axes: Axes,
    place: Floor,
    where: Array,
    radius: float,
    robot: Robot | None = None,
    heading: float = 0.0,
    **look: Any,
) -> None:
    """Draw a person, or a robot as it looks at a heading in rad, at each place in view at which it stands."""
    from matplotlib.patches import Circle

    if np.isfinite(where).all():
        for copy in place.copies(where, radius):
            if robot is None:
                axes.add_patch(Circle(tuple(copy), radius, **look))
            else:
                axes.add_patch(shapes.robot(robot.body, copy, heading, **look))
