"""Cells that a robot keeps of its surroundings, as their changes from frame to frame."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._replay.ground import MOST_CELLS
from hrsafety._replay.packing import Block, block
from hrsafety._replay.record import FREE, OCCUPIED, PERSON_POSSIBLE, UNKNOWN, PlayedCells

__all__ = ["MOST_LETTERS", "cells_of"]

Array = npt.NDArray[np.float64]
Cells = npt.NDArray[np.uint8]
Whole = npt.NDArray[np.int64]

MOST_LETTERS = 400_000
"""Letters of the cells of a robot in a page; of cells that would need more several are one."""
SAME = 255
WEIGHT = np.array([1, 0, 2, 3], dtype=np.uint8)
"""Weight by kind: of several cells the kind of the largest weight is shown, so that only free cells are free."""
KIND = np.array([FREE, UNKNOWN, OCCUPIED, PERSON_POSSIBLE], dtype=np.uint8)
"""Kind by weight."""


def cells_of(name: str, cells: PlayedCells, time: Array) -> tuple[dict[str, Any], Block] | None:
    """Return the grid that holds all cells of a robot, and the changes of its cells; ``None`` without any.

    Parameters
    ----------
    name : str
        Of the block.
    cells : PlayedCells
        Cells of a robot.
    time : ndarray, shape (n,)
        Frames in s.

    Returns
    -------
    dict
        Grid as those of maps are, first frame with cells, whether they are a belief.
    Block
        Changes: frames since the change before, row, first column, columns, kind.
    """
    at = np.searchsorted(cells.time, time + 1e-9, side="right") - 1
    if at[-1] < 0:
        return None
    filled = cells.size.min(axis=1) > 0
    low = cells.low[filled].min(axis=0) if filled.any() else np.zeros(2)
    corner = np.zeros_like(cells.size)
    corner[filled] = np.round((cells.low[filled] - low) / cells.side)[:, ::-1]
    high: Whole = (corner + cells.size)[filled].max(axis=0, initial=1)
    many = max(1, math.ceil(math.sqrt(math.prod(high.tolist()) / MOST_CELLS)))
    while True:
        rows, columns = (-(-high // many)).tolist()
        made = np.concatenate([np.empty((0, 5), np.int64), *_changes(cells, at, corner, (rows, columns), many)])
        made[:, 0] = np.diff(made[:, 0], prepend=0)
        packed = block(name, made, kind="u16")
        if len(packed.text) <= MOST_LETTERS or rows * columns == 1:
            grid = [rows, columns, many * cells.side, *map(float, low), 0.0]
            begin = int(np.argmax(at >= 0))
            return {"grid": grid, "begin": begin, "belief": cells.belief}, packed
        many *= 2


def _changes(cells: PlayedCells, at: Whole, corner: Whole, size: tuple[int, int], many: int) -> Iterator[Whole]:
    """Yield the runs of cells along rows that change at each frame, many cells to a side of a shown one."""
    shown, last, box = np.full(size, UNKNOWN, dtype=np.uint8), -1, np.zeros((2, 2), dtype=np.int64)
    for frame, row in enumerate(at.tolist()):
        if row == last:
            continue
        found = _coarse(cells.kinds(row), (corner[row] % many).tolist(), many)
        first = corner[row] // many
        last, before, box = row, box, np.array([first, first + found.shape])
        # Only there cells are or were known.
        low, high = np.minimum(before[0], box[0]), np.maximum(before[1], box[1])
        was = shown[low[0] : high[0], low[1] : high[1]]
        now = np.full(was.shape, UNKNOWN, dtype=np.uint8)
        inside = box - low
        now[inside[0, 0] : inside[1, 0], inside[0, 1] : inside[1, 1]] = found
        marks = np.pad(np.where(now == was, SAME, now), ((0, 0), (0, 1)), constant_values=SAME)
        line = marks.ravel()
        edges = np.flatnonzero(np.diff(line, prepend=np.uint8(SAME)))
        begins = np.flatnonzero(line[edges] != SAME)  # each run ends within its row
        starts, ends = edges[begins], edges[begins + 1] if len(begins) else edges[:0]
        rows, columns = np.divmod(starts, marks.shape[1])
        table = [np.full(len(starts), frame), rows + low[0], columns + low[1], ends - starts, line[starts]]
        yield np.stack(table, axis=1)
        was[:] = now


def _coarse(kinds: Cells, inside: list[int], many: int) -> Cells:
    """Return cells of which many to a side are one; `inside`: rows and columns before them in the first one."""
    if many == 1 or not kinds.size:
        return kinds if kinds.size else kinds[:0, :0]
    after = [-(before + size) % many for before, size in zip(inside, kinds.shape, strict=True)]
    weights = np.pad(WEIGHT[kinds], [*zip(inside, after, strict=True)], constant_values=WEIGHT[UNKNOWN])
    rows, columns = (size // many for size in weights.shape)
    found: Cells = KIND[weights.reshape(rows, many, columns, many).max(axis=(1, 3))]
    return found
