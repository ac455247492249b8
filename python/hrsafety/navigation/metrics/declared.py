"""The social metrics: one list, from which rows, columns, units and documentation follow."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Generic, Literal, NamedTuple, TypeVar

from hrsafety import _hrsafety
from hrsafety._display import displayed

__all__ = ["METRICS", "OF_GOAL", "WORLD_METRICS", "Measured", "MeasuredWorld", "Metric", "with_metrics"]

N = TypeVar("N")
K = TypeVar("K")
F = TypeVar("F")
C = TypeVar("C", bound=type)


@displayed
class Metric(NamedTuple):
    """Declaration of a metric.

    Attributes
    ----------
    name : str
        Its name, in files too.
    kind : {"number", "count", "flag"}
        What it is counted in.
    unit : str
        Its unit; empty without one.
    meaning : str
        What it is, in words.
    """

    name: str
    kind: Literal["number", "count", "flag"]
    unit: str
    meaning: str


_ROBOT, _WORLD = ({row[0]: Metric._make(row) for row in rows} for rows in _hrsafety.crowd_metric_names())
METRICS: Mapping[str, Metric] = MappingProxyType(_ROBOT)
"""Declaration of each metric of a robot by the native core, in the order of tables."""
WORLD_METRICS: Mapping[str, Metric] = MappingProxyType(_WORLD)
"""Declaration of each metric of a world by the native core."""

OF_GOAL = (
    *("arrived", "arrival_time", "final_goal_distance", "success", "path_length_ratio", "spl"),
    *("longest_without_progress", "frozen", "path_irregularity", "efficacy"),
)
"""Metrics that say nothing without a goal."""


class Measured(Generic[N, K, F]):
    """A value for each of `METRICS`, for type checkers: names cannot come from a module that is compiled."""

    arrived: F
    arrival_time: N
    final_goal_distance: N
    success: F
    path_length: N
    path_length_ratio: N
    spl: N
    path_irregularity: N
    heading_change: N
    mean_speed: N
    max_speed: N
    efficacy: N
    mean_acceleration: N
    max_acceleration: N
    mean_jerk: N
    stalled_time: N
    longest_without_progress: N
    frozen: F
    min_clearance: N
    mean_clearance: N
    wall_clearance: N
    intimate_share: N
    personal_share: N
    social_share: N
    comfort_share: N
    discomfort_time: N
    min_time_to_collision: N
    low_time_to_collision_share: N
    robot_on_person: K
    person_on_robot: K
    mutual_contacts: K
    max_closing_speed: N
    wall_contacts: K
    group_intrusion_share: N
    force_on_people: N
    force_on_robot: N
    social_work: N
    person_delay: N
    person_detour: N
    people_blocked: K
    person_deviation: N


class MeasuredWorld(Generic[N, K]):
    """A value for each of `WORLD_METRICS`, for type checkers."""

    throughput: N
    deadlocked_share: N
    mean_person_speed: N
    aggregated_time: N
    robot_contacts: K


def with_metrics(metrics: Mapping[str, Metric], suffix: str = "") -> Callable[[C], C]:
    """Put the metrics, as attributes of a type, where ``{metrics}`` stands in the docstring of a class."""
    kinds = {"number": "float", "count": "int", "flag": "bool"}
    if suffix:
        kinds = {kind: f"ndarray of {word}{suffix}" for kind, word in kinds.items()}
    entries = [f"    {each.name} : {kinds[each.kind]}\n        {_sentence(each)}" for each in metrics.values()]

    def fill(owner: C) -> C:
        owner.UNITS = {name: each.unit for name, each in metrics.items()}  # type: ignore[attr-defined]  # read by _display
        # Without docstrings, as under python -OO, there is nothing to fill.
        if owner.__doc__:
            owner.__doc__ = owner.__doc__.replace("    {metrics}", "\n".join(entries))
        return owner

    return fill


def _sentence(metric: Metric) -> str:
    unit = f", in {metric.unit}" if metric.unit else ""
    meaning, semicolon, rest = metric.meaning.partition(";")
    return f"{meaning[0].upper()}{meaning[1:]}{unit}{semicolon}{rest}."
