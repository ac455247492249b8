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
from hrsafety.plotting.camera import calibration_errors, velocity_estimates
from hrsafety.plotting.energies import energy
from hrsafety.plotting.fields import force_field, potential_valley
from hrsafety.plotting.follower import follower_rates, follower_runs, impedance_forces
from hrsafety.plotting.follower_movies import animate_follower
from hrsafety.plotting.gains import flatness, gain_sensitivity
from hrsafety.plotting.histories import distances, lyapunov
from hrsafety.plotting.impacts import impact_histories, impact_study, measured_impact
from hrsafety.plotting.layouts import layout
from hrsafety.plotting.repeated import repeated_distances, repeated_paths
from hrsafety.plotting.scenes import paths
from hrsafety.plotting.searches import pareto_front, search_history
from hrsafety.plotting.sequences import time_sequence
from hrsafety.plotting.skirt import skirt_clearances, skirt_ring, skirt_runs, skirt_sensor_counts
from hrsafety.plotting.sound import sound_burst, sound_fixes, sound_likeness
from hrsafety.plotting.standings import plot_arena_standings
from hrsafety.plotting.studies import clearances, outcomes
from hrsafety.plotting.style import MissingExtraError
from hrsafety.plotting.sweep_overviews import sweep_parallel, sweep_scatter
from hrsafety.plotting.sweeps import sweep_lines, sweep_map
from hrsafety.plotting.tracking import tracking_errors, tracking_paths
from hrsafety.plotting.wheels import wheel_identification, wheel_tracking

__all__ = [
    "MissingExtraError",
    "animate",
    "animate_follower",
    "calibration_errors",
    "clearances",
    "distances",
    "energy",
    "flatness",
    "foam_boundaries",
    "foam_map",
    "follower_rates",
    "follower_runs",
    "force_field",
    "gain_sensitivity",
    "impact_histories",
    "impact_study",
    "impedance_forces",
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
    "repeated_distances",
    "repeated_paths",
    "search_history",
    "skirt_clearances",
    "skirt_ring",
    "skirt_runs",
    "skirt_sensor_counts",
    "sound_burst",
    "sound_fixes",
    "sound_likeness",
    "sweep_lines",
    "sweep_map",
    "sweep_parallel",
    "sweep_scatter",
    "time_sequence",
    "tracking_errors",
    "tracking_paths",
    "velocity_estimates",
    "wheel_identification",
    "wheel_tracking",
]
