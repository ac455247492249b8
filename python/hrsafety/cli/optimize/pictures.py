"""Pictures of ``hrsafety optimize``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from hrsafety.cli.optimize.report import METRIC_UNITS, MOST_PATHS, GainReport
from hrsafety.navigation.gains.metrics import is_maximized

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Picture", "make"]


class Picture(NamedTuple):
    """A picture with the sentence below it.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The picture.
    caption : str
        What it shows.
    """

    figure: Figure
    caption: str


def make(report: GainReport) -> Iterator[tuple[str, Picture]]:
    """Draw every picture of the page.

    Parameters
    ----------
    report : GainReport
        What was found.

    Yields
    ------
    (str, Picture)
        File name without ending, and the picture.
    """
    from hrsafety import plotting

    yield from _paths(report)
    quantity = _quantity(report.objective)
    marks = {entry.name: (entry.law.gains, _signed(report, entry.value)) for entry in report.sets[1:]}
    yield (
        "flatness",
        Picture(
            plotting.flatness(report.flatness, marks=marks, quantity=quantity),
            "The objective along each gain, the others as in the best set; dashed: the range that is as good",
        ),
    )
    yield (
        "sensitivity",
        Picture(
            plotting.gain_sensitivity(report.sensitivity),
            "Mean H and its relative sensitivity when one gain of the best set changes, beyond the bounds too",
        ),
    )
    yield (
        "history",
        Picture(plotting.search_history(report.search, quantity=quantity), "How the search closed in"),
    )
    if report.front is not None and len(report.front):
        yield (
            "front",
            Picture(plotting.pareto_front(report.front), "Gain sets that no other one beats in every objective"),
        )


def _paths(report: GainReport) -> Iterator[tuple[str, Picture]]:
    """Draw the paths through each scenario: the best gains and those to compare with."""
    from hrsafety import plotting

    labels = [entry.name for entry in report.sets]
    for index, name in enumerate(report.study.names[:MOST_PATHS]):
        runs = [entry.runs[index] for entry in report.sets]
        figure = plotting.paths(runs, labels=labels, title=name)
        yield f"paths-{name}", Picture(figure, f"Paths through {name}: {', '.join(labels)}")


def _quantity(objective: str) -> str:
    """Return the axis label of an objective as it is maximized."""
    words = "mean H" if objective == "performance" else objective.replace("_", " ")
    unit = f" ({METRIC_UNITS[objective]})" if METRIC_UNITS[objective] else ""
    return f"{words}{unit}" if is_maximized(objective) else f"minus {words}{unit}"


def _signed(report: GainReport, value: float) -> float:
    return value if is_maximized(report.objective) else -value
