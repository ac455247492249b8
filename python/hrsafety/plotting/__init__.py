"""Pictures of results: paths, forces, distances, energies, studies and animations.

Every function takes results of `hrsafety.navigation`, `.impact`, `.contact`, `.standards` or `.arms`, computes no
physics, and returns a ``matplotlib.figure.Figure`` that needs no display and leaves no trace in ``pyplot``; save it
with ``figure.savefig(path)``. `animate` writes a file and returns its path. Axis labels carry
units. matplotlib is imported when a picture is asked for; without it the functions raise
`MissingExtraError`, which names ``pip install matplotlib``.
"""

from types import ModuleType
from typing import TYPE_CHECKING

from hrsafety._namespace import names_of
from hrsafety.plotting import arms, comparisons, contacts, crowds, gains, impacts, reactive, robots, runs, sweeps
from hrsafety.plotting.arms.ellipses import mass_ellipse
from hrsafety.plotting.comparisons.law_runs import comparison_distances, comparison_paths, comparison_sequence
from hrsafety.plotting.comparisons.repeated import repeated_distances, repeated_paths
from hrsafety.plotting.comparisons.standings import comparison_standings
from hrsafety.plotting.comparisons.studies import clearances, outcomes
from hrsafety.plotting.gains.searches import pareto_front, search_history
from hrsafety.plotting.gains.sensitivity import flatness, gain_sensitivity
from hrsafety.plotting.impacts.boundaries import foam_boundaries, foam_map
from hrsafety.plotting.impacts.histories import impact_histories, impact_study, measured_impact
from hrsafety.plotting.runs.animation import animate
from hrsafety.plotting.runs.energies import energy
from hrsafety.plotting.runs.fields import force_field, potential_valley
from hrsafety.plotting.runs.histories import distances, lyapunov
from hrsafety.plotting.runs.layouts import layout
from hrsafety.plotting.runs.scenes import paths
from hrsafety.plotting.runs.sequences import time_sequence
from hrsafety.plotting.style import MissingExtraError
from hrsafety.plotting.sweeps.lines import sweep_lines, sweep_map
from hrsafety.plotting.sweeps.overviews import sweep_parallel, sweep_scatter

__all__ = [
    "MissingExtraError",
    "animate",
    "arms",
    "clearances",
    "comparison_distances",
    "comparison_paths",
    "comparison_sequence",
    "comparison_standings",
    "comparisons",
    "contacts",
    "crowds",
    "distances",
    "energy",
    "flatness",
    "foam_boundaries",
    "foam_map",
    "force_field",
    "gain_sensitivity",
    "gains",
    "impact_histories",
    "impact_study",
    "impacts",
    "layout",
    "lyapunov",
    "mass_ellipse",
    "measured_impact",
    "outcomes",
    "pareto_front",
    "paths",
    "potential_valley",
    "reactive",
    "repeated_distances",
    "repeated_paths",
    "robots",
    "runs",
    "search_history",
    "sweep_lines",
    "sweep_map",
    "sweep_parallel",
    "sweep_scatter",
    "sweeps",
    "time_sequence",
]

if not TYPE_CHECKING:  # a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {},
        below=[f"{__name__}.{each}" for each in __all__ if isinstance(globals()[each], ModuleType)],
    )
