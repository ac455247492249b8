"""Pictures of many runs: laws beside each other, seeds, outcomes."""

from hrsafety.plotting.comparisons.law_runs import comparison_distances, comparison_paths, comparison_sequence
from hrsafety.plotting.comparisons.repeated import repeated_distances, repeated_paths
from hrsafety.plotting.comparisons.standings import comparison_standings
from hrsafety.plotting.comparisons.studies import clearances, outcomes

__all__ = [
    "clearances",
    "comparison_distances",
    "comparison_paths",
    "comparison_sequence",
    "comparison_standings",
    "outcomes",
    "repeated_distances",
    "repeated_paths",
]
