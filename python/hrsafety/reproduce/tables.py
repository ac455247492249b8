"""Every printed value of the tables of chapters 5 to 7, measured again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from hrsafety.reproduce.built import runs as built_runs
from hrsafety.reproduce.built import tables as built_tables
from hrsafety.reproduce.cells import PrintedValue, tolerance_of
from hrsafety.reproduce.measured import LAWS, MeasuredRun, measure_laws, score_of_parts
from hrsafety.reproduce.published import Row, printed_rows
from hrsafety.reproduce.reasons import cause_of, note_of, why_not_judged

__all__ = [
    "GAIN_UNITS",
    "UNITS",
    "chapter_6",
    "chapter_7",
    "explained",
    "input_cell",
    "numbers",
    "printed_score",
    "unpredictable_human",
]

GAIN_UNITS = {"K_1": "N/m", "K_3": "N/m", "K_5": "N/m^2", "b": "s"}
"""Units of the gains, in the order of the gain sets."""
_GAINS = {
    "K_1": ("attractive_gain", "N/m"),
    "K_3": ("repulsive_gain", "N/m"),
    "K_5": ("detour_gain", "N/m^2"),
    "b": ("gain_ratio", "s"),
}
# One gain for repulsion and detour; Table C.1 prints it twice.
_GE_CUI_GAINS = {
    "K_1": ("attractive_gain", "N/m"),
    "K_3": ("repulsive_gain", "N m^2"),
    "K_5": ("repulsive_gain", "N m^2"),
    "b": ("gain_ratio", "s"),
}
UNITS = {"T": "s", "L": "J", "d": "m", "H": "1"}
"""Unit of a column by the letter that its name begins with."""

# Scores of chapters 5 to 7 are printed with two digits.
_DIGITS_OF_SCORES = 2


def chapter_6() -> list[PrintedValue]:
    """Return the cells of Tables 6.1 to 6.5: gains, and configurations c1 to c4."""
    names = ("c1", "c2", "c3", "c4")
    runs = measure_laws(names, LAWS)
    cells = _gain_cells("6.1")
    for index in range(len(names)):
        cells += _method_cells(f"6.{index + 2}", {method: rows[index] for method, rows in runs.items()})
    return cells


def chapter_7() -> list[PrintedValue]:
    """Return the cells of Tables 7.1 to 7.4, configurations n1 to n4, and of section 7.5.5."""
    names = ("n1", "n2", "n3", "n4")
    runs = measure_laws(names, ["new_vff"])["new_vff"]
    cells = []
    for index, name in enumerate(names):
        both = {"holonomic": runs[index], "nonholonomic": built_runs.two_wheels(name)}
        cells += _method_cells(f"7.{index + 1}", both)
    return [*cells, *built_tables.multiple_obstacles()]


def unpredictable_human() -> list[PrintedValue]:
    """Return the cells of Table 5.1: a person who stops and turns."""
    runs = measure_laws(["unpredictable_human"], ["masoud", "ge_cui", "new_vff"])
    renamed = {
        method: replace(run, values=run.values | {"d_min": run.values["d_human_min"]})
        for method, (run,) in runs.items()
    }
    return _method_cells("5.1", renamed)


def numbers(row: Row) -> Iterable[tuple[str, float]]:
    """Return the printed numbers of a row: no labels, notes or dashes."""
    for column, value in row.items():
        if column not in {"method", "change_percent", "note"} and value is not None:
            yield column, float(value)


def _gain_cells(table: str) -> list[PrintedValue]:
    """Return the printed gains: inputs, not results."""
    return [
        input_cell(table, row["method"], column, printed)
        for row in printed_rows(table)
        for column, printed in numbers(row)
    ]


def input_cell(table: str, method: str, column: str, printed: float) -> PrintedValue:
    """Return the cell of a printed gain that the runs use."""
    names = _GE_CUI_GAINS if method == "ge_cui" else _GAINS
    field, unit = names[column]
    used = getattr(LAWS[method], field)
    rounded = ", printed with fewer digits" if used != printed else ""
    reason = f"An input, not a result: the runs use {used:g}{rounded}."
    return PrintedValue.listed(table=table, row=method, column=column, printed=printed, unit=unit, reason=reason)


def _method_cells(table: str, runs: Mapping[str, MeasuredRun]) -> list[PrintedValue]:
    """Return the cells of a table with one row for each method."""
    cells = []
    for row in printed_rows(table):
        method = row["method"]
        for column, printed in numbers(row):
            place: dict[str, Any] = {"table": table, "row": method, "column": column, "printed": printed}
            unit = UNITS[column[0]]
            if method.endswith("_experiment"):
                cells.append(built_tables.experiment_cell(**place, unit=unit))
                continue
            run, unjudged = runs[method], why_not_judged(method, column)
            if unjudged:
                cells.append(PrintedValue.beside(**place, measured=run.values[column], unit=unit, reason=unjudged))
                continue
            cell = PrintedValue.compared(
                **place, measured=run.values[column], tolerance=tolerance_of(column), unit=unit
            )
            cells.append(explained(cell, printed_score(run, row) if column == "H" else None))
    return cells


def printed_score(run: MeasuredRun, row: Row, suffix: str = "") -> float:
    """Return the score that follows from the printed T, L and d of a row."""
    distances = {
        column.removesuffix(suffix): float(value)
        for column, value in row.items()
        if column.startswith("d_") and column.endswith(suffix) and value is not None
    }
    if "d_min" in distances:
        distances["d_human_min"] = distances.pop("d_min")
    return score_of_parts(run, time=row[f"T_arrive{suffix}"], energy=row[f"L_energy{suffix}"], distances=distances)


def explained(cell: PrintedValue, score: float | None = None) -> PrintedValue:
    """Return the cell with its reason: the cause if it is off, a note where one is due."""
    reason = note_of(cell.table, cell.row, cell.column)
    if not cell.within:
        cause = cause_of(cell.table, cell.row, cell.column)
        reason = " ".join(dict.fromkeys(text for text in (cause, reason) if text))
        if _agrees_when_rounded(cell):
            reason += " Rounded to the printed digits it is within tolerance."
        if score is not None:
            reason += f" The printed T, L and d give H {score:.3f} with the T* and L* measured here."
    return replace(cell, reason=reason.strip())


def _agrees_when_rounded(cell: PrintedValue) -> bool:
    """Return whether a score would be within its tolerance with no more digits than printed."""
    if cell.unit != "1" or cell.tolerance is None or not isinstance(cell.measured, float):
        return False
    rounded = round(cell.measured, _DIGITS_OF_SCORES)
    return cell.table[0] != "C" and abs(rounded - float(cell.printed)) <= cell.tolerance + 1e-9
