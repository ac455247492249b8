"""Static maps on axes: walls, filled polygons, discs and cells."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety.navigation.maps.parts import Cells
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.plotting import inputs, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from hrsafety.navigation.trajectory import Trajectory

__all__ = ["add_maps", "handles", "maps_of", "points_of"]

COLOR = "#3A3A3A"
UNKNOWN = "#D2D2D2"
ZORDER = 2.9  # below obstacles and paths
BELOW = 0.4  # unknown floor, below all else
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
    """Return the entries of the legend: of the map if there is one, and of what is unknown in it."""
    from matplotlib.patches import Patch

    drawn = list(maps)
    found: list[Artist] = []
    if any(each.bounds is not None for each in drawn):
        found.append(Patch(facecolor=COLOR, label="map"))
    if any(_unknown(grid).any() for each in drawn for grid in each.grids):
        found.append(Patch(facecolor=UNKNOWN, label="unknown"))
    return found


def _unknown(grid: Cells) -> npt.NDArray[np.bool_]:
    """Return which cells were not observed and are no walls."""
    return np.asarray(grid.unseen & ~grid.occupied)


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
        width, height = columns * grid.resolution, rows * grid.resolution
        look: style.Properties = {"origin": "lower", "interpolation": "nearest", "aspect": "equal"}
        limits = axes.get_xlim(), axes.get_ylim()
        for cells, color, order in ((grid.occupied, COLOR, ZORDER), (_unknown(grid), UNKNOWN, BELOW)):
            if order == BELOW and not cells.any():
                continue
            picture = np.zeros((rows, columns, 4))
            picture[cells] = to_rgba(color)
            image = axes.imshow(picture, extent=(0.0, width, 0.0, height), zorder=order, **look)
            image.set_transform(Affine2D().rotate(grid.yaw).translate(*grid.origin) + axes.transData)
        axes.set(xlim=limits[0], ylim=limits[1])
