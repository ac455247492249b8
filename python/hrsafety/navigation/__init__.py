"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from typing import TYPE_CHECKING

from hrsafety import errors
from hrsafety._namespace import names_below
from hrsafety.navigation import (
    controller,
    crowd,
    gains,
    knowledge,
    laws,
    maps,
    metrics,
    robots,
    run_table,
    sensing,
    tracking,
)
from hrsafety.navigation.batch import simulate_batch
from hrsafety.navigation.compare import compare
from hrsafety.navigation.gains.changes import gain_sensitivity
from hrsafety.navigation.gains.results import GainSearch
from hrsafety.navigation.gains.search import optimize_gains
from hrsafety.navigation.laws.force_laws import BorensteinKoren, GeCui, Khatib, Masoud, VirtualForceField
from hrsafety.navigation.laws.force_laws import Law as Law  # listed in `laws`; a name of type hints
from hrsafety.navigation.laws.forces import ForceTerms, Lyapunov, force_terms, lyapunov
from hrsafety.navigation.laws.planners import (
    FieldDStar,
    OptimalReciprocalCollisionAvoidance,
    RapidlyExploringRandomTree,
    VelocityObstacle,
)
from hrsafety.navigation.many import simulate_many
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.moving_rectangle import MovingRectangle
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.performance import Performance
from hrsafety.navigation.regions import Regions, region_radii
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.run import Run
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_arrays import Scenarios
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.simulation import evaluate, simulate
from hrsafety.navigation.trajectory import Trajectory

__all__ = [
    "BorensteinKoren",
    "DifferentialDriveRobot",
    "Disc",
    "FieldDStar",
    "ForceTerms",
    "GainSearch",
    "GeCui",
    "HolonomicRobot",
    "Human",
    "Khatib",
    "Lyapunov",
    "Masoud",
    "Measurement",
    "MovingDisc",
    "MovingRectangle",
    "Obstacle",
    "OptimalReciprocalCollisionAvoidance",
    "Performance",
    "RapidlyExploringRandomTree",
    "Rectangle",
    "Regions",
    "Run",
    "Scenario",
    "Scenarios",
    "Trajectory",
    "VelocityObstacle",
    "VirtualForceField",
    "compare",
    "crowd",
    "evaluate",
    "force_terms",
    "gain_sensitivity",
    "gains",
    "laws",
    "lyapunov",
    "maps",
    "metrics",
    "optimize_gains",
    "region_radii",
    "robots",
    "sensing",
    "simulate",
    "simulate_batch",
    "simulate_many",
    "tracking",
]

if not TYPE_CHECKING:  # a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_below(
        __name__,
        __all__,
        [crowd, gains, laws, maps, metrics, robots, sensing, tracking, knowledge, controller, run_table, errors],
    )
