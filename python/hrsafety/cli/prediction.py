"""Prediction of a cell or a program beside measured records: a row of its measurement plan, filled and never tuned."""

from __future__ import annotations

from pathlib import Path

from hrsafety import contact
from hrsafety._keys import parsed
from hrsafety.cli import output
from hrsafety.contact.cell.handover import plan_of
from hrsafety.contact.cell.study import verdicts_of
from hrsafety.contact.plan import LOADS
from hrsafety.errors import InvalidParameterError
from hrsafety.pages.report import ReportTable, Section

__all__ = ["above_prediction", "planned_row", "prediction_section"]


def planned_row(path: str, row: int | None, load: str) -> contact.PlannedMeasurement:
    """Return the row of the measurement plan of a cell or a program that records are about.

    Parameters
    ----------
    path : str
        The file of the cell or the program.
    row : int or None
        Number of the row on its page, from 1; ``None`` for a plan of one row.
    load : {"force", "pressure"}
        Load of the records.

    Returns
    -------
    PlannedMeasurement
        The row.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, or the plan has no such row or one of another load.
    """
    with output.located(path):
        rows = _planned(path)
    if row is None and len(rows) != 1:
        raise InvalidParameterError("--plan-row", f"be given: the plan of {path} has {len(rows)} rows", row)
    number = 1 if row is None else row
    if not 1 <= number <= len(rows):
        raise InvalidParameterError("--plan-row", f"be 1 to {len(rows)}, the rows of the plan of {path}", number)
    chosen = rows[number - 1]
    if chosen.load != load:
        rule = f"be a row of {load}: what governs there is the {chosen.load}"
        raise InvalidParameterError("--plan-row", rule, number)
    return chosen


def _planned(path: str) -> tuple[contact.PlannedMeasurement, ...]:
    """Return the measurement plan of a cell file, or of that of a program."""
    from hrsafety import program

    if "motion" in parsed(Path(path)):
        study = program.load_program(path).report()
        return study.plan.rows if isinstance(study, program.ProgramStudy) else ()
    cell = contact.load_cell(path)
    judged, loads, _ = verdicts_of(cell)
    return plan_of(cell, judged, loads).rows


def prediction_section(plan: contact.MeasurementPlan) -> Section:
    """Return a prediction beside what was measured, as a part of a report.

    Parameters
    ----------
    plan : MeasurementPlan
        Of one row.

    Returns
    -------
    Section
        With its table.
    """
    (row,) = plan.rows
    shown = ["-" if value is None else f"{value:.4g}" for value in (row.prediction, row.limit)]
    largest = max(row.measured)
    share = "-" if not row.prediction else f"{largest / row.prediction:.2f}"
    found = "-" if row.found is None else f"{row.found.expanded_uncertainty:.3g}"
    place = f"{row.region.replace('_', ' ')}, {row.setup}, {row.covering or 'bare'}"
    cells = (place, row.load, shown[0], f"{largest:.4g}", share, found, shown[1], row.accept)
    titles = ("contact", "load", "prediction", "largest measured", "of the prediction", "U", "limit", "accept")
    table = ReportTable(headers=[titles], rows=[cells], left=(0, 1, 7), printed=True)
    words = "The prediction is that of the file as it is: nothing was tuned to the records."
    return Section("Prediction beside the measurement", [words, table])


def above_prediction(plan: contact.MeasurementPlan, path: str) -> tuple[tuple[str, str], ...]:
    """Return the fact that measured loads are above the predicted one by more than their uncertainty, if they are.

    Parameters
    ----------
    plan : MeasurementPlan
        Of one row.
    path : str
        The file of the prediction.

    Returns
    -------
    tuple of (str, str)
        Title and words of the fact, or nothing.
    """
    (row,) = plan.rows
    spread = 0.0 if row.found is None else row.found.expanded_uncertainty
    if row.prediction is None or not max(row.measured) - spread > row.prediction:
        return ()
    largest, predicted = (f"{value:.4g} {LOADS[row.load]}" for value in (max(row.measured), row.prediction))
    words = (
        f"the largest load, {largest}, is above the predicted {predicted}: either the robot was faster than planned, "
        f"or {Path(path).name} takes it for too light or the contact for too soft, and its allowed speeds are too "
        "high; none but the measured one is confirmed"
    )
    return (("prediction", words),)
