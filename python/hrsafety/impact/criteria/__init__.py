"""Criteria of an impact: head injury, moving averages, filters of measured signals."""

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
