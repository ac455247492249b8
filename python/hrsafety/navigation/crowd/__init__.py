"""People that react to each other and to robots: models, worlds, simulations."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.crowd.agents import CrowdRobot as CrowdRobot, Person as Person, Source as Source
    from hrsafety.navigation.crowd.calibration import PeopleFit as PeopleFit, fit_people as fit_people
    from hrsafety.navigation.crowd.circle import circle_starts as circle_starts
    from hrsafety.navigation.crowd.comparison import CrowdComparison as CrowdComparison, CrowdStanding as CrowdStanding
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
        crowd_batch as crowd_batch,
        episodes_of as episodes_of,
        world_metrics as world_metrics,
    )
    from hrsafety.navigation.crowd.simulation import (
        simulate_crowd as simulate_crowd,
        simulate_crowds as simulate_crowds,
    )
    from hrsafety.navigation.crowd.table import CrowdTable as CrowdTable
    from hrsafety.navigation.crowd.trajectories import CrowdTrajectories as CrowdTrajectories, Divergence as Divergence
    from hrsafety.navigation.crowd.world import World as World
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
