"""Names of rows and columns of the published tables as a reader knows them."""

from __future__ import annotations

import re

__all__ = ["GAIN_LABELS", "TABLE_TITLES", "column_label", "row_label"]

GAIN_LABELS = {"new_vff": "New VFF", "new_vff_optimised": "New VFF*"}
"""Gain sets; the star marks the optimized ones, as in the source."""

TABLE_TITLES = {
    "3.1": "manipulators",
    "3.2": "heads and necks of the four simulations",
    "3.3": "foams",
    "Section 3.6": "head and neck",
    "Section 3.7": "manipulator, foam, impact point",
    "Section 3.8": "acceleration and deceleration",
    "Section 3.9": "which foams fit",
    "4.1": "Direct-drive manipulator",
    "4.2": "Puma 560",
    "Section 4.3": "experiments with the direct drive",
    "Section 4.4": "experiments with the Puma 560",
    "Section 4.5": "conclusions of chapter 4",
    "Section A.1": "foam tests",
    "Section A.2": "direct-drive arm",
    "Section A.3": "pneumatic cylinder",
    "A.1": "Open-loop tests of the direct drive",
    "Section 2.2.5": "the collinear condition",
    "Section 5.7": "a person nobody can predict",
    "Section 6.4.1": "the path beside a disc",
    "Section 6.4.2": "a person who comes the other way",
    "Section 6.4.5": "a person who walks parallel to the way",
    "5.1": "A person who stops and turns",
    "6.1": "Gains",
    "6.2": "Configuration 1, a disc",
    "6.3": "Configuration 2, a person",
    "6.4": "Configuration 3, a disc and a rectangle",
    "6.5": "Configuration 4, a person, a disc and a rectangle",
    "7.1": "Configuration 1, a disc",
    "7.2": "Configuration 2, a person",
    "7.3": "Configuration 3, a disc and a rectangle",
    "7.4": "Configuration 4, a person, a disc and a rectangle",
    "Section 7.5.5": "a person, a disc and another robot at once",
    "Section C.2": "the search for the best gains",
    "Section C.3": "sensitivities and trends of the text",
    "C.1": "Optimized gains",
    "C.2": "Change of K<sub>1</sub>: time, energy, distance",
    "C.3": "Change of K<sub>1</sub>: score and sensitivity",
    "C.4": "Change of K<sub>3</sub>: time, energy, distance",
    "C.5": "Change of K<sub>3</sub>: score and sensitivity",
    "C.6": "Change of K<sub>5</sub>: time, energy, distance",
    "C.7": "Change of K<sub>5</sub>: score and sensitivity",
    "C.8": "Change of b: time, energy, distance",
    "C.9": "Change of b: score and sensitivity",
    "D.1": "Holonomic robot: wheel models",
    "D.2": "Holonomic robot: wheel controllers",
    "Section D.4": "camera calibration and position errors",
    "E.1": "Differential-drive robot: wheel models",
    "E.2": "Differential-drive robot: wheel controllers",
    "Section D.2": "identification, holonomic robot",
    "Section D.3": "observer and wheel period, holonomic robot",
    "Section E.2": "identification, differential-drive robot",
    "Section E.3": "observer and wheel period, differential-drive robot",
}
"""What each published table is about, in HTML."""

_ROWS = GAIN_LABELS | {
    "masoud": "Masoud*",
    "ge_cui": "Ge & Cui*",
    "new_vff_experiment": "New VFF, experiment",
    "holonomic": "Holonomic",
    "nonholonomic": "Nonholonomic",
    "nonholonomic_experiment": "Nonholonomic, experiment",
}
_COLUMNS = {
    "T_arrive": "T",
    "L_energy": "L",
    "d_min": "d to person",
    "d_human_min": "d to person",
    "d_circle_min": "d to disc",
    "d_rectangle_min": "d to rectangle",
    "H_mean": "H mean",
    "sensitivity_percent": "Sensitivity",
    "outcome": "Outcome",
}


def row_label(row: str) -> str:
    """Return the name of a row."""
    return _ROWS.get(row, row)


def column_label(column: str, unit: str = "") -> str:
    """Return the name of a column, with its unit if it has one."""
    match = re.fullmatch(r"((?:T|L|d|outcome).*?)_([123])", column)
    stem, where = (match[1], f", c{match[2]}") if match else (column, "")
    name = _COLUMNS.get(stem) or re.sub(r"_(\d|max|[a-z]{1,2}(?:,max)?)\b", r"<sub>\1</sub>", stem)
    name = re.sub(r"\beps(?=<)", "&epsilon;", name) + where
    return f"{name} ({unit})" if unit not in {"", "1"} else name
