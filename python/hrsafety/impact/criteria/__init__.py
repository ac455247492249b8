"""Criteria of an impact: head injury, moving averages, filters of measured signals."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.impact.criteria.filters import CHANNEL_CLASSES, channel_corner, channel_filter
    from hrsafety.impact.criteria.loads import (
        HeadInjury,
        ImpactMetrics,
        MovingLevel,
        average_3ms,
        clip_3ms,
        hic,
        hic_of_pulse,
        metrics,
    )
    from hrsafety.impact.criteria.recorded import recorded_metrics

__all__ = [
    "CHANNEL_CLASSES",
    "HeadInjury",
    "ImpactMetrics",
    "MovingLevel",
    "average_3ms",
    "channel_corner",
    "channel_filter",
    "clip_3ms",
    "hic",
    "hic_of_pulse",
    "metrics",
    "recorded_metrics",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.impact.criteria.filters": "CHANNEL_CLASSES channel_corner channel_filter",
            "hrsafety.impact.criteria.loads": (
                "HeadInjury ImpactMetrics MovingLevel average_3ms clip_3ms hic hic_of_pulse metrics"
            ),
            "hrsafety.impact.criteria.recorded": "recorded_metrics",
        },
    )
