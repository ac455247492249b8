"""Pictures of ``hrsafety optimize``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from hrsafety.cli.optimize.found import METRIC_UNITS, MOST_PATHS, FoundGains
from hrsafety.navigation.gains.metrics import is_maximized

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["make"]


def make(found: FoundGains) -> Iterator[tuple[str, Figure, str]]:
    """Draw every picture of the page.

    Parameters
    ----------
    found : FoundGains
        What was found.

    Yields
    ------
    (str, Figure, str)
        File name without ending, picture and caption.
    """
    from hrsafety import plotting

    yield from _paths(found)
    quantity = _quantity(found.objective)
    marks = {entry.name: (entry.law.gains, _signed(found, entry.value)) for entry in found.sets[1:]}
    words = "The objective along each gain, the others as in the best set; dashed: the range that is as good."
    yield "flatness", plotting.flatness(found.flatness, marks=marks, quantity=quantity), words
    words = "Mean H and its relative sensitivity when one gain of the best set changes, beyond the bounds too."
    yield "sensitivity", plotting.gain_sensitivity(found.sensitivity), words
    yield "history", plotting.search_history(found.search, quantity=quantity), "How the search closed in."
    if found.front is not None and len(found.front):
        figure = plotting.pareto_front(found.front)
        yield "front", figure, "Gain sets that no other one beats in every objective."


def _paths(found: FoundGains) -> Iterator[tuple[str, Figure, str]]:
    """Draw the paths through each scenario: the best gains and those to compare with."""
    from hrsafety import plotting

    labels = [entry.name for entry in found.sets]
    for index, name in enumerate(found.study.names[:MOST_PATHS]):
        runs = [entry.runs[index] for entry in found.sets]
        figure = plotting.paths(runs, labels=labels, title=name)
        yield f"paths-{name}", figure, f"Paths through {name}: {', '.join(labels)}."


def _quantity(objective: str) -> str:
    """Return the axis label of an objective as it is maximized."""
    words = "mean H" if objective == "performance" else objective.replace("_", " ")
    unit = f" ({METRIC_UNITS[objective]})" if METRIC_UNITS[objective] else ""
    return f"{words}{unit}" if is_maximized(objective) else f"minus {words}{unit}"


def _signed(found: FoundGains, value: float) -> float:
    return value if is_maximized(found.objective) else -value
