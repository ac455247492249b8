"""Every printed value of Tables C.1 to C.9, measured again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from hrsafety.reproduce.cells import SCORE, PrintedValue, Tolerance, tolerance_of
from hrsafety.reproduce.gain import claims as gain_claims
from hrsafety.reproduce.gain.runs import CHANGES_PERCENT, GAIN_TABLES, GainRuns, gain_runs
from hrsafety.reproduce.measured import measure_laws
from hrsafety.reproduce.published import Row, printed_rows
from hrsafety.reproduce.reasons import note_of, why_not_judged
from hrsafety.reproduce.tables import GAIN_UNITS, UNITS, explained, input_cell, numbers, printed_score

__all__ = ["appendix_c"]

# Half a unit of the last digit of the scores and sensitivities that the sensitivities come from.
_SCORE_ROUNDING = 0.5e-4
_SENSITIVITY_ROUNDING_PERCENT = 0.5e-2


def appendix_c() -> list[PrintedValue]:
    """Return the cells of Tables C.1 to C.9 and the claims of sections C.2 and C.3."""
    runs = gain_runs()
    cells = [*_optimum(runs), *gain_claims.search(runs)]
    for index, (distances, scores) in enumerate(GAIN_TABLES.values()):
        cells += _distance_cells(distances, runs, index)
        cells += _outcome_cells(scores, runs, index)
        cells += _score_cells(scores, runs, index, _by_change(printed_rows(distances)))
    return [*cells, *gain_claims.sensitivities(runs), *gain_claims.trends(runs)]


def _by_change(rows: list[Row]) -> dict[float, Row]:
    return {row["change_percent"]: row for row in rows}


def _label(change_percent: float) -> str:
    return f"{change_percent:+g} %" if change_percent else "0 %"


def _straight(column: str) -> str:
    """Return the column whose values stand under a printed head of Tables C.2 to C.8."""
    exchanged = {"d_circle_min_3": "d_rectangle_min_3", "d_rectangle_min_3": "d_circle_min_3"}
    return exchanged.get(column, column)


# ---- Table C.1 --------------------------------------------------------------------------------------


def _optimum(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield the cells of Table C.1: printed optimum beside the own one."""
    found = dict(zip(GAIN_UNITS, runs.search.best.gains, strict=True))
    for row in printed_rows("C.1"):
        method = row["method"]
        for column, printed in numbers(row):
            place: dict[str, Any] = {"table": "C.1", "row": method, "column": column, "printed": printed}
            if method in _SEARCHED_ON:
                yield _of_compared_law(**place)
            elif column == "H_mean":
                best = float(runs.search.best_value)
                yield explained(PrintedValue.compared(**place, measured=best, tolerance=SCORE, unit="1"))
            else:
                reason = _why_another_gain(runs, list(GAIN_UNITS).index(column))
                yield PrintedValue.beside(**place, measured=found[column], unit=GAIN_UNITS[column], reason=reason)


def _of_compared_law(*, table: str, row: str, column: str, printed: float) -> PrintedValue:
    """Return a cell of a compared law: its printed gains are used, not searched anew."""
    if column != "H_mean":
        return input_cell(table, row, column, printed)
    scores = [run.values["H"] for run in measure_laws(_SEARCHED_ON[row], [row])[row]]
    place: dict[str, Any] = {"table": table, "row": row, "column": column, "printed": printed}
    measured = sum(scores) / len(scores)
    unjudged = why_not_judged(row, column)
    if unjudged:
        return PrintedValue.beside(
            **place, measured=measured, unit="1", reason=f"{note_of(table, row, column)} {unjudged}"
        )
    return explained(PrintedValue.compared(**place, measured=measured, tolerance=SCORE, unit="1"))


# Section 6.2.4; section C.2 names configurations 1, 2 and 4 for both.
_SEARCHED_ON = {"masoud": ("c1", "c2", "c3"), "ge_cui": ("c1", "c3", "c4")}


def _why_another_gain(runs: GainRuns, index: int) -> str:
    """Return why the own best gain is another one: numbers for the flat optimum."""
    flat = runs.flatness
    low, high = (f"{values[index]:.3g}" for values in (flat.low, flat.high))
    bound = float(runs.search.settings.bounds[index, 1])
    edge = " It lies at the bound of the search." if runs.search.best.gains[index] == bound else ""
    return (
        f"Not judged: the optimum is flat. From {low} to {high} this gain alone costs no more than "
        f"{100.0 * flat.tolerance:g} % of H; the printed gains together reach "
        f"{runs.changed.reference_performance.mean():.4f} here, these {runs.search.best_value:.4f}.{edge}"
    )


# ---- Tables C.2 to C.9 ------------------------------------------------------------------------------


def _distance_cells(table: str, runs: GainRuns, gain: int) -> Iterator[PrintedValue]:
    """Yield the cells of a table of T, L and d in three configurations."""
    for change, row in _by_change(printed_rows(table)).items():
        found = runs.measured(gain, CHANGES_PERCENT.index(change))
        for column, printed in numbers(row):
            quantity, configuration = _straight(column).rsplit("_", 1)
            cell = PrintedValue.compared(
                table=table,
                row=_label(change),
                column=column,
                printed=printed,
                measured=found[int(configuration) - 1].values[quantity],
                tolerance=tolerance_of(quantity),
                unit=UNITS[quantity[0]],
            )
            yield explained(cell)


def _outcome_cells(table: str, runs: GainRuns, gain: int) -> Iterator[PrintedValue]:
    """Yield the cells of the row that a table has in words: the gain at zero."""
    (row,) = (row for row in printed_rows("C.zero") if row["table"] == table)
    for index, run in enumerate(runs.at_zero(gain), start=1):
        printed = row[f"outcome_{index}"]
        cell = PrintedValue.listed(
            table=table, row="-100 %", column=f"outcome_{index}", printed=printed, unit="", reason=""
        )
        within = run.outcome == printed or (printed == "no arrival" and not run.arrived)
        yield explained(replace(cell, measured=run.outcome, within=within))


def _score_cells(table: str, runs: GainRuns, gain: int, parts: dict[float, Row]) -> Iterator[PrintedValue]:
    """Yield the cells of a table of scores and sensitivities."""
    for change, row in _by_change(printed_rows(table)).items():
        index = CHANGES_PERCENT.index(change)
        found = runs.measured(gain, index)
        mean = float(runs.changed.mean_performance[gain, index])
        for column, printed in numbers(row):
            place: dict[str, Any] = {"table": table, "row": _label(change), "column": column, "printed": printed}
            if column == "sensitivity_percent":
                yield _sensitivity_cell(place, change, runs, (gain, index))
            elif column == "H_mean":
                yield explained(PrintedValue.compared(**place, measured=mean, tolerance=SCORE, unit="1"))
            else:
                run = found[int(column[-1]) - 1]
                straight = {_straight(name): value for name, value in parts[change].items()}
                cell = PrintedValue.compared(**place, measured=run.values["H"], tolerance=SCORE, unit="1")
                yield explained(cell, printed_score(run, straight, column[1:]))


def _sensitivity_cell(
    place: dict[str, Any], change_percent: float, runs: GainRuns, at: tuple[int, int]
) -> PrintedValue:
    """Return the magnitude of (C.3.1) to (C.3.4) beside the printed one."""
    if change_percent == 0.0:
        reason = "0/0 at the optimum; the source prints 0 here and a dash in its other tables."
        return PrintedValue.listed(**place, unit="%", reason=reason)
    optimum = float(runs.changed.reference_performance.mean())
    rounding = abs(2.0 * _SCORE_ROUNDING / optimum / (change_percent / 100.0)) * 100.0
    cell = PrintedValue.compared(
        **place,
        measured=100.0 * abs(float(runs.changed.relative_sensitivity[at])),
        tolerance=Tolerance(rounding + _SENSITIVITY_ROUNDING_PERCENT, relative=False),
        unit="%",
    )
    return explained(cell)
