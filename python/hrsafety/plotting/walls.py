"""Static maps on axes: walls, filled polygons, discs and cells."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.plotting import inputs, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["add_maps", "handles", "maps_of", "points_of"]

COLOR = "#3A3A3A"
ZORDER = 2.9  # below obstacles and paths
THIN = 1.6  # pt, walls without thickness
_ROUND = 17  # points of half a circle


def maps_of(runs: Iterable[Trajectory]) -> list[StaticMap]:
    """Return the different maps that stand in the scenarios of runs, and that their laws and lidars know."""
    found: list[StaticMap] = []
    for run in runs:
        built = getattr(run, "built", None)
        sensors = () if built is None else built.sensors
        known = [
            getattr(run.scenario, "walls", None),
            getattr(run.law, "map", None),
            *(each.map for each in sensors if isinstance(each, Lidar)),
        ]
        found += [each for each in known if isinstance(each, StaticMap) and each not in found]
    return found


def points_of(maps: Iterable[StaticMap]) -> list[Any]:
    """Return the corners of the boxes around maps."""
    return [np.asarray(each.bounds) for each in maps if each.bounds is not None]


def add_maps(axes: Axes, maps: Iterable[StaticMap]) -> None:
    """Draw maps without changing the view."""
    for each in maps:
        _add_cells(axes, each)
        _add_solids(axes, each)


def handles(maps: Iterable[StaticMap]) -> list[Artist]:
    """Return the entry of the legend, if there is a map."""
    from matplotlib.patches import Patch

    return [Patch(facecolor=COLOR, label="map")] if any(each.bounds is not None for each in maps) else []


def _add_solids(axes: Axes, drawn: StaticMap) -> None:
    from matplotlib.collections import LineCollection, PatchCollection
    from matplotlib.patches import Circle, Polygon

    patches: list[Any] = [Polygon(outline, closed=True) for outline in drawn.polygons]
    patches += [Circle((x, y), radius) for x, y, radius in np.asarray(drawn.discs, dtype=np.float64).reshape(-1, 3)]
    thin = []
    for wall in drawn.walls:
        corners = np.asarray(wall.points)
        if wall.radius > 0.0:
            patches += [Polygon(_capsule(*ends, wall.radius)) for ends in itertools.pairwise(corners)]
        else:
            thin.append(corners)
    for collection in (
        PatchCollection(patches, facecolor=COLOR, edgecolor="none"),
        LineCollection(thin, colors=COLOR, linewidths=THIN, capstyle="round"),
    ):
        axes.add_collection(collection, autolim=False)
        collection.set_zorder(ZORDER)


def _capsule(start: inputs.Array, end: inputs.Array, radius: float) -> inputs.Array:
    """Return the outline of all that is within a radius of a segment."""
    along = np.arctan2(*(end - start)[::-1])
    half = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _ROUND)
    around = np.concatenate([along + half, along + np.pi + half])
    centers = np.repeat([end, start], _ROUND, axis=0)
    outline: inputs.Array = centers + radius * np.stack([np.cos(around), np.sin(around)], axis=1)
    return outline


def _add_cells(axes: Axes, drawn: StaticMap) -> None:
    from matplotlib.colors import to_rgba
    from matplotlib.transforms import Affine2D

    for grid in drawn.grids:
        rows, columns = grid.shape
        picture = np.zeros((rows, columns, 4))
        picture[grid.occupied] = to_rgba(COLOR)
        width, height = columns * grid.resolution, rows * grid.resolution
        look: style.Properties = {"origin": "lower", "interpolation": "nearest", "zorder": ZORDER, "aspect": "equal"}
        limits = axes.get_xlim(), axes.get_ylim()
        image = axes.imshow(picture, extent=(0.0, width, 0.0, height), **look)
        image.set_transform(Affine2D().rotate(grid.yaw).translate(*grid.origin) + axes.transData)
        axes.set(xlim=limits[0], ylim=limits[1])
