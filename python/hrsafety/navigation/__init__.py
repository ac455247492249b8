"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.batch import BatchSummary, simulate_batch
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
    "DifferentialDriveRobot",
    "Disc",
    "ForceField",
    "ForceTerms",
    "HolonomicRobot",
    "HrsafetyError",
    "Human",
    "InvalidParameterError",
    "Lyapunov",
    "Measurement",
    "MovingDisc",
    "Obstacle",
    "Performance",
    "Rectangle",
    "Regions",
    "Scenario",
    "ShapeError",
    "SimulationError",
    "Trajectory",
    "VirtualForceField",
    "evaluate",
    "force_field",
    "force_terms",
    "lyapunov",
    "region_radii",
    "simulate",
    "simulate_batch",
]
