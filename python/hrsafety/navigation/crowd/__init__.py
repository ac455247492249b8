"""People that react to each other and to robots: models, worlds, simulations."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation.crowd.agents import CrowdRobot, Person, Source
    from hrsafety.navigation.crowd.calibration import PeopleFit, fit_people
    from hrsafety.navigation.crowd.circle import circle_starts
    from hrsafety.navigation.crowd.comparison import CrowdComparison, CrowdStanding
    from hrsafety.navigation.crowd.decisions import decide
    from hrsafety.navigation.crowd.diagram import FundamentalDiagram, fundamental_diagram, weidmann_speed
    from hrsafety.navigation.crowd.pedestrians import (
        CollisionFreeSpeed,
        Moussaid,
        Pedestrian,
        ReciprocalAvoidance,
        SocialForce1995,
        SocialForce2000,
    )
    from hrsafety.navigation.crowd.predictions import PredictionErrors, prediction_errors
    from hrsafety.navigation.crowd.scores import crowd_batch, episodes_of, world_metrics
    from hrsafety.navigation.crowd.simulation import simulate_crowd, simulate_crowds
    from hrsafety.navigation.crowd.table import CrowdTable
    from hrsafety.navigation.crowd.trajectories import CrowdTrajectories, Divergence
    from hrsafety.navigation.crowd.world import World

__all__ = [
    "CollisionFreeSpeed",
    "CrowdComparison",
    "CrowdRobot",
    "CrowdStanding",
    "CrowdTable",
    "CrowdTrajectories",
    "Divergence",
    "FundamentalDiagram",
    "Moussaid",
    "Pedestrian",
    "PeopleFit",
    "Person",
    "PredictionErrors",
    "ReciprocalAvoidance",
    "SocialForce1995",
    "SocialForce2000",
    "Source",
    "World",
    "circle_starts",
    "crowd_batch",
    "decide",
    "episodes_of",
    "fit_people",
    "fundamental_diagram",
    "prediction_errors",
    "simulate_crowd",
    "simulate_crowds",
    "weidmann_speed",
    "world_metrics",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.crowd.agents": "CrowdRobot Person Source",
            "hrsafety.navigation.crowd.calibration": "PeopleFit fit_people",
            "hrsafety.navigation.crowd.circle": "circle_starts",
            "hrsafety.navigation.crowd.comparison": "CrowdComparison CrowdStanding",
            "hrsafety.navigation.crowd.decisions": "decide",
            "hrsafety.navigation.crowd.diagram": "FundamentalDiagram fundamental_diagram weidmann_speed",
            "hrsafety.navigation.crowd.pedestrians": (
                "CollisionFreeSpeed Moussaid Pedestrian ReciprocalAvoidance SocialForce1995 SocialForce2000"
            ),
            "hrsafety.navigation.crowd.predictions": "PredictionErrors prediction_errors",
            "hrsafety.navigation.crowd.scores": "crowd_batch episodes_of world_metrics",
            "hrsafety.navigation.crowd.simulation": "simulate_crowd simulate_crowds",
            "hrsafety.navigation.crowd.table": "CrowdTable",
            "hrsafety.navigation.crowd.trajectories": "CrowdTrajectories Divergence",
            "hrsafety.navigation.crowd.world": "World",
        },
    )
