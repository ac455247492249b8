"""The robot that follows a sound and avoids what its sonar sees."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.reactive.follower.collisions import (
        attraction_force as attraction_force,
        collision_point as collision_point,
        collision_vector as collision_vector,
        printed_foot as printed_foot,
        rotate_to_world as rotate_to_world,
    )
    from hrsafety.reactive.follower.experiments import (
        FollowerExperiment as FollowerExperiment,
        LawComparison as LawComparison,
        compare_experiments as compare_experiments,
        experiment as experiment,
    )
    from hrsafety.reactive.follower.impedance import VirtualImpedance as VirtualImpedance
    from hrsafety.reactive.follower.layouts import FollowerLayouts as FollowerLayouts
    from hrsafety.reactive.follower.runs import (
        FixDeviations as FixDeviations,
        Follower as Follower,
        FollowerRun as FollowerRun,
        fix_deviations as fix_deviations,
    )
    from hrsafety.reactive.follower.scenes import (
        FollowerScene as FollowerScene,
        MovingObstacle as MovingObstacle,
        SoundLeader as SoundLeader,
    )
    from hrsafety.reactive.follower.steps import FollowerSteps as FollowerSteps, follow as follow
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
