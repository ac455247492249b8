"""Every printed value of the published tables, measured again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from hrsafety.reproduce.cells import SCORE, Cell, Tolerance, tolerance_of
from hrsafety.reproduce.measured import GAIN_SETS, Gains, Measured, measure, score_of_parts
from hrsafety.reproduce.published import Row, printed_rows
from hrsafety.reproduce.reasons import cause_of, note_of, why_not_measured

__all__ = ["appendix_c", "chapter_6", "chapter_7", "unpredictable_human"]

CHANGES_PERCENT = (-100.0, -50.0, -20.0, -10.0, -5.0, -2.0, 0.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
"""Changes of one gain at a time in Tables C.2 to C.9."""
VARIED = {"K_1": ("C.2", "C.3"), "K_3": ("C.4", "C.5"), "K_5": ("C.6", "C.7"), "b": ("C.8", "C.9")}
"""Gain to its table of T, L, d and its table of scores."""

_GAIN_UNITS = {"K_1": "N/m", "K_3": "N/m", "K_5": "N/m^2", "b": "s"}
_UNITS = {"T": "s", "L": "J", "d": "m", "H": "1"}
# Scores of chapters 5 to 7 are printed with two digits.
_DIGITS_OF_SCORES = 2
# Half a unit of the last digit of the scores and sensitivities that the sensitivities come from.
_SCORE_ROUNDING = 0.5e-4
_SENSITIVITY_ROUNDING_PERCENT = 0.5e-2


def chapter_6() -> list[Cell]:
    """Return the cells of Tables 6.1 to 6.5: gains, and configurations c1 to c4.

    Returns
    -------
    list of Cell
        Every printed number once.
    """
    names = ("c1", "c2", "c3", "c4")
    runs = dict(zip(GAIN_SETS, measure(names, GAIN_SETS.values()), strict=True))
    cells = _gain_cells("6.1")
    for index in range(len(names)):
        cells += _method_cells(f"6.{index + 2}", {method: rows[index] for method, rows in runs.items()})
    return cells


def chapter_7() -> list[Cell]:
    """Return the cells of Tables 7.1 to 7.4: configurations n1 to n4.

    Returns
    -------
    list of Cell
        Every printed number once.
    """
    names = ("n1", "n2", "n3", "n4")
    (runs,) = measure(names, [GAIN_SETS["new_vff"]])
    return [cell for index, run in enumerate(runs) for cell in _method_cells(f"7.{index + 1}", {"holonomic": run})]


def unpredictable_human() -> list[Cell]:
    """Return the cells of Table 5.1: a person who stops and turns.

    Returns
    -------
    list of Cell
        Every printed number once.
    """
    ((run,),) = measure(["unpredictable_human"], [GAIN_SETS["new_vff"]])
    values = run.values | {"d_min": run.values["d_human_min"]}
    return _method_cells("5.1", {"new_vff": replace(run, values=values)})


def appendix_c() -> list[Cell]:
    """Return the cells of Tables C.1 to C.9: one gain at a time changed around the optimum.

    Returns
    -------
    list of Cell
        Every printed number once, and one cell for each outcome that the tables have in words.
    """
    keys = [(gain, change) for gain in VARIED for change in CHANGES_PERCENT]
    rows = measure(("c1", "c2", "c3"), [_changed(gain, change) for gain, change in keys])
    runs = dict(zip(keys, rows, strict=True))
    cells = _optimum_cells(runs["K_1", 0.0])
    for gain, (distances, scores) in VARIED.items():
        own = {change: runs[gain, change] for change in CHANGES_PERCENT}
        cells += _distance_cells(distances, own)
        cells += _outcome_cells(scores, own[-100.0])
        cells += _score_cells(scores, own, _by_change(printed_rows(distances)))
    return cells


def _changed(gain: str, change_percent: float) -> Gains:
    """Return the optimized gains with one of them changed."""
    gains = list(GAIN_SETS["new_vff_optimised"])
    gains[list(VARIED).index(gain)] *= 1.0 + change_percent / 100.0
    return (gains[0], gains[1], gains[2], gains[3])


def _numbers(row: Row) -> Iterable[tuple[str, float]]:
    """Return the printed numbers of a row: no labels, notes or dashes."""
    for column, value in row.items():
        if column not in {"method", "change_percent", "note"} and value is not None:
            yield column, float(value)


def _gain_cells(table: str) -> list[Cell]:
    """Return the printed gains: inputs, not results."""
    cells = []
    for row in printed_rows(table):
        method = row["method"]
        for column, printed in _numbers(row):
            reason = why_not_measured(method)
            if not reason:
                used = GAIN_SETS[method][list(_GAIN_UNITS).index(column)]
                rounded = ", printed with fewer digits" if used != printed else ""
                reason = f"An input, not a result: the runs use {used:g}{rounded}."
            cells.append(
                Cell.listed(
                    table=table, row=method, column=column, printed=printed, unit=_GAIN_UNITS[column], reason=reason
                )
            )
    return cells


def _optimum_cells(runs: list[Measured]) -> list[Cell]:
    """Return the cells of Table C.1: optimized gains and the mean score they reach."""
    optimum = {"new_vff": "new_vff_optimised"}
    cells = []
    for row in printed_rows("C.1"):
        method = row["method"]
        for column, printed in _numbers(row):
            place: dict[str, Any] = {"table": "C.1", "row": method, "column": column, "printed": printed}
            if method not in optimum:
                unit = _GAIN_UNITS.get(column, "1")
                cells.append(Cell.listed(**place, unit=unit, reason=why_not_measured(method)))
            elif column == "H_mean":
                cells.append(_explained(Cell.compared(**place, measured=_mean_score(runs), tolerance=SCORE, unit="1")))
            else:
                used = GAIN_SETS[optimum[method]][list(_GAIN_UNITS).index(column)]
                reason = f"An input, not a result: the runs use {used:g}."
                cells.append(Cell.listed(**place, unit=_GAIN_UNITS[column], reason=reason))
    return cells


def _method_cells(table: str, runs: Mapping[str, Measured]) -> list[Cell]:
    """Return the cells of a table with one row for each method."""
    cells = []
    for row in printed_rows(table):
        method = row["method"]
        for column, printed in _numbers(row):
            place: dict[str, Any] = {"table": table, "row": method, "column": column, "printed": printed}
            unit = _UNITS[column[0]]
            if method not in runs:
                cells.append(Cell.listed(**place, unit=unit, reason=why_not_measured(method)))
                continue
            run = runs[method]
            cell = Cell.compared(**place, measured=run.values[column], tolerance=tolerance_of(column), unit=unit)
            cells.append(_explained(cell, _printed_score(run, row) if column == "H" else None))
    return cells


def _printed_score(run: Measured, row: Row, suffix: str = "") -> float:
    """Return the score that follows from the printed T, L and d of a row."""
    distances = {
        column.removesuffix(suffix): float(value)
        for column, value in row.items()
        if column.startswith("d_") and column.endswith(suffix) and value is not None
    }
    if "d_min" in distances:
        distances["d_human_min"] = distances.pop("d_min")
    return score_of_parts(run, time=row[f"T_arrive{suffix}"], energy=row[f"L_energy{suffix}"], distances=distances)


def _explained(cell: Cell, printed_score: float | None = None) -> Cell:
    """Return the cell with its reason: the cause if it is off, a note where one is due."""
    reason = note_of(cell.table, cell.row, cell.column)
    if not cell.within:
        cause = cause_of(cell.table, cell.row, cell.column)
        reason = " ".join(dict.fromkeys(text for text in (cause, reason) if text))
        if _agrees_when_rounded(cell):
            reason += " Rounded to the printed digits it is within tolerance."
        if printed_score is not None:
            reason += f" The printed T, L and d give H {printed_score:.3f} with the T* and L* measured here."
    return replace(cell, reason=reason.strip())


def _agrees_when_rounded(cell: Cell) -> bool:
    """Return whether a score would be within its tolerance with no more digits than printed."""
    if cell.unit != "1" or cell.tolerance is None or not isinstance(cell.measured, float):
        return False
    rounded = round(cell.measured, _DIGITS_OF_SCORES)
    return cell.table[0] != "C" and abs(rounded - float(cell.printed)) <= cell.tolerance + 1e-9


def _by_change(rows: list[Row]) -> dict[float, Row]:
    return {row["change_percent"]: row for row in rows}


def _label(change_percent: float) -> str:
    return f"{change_percent:+g} %" if change_percent else "0 %"


def _straight(column: str) -> str:
    """Return the column whose values stand under a printed head of Tables C.2 to C.8."""
    exchanged = {"d_circle_min_3": "d_rectangle_min_3", "d_rectangle_min_3": "d_circle_min_3"}
    return exchanged.get(column, column)


def _distance_cells(table: str, runs: Mapping[float, list[Measured]]) -> list[Cell]:
    """Return the cells of a table of T, L and d in three configurations."""
    cells = []
    for change, row in _by_change(printed_rows(table)).items():
        for column, printed in _numbers(row):
            quantity, configuration = _straight(column).rsplit("_", 1)
            run = runs[change][int(configuration) - 1]
            cell = Cell.compared(
                table=table,
                row=_label(change),
                column=column,
                printed=printed,
                measured=run.values[quantity],
                tolerance=tolerance_of(quantity),
                unit=_UNITS[quantity[0]],
            )
            cells.append(_explained(cell))
    return cells


def _outcome_cells(table: str, runs: list[Measured]) -> list[Cell]:
    """Return the cells of the row that a table has in words: the gain at zero."""
    (row,) = (row for row in printed_rows("C.zero") if row["table"] == table)
    cells = []
    for index, run in enumerate(runs, start=1):
        printed = row[f"outcome_{index}"]
        cell = replace(
            Cell.listed(table=table, row="-100 %", column=f"outcome_{index}", printed=printed, unit="", reason=""),
            measured=run.outcome,
            within=run.outcome == printed or (printed == "no arrival" and not run.arrived),
        )
        cells.append(_explained(cell))
    return cells


def _score_cells(table: str, runs: Mapping[float, list[Measured]], parts: Mapping[float, Row]) -> list[Cell]:
    """Return the cells of a table of scores and sensitivities."""
    optimum = _mean_score(runs[0.0])
    cells = []
    for change, row in _by_change(printed_rows(table)).items():
        for column, printed in _numbers(row):
            place: dict[str, Any] = {"table": table, "row": _label(change), "column": column, "printed": printed}
            if column == "sensitivity_percent":
                cells.append(_sensitivity_cell(place, change, _mean_score(runs[change]), optimum))
            elif column == "H_mean":
                cell = Cell.compared(**place, measured=_mean_score(runs[change]), tolerance=SCORE, unit="1")
                cells.append(_explained(cell))
            else:
                run = runs[change][int(column[-1]) - 1]
                straight = {_straight(name): value for name, value in parts[change].items()}
                cell = Cell.compared(**place, measured=run.values["H"], tolerance=SCORE, unit="1")
                cells.append(_explained(cell, _printed_score(run, straight, column[1:])))
    return cells


def _mean_score(runs: list[Measured]) -> float:
    return sum(run.values["H"] for run in runs) / len(runs)


def _sensitivity_cell(place: dict[str, Any], change_percent: float, score: float, optimum: float) -> Cell:
    """Return S = |(1 - H_mean/H_opt) / (1 - K/K_opt)| of (C.3.1) to (C.3.4) beside the printed one."""
    if change_percent == 0.0:
        reason = "0/0 at the optimum; the source prints 0 here and a dash in its other tables."
        return Cell.listed(**place, unit="%", reason=reason)
    share = change_percent / 100.0
    rounding = abs(2.0 * _SCORE_ROUNDING / optimum / share) * 100.0 + _SENSITIVITY_ROUNDING_PERCENT
    cell = Cell.compared(
        **place,
        measured=abs((1.0 - score / optimum) / share) * 100.0,
        tolerance=Tolerance(rounding, relative=False),
        unit="%",
    )
    return _explained(cell)
