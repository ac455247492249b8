"""The robot that follows a sound and avoids what its sonar sees."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.reactive.follower.collisions import (
        attraction_force,
        collision_point,
        collision_vector,
        printed_foot,
        rotate_to_world,
    )
    from hrsafety.reactive.follower.experiments import (
        FollowerExperiment,
        LawComparison,
        compare_experiments,
        experiment,
    )
    from hrsafety.reactive.follower.impedance import VirtualImpedance
    from hrsafety.reactive.follower.layouts import FollowerLayouts
    from hrsafety.reactive.follower.runs import FixDeviations, Follower, FollowerRun, fix_deviations
    from hrsafety.reactive.follower.scenes import FollowerScene, MovingObstacle, SoundLeader
    from hrsafety.reactive.follower.steps import FollowerSteps, follow

__all__ = [
    "FixDeviations",
    "Follower",
    "FollowerExperiment",
    "FollowerLayouts",
    "FollowerRun",
    "FollowerScene",
    "FollowerSteps",
    "LawComparison",
    "MovingObstacle",
    "SoundLeader",
    "VirtualImpedance",
    "attraction_force",
    "collision_point",
    "collision_vector",
    "compare_experiments",
    "experiment",
    "fix_deviations",
    "follow",
    "printed_foot",
    "rotate_to_world",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.reactive.follower.collisions": (
                "attraction_force collision_point collision_vector printed_foot rotate_to_world"
            ),
            "hrsafety.reactive.follower.experiments": (
                "FollowerExperiment LawComparison compare_experiments experiment"
            ),
            "hrsafety.reactive.follower.impedance": "VirtualImpedance",
            "hrsafety.reactive.follower.layouts": "FollowerLayouts",
            "hrsafety.reactive.follower.runs": "FixDeviations Follower FollowerRun fix_deviations",
            "hrsafety.reactive.follower.scenes": "FollowerScene MovingObstacle SoundLeader",
            "hrsafety.reactive.follower.steps": "FollowerSteps follow",
        },
    )
