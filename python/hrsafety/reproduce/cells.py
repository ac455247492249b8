"""One printed value beside the measured one, and when they count as equal."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from hrsafety._records import dataclass

__all__ = ["PrintedValue", "Tolerance", "tolerance_of"]

# A deviation that sits on its bound in decimal must not fall off it in binary.
_ROUNDING = 1e-9


class Tolerance(NamedTuple):
    """Largest deviation that counts as agreement.

    Attributes
    ----------
    limit : float
        The bound.
    relative : bool
        Whether it is a share of the printed value, or in the unit of the value.
    """

    limit: float
    relative: bool


# Arrival times, distances to single stationary obstacles, scores and energies of the published
# tables agree this well with an implementation of the corrected equations wherever the source
# gives everything that the value depends on. Energies depend on a motor resistance that is
# calibrated, hence the wide bound.
ARRIVAL_TIME = Tolerance(0.05, relative=True)
DISTANCE = Tolerance(0.06, relative=True)
SCORE = Tolerance(0.03, relative=False)
ENERGY = Tolerance(0.25, relative=True)


def tolerance_of(column: str) -> Tolerance:
    """Return the tolerance of a column by its name."""
    for prefix, tolerance in (("T_", ARRIVAL_TIME), ("d_", DISTANCE), ("H", SCORE), ("L_", ENERGY)):
        if column.startswith(prefix):
            return tolerance
    raise KeyError(column)


@dataclass(frozen=True, kw_only=True, slots=True)
class PrintedValue:
    """One printed value and what was measured for it.

    Attributes
    ----------
    table : str
        Number of the published table, for example ``"6.2"``.
    row : str
        Method, or change of the gain.
    column : str
        Quantity as named in the table.
    printed : float or str
        Value as printed; words where the table has words.
    measured : float, str or None
        Own result; ``None`` where there is none.
    deviation : float or None
        measured - printed, as a share of the printed value if ``relative``.
    relative : bool
        Whether deviation and tolerance are shares of the printed value.
    unit : str
        Unit of both values.
    tolerance : float or None
        Largest deviation that counts as agreement; ``None`` if there is nothing to judge.
    within : bool or None
        Whether the deviation is within the tolerance; ``None`` if there is nothing to judge.
    reason : str
        Why the values differ, why there is no measured value, or what the reader must know.
    """

    table: str
    row: str
    column: str
    printed: float | str
    measured: float | str | None
    deviation: float | None
    relative: bool
    unit: str
    tolerance: float | None
    within: bool | None
    reason: str

    @classmethod
    def compared(
        cls,
        *,
        table: str,
        row: str,
        column: str,
        printed: float,
        measured: float,
        tolerance: Tolerance,
        unit: str,
    ) -> PrintedValue:
        """Return the cell of a measured value, judged; its reason is still empty."""
        deviation = measured - printed
        if tolerance.relative:
            deviation /= printed
        known = math.isfinite(deviation)
        return cls(
            table=table,
            row=row,
            column=column,
            printed=printed,
            measured=measured if known else "no arrival",
            deviation=deviation if known else None,
            relative=tolerance.relative,
            unit=unit,
            tolerance=tolerance.limit,
            within=known and abs(deviation) <= tolerance.limit + _ROUNDING,
            reason="",
        )

    @classmethod
    def listed(cls, *, table: str, row: str, column: str, printed: float | str, unit: str, reason: str) -> PrintedValue:
        """Return the cell of a printed value that nothing was measured for."""
        return cls(
            table=table,
            row=row,
            column=column,
            printed=printed,
            measured=None,
            deviation=None,
            relative=False,
            unit=unit,
            tolerance=None,
            within=None,
            reason=reason,
        )

    @classmethod
    def beside(
        cls, *, table: str, row: str, column: str, printed: float | str, measured: float | str, unit: str, reason: str
    ) -> PrintedValue:
        """Return a value beside another that is no judgment of the source: with deviation, without verdict."""
        cell = cls.listed(table=table, row=row, column=column, printed=printed, unit=unit, reason=reason)
        if isinstance(printed, str) or isinstance(measured, str):
            return replace(cell, measured=measured)
        deviation = measured / printed - 1.0 if printed else math.nan
        known = math.isfinite(deviation)
        return replace(cell, measured=float(measured), deviation=deviation if known else None, relative=known)
