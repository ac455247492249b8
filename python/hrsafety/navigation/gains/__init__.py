"""Gains of laws: search, fronts, sensitivity."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.gains.changes import (
        GainSensitivity as GainSensitivity,
        gain_sensitivity as gain_sensitivity,
    )
    from hrsafety.navigation.gains.confidence import Confidence as Confidence
    from hrsafety.navigation.gains.front import pareto_front as pareto_front
    from hrsafety.navigation.gains.results import (
        Flatness as Flatness,
        GainSearch as GainSearch,
        ParetoFront as ParetoFront,
        SearchStage as SearchStage,
    )
    from hrsafety.navigation.gains.search import optimize_gains as optimize_gains
    from hrsafety.navigation.gains.settings import GainConstraint as GainConstraint, SearchSettings as SearchSettings
    from hrsafety.navigation.gains.slopes import GainGradient as GainGradient, gain_gradient as gain_gradient
    from hrsafety.navigation.gains.stream import stream_batch as stream_batch
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
