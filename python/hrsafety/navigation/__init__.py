"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.arena import ArenaResult, Standing, arena, step_cost
from hrsafety.navigation.batch import BatchSummary, simulate_batch
from hrsafety.navigation.gain_changes import GainSensitivity, gain_sensitivity
from hrsafety.navigation.gain_confidence import Confidence
from hrsafety.navigation.gain_front import pareto_front
from hrsafety.navigation.gain_results import Flatness, GainSearch, LocalSearch, ParetoFront, SearchRound
from hrsafety.navigation.gain_search import optimize_gains
from hrsafety.navigation.gain_settings import GainConstraint, SearchSettings
from hrsafety.navigation.gain_slopes import GainGradient, gain_gradient
from hrsafety.navigation.laws import BorensteinKoren, GeCui, Khatib, Law, Masoud, VirtualForceField
from hrsafety.navigation.obstacles import Disc, Human, MovingDisc, Obstacle, Rectangle
from hrsafety.navigation.planners import (
    FieldDStar,
    OptimalReciprocalCollisionAvoidance,
    RapidlyExploringRandomTree,
    VelocityObstacle,
)
from hrsafety.navigation.robots import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Measurement, Regions, Scenario, region_radii
from hrsafety.navigation.simulation import (
    ForceField,
    ForceTerms,
    Lyapunov,
    Performance,
    Trajectory,
    command,
    evaluate,
    force_field,
    force_terms,
    lyapunov,
    simulate,
)

__all__ = [
    "ArenaResult",
    "BatchSummary",
    "BorensteinKoren",
    "Confidence",
    "DifferentialDriveRobot",
    "Disc",
    "FieldDStar",
    "Flatness",
    "ForceField",
    "ForceTerms",
    "GainConstraint",
    "GainGradient",
    "GainSearch",
    "GainSensitivity",
    "GeCui",
    "HolonomicRobot",
    "HrsafetyError",
    "Human",
    "InvalidParameterError",
    "Khatib",
    "Law",
    "LocalSearch",
    "Lyapunov",
    "Masoud",
    "Measurement",
    "MovingDisc",
    "Obstacle",
    "OptimalReciprocalCollisionAvoidance",
    "ParetoFront",
    "Performance",
    "RapidlyExploringRandomTree",
    "Rectangle",
    "Regions",
    "Scenario",
    "SearchRound",
    "SearchSettings",
    "ShapeError",
    "SimulationError",
    "Standing",
    "Trajectory",
    "VelocityObstacle",
    "VirtualForceField",
    "arena",
    "command",
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
    "step_cost",
]
