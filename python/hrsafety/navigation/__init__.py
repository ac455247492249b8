"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation import crowd, gains, laws, maps, metrics, robots, sensing, tracking
    from hrsafety.navigation.batch import simulate_batch
    from hrsafety.navigation.comparison import compare
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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.batch": "simulate_batch",
            "hrsafety.navigation.comparison": "compare",
            "hrsafety.navigation.gains.changes": "gain_sensitivity",
            "hrsafety.navigation.gains.results": "GainSearch",
            "hrsafety.navigation.gains.search": "optimize_gains",
            "hrsafety.navigation.laws.force_laws": "BorensteinKoren GeCui Khatib Masoud VirtualForceField",
            "hrsafety.navigation.laws.forces": "ForceTerms Lyapunov force_terms lyapunov",
            "hrsafety.navigation.laws.planners": (
                "FieldDStar OptimalReciprocalCollisionAvoidance RapidlyExploringRandomTree VelocityObstacle"
            ),
            "hrsafety.navigation.many": "simulate_many",
            "hrsafety.navigation.obstacles.base": "Obstacle",
            "hrsafety.navigation.obstacles.moving": "Human MovingDisc",
            "hrsafety.navigation.obstacles.moving_rectangle": "MovingRectangle",
            "hrsafety.navigation.obstacles.standing": "Disc Rectangle",
            "hrsafety.navigation.performance": "Performance",
            "hrsafety.navigation.regions": "Regions region_radii",
            "hrsafety.navigation.robots.bodies": "DifferentialDriveRobot HolonomicRobot",
            "hrsafety.navigation.run": "Run",
            "hrsafety.navigation.scenario": "Scenario",
            "hrsafety.navigation.scenario_arrays": "Scenarios",
            "hrsafety.navigation.sensing.measurement": "Measurement",
            "hrsafety.navigation.simulation": "evaluate simulate",
            "hrsafety.navigation.trajectory": "Trajectory",
        },
        below=[
            "hrsafety.navigation.crowd",
            "hrsafety.navigation.gains",
            "hrsafety.navigation.laws",
            "hrsafety.navigation.maps",
            "hrsafety.navigation.metrics",
            "hrsafety.navigation.robots",
            "hrsafety.navigation.sensing",
            "hrsafety.navigation.tracking",
            "hrsafety.navigation.knowledge",
            "hrsafety.navigation.controller",
            "hrsafety.navigation.tables.runs",
            "hrsafety.errors",
        ],
    )
