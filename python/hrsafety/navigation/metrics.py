"""Scores and statistics of runs: performance, shares and means with intervals, paired differences."""

from hrsafety._statistics import Mean, Paired, Share, compare_paired, mean_interval, wilson
from hrsafety.navigation.arena import Standing, step_cost
from hrsafety.navigation.performance import Performance
from hrsafety.navigation.repeated import Band, Repeated, repeat

__all__ = [
    "Band",
    "Mean",
    "Paired",
    "Performance",
    "Repeated",
    "Share",
    "Standing",
    "compare_paired",
    "mean_interval",
    "repeat",
    "step_cost",
    "wilson",
]
