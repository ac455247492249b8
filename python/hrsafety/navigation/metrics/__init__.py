"""Scores and statistics of runs: social metrics, performance, shares and means with intervals, paired differences."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety._statistics import Mean, Paired, Share, compare_paired, mean_interval, wilson
    from hrsafety.navigation.bands import Band
    from hrsafety.navigation.comparison import Comparison, Standing, step_cost
    from hrsafety.navigation.metrics.declared import METRICS, WORLD_METRICS, Metric
    from hrsafety.navigation.metrics.episode import Episode
    from hrsafety.navigation.metrics.scores import (
        EpisodeMetrics,
        MetricTable,
        WorldMetrics,
        evaluate,
        evaluate_many,
        evaluate_world,
    )
    from hrsafety.navigation.performance import Performance
    from hrsafety.navigation.pursuits import Falsification, Pursuit, falsify
    from hrsafety.navigation.safety_record import SafetyDecision, SafetyRecord, record_safety

__all__ = [
    "METRICS",
    "WORLD_METRICS",
    "Band",
    "Comparison",
    "Episode",
    "EpisodeMetrics",
    "Falsification",
    "Mean",
    "Metric",
    "MetricTable",
    "Paired",
    "Performance",
    "Pursuit",
    "SafetyDecision",
    "SafetyRecord",
    "Share",
    "Standing",
    "WorldMetrics",
    "compare_paired",
    "evaluate",
    "evaluate_many",
    "evaluate_world",
    "falsify",
    "mean_interval",
    "record_safety",
    "step_cost",
    "wilson",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety._statistics": "Mean Paired Share compare_paired mean_interval wilson",
            "hrsafety.navigation.bands": "Band",
            "hrsafety.navigation.comparison": "Comparison Standing step_cost",
            "hrsafety.navigation.metrics.declared": "METRICS WORLD_METRICS Metric",
            "hrsafety.navigation.metrics.episode": "Episode",
            "hrsafety.navigation.metrics.scores": (
                "EpisodeMetrics MetricTable WorldMetrics evaluate evaluate_many evaluate_world"
            ),
            "hrsafety.navigation.performance": "Performance",
            "hrsafety.navigation.pursuits": "Falsification Pursuit falsify",
            "hrsafety.navigation.safety_record": "SafetyDecision SafetyRecord record_safety",
        },
    )
