"""Moving pictures of a world of people and robots, as GIF or MP4."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import callback, positive
from hrsafety.plotting import floor, movies, notes, shapes, style
from hrsafety.plotting.crowds import world_scenes

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["animate_crowd"]

DPI = 85
TRAIL_TIME = 2.0  # s of the ways of people that fade behind them
BODY: style.Properties = {"edgecolor": "white", "linewidth": 1.0, "animated": True}
LONGEST_STEP = 1.0  # m between two rows, beyond which a person has not walked


@notes.picture
def animate_crowd(
    run: Trajectory,
    path: str | os.PathLike[str],
    *,
    frames_per_second: float = 20,
    speed: float = 1.0,
    end: float | None = None,
    color_by: str = "model",
    title: str | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write an animation of a world to a GIF or MP4 file.

    Shown are walls, people with the last two seconds of their ways, robots with their ways and headings, goals,
    contacts and a clock. The file appears under its name only when it is complete.

    Parameters
    ----------
    run : Trajectory
        What happened.
    path : str or path-like
        Where to write; ``.gif`` needs Pillow, ``.mp4`` the program ffmpeg.
    frames_per_second : float
        Frames in a second of viewing time; at most 50 for a GIF.
    speed : float
        Simulated time over viewing time: 2 plays twice as fast.
    end : float or None
        Last instant that is shown, in s; of the whole run if None.
    color_by : {"model", "group"}
        What the colors of people tell.
    title : str or None
        Title above the scene.
    progress : callable or None
        Called with ``(done, total)`` after each frame that was drawn.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InvalidParameterError
        If a number is not positive and finite, a word is unknown, the suffix is neither ``.gif`` nor ``.mp4``, the
        folder does not exist, or more than 6000 frames would be needed.
    MissingExtraError
        If matplotlib, Pillow or ffmpeg is needed and missing.
    HrsafetyError
        If ffmpeg fails.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.bottleneck(10, time_limit=4))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = plotting.crowds.animate_crowd(run, pathlib.Path(folder) / "door.gif", frames_per_second=4)
    ...     file.name
    'door.gif'
    """
    run = world_scenes.checked_crowd(run)
    kinds = world_scenes.kinds_of_people(run, color_by)
    target = movies.checked_target(path)
    until = float(run.time[-1]) if end is None else min(positive("end", end), float(run.time[-1]))
    instants = movies.checked_instants(target, until, frames_per_second, speed)
    rows = [int(np.abs(run.time - instant).argmin()) for instant in (*instants, until)]
    frames = _frames(run, rows, kinds, title=title)
    movies.write(target, movies.counted(frames, len(rows), callback("progress", progress)), frames_per_second)
    return target


class _Stage:
    """Moving artists of the picture of a world, and how they show one row."""

    def __init__(self, axes: Axes, run: Trajectory, place: world_scenes.Floor, kinds: Sequence[str]) -> None:
        self.run, self.place = run, place
        colors = world_scenes.color_of(kinds)
        self.people = [
            _circle(axes, radius, colors[kind], 3.2)
            for kind, radius in zip(kinds, run.obstacle_radius.tolist(), strict=True)
        ]
        self.ways = _FadingWays(axes, run, place, [colors[kind] for kind in kinds])
        looks = [str(look["color"]) for look in world_scenes.robot_looks(len(run.scenario.robots))]
        self.trails = [axes.plot([], [], color=color, linewidth=2.0, zorder=4.0, animated=True)[0] for color in looks]
        self.robots = [
            axes.add_patch(shapes.robot(robot.body, (0.0, 0.0), facecolor=color, zorder=5.0, **BODY))
            for robot, color in zip(run.scenario.robots, looks, strict=True)
        ]
        arrow: style.Properties = {"color": "white", "linewidth": 1.6, "zorder": 5.5, "animated": True}
        self.headings = [axes.plot([], [], **arrow)[0] for _ in run.scenario.robots]
        self.touched = world_scenes.contacts(run)
        self.contacts = axes.plot([], [], zorder=7.0, animated=True, **floor.CONTACT)[0]
        self.flash = axes.plot([], [], zorder=7.0, animated=True, **floor.FLASH)[0]
        where: style.Properties = {"x": 1.0, "y": 1.01, "transform": axes.transAxes, "ha": "right", "va": "bottom"}
        self.clock = axes.text(s="", **where, fontsize=style.FONT_SIZE + 1, zorder=9.0, animated=True)

    def artists(self) -> list[Artist]:
        """Return everything that moves, from back to front."""
        moving = [self.ways.lines, *self.people, *self.trails, *self.robots, *self.headings]
        return [*moving, self.contacts, self.flash, self.clock]

    def show(self, row: int) -> None:
        """Put everything where it is at one row of the run."""
        run = self.run
        for body, where in zip(self.people, self.place.wrapped(run.obstacle_position[row]), strict=True):
            present = bool(np.isfinite(where).all())
            body.set_visible(present)
            if present:
                body.set_center(where)
        self.ways.show(row)
        for index, (body, trail) in enumerate(zip(self.robots, self.trails, strict=True)):
            center = run.robot_position[row, index]
            shapes.move(body, center, float(run.robot_heading[row, index]))
            trail.set_data(*run.robot_position[: row + 1, index].T)
            angle, radius = shapes.look_angle(run, row, index), run.scenario.robots[index].body.radius
            ahead = center + radius * np.array([np.cos(angle), np.sin(angle)])
            self.headings[index].set_data(*np.stack([center, ahead]).T)
        places = [run.robot_position[instant, robot] for instant, robot in self.touched if instant <= row]
        self.contacts.set_data(*np.array(places).reshape(-1, 2).T)
        since = run.time[row] - floor.FLASH_TIME
        now = [
            run.robot_position[row, robot]
            for instant, robot in self.touched
            if since <= run.time[instant] <= run.time[row]
        ]
        self.flash.set_data(*np.array(now).reshape(-1, 2).T)
        self.clock.set_text(f"{run.time[row]:5.2f} s")


class _FadingWays:
    """Ways of the people behind them, which fade with time."""

    def __init__(self, axes: Axes, run: Trajectory, place: world_scenes.Floor, colors: Sequence[str]) -> None:
        from matplotlib.collections import LineCollection
        from matplotlib.colors import to_rgb

        self.run, self.place = run, place
        self.colors = np.array([to_rgb(color) for color in colors]).reshape(-1, 3)
        self.lines = LineCollection([], linewidth=1.6, zorder=3.0, animated=True)
        axes.add_collection(self.lines, autolim=False)

    def show(self, row: int) -> None:
        """Put the ways behind the people of one row of the run."""
        time = self.run.time
        first = int(np.searchsorted(time, time[row] - TRAIL_TIME))
        ways = np.stack([self.place.wrapped(places) for places in self.run.obstacle_position[first : row + 1]])
        pieces = np.stack([ways[:-1], ways[1:]], axis=2)  # instant, person, end, axis
        kept = np.hypot(*np.moveaxis(pieces[:, :, 1] - pieces[:, :, 0], -1, 0)) < LONGEST_STEP  # False for the absent
        fade = (time[first + 1 : row + 1] - time[row] + TRAIL_TIME) / TRAIL_TIME
        looks = np.empty((*kept.shape, 4))
        looks[..., :3], looks[..., 3] = self.colors, 0.7 * fade[:, np.newaxis]
        self.lines.set_segments(list(pieces[kept]))
        self.lines.set_color(looks[kept])


def _circle(axes: Axes, radius: float, color: str, zorder: float) -> Any:
    """Add a circle at the origin that will be moved."""
    from matplotlib.patches import Circle

    return axes.add_patch(Circle((0.0, 0.0), radius, facecolor=color, zorder=zorder, **BODY))


def _background(
    run: Trajectory, place: world_scenes.Floor, kinds: Sequence[str], *, title: str | None
) -> tuple[Figure, Axes]:
    """Return a figure with everything that does not move."""
    handles = _handles(run, kinds)
    height = style.scene_height(place.limits, titled=True, legend_rows=-(-len(handles) // 3))
    figure, axes = style.one_panel(height, title=title or " ", dpi=DPI, compressed=True)  # the clock stands beside it
    style.frame_scene(axes, place.limits)
    world_scenes.add_walls(axes, run.scenario, place)
    world_scenes.add_goals(axes, run.scenario)
    style.legend_below(figure, handles, columns=3)
    notes.add_warnings(figure, run)
    return figure, axes


def _handles(run: Trajectory, kinds: Sequence[str]) -> list[Artist]:
    """Return the legend."""
    handles: list[Artist] = []
    if run.scenario.robots:
        look: style.Properties = {"marker": "o", "markersize": 9, "linestyle": "-", "linewidth": 2.0}
        handles.append(floor.handle("robot, path so far", color=style.RUN_COLORS[0], **look))
    handles += world_scenes.people_handles(kinds) + world_scenes.scene_handles(run.scenario)
    if world_scenes.contacts(run):
        handles.append(floor.handle("first contact", **floor.CONTACT))
    return handles


def _frames(run: Trajectory, rows: Sequence[int], kinds: Sequence[str], *, title: str | None) -> Iterator[movies.Frame]:
    """Return the pictures: only what moves is drawn again."""
    place = world_scenes.Floor.of(run)
    figure, axes = _background(run, place, kinds, title=title)
    stage = _Stage(axes, run, place, kinds)
    artists = stage.artists()

    def shown(row: int) -> list[Artist]:
        stage.show(row)
        return artists

    return movies.drawn(figure, axes, rows, shown)
