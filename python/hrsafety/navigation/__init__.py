"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.batch import BatchSummary, simulate_batch
from hrsafety.navigation.gain_changes import GainSensitivity, gain_sensitivity
from hrsafety.navigation.gain_confidence import Confidence
from hrsafety.navigation.gain_front import pareto_front
from hrsafety.navigation.gain_results import Flatness, GainSearch, LocalSearch, ParetoFront, SearchRound
from hrsafety.navigation.gain_search import optimize_gains
from hrsafety.navigation.gain_settings import GainConstraint, SearchSettings
from hrsafety.navigation.gain_slopes import GainGradient, gain_gradient
from hrsafety.navigation.laws import VirtualForceField
from hrsafety.navigation.obstacles import Disc, Human, MovingDisc, Obstacle, Rectangle
from hrsafety.navigation.robots import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Measurement, Regions, Scenario, region_radii
from hrsafety.navigation.simulation import (
    ForceField,
    ForceTerms,
    Lyapunov,
    Performance,
    Trajectory,
    evaluate,
    force_field,
    force_terms,
    lyapunov,
    simulate,
)

__all__ = [
    "BatchSummary",
    "Confidence",
    "DifferentialDriveRobot",
    "Disc",
    "Flatness",
    "ForceField",
    "ForceTerms",
    "GainConstraint",
    "GainGradient",
    "GainSearch",
    "GainSensitivity",
    "HolonomicRobot",
    "HrsafetyError",
    "Human",
    "InvalidParameterError",
    "LocalSearch",
    "Lyapunov",
    "Measurement",
    "MovingDisc",
    "Obstacle",
    "ParetoFront",
    "Performance",
    "Rectangle",
    "Regions",
    "Scenario",
    "SearchRound",
    "SearchSettings",
    "ShapeError",
    "SimulationError",
    "Trajectory",
    "VirtualForceField",
    "evaluate",
    "force_field",
    "force_terms",
    "gain_gradient",
    "gain_sensitivity",
    "lyapunov",
    "optimize_gains",
    "pareto_front",
    "region_radii",
    "simulate",
    "simulate_batch",
]
