"""Standing obstacles and unseen floor for a player."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._replay.packing import Block, block

__all__ = ["ground_of"]

MOST_CELLS = 1_000_000
"""Cells of a grid that is shown as it is; of a finer one several are one, occupied if one of them is."""
FREE, OCCUPIED, UNSEEN = 0, 1, 2


def ground_of(maps: Iterable[Any]) -> tuple[dict[str, Any], list[Block]]:
    """Return shapes of maps, and their grids packed.

    Parameters
    ----------
    maps : iterable of StaticMap
        What stands.

    Returns
    -------
    dict
        Walls, polygons, discs, grids without their cells, and the box around all.
    list of Block
        Cells: 0 free, 1 occupied, 2 not seen by anybody.
    """
    walls: list[Any] = []
    polygons: list[Any] = []
    discs: list[Any] = []
    grids: list[Any] = []
    blocks: list[Block] = []
    corners: list[Any] = []
    for each in maps:
        walls += [[_points(wall.points), float(wall.radius)] for wall in each.walls]
        polygons += [_points(outline) for outline in each.polygons]
        discs += [[float(part) for part in disc] for disc in each.discs]
        for grid in each.grids:
            cells, side = _coarse(grid)
            blocks.append(block(f"grid{len(grids)}", cells.ravel(), kind="u8"))
            place = [*map(float, grid.origin), float(grid.yaw)]
            grids.append([cells.shape[0], cells.shape[1], side, *place, bool(grid.limits)])
        if each.bounds is not None:
            corners += [each.bounds[0], each.bounds[1]]
    box = None
    if corners:
        places = np.array(corners, dtype=np.float64)
        box = [*places.min(axis=0).tolist(), *places.max(axis=0).tolist()]
    return {"walls": walls, "polygons": polygons, "discs": discs, "grids": grids, "box": box}, blocks


def _points(corners: Iterable[Any]) -> list[list[float]]:
    return [[round(float(x), 4), round(float(y), 4)] for x, y in corners]


def _coarse(grid: Any) -> tuple[npt.NDArray[np.uint8], float]:
    """Return the cells of a grid and their side in m; what is occupied or unseen in part is so as a whole."""
    cells = np.where(grid.occupied, OCCUPIED, np.where(grid.unseen, UNSEEN, FREE)).astype(np.uint8)
    side, step = float(grid.resolution), 1
    while cells.size / step**2 > MOST_CELLS:
        step += 1
    if step > 1:
        rows, columns = (-(-size // step) * step for size in cells.shape)
        whole = np.full((rows, columns), FREE, dtype=np.uint8)
        whole[: cells.shape[0], : cells.shape[1]] = cells
        parts = whole.reshape(rows // step, step, columns // step, step)
        some = [(parts == each).any(axis=(1, 3)) for each in (OCCUPIED, UNSEEN)]
        cells = np.where(some[0], OCCUPIED, np.where(some[1], UNSEEN, FREE)).astype(np.uint8)
    return cells, side * step
