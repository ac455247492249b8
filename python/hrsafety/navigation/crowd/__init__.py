"""People that react to each other and to robots: their models, and what is measured of them."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.crowd.calibration import PeopleFit as PeopleFit, fit_people as fit_people
    from hrsafety.navigation.crowd.circle import circle_starts as circle_starts
    from hrsafety.navigation.crowd.decisions import decide as decide
    from hrsafety.navigation.crowd.diagram import (
        FundamentalDiagram as FundamentalDiagram,
        fundamental_diagram as fundamental_diagram,
        weidmann_speed as weidmann_speed,
    )
    from hrsafety.navigation.crowd.pedestrians import (
        CollisionFreeSpeed as CollisionFreeSpeed,
        Moussaid as Moussaid,
        Pedestrian as Pedestrian,
        ReciprocalAvoidance as ReciprocalAvoidance,
        SocialForce1995 as SocialForce1995,
        SocialForce2000 as SocialForce2000,
    )
    from hrsafety.navigation.crowd.predictions import (
        PredictionErrors as PredictionErrors,
        prediction_errors as prediction_errors,
    )
    from hrsafety.navigation.crowd.scores import (
        episodes_of as episodes_of,
        world_metrics as world_metrics,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
