"""Where a sound comes from: bursts, microphones, delays, fixes."""

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
