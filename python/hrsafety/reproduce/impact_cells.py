"""Cells of the impact part: numbers, percentages and claims in words, each with its verdict."""

from __future__ import annotations

import math
from dataclasses import replace

from hrsafety.reproduce.cells import Cell, Tolerance

__all__ = ["FOAM_TOLERANCE", "PERCENT", "SIMULATED", "claim", "listed", "number"]

# Half a unit of the last printed digit is up to 1.5 % of a printed value; the foam parameters are
# printed with an uncertainty of 0.2 % (Foam 1) and 2.3 % (Foam 2). Half the spread of repeated
# experiments is larger: 1.6 %, 5 % and 4 % in the mean of Table 4.1.
SIMULATED = {
    "a_h,max": Tolerance(0.02, relative=True),
    "impact period": Tolerance(0.04, relative=True),
    "eps_max": Tolerance(0.03, relative=True),
}
# Percentages of the text are whole numbers: one unit of the last digit.
PERCENT = Tolerance(1.0, relative=False)
# Results of appendix A are printed with two to four digits.
FOAM_TOLERANCE = Tolerance(0.005, relative=True)


def number(
    table: str,
    row: str,
    column: str,
    *,
    printed: float,
    measured: float,
    tolerance: Tolerance,
    unit: str,
    reason: str = "",
) -> Cell:
    """Return a judged number; the reason is kept only where it is off or says what to know."""
    cell = Cell.compared(
        table=table,
        row=row,
        column=column,
        printed=float(printed),
        measured=float(measured),
        tolerance=tolerance,
        unit=unit,
    )
    return replace(cell, reason=reason)


def claim(table: str, row: str, column: str, *, printed: str, measured: str, holds: bool, reason: str = "") -> Cell:
    """Return a judged claim in words."""
    cell = Cell.listed(table=table, row=row, column=column, printed=printed, unit="", reason=reason)
    return replace(cell, measured=measured, within=bool(holds))


def listed(
    table: str, row: str, column: str, *, printed: float | str, measured: float | str, unit: str, reason: str
) -> Cell:
    """Return a value beside another that is no judgment of the source, for example an experiment."""
    cell = Cell.listed(table=table, row=row, column=column, printed=printed, unit=unit, reason=reason)
    if isinstance(printed, str) or isinstance(measured, str):
        return replace(cell, measured=measured)
    deviation = measured / printed - 1.0 if printed else math.nan
    known = math.isfinite(deviation)
    return replace(cell, measured=float(measured), deviation=deviation if known else None, relative=known)
