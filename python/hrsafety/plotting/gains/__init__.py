"""Pictures of searches for gains and of the sensitivity to them."""

from hrsafety.plotting.gains.searches import pareto_front, search_history
from hrsafety.plotting.gains.sensitivity import flatness, gain_sensitivity

__all__ = [
    "flatness",
    "gain_sensitivity",
    "pareto_front",
    "search_history",
]
