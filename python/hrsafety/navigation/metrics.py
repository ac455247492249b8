"""Scores and statistics of runs: performance, shares and means with intervals, paired differences."""

from hrsafety._statistics import Mean, Paired, Share, compare_paired, mean_interval, wilson
from hrsafety.navigation.bands import Band
from hrsafety.navigation.compare import Comparison, Standing, step_cost
from hrsafety.navigation.performance import Performance
from hrsafety.navigation.pursuits import Falsification, Pursuit, falsify

__all__ = [
    "Band",
    "Comparison",
    "Falsification",
    "Mean",
    "Paired",
    "Performance",
    "Pursuit",
    "Share",
    "Standing",
    "compare_paired",
    "falsify",
    "mean_interval",
    "step_cost",
    "wilson",
]
