"""Shares and means with intervals, and paired comparisons of the same runs."""

from hrsafety._statistics import Mean, Paired, Share, compare_paired, mean_interval, wilson

__all__ = ["Mean", "Paired", "Share", "compare_paired", "mean_interval", "wilson"]
