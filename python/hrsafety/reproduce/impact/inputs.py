"""Tables 3.1 to 3.3 of Zeng (2011): printed numbers that go into the simulations."""

from __future__ import annotations

from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.published import published_tables

__all__ = ["INPUT", "cells"]

INPUT = "Input of the simulations: nothing is measured for it."
_NAMES = {"3.1": ("manipulator", "Manipulator"), "3.2": ("simulation", "Simulation"), "3.3": ("foam", "Foam")}


def cells() -> list[PrintedValue]:
    """Return the printed parameters of manipulators, heads and foams, without verdicts."""
    found: list[PrintedValue] = []
    for number, (key, name) in _NAMES.items():
        table = published_tables()[f"zeng2011:{number}"]
        for row in table["rows"]:
            for column, value in row.items():
                if column != key:
                    unit = table["units"].get(column, "")
                    place = {"table": number, "row": f"{name} {row[key]}", "column": column}
                    found.append(PrintedValue.listed(**place, printed=value, unit=unit, reason=INPUT))
    table = published_tables()["zeng2011:A.1"]
    for row in table["rows"]:
        for column in ("kappa", "A"):
            for test, value in enumerate(row[column], start=1):
                place = {"table": "A.1", "row": f"{row['u']:g} V, test {test}", "column": column}
                found.append(PrintedValue.listed(**place, printed=value, unit=table["units"][column], reason=INPUT))
    return found
