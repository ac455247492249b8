"""Metrics of runs that gains are searched and judged by."""

from __future__ import annotations

from typing import Literal

from hrsafety._arguments import Array, word
from hrsafety.navigation.tables.runs import RunTable

__all__ = ["METRICS", "METRIC_UNITS", "Metric", "check_metric", "is_maximized", "metric_values"]

Metric = Literal[
    "performance",
    "performance_arrival_time",
    "performance_avoidance",
    "performance_energy_saving",
    "arrival_time",
    "energy",
    "path_length",
    "min_clearance",
]

# Column of a batch, and whether large values are good.
METRICS: dict[str, tuple[str, bool]] = {
    "performance": ("performance_total", True),
    "performance_arrival_time": ("performance_arrival_time", True),
    "performance_avoidance": ("performance_avoidance", True),
    "performance_energy_saving": ("performance_energy_saving", True),
    "arrival_time": ("arrival_time", False),
    "energy": ("energy", False),
    "path_length": ("path_length", False),
    "min_clearance": ("min_clearance", True),
}

METRIC_UNITS = {"arrival_time": "s", "energy": "J", "path_length": "m", "min_clearance": "m"}
"""Units of the metrics that have one."""


def check_metric(name: str, value: object) -> str:
    """Return the name of a metric, or list them all."""
    return word(name, value, tuple(METRICS))


def is_maximized(metric: str) -> bool:
    """Return whether large values of a metric are good."""
    return METRICS[metric][1]


def metric_values(table: RunTable, metric: str) -> Array:
    """Return a metric of every row of a batch, in its own unit."""
    values: Array = getattr(table, METRICS[metric][0])
    return values
