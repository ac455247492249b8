"""Gains of laws: search, fronts, sensitivity."""

from hrsafety.navigation.gains.changes import GainSensitivity, gain_sensitivity
from hrsafety.navigation.gains.confidence import Confidence
from hrsafety.navigation.gains.front import pareto_front
from hrsafety.navigation.gains.results import Flatness, GainSearch, LocalSearch, ParetoFront, SearchRound
from hrsafety.navigation.gains.search import optimize_gains
from hrsafety.navigation.gains.settings import GainConstraint, SearchSettings
from hrsafety.navigation.gains.slopes import GainGradient, gain_gradient
from hrsafety.navigation.gains.stream import stream_batch

__all__ = [
    "Confidence",
    "Flatness",
    "GainConstraint",
    "GainGradient",
    "GainSearch",
    "GainSensitivity",
    "LocalSearch",
    "ParetoFront",
    "SearchRound",
    "SearchSettings",
    "gain_gradient",
    "gain_sensitivity",
    "optimize_gains",
    "pareto_front",
    "stream_batch",
]
