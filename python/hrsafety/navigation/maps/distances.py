"""Exact Euclidean distance transform of an occupancy grid."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, positive
from hrsafety._bounds import MOST_CELLS
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

__all__ = ["distance_transform", "occupied_cells"]

AT_ONCE = 1 << 22
"""Cells that are converted at once, in some hundredths of a second."""


def occupied_cells(name: str, value: object) -> npt.NDArray[np.bool_]:
    """Return an array of truth values with rows and columns, or say what it should have been."""
    rule = "be an array of truth values, or of 0 and 1"
    try:
        cells = np.asarray(value)
    except (TypeError, ValueError):
        raise InvalidParameterError(name, rule, value) from None
    if cells.ndim != 2 or not cells.size:
        raise ShapeError(name, "(rows, columns), one cell at least", cells.shape)
    if cells.size > MOST_CELLS:
        raise InvalidParameterError(name, f"have at most {MOST_CELLS} cells", cells.size)
    if cells.dtype.kind not in "biu":
        raise InvalidParameterError(name, rule, Shown(f"an array of {cells.dtype}"))
    if cells.dtype.kind == "b" and cells.flags.c_contiguous:
        return cells
    # In parts, between which Ctrl-C is answered.
    whole = np.empty(cells.shape, dtype=np.bool_)
    rows = max(AT_ONCE // cells.shape[1], 1)
    for first in range(0, len(cells), rows):
        part = cells[first : first + rows]
        whole[first : first + rows] = part
        other = part != whole[first : first + rows]
        if other.any():
            row, column = np.argwhere(other)[0]
            shown = Shown(f"{part[row, column]} in row {first + row}, column {column}")
            raise InvalidParameterError(name, rule, shown, "compare occupancies with a threshold")
    return whole


def distance_transform(occupied: npt.ArrayLike, *, resolution: float = 1.0) -> Array:
    """Return the distance of every cell from the nearest occupied one, center to center.

    Exact, in time proportional to the number of cells (Felzenszwalb and Huttenlocher 2012).

    Parameters
    ----------
    occupied : array_like of bool, shape (rows, columns)
        Which cells are occupied.
    resolution : float
        Side of a cell in m.

    Returns
    -------
    ndarray, shape (rows, columns)
        Distances in m, infinite without an occupied cell.

    Raises
    ------
    InvalidParameterError
        If the cells are no truth values or too many, or the resolution is not positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.maps.distance_transform([[1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]])[0] ** 2
    array([0., 1., 4., 4.])
    """
    return _hrsafety.cell_distances(occupied_cells("occupied", occupied), positive("resolution", resolution))
