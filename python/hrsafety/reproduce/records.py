"""All values of the page as CSV and JSON."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, fields
from typing import Any

from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.laws.study import LawsStudy, rows
from hrsafety.reproduce.study import Aggregate, LawComparisons

__all__ = ["cells_csv", "cells_json", "laws_csv", "laws_json", "study_csv", "study_json"]


def cells_csv(cells: Sequence[PrintedValue]) -> str:
    """Return cells as CSV, one line each; ``deviation`` is a share of printed if ``relative``."""
    return _csv([entry.name for entry in fields(PrintedValue)], [asdict(cell) for cell in cells])


def cells_json(cells: Sequence[PrintedValue]) -> str:
    """Return cells as a JSON list of objects."""
    return json.dumps([asdict(cell) for cell in cells], indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def laws_csv(study: LawsStudy) -> str:
    """Return every law with the unpredictable person as CSV."""
    table = rows(study)
    return _csv(list(table[0]), table)


def laws_json(study: LawsStudy) -> str:
    """Return every law with the unpredictable person as a JSON list of objects."""
    return json.dumps(rows(study), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def study_csv(study: LawComparisons) -> str:
    """Return the comparison of the stabilizing modes as CSV."""
    rows = [_flat(aggregate) for aggregate in study.aggregates]
    return _csv(list(rows[0]), rows)


def study_json(study: LawComparisons) -> str:
    """Return the comparison of the stabilizing modes and the recommended mode as JSON."""
    content = {
        "recommended": study.recommended,
        "rankings": [asdict(ranking) for ranking in study.rankings],
        "aggregates": [_flat(aggregate) for aggregate in study.aggregates],
    }
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _flat(aggregate: Aggregate) -> dict[str, Any]:
    """Return an aggregate as one level of columns with units; unknown numbers are None."""
    row: dict[str, Any] = aggregate.key._asdict()
    row["runs"] = aggregate.arrivals.runs
    for name in ("contacts_moving", "contacts_standing", "contacts", "arrivals"):
        share = getattr(aggregate, name)
        row |= {name: share.count, f"{name}_share": share.value}
        row |= {f"{name}_share_low": share.low, f"{name}_share_high": share.high}
    row |= {
        "median_arrival_time_s": aggregate.median_arrival_time,
        "mean_score": aggregate.mean_score,
        "clearance_5_percent_m": aggregate.clearance_low,
        "clearance_median_m": aggregate.clearance_median,
        "descent_share": aggregate.descent_share,
        "min_distances_m": " ".join(f"{distance:.4f}" for distance in aggregate.min_distances),
        "contact_here_only": aggregate.against_off.only_first,
        "contact_off_only": aggregate.against_off.only_second,
        "paired_p_value": aggregate.against_off.p_value,
    }
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in row.items()
    }


def _csv(header: Sequence[str], rows: Sequence[dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, header, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()
