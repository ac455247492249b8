"""Avoidance from sensors: sound, ultrasound and virtual impedance."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.reactive import follower as follower, skirt as skirt, sonar as sonar, sound as sound
    from hrsafety.reactive.follower.experiments import (
        FollowerExperiment as FollowerExperiment,
        experiment as experiment,
    )
    from hrsafety.reactive.follower.impedance import VirtualImpedance as VirtualImpedance
    from hrsafety.reactive.follower.layouts import FollowerLayouts as FollowerLayouts
    from hrsafety.reactive.follower.runs import Follower as Follower, FollowerRun as FollowerRun
    from hrsafety.reactive.follower.scenes import (
        FollowerScene as FollowerScene,
        MovingObstacle as MovingObstacle,
        SoundLeader as SoundLeader,
    )
    from hrsafety.reactive.follower.steps import FollowerSteps as FollowerSteps, follow as follow
    from hrsafety.reactive.percept import Percept as Percept
    from hrsafety.reactive.skirt.ring import UltrasonicSkirt as UltrasonicSkirt
    from hrsafety.reactive.skirt.runs import (
        SkirtMotion as SkirtMotion,
        SkirtRun as SkirtRun,
        SkirtScene as SkirtScene,
        SkirtTest as SkirtTest,
        skirt_test as skirt_test,
    )
    from hrsafety.reactive.skirt.steps import SkirtSteps as SkirtSteps, skirt_run as skirt_run
    from hrsafety.reactive.skirt.study import SmallestSkirt as SmallestSkirt, smallest_skirt as smallest_skirt
    from hrsafety.reactive.sonar.echoes import (
        Box as Box,
        Cylinder as Cylinder,
        Sonar as Sonar,
        SonarMounts as SonarMounts,
        Wall as Wall,
    )
    from hrsafety.reactive.sound.bursts import Burst as Burst, Converter as Converter, record_burst as record_burst
    from hrsafety.reactive.sound.delays import Delays as Delays, estimate_delays as estimate_delays
    from hrsafety.reactive.sound.fixes import Fix as Fix, Fixes as Fixes, locate as locate, locate_batch as locate_batch
    from hrsafety.reactive.sound.microphones import MicrophoneArray as MicrophoneArray
    from hrsafety.reactive.sound.recording import SoundRecording as SoundRecording, read_recording as read_recording
    from hrsafety.reactive.sound.trials import localize_bursts as localize_bursts
else:
    __all__, __getattr__, __dir__ = names_of(
        __name__,
        below=[
            "hrsafety.reactive.follower",
            "hrsafety.reactive.skirt",
            "hrsafety.reactive.sonar",
            "hrsafety.reactive.sound",
            "hrsafety.errors",
        ],
    )
