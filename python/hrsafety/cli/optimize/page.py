"""The summary page of ``hrsafety optimize``."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from hrsafety import navigation as nav
from hrsafety.cli.optimize import record as optimize_record
from hrsafety.cli.optimize.report import (
    METRIC_UNITS,
    MOST_PATHS,
    NOT_EVERYWHERE,
    GainReport,
    Table,
    confidence_words,
    gain_words,
    scenario_table,
    scenario_words,
    search_words,
    set_table,
)
from hrsafety.pages import Picture, written

__all__ = ["html"]

GAIN_TITLES = ("K_1 (N/m)", "K_3 (N/m)", "K_5 (N/m^2)", "b (s)")
MOST_ROWS = 20  # scenarios that are listed unfolded
Rows = list[tuple[str, ...]]


def html(report: GainReport, pictures: Mapping[str, Picture], warned: Sequence[str] = ()) -> str:
    """Return the page.

    Parameters
    ----------
    report : GainReport
        What was found.
    pictures : mapping of str to Picture
        By name.
    warned : sequence of str
        Warnings of scenarios and search.

    Returns
    -------
    str
        A complete HTML document.
    """
    search, study, front = report.search, report.study, report.front
    scenario_titles, scenario_rows = _titled(scenario_table(report))
    return written(
        "optimize.html",
        title=study.title,
        warned=warned,
        report=report,
        search=search,
        scenarios=scenario_words(study),
        search_words=search_words(search),
        gains=gain_words(report.sets[0].law.gains),
        reached=_reached(report),
        not_everywhere=NOT_EVERYWHERE,
        sets=_titled(set_table(report)),
        scenario_titles=scenario_titles,
        scenario_rows=scenario_rows,
        most_rows=MOST_ROWS,
        noisy=any(scenario.measurement is not None for scenario in study.scenarios),
        paths=[pictures[f"paths-{name}"] for name in study.names[:MOST_PATHS]],
        pictures={name: pictures.get(name) for name in ("flatness", "sensitivity", "history", "front")},
        flatness=report.flatness,
        flat_rows=_flat_rows(report),
        gain_titles=GAIN_TITLES,
        history_rows=_history_rows(search),
        local_rows=_local_rows(search),
        front=front,
        front_names="" if front is None else " and ".join(name.replace("_", " ") for name in front.objectives),
        front_titles=() if front is None else _front_titles(front),
        front_rows=[] if front is None else _front_rows(front),
        settings=[
            (name.replace("_", " "), _shown(value))
            for name, value in optimize_record.settings(study, search.settings).items()
        ],
        files=[
            "results.json with every value",
            *(["front.csv"] if front is not None else []),
            *(f"{name}.png" for name in pictures),
        ],
    )


def _titled(table: Table) -> tuple[list[str], Rows]:
    """Return a table with the units in the titles."""
    (names, units), rows = table
    return [f"{name} ({unit})" if unit else name for name, unit in zip(names, units, strict=True)], rows


def _reached(report: GainReport) -> str:
    unit = f" {METRIC_UNITS[report.objective]}".rstrip()
    value = f"{report.sets[0].value:.5f}{unit}"
    return f"{report.objective.replace('_', ' ')} {value}{confidence_words(report.search)}"


def _flat_rows(report: GainReport) -> Rows:
    """Return each gain with the range that is as good, its bounds and its sensitivity."""
    found, bounds = report.flatness, report.search.settings.bounds
    average, largest = report.sensitivity.average_sensitivity(), report.sensitivity.largest_sensitivity()
    return [
        (
            title,
            f"{found.best_gains[index]:.4g}",
            f"{found.low[index]:.4g} to {found.high[index]:.4g}",
            f"{bounds[index, 0]:g} to {bounds[index, 1]:g}",
            *(_percent(float(values[index])) for values in (average, largest)),
        )
        for index, title in enumerate(GAIN_TITLES)
    ]


def _history_rows(search: nav.GainSearch) -> Rows:
    return [
        (
            str(index),
            f"{entry.evaluations:,}",
            f"{entry.failures:,}",
            f"{entry.best_value:.5f}",
            f"{entry.worst_survivor:.5f}",
            *(f"{axis[0]:.4g} to {axis[-1]:.4g}" for axis in entry.axes),
        )
        for index, entry in enumerate(search.history, start=1)
    ]


def _local_rows(search: nav.GainSearch) -> Rows:
    return [
        (
            str(index),
            f"{entry.start_value:.5f}",
            f"{entry.value:.5f}",
            *(f"{gain:.4g}" for gain in entry.gains),
            f"{entry.evaluations:,}",
            entry.status.replace("_", " "),
        )
        for index, entry in enumerate(search.local, start=1)
    ]


def _front_titles(front: nav.gains.ParetoFront) -> tuple[str, ...]:
    return (*GAIN_TITLES, *(f"{name} ({METRIC_UNITS[name]})".replace(" ()", "") for name in front.objectives))


def _front_rows(front: nav.gains.ParetoFront) -> Rows:
    return [
        (*(f"{gain:.4g}" for gain in gains), *(f"{value:.4f}" for value in values))
        for gains, values in zip(front.gains, front.values, strict=True)
    ]


def _percent(share: float) -> str:
    return f"{100.0 * share:.2f}" if math.isfinite(share) else "none"


def _shown(value: object) -> str:
    """Return a setting in words."""
    if value is None:
        return "none"
    if isinstance(value, dict):
        return "; ".join(f"{name} {_shown(entry)}" for name, entry in value.items())
    if hasattr(value, "tolist"):
        return _shown(value.tolist())
    if isinstance(value, (list, tuple)):
        return ", ".join(_shown(entry) for entry in value) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
