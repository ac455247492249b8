"""Avoidance from sensors: sound, ultrasound and virtual impedance."""

from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, SimulationError
from hrsafety.reactive.bursts import Burst, Converter, doppler_frequency, record_burst
from hrsafety.reactive.collisions import (
    attraction_force,
    collision_point,
    collision_vector,
    printed_foot,
    rotate_to_world,
)
from hrsafety.reactive.delays import Delays, Likeness, estimate_delays, likeness
from hrsafety.reactive.experiments import FollowerExperiment, LawComparison, compare_experiments, experiment
from hrsafety.reactive.fixes import Fix, Fixes, locate, locate_batch
from hrsafety.reactive.follower import (
    FixDeviations,
    Follower,
    FollowerRun,
    fix_deviations,
    follow,
)
from hrsafety.reactive.impedance import VirtualImpedance
from hrsafety.reactive.layouts import FollowerLayouts
from hrsafety.reactive.microphones import (
    MicrophoneArray,
    microphone_elevations,
    parallel_ray_bearing,
    parallel_ray_bias,
    printed_range,
)
from hrsafety.reactive.recording import SoundRecording, read_recording
from hrsafety.reactive.scenes import FollowerScene, MovingObstacle, SoundLeader
from hrsafety.reactive.skirt import MOTION_DIRECTIONS, SkirtState, UltrasonicSkirt, skirt_states
from hrsafety.reactive.skirt_geometry import (
    SensorCount,
    SkirtSpacing,
    least_skirt_sensors,
    skirt_closing_radius,
    skirt_safe_distance,
    skirt_spacing,
)
from hrsafety.reactive.skirt_kinematics import TriOmniKinematics
from hrsafety.reactive.skirt_study import SmallestSkirt, smallest_skirt
from hrsafety.reactive.skirt_tests import (
    SkirtMotion,
    SkirtRun,
    SkirtScene,
    SkirtShares,
    SkirtTest,
    skirt_run,
    skirt_test,
)
from hrsafety.reactive.sonar import Box, Disc, Sonar, SonarMounts, Wall, cast_rays, speed_of_sound
from hrsafety.reactive.trials import jittered_fixes, localize_bursts

__all__ = [
    "MOTION_DIRECTIONS",
    "Box",
    "Burst",
    "Converter",
    "Delays",
    "Disc",
    "Fix",
    "FixDeviations",
    "Fixes",
    "Follower",
    "FollowerExperiment",
    "FollowerLayouts",
    "FollowerRun",
    "FollowerScene",
    "HrsafetyError",
    "InvalidParameterError",
    "LawComparison",
    "Likeness",
    "MicrophoneArray",
    "MovingObstacle",
    "SensorCount",
    "ShapeError",
    "SimulationError",
    "SkirtMotion",
    "SkirtRun",
    "SkirtScene",
    "SkirtShares",
    "SkirtSpacing",
    "SkirtState",
    "SkirtTest",
    "SmallestSkirt",
    "Sonar",
    "SonarMounts",
    "SoundLeader",
    "SoundRecording",
    "TriOmniKinematics",
    "UltrasonicSkirt",
    "VirtualImpedance",
    "Wall",
    "attraction_force",
    "cast_rays",
    "collision_point",
    "collision_vector",
    "compare_experiments",
    "doppler_frequency",
    "estimate_delays",
    "experiment",
    "fix_deviations",
    "follow",
    "jittered_fixes",
    "least_skirt_sensors",
    "likeness",
    "localize_bursts",
    "locate",
    "locate_batch",
    "microphone_elevations",
    "parallel_ray_bearing",
    "parallel_ray_bias",
    "printed_foot",
    "printed_range",
    "read_recording",
    "record_burst",
    "rotate_to_world",
    "skirt_closing_radius",
    "skirt_run",
    "skirt_safe_distance",
    "skirt_spacing",
    "skirt_states",
    "skirt_test",
    "smallest_skirt",
    "speed_of_sound",
]
