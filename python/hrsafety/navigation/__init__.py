"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation import (
        crowd as crowd,
        gains as gains,
        laws as laws,
        maps as maps,
        metrics as metrics,
        robots as robots,
        sensing as sensing,
        tracking as tracking,
    )
    from hrsafety.navigation.batch import simulate_batch as simulate_batch
    from hrsafety.navigation.comparison import compare as compare
    from hrsafety.navigation.controller import Controller as Controller
    from hrsafety.navigation.crowd.agents import Person as Person, Robot as Robot, Source as Source
    from hrsafety.navigation.crowd.world import World as World
    from hrsafety.navigation.gains.changes import gain_sensitivity as gain_sensitivity
    from hrsafety.navigation.gains.results import GainSearch as GainSearch
    from hrsafety.navigation.gains.search import optimize_gains as optimize_gains
    from hrsafety.navigation.laws.arc_rollouts import ArcRollouts as ArcRollouts
    from hrsafety.navigation.laws.force_laws import (
        BorensteinKoren as BorensteinKoren,
        GeCui as GeCui,
        Khatib as Khatib,
        Law as Law,
        Masoud as Masoud,
        VirtualForceField as VirtualForceField,
    )
    from hrsafety.navigation.laws.forces import (
        ForceTerms as ForceTerms,
        Lyapunov as Lyapunov,
        force_terms as force_terms,
        lyapunov as lyapunov,
    )
    from hrsafety.navigation.laws.foresight import Foresight as Foresight
    from hrsafety.navigation.laws.local_planners import (
        DWB as DWB,
        DynamicWindow as DynamicWindow,
        PathIntegral as PathIntegral,
        RegulatedPurePursuit as RegulatedPurePursuit,
    )
    from hrsafety.navigation.laws.planners import (
        FieldDStar as FieldDStar,
        OptimalReciprocalCollisionAvoidance as OptimalReciprocalCollisionAvoidance,
        RapidlyExploringRandomTree as RapidlyExploringRandomTree,
        SocialForce as SocialForce,
        VelocityObstacle as VelocityObstacle,
    )
    from hrsafety.navigation.laws.safe_navigation import SafeNavigation as SafeNavigation
    from hrsafety.navigation.laws.shield import Shield as Shield
    from hrsafety.navigation.laws.unseen import Unseen as Unseen
    from hrsafety.navigation.laws.yielding import Yielding as Yielding
    from hrsafety.navigation.many import simulate_many as simulate_many
    from hrsafety.navigation.maps.guide import Guide as Guide
    from hrsafety.navigation.maps.static_map import StaticMap as StaticMap
    from hrsafety.navigation.maps.unknown_map import UnknownMap as UnknownMap
    from hrsafety.navigation.obstacles.base import Obstacle as Obstacle
    from hrsafety.navigation.obstacles.moving import Human as Human, MovingDisc as MovingDisc
    from hrsafety.navigation.obstacles.moving_rectangle import MovingRectangle as MovingRectangle
    from hrsafety.navigation.obstacles.standing import Disc as Disc, Rectangle as Rectangle
    from hrsafety.navigation.performance import Performance as Performance
    from hrsafety.navigation.place import Place as Place
    from hrsafety.navigation.pursuits import falsify as falsify
    from hrsafety.navigation.regions import Regions as Regions, region_radii as region_radii
    from hrsafety.navigation.robots.bodies import (
        DifferentialDriveRobot as DifferentialDriveRobot,
        HolonomicRobot as HolonomicRobot,
    )
    from hrsafety.navigation.run import Run as Run
    from hrsafety.navigation.scan_controller import LidarScan as LidarScan, ScanController as ScanController
    from hrsafety.navigation.scenario import Scenario as Scenario
    from hrsafety.navigation.scenario_arrays import Scenarios as Scenarios
    from hrsafety.navigation.sensing.lidar import Lidar as Lidar
    from hrsafety.navigation.sensing.measurement import Measurement as Measurement
    from hrsafety.navigation.simulation import evaluate as evaluate, simulate as simulate
    from hrsafety.navigation.tables.runs import RunTable as RunTable
    from hrsafety.navigation.trajectory import Trajectory as Trajectory
else:
    __all__, __getattr__, __dir__ = names_of(
        __name__,
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
            "hrsafety.navigation.scan_controller",
            "hrsafety.navigation.tables.runs",
            "hrsafety.errors",
        ],
    )
