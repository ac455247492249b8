"""Where a sound comes from: bursts, microphones, delays, fixes."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.reactive.sound.bursts import (
        Burst as Burst,
        Converter as Converter,
        doppler_frequency as doppler_frequency,
        record_burst as record_burst,
    )
    from hrsafety.reactive.sound.delays import (
        Delays as Delays,
        Likeness as Likeness,
        estimate_delays as estimate_delays,
        likeness as likeness,
    )
    from hrsafety.reactive.sound.fixes import Fix as Fix, Fixes as Fixes, locate as locate, locate_batch as locate_batch
    from hrsafety.reactive.sound.microphones import (
        MicrophoneArray as MicrophoneArray,
        microphone_elevations as microphone_elevations,
        parallel_ray_bearing as parallel_ray_bearing,
        parallel_ray_bias as parallel_ray_bias,
        printed_range as printed_range,
    )
    from hrsafety.reactive.sound.recording import SoundRecording as SoundRecording, read_recording as read_recording
    from hrsafety.reactive.sound.trials import jittered_fixes as jittered_fixes, localize_bursts as localize_bursts
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
