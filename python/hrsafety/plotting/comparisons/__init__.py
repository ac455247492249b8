"""Pictures of many runs: laws beside each other, seeds, outcomes."""

from hrsafety.plotting.comparisons.arena import plot_arena_distances, plot_arena_paths, plot_arena_sequence
from hrsafety.plotting.comparisons.repeated import repeated_distances, repeated_paths
from hrsafety.plotting.comparisons.standings import plot_arena_standings
from hrsafety.plotting.comparisons.studies import clearances, outcomes

__all__ = [
    "clearances",
    "outcomes",
    "plot_arena_distances",
    "plot_arena_paths",
    "plot_arena_sequence",
    "plot_arena_standings",
    "repeated_distances",
    "repeated_paths",
]
