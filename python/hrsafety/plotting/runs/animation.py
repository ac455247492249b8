"""Moving pictures of a run, as GIF or MP4."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety._arguments import callback
from hrsafety.plotting import floor, inputs, movies, notes, shapes, style, walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["animate"]

DPI = 85
MARGIN = 1.2  # free space around the path of the robot, in m
SMALLEST_BODY_WITH_ID = 0.15  # m, radius of a body into which an id fits
ROBOT_COLOR = style.RUN_COLORS[0]


@notes.picture
def animate(
    trajectory: Trajectory,
    path: str | os.PathLike[str],
    *,
    frames_per_second: float = 20,
    speed: float = 1.0,
    names: Sequence[str] | None = None,
    regions: bool = True,
    title: str | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write an animation of a run to a GIF or MP4 file.

    Shown are the robot with its trail and heading, what its lidar hits if it has one, its goal, every obstacle that is
    present, with an id in each moving one, and a clock. Stationary obstacles show their regions all the time, moving
    ones while the robot is inside their active region; of more than six obstacles only the border of the active one. A
    contact is ringed and leaves a red cross. The view holds the whole path of the robot with a margin; whoever walks
    outside is out of view. The file appears under its name only when it is complete.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    path : str or path-like
        Where to write; ``.gif`` needs Pillow, ``.mp4`` the program ffmpeg.
    frames_per_second : float
        Frames in a second of viewing time; at most 50 for a GIF.
    speed : float
        Simulated time over viewing time: 2 plays twice as fast.
    names : sequence of str or None
        Short id of each obstacle, written into moving ones; their number from 1 when ``None``.
    regions : bool
        Whether active and critical regions are shown.
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
        If a number is not positive and finite, the suffix is neither ``.gif`` nor ``.mp4``,
        the folder does not exist, the number of names is wrong, or more than 6000 frames
        would be needed.
    MissingExtraError
        If matplotlib, Pillow or ffmpeg is needed and missing.
    HrsafetyError
        If ffmpeg fails.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c2"), nav.VirtualForceField())
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = plotting.animate(run, pathlib.Path(folder) / "c2.gif", frames_per_second=5)
    ...     file.name, file.stat().st_size < 1_000_000
    ('c2.gif', True)
    """
    run = inputs.checked_trajectory("trajectory", trajectory)
    target = movies.checked_target(path)
    instants = movies.checked_instants(target, float(run.time[-1]), frames_per_second, speed)
    rows = [*(inputs.row_at(run, float(instant)) for instant in instants), len(run.time) - 1]
    count = len(run.scenario.obstacles)
    ids = inputs.checked_labels(names if names is not None else [str(i + 1) for i in range(count)], count, name="names")
    frames = _frames(run, rows, ids, regions=regions, title=title)
    movies.write(target, movies.counted(frames, len(rows), callback("progress", progress)), frames_per_second)
    return target


class _Stage:
    """Moving artists of the picture of a run, and how they show one row."""

    def __init__(self, axes: Axes, run: Trajectory, ids: Sequence[str], *, regions: bool) -> None:
        self.run = run
        self.regions = regions
        self.bodies: list[tuple[int, Any, Any, list[Any]]] = []
        self.fixed: list[Any] = []  # drawn again in each frame, above the regions of what moves
        obstacles = run.scenario.obstacles
        for index, (obstacle, look) in enumerate(zip(obstacles, shapes.looks(obstacles), strict=True)):
            if shapes.is_mobile(obstacle):
                self.bodies.append(self._add_moving(axes, index, look.color, ids[index]))
            else:
                edges: style.Properties = {"edgecolor": "white", "linewidth": 0.8, "zorder": 3.0, "animated": True}
                self.fixed.append(shapes.body(obstacle, shapes.center(obstacle), facecolor=look.color, **edges))
        shapes.add(axes, self.fixed)
        trail: style.Properties = {"color": ROBOT_COLOR, "linewidth": 2.0, "zorder": 4.0, "animated": True}
        self.trail = axes.plot([], [], **trail)[0]
        contact: style.Properties = {
            "marker": "X",
            "color": style.CONTACT_COLOR,
            "markersize": 11,
            "markeredgecolor": "white",
        }
        self.contacts = axes.plot([], [], linestyle="none", zorder=7.0, animated=True, **contact)[0]
        own: style.Properties = {"facecolor": ROBOT_COLOR, "edgecolor": "white", "linewidth": 1.0, "animated": True}
        self.robot = axes.add_patch(shapes.robot(run.scenario.robot, (0.0, 0.0), zorder=5.0, **own))
        self.scanned = shapes.scan_of(run)
        self.scan = axes.plot([], [], zorder=2.95, animated=True, **shapes.SCAN)[0]
        self.heading = axes.plot([], [], color="white", linewidth=1.6, zorder=5.5, animated=True)[0]
        self.flash = axes.plot([], [], zorder=7.0, animated=True, **floor.FLASH)[0]
        box: style.Properties = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
        place: style.Properties = {"x": 0.015, "y": 0.975, "transform": axes.transAxes, "ha": "left", "va": "top"}
        self.clock = axes.text(s="", **place, bbox=box, fontsize=style.FONT_SIZE + 1, zorder=9.0, animated=True)

    def _add_moving(self, axes: Axes, index: int, color: str, name: str) -> tuple[int, Any, Any, list[Any]]:
        """Add body, id and regions of a moving obstacle, all hidden."""
        obstacle: Any = self.run.scenario.obstacles[index]
        edges: style.Properties = {"edgecolor": "white", "linewidth": 1.0, "zorder": 3.2, "animated": True}
        body = axes.add_patch(shapes.body(obstacle, (0.0, 0.0), facecolor=color, **edges))
        letters: style.Properties = {
            "ha": "center",
            "va": "center_baseline",
            "color": "white",
            "fontsize": 9.0,
            "clip_on": True,
        }
        shown_name = name if shapes.least_half_width(obstacle) >= SMALLEST_BODY_WITH_ID else ""
        text = axes.text(0.0, 0.0, shown_name, fontweight="bold", zorder=4.5, animated=True, **letters)
        rings = []
        if self.regions:
            rings = self._rings(axes, obstacle, color)
            for ring in rings:
                ring.set_animated(True)
            shapes.add(axes, rings)
        return index, body, text, rings

    def _rings(self, axes: Axes, obstacle: Any, color: str) -> list[Any]:
        """Return the regions of a moving obstacle; of many obstacles only a border of the active one."""
        if len(self.run.scenario.obstacles) <= shapes.MOST_COLORS:
            patches = list(shapes.region_patches(obstacle, (0.0, 0.0), color))
            wide = 2.0 * shapes.region_radii(obstacle)[0] > max(np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim()))
            return patches[1:] if wide else patches  # a face that covers the picture tells nothing, its border does
        active, _ = shapes.region_radii(obstacle)
        border: style.Properties = {"fill": False, "linewidth": 0.5, "antialiased": False}  # small in a file
        border |= {"edgecolor": _tint(color), "zorder": 1.1}
        return [shapes.region(obstacle, (0.0, 0.0), active, **border)]

    def artists(self) -> list[Artist]:
        """Return everything that moves, from back to front."""
        moving = [artist for _, body, text, rings in self.bodies for artist in (body, text, *rings)]
        every = [
            self.scan,
            *self.fixed,
            *moving,
            self.trail,
            self.contacts,
            self.flash,
            self.robot,
            self.heading,
            self.clock,
        ]
        return sorted(every, key=lambda artist: float(artist.get_zorder()))

    def show(self, row: int) -> None:
        """Put everything where it is at one row of the run."""
        run = self.run
        for index, body, text, rings in self.bodies:
            place = run.obstacle_position[row, index]
            present = bool(np.isfinite(place).all())
            active, _ = shapes.region_radii(run.scenario.obstacles[index])
            met = present and bool(run.distance[row, index] < active)
            body.set_visible(present)
            # Letters far beside the picture are more than the fonts can place.
            (left, right), (bottom, top) = text.axes.get_xlim(), text.axes.get_ylim()
            text.set_visible(present and left <= place[0] <= right and bottom <= place[1] <= top)
            for ring in rings:
                ring.set_visible(met)
            if present:
                text.set_position(place)
                for patch in (body, *rings):
                    shapes.move(patch, place)
        self.trail.set_data(run.position[: row + 1, 0], run.position[: row + 1, 1])
        shapes.move(self.robot, run.position[row], float(run.heading[row]))
        angle, ahead = shapes.look_angle(run, row), run.scenario.robot.radius
        self.heading.set_data(*(run.position[row] + np.outer([0.0, ahead], [np.cos(angle), np.sin(angle)])).T)
        if self.scanned is not None:
            self.scan.set_data(*self.scanned(row).T)
        touched = inputs.contact_times(run)
        touched = touched[touched <= run.time[row]]
        rows = [inputs.row_at(run, float(instant)) for instant in touched]
        self.contacts.set_data(run.position[rows, 0], run.position[rows, 1])
        fresh = bool((touched > run.time[row] - floor.FLASH_TIME).any())
        self.flash.set_data(*(run.position[[row] if fresh else []].T))
        self.clock.set_text(f"{run.time[row]:5.2f} s")


def _tint(color: str) -> tuple[float, ...]:
    """Return a color half way to white."""
    from matplotlib.colors import to_rgb

    return tuple((1.0 + part) / 2.0 for part in to_rgb(color))


def _background(run: Trajectory, *, regions: bool, title: str | None) -> tuple[Figure, Axes]:
    """Return a figure with everything that does not move."""
    scenario = run.scenario
    limits = inputs.view_limits([run.position, scenario.start, scenario.goal], margin=MARGIN, least_ratio=0.5)
    height = style.scene_height(limits, titled=title is not None)
    figure, axes = style.one_panel(height, title=title, dpi=DPI, compressed=True)
    style.frame_scene(axes, limits)
    walls.add_maps(axes, walls.maps_of([run]))
    for obstacle, look in zip(scenario.obstacles, shapes.looks(scenario.obstacles), strict=True):
        if regions and not shapes.is_mobile(obstacle):
            shapes.add_regions(axes, obstacle, shapes.center(obstacle), look.color)
    shapes.add_start_and_goal(axes, scenario)
    notes.add_warnings(figure, run)
    return figure, axes


def _frames(
    run: Trajectory, rows: Sequence[int], ids: Sequence[str], *, regions: bool, title: str | None
) -> Iterator[movies.Frame]:
    """Return the pictures: only what moves is drawn again."""
    figure, axes = _background(run, regions=regions, title=title)
    stage = _Stage(axes, run, ids, regions=regions)
    artists = stage.artists()

    def shown(row: int) -> list[Artist]:
        stage.show(row)
        return artists

    return movies.drawn(figure, axes, rows, shown)
