"""Gains of laws: search, fronts, sensitivity."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation.gains.changes import GainSensitivity, gain_sensitivity
    from hrsafety.navigation.gains.confidence import Confidence
    from hrsafety.navigation.gains.front import pareto_front
    from hrsafety.navigation.gains.pareto import ParetoFront
    from hrsafety.navigation.gains.results import Flatness, GainSearch, LocalSearch, SearchRound
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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.gains.changes": "GainSensitivity gain_sensitivity",
            "hrsafety.navigation.gains.confidence": "Confidence",
            "hrsafety.navigation.gains.front": "pareto_front",
            "hrsafety.navigation.gains.pareto": "ParetoFront",
            "hrsafety.navigation.gains.results": "Flatness GainSearch LocalSearch SearchRound",
            "hrsafety.navigation.gains.search": "optimize_gains",
            "hrsafety.navigation.gains.settings": "GainConstraint SearchSettings",
            "hrsafety.navigation.gains.slopes": "GainGradient gain_gradient",
            "hrsafety.navigation.gains.stream": "stream_batch",
        },
    )
