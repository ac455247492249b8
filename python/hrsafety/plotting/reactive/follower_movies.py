"""Moving pictures of the robot that follows a sound."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety.plotting import movies, notes, style
from hrsafety.plotting.reactive.follower import LEADER_COLOR, ROBOT_COLOR, check_rows, patch_of, view_of
from hrsafety.plotting.runs.animation import DPI

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from hrsafety.reactive import FollowerRun

__all__ = ["animate_follower"]

BEAM_COLOR = style.RUN_COLORS[4]


@notes.picture
def animate_follower(
    run: FollowerRun,
    path: str | os.PathLike[str],
    *,
    frames_per_second: float = 15,
    speed: float = 2.0,
    title: str | None = None,
) -> Path:
    """Write an animation of a run of the follower to a GIF or MP4 file.

    Shown are the robot with its heading and trail, where it wants to be, the leader, the
    obstacles, the readings of its sensors as arcs, and a clock.

    Parameters
    ----------
    run : FollowerRun
        The run.
    path : str or path-like
        Where to write; ``.gif`` needs Pillow, ``.mp4`` the program ffmpeg.
    frames_per_second : float
        Frames in a second of viewing time; at most 50 for a GIF.
    speed : float
        Simulated time over viewing time.
    title : str or None
        Title above the scene.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InvalidParameterError
        If a number is not positive and finite, the suffix is unknown, the folder does not exist, or
        more than 6000 frames would be needed.
    MissingExtraError
        If matplotlib, Pillow or ffmpeg is needed and missing.
    HrsafetyError
        If ffmpeg fails.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import plotting, reactive
    >>> run = reactive.follow(reactive.FollowerLayouts(kind="one_dynamic").scene(3))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     target = pathlib.Path(folder) / "run.gif"
    ...     file = plotting.reactive.animate_follower(run, target, frames_per_second=2, speed=4.0)
    ...     file.stat().st_size > 1000
    True
    """
    target = movies.checked_target(path)
    check_rows("run", run)
    instants = movies.checked_instants(target, float(run.time[-1]), frames_per_second, speed)
    rows = np.searchsorted(run.time, instants - 1e-9).tolist()
    frames = _frames(run, [*rows, len(run) - 1], title)
    movies.write(target, frames, frames_per_second)
    return target


def _frames(run: FollowerRun, rows: Sequence[int], title: str | None) -> Iterator[movies.Frame]:
    """Return the pictures: only what moves is drawn again."""
    limits = view_of([run])
    figure = style.new_figure(
        style.scene_height(limits, titled=title is not None), title=title, dpi=DPI, compressed=True
    )
    axes = figure.subplots()
    style.frame_scene(axes, limits)
    axes.plot(*run.source.T, color=LEADER_COLOR, linewidth=1.0, linestyle=":")

    def shown(row: int) -> Iterator[Artist]:
        for artist in _moving(axes, run, row):
            yield artist
            artist.remove()

    return movies.drawn(figure, axes, rows, shown)


def _moving(axes: Axes, run: FollowerRun, row: int) -> list[Artist]:
    """Add everything that moves as it is at one row, from back to front."""
    from matplotlib.patches import Circle

    artists: list[Artist] = [axes.add_patch(arc) for arc in _arcs(run, row)]
    for index, mover in enumerate(run.scene.movers):
        body = patch_of(mover.shape, run.shift[row, index])
        body.set(facecolor=style.PERSON_COLORS[index % 2], edgecolor="white", linewidth=0.8)
        artists.append(axes.add_patch(body))
    place, heading = run.position[row], run.heading[row]
    artists += axes.plot(*run.position[: row + 1].T, color=ROBOT_COLOR, linewidth=1.6)
    artists += axes.plot(*run.source[row], marker="*", color=LEADER_COLOR, markersize=13)
    artists += axes.plot(*run.target[row], marker="+", color=LEADER_COLOR, markersize=9, markeredgewidth=1.6)
    touched = run.collided and row == len(run) - 1
    color = style.CONTACT_COLOR if touched else ROBOT_COLOR
    artists.append(axes.add_patch(Circle(tuple(place), run.body_radius, facecolor=color, edgecolor="white")))
    nose = place + run.body_radius * np.array([math.cos(heading), math.sin(heading)])
    artists += axes.plot(*np.array([place, nose]).T, color="white", linewidth=1.8)
    corner: style.Properties = {"transform": axes.transAxes, "ha": "left", "va": "top", "fontsize": 12}
    artists.append(axes.text(0.015, 0.975, f"{run.time[row]:5.2f} s", **corner))
    return artists


def _arcs(run: FollowerRun, row: int) -> Iterator[Any]:
    """Yield the arcs on which the echoes of the sensors lie."""
    from matplotlib.patches import Wedge

    sonar = run.sonar
    heading, half = float(run.heading[row]), math.degrees(0.5 * sonar.beam_width)
    turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    mounts = sonar.mounts
    for position, axis, reading in zip(mounts.position, mounts.axis, run.readings[row], strict=True):
        if math.isfinite(reading):
            middle = math.degrees(heading + axis)
            place = run.position[row] + turn @ position
            look: style.Properties = {"width": 0.03, "facecolor": BEAM_COLOR, "edgecolor": "none", "alpha": 0.8}
            yield Wedge(tuple(place), reading, middle - half, middle + half, **look)
