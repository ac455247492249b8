"""Where a sound comes from: bursts, microphones, delays, fixes."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.reactive.sound.bursts import Burst, Converter, doppler_frequency, record_burst
    from hrsafety.reactive.sound.delays import Delays, Likeness, estimate_delays, likeness
    from hrsafety.reactive.sound.fixes import Fix, Fixes, locate, locate_batch
    from hrsafety.reactive.sound.microphones import (
        MicrophoneArray,
        microphone_elevations,
        parallel_ray_bearing,
        parallel_ray_bias,
        printed_range,
    )
    from hrsafety.reactive.sound.recording import SoundRecording, read_recording
    from hrsafety.reactive.sound.trials import jittered_fixes, localize_bursts

__all__ = [
    "Burst",
    "Converter",
    "Delays",
    "Fix",
    "Fixes",
    "Likeness",
    "MicrophoneArray",
    "SoundRecording",
    "doppler_frequency",
    "estimate_delays",
    "jittered_fixes",
    "likeness",
    "localize_bursts",
    "locate",
    "locate_batch",
    "microphone_elevations",
    "parallel_ray_bearing",
    "parallel_ray_bias",
    "printed_range",
    "read_recording",
    "record_burst",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.reactive.sound.bursts": "Burst Converter doppler_frequency record_burst",
            "hrsafety.reactive.sound.delays": "Delays Likeness estimate_delays likeness",
            "hrsafety.reactive.sound.fixes": "Fix Fixes locate locate_batch",
            "hrsafety.reactive.sound.microphones": (
                "MicrophoneArray microphone_elevations parallel_ray_bearing parallel_ray_bias printed_range"
            ),
            "hrsafety.reactive.sound.recording": "SoundRecording read_recording",
            "hrsafety.reactive.sound.trials": "jittered_fixes localize_bursts",
        },
    )
