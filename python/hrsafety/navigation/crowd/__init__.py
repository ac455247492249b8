"""People that react to each other and to robots: models, worlds, simulations."""

from hrsafety.navigation import metrics as _metrics  # noqa: F401  # before worlds: comparisons, which it names, know them
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
