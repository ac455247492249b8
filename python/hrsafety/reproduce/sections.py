"""Sections of the page: their tables with their pictures, and what their templates need besides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain.deviations import deviations
from hrsafety.reproduce.impact.cases import parameter_sets
from hrsafety.reproduce.impact.tables import COLUMNS, ImpactRow, experiments
from hrsafety.reproduce.laws.compared import COMPARED, FORCES, LIKE_SOURCE
from hrsafety.reproduce.laws.study import LawsStudy, compared_contacts
from hrsafety.reproduce.names import GAIN_LABELS, beside_none, column_label
from hrsafety.reproduce.parts import PARTS, Made, ReproducedPart
from hrsafety.reproduce.ranking import BASELINE
from hrsafety.reproduce.study import SIDES, Aggregate, LawComparisons
from hrsafety.reproduce.views import by_table, counted, view

__all__ = ["section_of", "shown_parts"]

# Order of the sections of the page.
_ORDER = (
    *("impact", "tables-6", "tables-7", "table-5.1", "laws", "tables-c"),
    *("reactive", "stabilizing", "wheels", "camera", "figures-6", "figures-7"),
)
_DIGITS = {"a_h_max": 3, "impact_period": 4, "compression_max": 5}


def shown_parts(made: Mapping[str, Made], cells: Sequence[PrintedValue]) -> list[ReproducedPart]:
    """Return the parts that have a section, in the order of the page."""
    tables = list(by_table(cells))
    return [
        PARTS[name]
        for name in _ORDER
        if name in made and (made[name].cells or made[name].study or beside_none(tables, made[name].pictures))
    ]


def section_of(part: ReproducedPart, made: Mapping[str, Made], cells: Sequence[PrintedValue]) -> dict[str, Any]:
    """Return what the template of a section shows."""
    own = made[part.name]
    pictures = [picture for name, each in made.items() if PARTS[name].placed for picture in each.pictures]
    groups = by_table(own.cells)
    section: dict[str, Any] = {
        "part": part,
        "tables": [view(table, groups[table], pictures) for table in dict.fromkeys((*part.tables, *groups))],
        "total": counted(own.cells),
        "pictures": beside_none(list(by_table(cells)), own.pictures),
        "study": own.study,
    }
    return section | (_MORE[part.name](own) if part.name in _MORE else {})


# ---- impact -----------------------------------------------------------------------------------------


def _impact(made: Made) -> dict[str, Any]:
    places = {(cell.row, cell.column): cell for cell in made.cells}
    rows: dict[str, list[dict[str, Any]]] = {}
    for row in experiments():
        rows.setdefault(row.table, []).append(_experiment(row, places))
    return {"sets": parameter_sets(), "experiments": rows}


def _experiment(row: ImpactRow, places: Mapping[tuple[str, str], PrintedValue]) -> dict[str, Any]:
    """Return one row of Table 4.1 or 4.2: runs, printed simulation and own values."""
    lines, reasons = [], []
    for column, (name, unit) in COLUMNS.items():
        own = [places[row.name, f"{name}, set {choice.name}"] for choice in parameter_sets()]
        reasons += [cell.reason for cell in own if cell.reason]
        value = row.simulated["A"][column]
        lines.append(
            {
                "label": column_label(name, unit),
                "runs": " / ".join(f"{run:g}" for run in row.measured[column]),
                "printed": f"{row.printed[column]:g}",
                "sets": [(f"{cell.measured:.{_DIGITS[column]}f}", cell.within) for cell in own],
                "from_printed": 100.0 * (value / row.printed[column] - 1.0),
                "from_runs": 100.0 * (value / row.mean(column) - 1.0),
            }
        )
    return {"name": row.name, "lines": lines, "reason": " ".join(dict.fromkeys(reasons))}


# ---- appendix C and compared laws -------------------------------------------------------------------


def _gains(made: Made) -> dict[str, Any]:
    return {
        "deviations": [
            (*row[:3], f"{row.mean:+.1f}", f"{row.worst:.1f}", f"{row.second_worst:.1f}")
            for row in deviations(made.cells)
        ]
    }


def _laws(made: Made) -> dict[str, Any]:
    study: LawsStudy = made.study
    touching = [COMPARED[name].label for name in COMPARED if np.isfinite(study.printed[name].contact_time[0])]
    clean = [COMPARED[name].label for name in COMPARED if not study.varied[name].contact.any()]
    return {
        "pictures": made.pictures,
        "forces": FORCES,
        "walks": len(study.varied["new_vff"].contact),
        "encounters": [_encounter(study, name) for name in {**COMPARED, **LIKE_SOURCE}],
        "touching": ", ".join(touching) or "no law",
        "clean": ", ".join(clean) or "none",
    }


def _encounter(study: LawsStudy, name: str) -> dict[str, Any]:
    many = study.varied[name]
    return {
        "label": {**COMPARED, **LIKE_SOURCE}[name].label,
        "run": study.printed[name],
        "many": many,
        "first_contact": float(np.median(many.contact_time[many.contact])) if many.contact.any() else float("nan"),
        "median": float(np.median(many.least_distance)),
        "paired": compared_contacts(study, name) if name != "new_vff" else None,
    }


# ---- stabilizing force ------------------------------------------------------------------------------


def _stabilizing(made: Made) -> dict[str, Any]:
    study: LawComparisons = made.study
    sides = [(side, _groups([entry for entry in study.aggregates if entry.key.side == side])) for side in SIDES]
    return {"pictures": made.pictures, "gain_labels": GAIN_LABELS, "baseline": BASELINE, "sides": sides}


def _groups(entries: Sequence[Aggregate]) -> list[dict[str, Any]]:
    """Return one group for the single runs and one for each experiment with many runs."""
    single = [entry for entry in entries if entry.arrivals.runs == 1]
    groups: list[dict[str, Any]] = [{"single": True, "entries": single}] if single else []
    for experiment in dict.fromkeys(entry.key.experiment for entry in entries if entry.arrivals.runs > 1):
        title = experiment.replace("crowds", "Crowds").replace("+-", "±")
        own = [entry for entry in entries if entry.key.experiment == experiment]
        groups.append({"single": False, "title": title, "entries": own})
    return groups


_MORE: Mapping[str, Callable[[Made], dict[str, Any]]] = {
    "impact": _impact,
    "tables-c": _gains,
    "laws": _laws,
    "stabilizing": _stabilizing,
}
