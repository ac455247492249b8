"""Measured pressures: largest cell, and largest mean over 1 cm2, of a foil of cells."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, numbers, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import ResultWarning, implausible, telling
from hrsafety.records import traces
from hrsafety.records.units import in_unit
from hrsafety.standards.verdicts import doubted

__all__ = ["PressureRecord", "pressure"]

_PATCH = 0.01
"""Edge of the square over which pressures are averaged, in m."""
_MISMATCH = 0.2
_EQUAL_CELLS = 3
"""So many cells with the largest value of a frame are full, or their digits too coarse to tell."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PressureRecord:
    """Pressures of a measured contact.

    Attributes
    ----------
    cell : float
        Largest pressure of a cell in Pa.
    patch : float
        Largest mean over a square of 1 cm2, in whole cells, in Pa.
    frame : int
        Frame of the largest cell.
    force : float
        Largest sum of all cells in N.
    warnings : tuple of ResultWarning
        ``saturated``, ``force_pressure_mismatch``, ``patch_leaves_foil``, ``no_push``, ``implausible``.
    """

    cell: Annotated[float, "Pa"]
    patch: Annotated[float, "Pa"]
    frame: int
    force: Annotated[float, "N"]
    warnings: tuple[ResultWarning, ...]

    def verdict(self, limit: float, *, patch: bool = False) -> str:
        """Return what the pressures mean for a limit.

        Parameters
        ----------
        limit : float
            In Pa.
        patch : bool
            Whether the mean over 1 cm2 is judged in place of the largest cell.

        Returns
        -------
        str
            ``"within_limits"``, ``"exceeds"``, or ``"not_checked"`` where a doubt may lie on the unsafe side.
        """
        load = self.patch if patch else self.cell
        return doubted("exceeds" if load > positive("limit", limit) else "within_limits", self.warnings)


@telling()
def pressure(
    frames: npt.ArrayLike,
    *,
    pitch: float,
    unit: str = "Pa",
    peak_force: float | None = None,
    full_scale: float | None = None,
) -> PressureRecord:
    """Return the pressures of a measured contact.

    Parameters
    ----------
    frames : array_like, shape (rows, columns) or (n, rows, columns)
        Pressure of each cell.
    pitch : float
        Distance of neighboring cells in m.
    unit : {"Pa", "kPa", "MPa", "N/mm2", "N/cm2", "bar", "psi"}
        Of the values.
    peak_force : float or None
        Largest force in N that was measured beside the foil: a sum of the cells that differs by more than 20 % is
        ``force_pressure_mismatch``.
    full_scale : float or None
        Largest pressure that a cell measures, in `unit`.

    Returns
    -------
    PressureRecord
        Pressures and doubts.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or a pitch not positive, or a unit unknown.
    ShapeError
        If there are no cells.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import records
    >>> rows, columns = np.mgrid[0:20, 0:24]
    >>> foil = 2e6 * np.exp(-((rows - 8) ** 2 + (columns - 9) ** 2) / (2 * 3.5**2))
    >>> found = records.pressure(foil, pitch=0.0025)
    >>> round(found.patch), found.verdict(1.9e6), found.verdict(1.9e6, patch=True)
    (1776025, 'exceeds', 'within_limits')
    """
    given = numbers("frames", frames)
    cells = given[None] if given.ndim == 2 else given
    if cells.ndim != 3 or 0 in cells.shape:
        raise ShapeError("frames", "have shape (rows, columns) or (n, rows, columns)", given.shape)
    if not np.isfinite(cells).all():
        raise InvalidParameterError("frames", "be finite", float(cells[~np.isfinite(cells)][0]))
    edge = positive("pitch", pitch)
    values = in_unit("unit", cells, unit, "pressure")
    largest = values.max(axis=(1, 2))
    frame = int(np.argmax(largest))
    total = float(values.sum(axis=(1, 2)).max()) * edge**2
    across = max(round(_PATCH / edge), 1)
    beside = None if peak_force is None else positive("peak_force", peak_force)
    doubts = list(_doubts(values, edge, total, across, beside))
    limit = None if full_scale is None else positive("full_scale", full_scale)
    equal = int((values[frame] == largest[frame]).sum())
    if limit is not None and float(np.abs(cells).max()) >= traces.FULL_SCALE * limit:
        message = "a cell measures the full scale: pressures are lower bounds"
        doubts.append(ResultWarning("saturated", "frames", message))
    elif limit is None and largest[frame] > 0.0 and equal >= _EQUAL_CELLS:
        message = (
            f"{equal} cells of frame {frame} measure the same largest pressure: they are full, and pressures are lower "
            "bounds, or their digits are too coarse to tell; give full_scale"
        )
        doubts.append(ResultWarning("saturated", "frames", message))
    return PressureRecord(
        cell=float(largest[frame]),
        patch=_patch(values, across),
        frame=frame,
        force=total,
        warnings=tuple(doubts),
    )


def _patch(values: Array, across: int) -> float:
    """Return the largest mean of squares of so many cells that lie on the foil."""
    rows, columns = (min(across, size) for size in values.shape[1:])
    windows = np.lib.stride_tricks.sliding_window_view(values, (rows, columns), axis=(1, 2))
    return float(windows.mean(axis=(3, 4)).max())


def _doubts(values: Array, edge: float, total: float, across: int, peak_force: float | None) -> Iterator[ResultWarning]:
    """Give what is doubtful about a foil."""
    if not (most := float(values.max())) > 0.0:
        yield ResultWarning("no_push", "frames", "no cell is pressed: nothing was measured")
    else:
        units = {"largest of frames": "peak_pressure", "pitch": "foil_pitch"}
        yield from implausible({"largest of frames": most, "pitch": edge}, units)
    if across > min(values.shape[1:]):
        message = f"the foil has fewer than the {across} cells of 1 cm2 along an edge: the mean is over what there is"
        yield ResultWarning("patch_leaves_foil", "frames", message, safe_side=True)
    if peak_force is not None and abs(total - peak_force) > _MISMATCH * peak_force:
        message = f"the cells add up to {total:.4g} N, and the force is {peak_force:.4g} N: a part is not on the foil?"
        yield ResultWarning("force_pressure_mismatch", "frames", message)
