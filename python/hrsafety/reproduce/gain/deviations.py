"""Deviations of measured from printed values over all rows of Tables C.2 to C.9."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain.runs import GAIN_TABLES

__all__ = ["Deviation", "deviations"]


class Deviation(NamedTuple):
    """How far the measured values of a quantity are from the printed ones.

    Attributes
    ----------
    configuration, quantity : str
        Which.
    values : int
        Number of values.
    mean, worst, second_worst : float
        Mean of the deviations, and largest magnitudes, in %.
    """

    configuration: str
    quantity: str
    values: int
    mean: float
    worst: float
    second_worst: float


_QUANTITIES = (("T", ("T_arrive",)), ("d", ("d_circle_min", "d_human_min", "d_rectangle_min")), ("H", ("H",)))


def deviations(cells: Sequence[PrintedValue]) -> Iterator[Deviation]:
    """Yield the deviations of T, d and H in each configuration over all rows of Tables C.2 to C.9."""
    tables = {table for pair in GAIN_TABLES.values() for table in pair}
    own = [cell for cell in cells if cell.table in tables and isinstance(cell.measured, float)]
    for place in (1, 2, 3):
        for quantity, stems in _QUANTITIES:
            names = {f"{stem}_{place}" for stem in stems}
            shares = [
                100.0 * (float(cell.measured or 0.0) / float(cell.printed) - 1.0)
                for cell in own
                if cell.column in names
            ]
            *_, second, worst = sorted(abs(share) for share in shares)
            yield Deviation(f"c{place}", quantity, len(shares), float(np.mean(shares)), worst, second)
