"""Tables 4.1 and 4.2: every printed simulation and experiment beside the exact response."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from hrsafety import impact
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact.cases import KILO, ParameterSet, foam, manipulator, parameter_sets
from hrsafety.reproduce.published import printed_rows
from hrsafety.reproduce.sheets import Sheet

__all__ = ["COLUMNS", "ImpactRow", "cells", "experiments"]

COLUMNS = {
    "a_h_max": ("a_h,max", "g"),
    "impact_period": ("impact period", "s"),
    "compression_max": ("eps_max", "m"),
}
"""Printed column to its name on the page and its unit."""

SHEET = Sheet("chapter_4")


@dataclass(frozen=True, kw_only=True)
class ImpactRow:
    """One row of Table 4.1 or 4.2 and the exact responses for it.

    Attributes
    ----------
    table : str
        ``"4.1"`` or ``"4.2"``.
    name : str
        Foam, manipulator and speeds in words.
    foam_number, stiffness, damping : int, float, float
        Foam of Table 3.3; K_r in N/m and C_r in N s/m.
    manipulator_speed, head_speed : float
        Printed speeds in m/s.
    measured : dict of str to tuple of float
        Experiments by column.
    printed : dict of str to float
        Printed simulation by column.
    simulated : dict of str to dict of str to float
        Own values by set (A, B) and column.
    """

    table: str
    name: str
    foam_number: int
    stiffness: float
    damping: float
    manipulator_speed: float
    head_speed: float
    measured: dict[str, tuple[float, ...]]
    printed: dict[str, float]
    simulated: dict[str, dict[str, float]]

    @property
    def closing_speed(self) -> float:
        """Return the closing speed in m/s."""
        return self.manipulator_speed - self.head_speed

    def arm(self) -> impact.Manipulator:
        """Return the manipulator of the row."""
        return manipulator(1 if self.table == "4.1" else 2, stiffness=self.stiffness, damping=self.damping)

    def covering(self, choice: ParameterSet) -> impact.Foam:
        """Return the foam of the row in one reading."""
        if self.table == "4.2":
            return choice.puma
        return choice.direct_drive[foam(self.foam_number).stiffness / KILO]

    def mean(self, column: str) -> float:
        """Return the mean of the experiments."""
        return float(np.mean(self.measured[column]))


@cache
def experiments() -> tuple[ImpactRow, ...]:
    """Return every row of both tables with its exact responses."""
    return tuple([*_direct_drive(), *_puma()])


def cells() -> list[PrintedValue]:
    """Return a cell for every printed simulation (twice, sets A and B) and every experiment."""
    return [cell for row in experiments() for cell in _cells_of(row)]


def _direct_drive() -> Iterator[ImpactRow]:
    numbers = {24.3: 1, 13.8: 2}
    for row in printed_rows("4.1"):
        number_ = numbers[row["K_c"]]
        name = f"Foam {number_}, K_r {row['K_r']:g} kN/m, C_r {row['C_r']:g} N s/m"
        yield _experiment("4.1", name, number_, KILO * row["K_r"], float(row["C_r"]), row)


def _puma() -> Iterator[ImpactRow]:
    arm = manipulator(2)
    for row in printed_rows("4.2"):
        yield _experiment("4.2", "Puma 560, Foam 1", 1, arm.stiffness, arm.damping, row)


def _experiment(
    table: str,
    name: str,
    foam_number: int,
    stiffness: float,
    damping: float,
    row: dict[str, Any],
) -> ImpactRow:
    bare = ImpactRow(
        table=table,
        name=f"{name}, v_r {row['v_r']:g}, v_h {row['v_h']:g} m/s",
        foam_number=foam_number,
        stiffness=stiffness,
        damping=damping,
        manipulator_speed=row["v_r"],
        head_speed=row["v_h"],
        measured={column: tuple(run[column] for run in row["experiment"]) for column in COLUMNS},
        printed=row["simulation"],
        simulated={},
    )
    bare.simulated.update({choice.name: _simulated(bare, choice) for choice in parameter_sets()})
    return bare


def _simulated(row: ImpactRow, choice: ParameterSet) -> dict[str, float]:
    found = impact.metrics(row.arm(), row.covering(choice), impact.Head.apparatus(), closing_speed=row.closing_speed)
    return {
        "a_h_max": found.peak_head_acceleration / choice.gravity,
        "impact_period": found.impact_duration,
        "compression_max": found.max_compression,
    }


def _cells_of(row: ImpactRow) -> Iterator[PrintedValue]:
    for choice in parameter_sets():
        for column, (name, unit) in COLUMNS.items():
            yield SHEET.number(
                "simulated",
                row.simulated[choice.name][column],
                printed=row.printed[column],
                **_words(row, name, unit),
                set=choice.name,
                why=SHEET.text(_reason(row, column)),
            )
    for column, (name, unit) in COLUMNS.items():
        texts = ("experiment", "hysteresis") if column == "impact_period" else ("experiment",)
        why = " ".join(SHEET.text(text) for text in texts)
        for run, value in enumerate(row.measured[column], start=1):
            own = row.simulated["A"][column]
            yield SHEET.listed("run", own, printed=value, **_words(row, name, unit), run=run, why=why)


def _words(row: ImpactRow, name: str, unit: str) -> dict[str, Any]:
    return {"number": row.table, "row": row.name, "name": name, "unit": unit}


def _reason(row: ImpactRow, column: str) -> str:
    """Return the name of the text that says why a printed simulation differs."""
    if row.table == "4.2":
        return "slow_puma" if row.closing_speed < 1.0 else "rounded"
    if row.damping > 250.0:
        return "damped"
    if row.foam_number == 2:
        return "foam_2" if column != "impact_period" else "softer"
    return "stiffer" if column == "impact_period" and row.stiffness < 20000.0 else "rounded"
