"""The robot that follows a sound and avoids what its sonar sees."""

from hrsafety.reactive.follower.collisions import (
    attraction_force,
    collision_point,
    collision_vector,
    printed_foot,
    rotate_to_world,
)
from hrsafety.reactive.follower.experiments import FollowerExperiment, LawComparison, compare_experiments, experiment
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
