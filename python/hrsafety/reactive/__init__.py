"""Avoidance from sensors: sound, ultrasound and virtual impedance."""

from typing import TYPE_CHECKING

from hrsafety import errors
from hrsafety._namespace import names_below
from hrsafety.reactive import follower, skirt, sonar, sound
from hrsafety.reactive.follower.experiments import FollowerExperiment, experiment
from hrsafety.reactive.follower.impedance import VirtualImpedance
from hrsafety.reactive.follower.layouts import FollowerLayouts
from hrsafety.reactive.follower.runs import Follower, FollowerRun
from hrsafety.reactive.follower.scenes import FollowerScene, MovingObstacle, SoundLeader
from hrsafety.reactive.follower.steps import FollowerSteps, follow
from hrsafety.reactive.percept import Percept
from hrsafety.reactive.skirt.ring import UltrasonicSkirt
from hrsafety.reactive.skirt.runs import SkirtMotion, SkirtRun, SkirtScene, SkirtTest, skirt_test
from hrsafety.reactive.skirt.steps import SkirtSteps, skirt_run
from hrsafety.reactive.skirt.study import SmallestSkirt, smallest_skirt
from hrsafety.reactive.sonar.echoes import Box, Disc, Sonar, SonarMounts, Wall
from hrsafety.reactive.sound.bursts import Burst, Converter, record_burst
from hrsafety.reactive.sound.delays import Delays, estimate_delays
from hrsafety.reactive.sound.fixes import Fix, Fixes, locate, locate_batch
from hrsafety.reactive.sound.microphones import MicrophoneArray
from hrsafety.reactive.sound.recording import SoundRecording, read_recording
from hrsafety.reactive.sound.trials import localize_bursts

__all__ = [
    "Box",
    "Burst",
    "Converter",
    "Delays",
    "Disc",
    "Fix",
    "Fixes",
    "Follower",
    "FollowerExperiment",
    "FollowerLayouts",
    "FollowerRun",
    "FollowerScene",
    "FollowerSteps",
    "MicrophoneArray",
    "MovingObstacle",
    "Percept",
    "SkirtMotion",
    "SkirtRun",
    "SkirtScene",
    "SkirtSteps",
    "SkirtTest",
    "SmallestSkirt",
    "Sonar",
    "SonarMounts",
    "SoundLeader",
    "SoundRecording",
    "UltrasonicSkirt",
    "VirtualImpedance",
    "Wall",
    "estimate_delays",
    "experiment",
    "follow",
    "follower",
    "localize_bursts",
    "locate",
    "locate_batch",
    "read_recording",
    "record_burst",
    "skirt",
    "skirt_run",
    "skirt_test",
    "smallest_skirt",
    "sonar",
    "sound",
]

if not TYPE_CHECKING:  # a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_below(__name__, __all__, [follower, skirt, sonar, sound, errors])
