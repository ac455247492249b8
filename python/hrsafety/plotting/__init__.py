"""Pictures of results: paths, forces, distances, energies, studies and animations.

Every function takes results of `hrsafety.navigation` or `hrsafety.impact`, computes no physics, and returns a
``matplotlib.figure.Figure`` that needs no display and leaves no trace in ``pyplot``; save it
with ``figure.savefig(path)``. `animate` writes a file and returns its path. Axis labels carry
units. matplotlib is imported when a picture is asked for; without it the functions raise
`MissingExtraError`, which names ``pip install hrsafety[plot]``.
"""

from hrsafety.plotting.animation import animate
from hrsafety.plotting.arena import (
    plot_arena_distances,
    plot_arena_paths,
    plot_arena_sequence,
)
from hrsafety.plotting.boundaries import foam_boundaries, foam_map
from hrsafety.plotting.energies import energy
from hrsafety.plotting.fields import force_field, potential_valley
from hrsafety.plotting.gains import flatness, gain_sensitivity
from hrsafety.plotting.histories import distances, lyapunov
from hrsafety.plotting.impacts import impact_histories, impact_study, measured_impact
from hrsafety.plotting.layouts import layout
from hrsafety.plotting.scenes import paths
from hrsafety.plotting.searches import pareto_front, search_history
from hrsafety.plotting.sequences import time_sequence
from hrsafety.plotting.standings import plot_arena_standings
from hrsafety.plotting.studies import clearances, outcomes
from hrsafety.plotting.style import MissingExtraError
from hrsafety.plotting.sweep_overviews import sweep_parallel, sweep_scatter
from hrsafety.plotting.sweeps import sweep_lines, sweep_map

__all__ = [
    "MissingExtraError",
    "animate",
    "clearances",
    "distances",
    "energy",
    "flatness",
    "foam_boundaries",
    "foam_map",
    "force_field",
    "gain_sensitivity",
    "impact_histories",
    "impact_study",
    "layout",
    "lyapunov",
    "measured_impact",
    "outcomes",
    "pareto_front",
    "paths",
    "plot_arena_distances",
    "plot_arena_paths",
    "plot_arena_sequence",
    "plot_arena_standings",
    "potential_valley",
    "search_history",
    "sweep_lines",
    "sweep_map",
    "sweep_parallel",
    "sweep_scatter",
    "time_sequence",
]
