"""Pictures of runs: paths, distances, energies, forces, animations."""

from hrsafety.plotting.runs.animation import animate
from hrsafety.plotting.runs.decisions import animate_safety, safety_decision
from hrsafety.plotting.runs.energies import energy
from hrsafety.plotting.runs.fields import force_field, potential_valley
from hrsafety.plotting.runs.histories import distances, lyapunov
from hrsafety.plotting.runs.judgements import judged_way, worst_moments
from hrsafety.plotting.runs.known_places import animate_known_cells, known_cells
from hrsafety.plotting.runs.layouts import layout
from hrsafety.plotting.runs.plans import guide_plan
from hrsafety.plotting.runs.pursuits import worst_pursuit
from hrsafety.plotting.runs.scenes import paths
from hrsafety.plotting.runs.sequences import time_sequence

__all__ = [
    "animate",
    "animate_known_cells",
    "animate_safety",
    "distances",
    "energy",
    "force_field",
    "guide_plan",
    "judged_way",
    "known_cells",
    "layout",
    "lyapunov",
    "paths",
    "potential_valley",
    "safety_decision",
    "time_sequence",
    "worst_moments",
    "worst_pursuit",
]
