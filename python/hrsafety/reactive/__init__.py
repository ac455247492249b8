"""Avoidance from sensors: sound, ultrasound and virtual impedance."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.reactive.follower.experiments": "FollowerExperiment experiment",
            "hrsafety.reactive.follower.impedance": "VirtualImpedance",
            "hrsafety.reactive.follower.layouts": "FollowerLayouts",
            "hrsafety.reactive.follower.runs": "Follower FollowerRun",
            "hrsafety.reactive.follower.scenes": "FollowerScene MovingObstacle SoundLeader",
            "hrsafety.reactive.follower.steps": "FollowerSteps follow",
            "hrsafety.reactive.percept": "Percept",
            "hrsafety.reactive.skirt.ring": "UltrasonicSkirt",
            "hrsafety.reactive.skirt.runs": "SkirtMotion SkirtRun SkirtScene SkirtTest skirt_test",
            "hrsafety.reactive.skirt.steps": "SkirtSteps skirt_run",
            "hrsafety.reactive.skirt.study": "SmallestSkirt smallest_skirt",
            "hrsafety.reactive.sonar.echoes": "Box Disc Sonar SonarMounts Wall",
            "hrsafety.reactive.sound.bursts": "Burst Converter record_burst",
            "hrsafety.reactive.sound.delays": "Delays estimate_delays",
            "hrsafety.reactive.sound.fixes": "Fix Fixes locate locate_batch",
            "hrsafety.reactive.sound.microphones": "MicrophoneArray",
            "hrsafety.reactive.sound.recording": "SoundRecording read_recording",
            "hrsafety.reactive.sound.trials": "localize_bursts",
        },
        below=[
            "hrsafety.reactive.follower",
            "hrsafety.reactive.skirt",
            "hrsafety.reactive.sonar",
            "hrsafety.reactive.sound",
            "hrsafety.errors",
        ],
    )
