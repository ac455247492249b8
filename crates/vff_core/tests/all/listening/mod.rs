//! What the tests of localization share: the array, bursts and how they are heard.

use numeric::parallel::Work;
use vff_core::sensing::sound::burst::{Burst, Sound};
use vff_core::sensing::sound::correlation::Method;
use vff_core::sensing::sound::delays::{DelayFinder, DelayOptions};
use vff_core::sensing::sound::microphones::MicrophoneArray;
use vff_core::sensing::sound::recording::{Hearing, Recording};

pub const ARRAY: MicrophoneArray = MicrophoneArray {
    spacing: 0.4,
    speed_of_sound: 340.0,
};
/// Samples in a second.
pub const RATE: f64 = 100e3;
/// Never interrupted.
pub const GO_ON: &(dyn Fn() -> bool + Sync) = &|| false;

/// Work of so many threads that tells nobody how far it is.
pub fn work(threads: Option<usize>, interrupted: &(dyn Fn() -> bool + Sync)) -> Work<'_> {
    Work {
        threads,
        interrupted,
        progress: &|_| (),
    }
}

/// Noise from 500 Hz to 8 kHz, of a duration in s.
pub fn noise_burst(duration: f64) -> Burst {
    Burst {
        sound: Sound::Noise {
            low: 500.0,
            high: 8000.0,
            seed: 1,
        },
        duration,
        level: 0.2,
        ramp: 0.005,
    }
}

/// At rest without noise, from a source at a range in m and a bearing in rad.
pub fn heard_at(range: f64, bearing: f64) -> Hearing {
    Hearing {
        range,
        bearing,
        observer_speed: 0.0,
        source_speed: 0.0,
        noise: 0.0,
        lead: 0.005,
        samples: None,
    }
}

/// Delays between samples, from the whole recording.
pub fn options(method: Method) -> DelayOptions {
    DelayOptions {
        method,
        between_samples: true,
        window: None,
        start: None,
    }
}

/// Samples of M1, M2 and M3.
pub fn channels(recording: &Recording) -> [&[f64]; 3] {
    let count = recording.samples.len() / 3;
    let (first, rest) = recording.samples.split_at(count);
    let (second, third) = rest.split_at(count);
    [first, second, third]
}

/// Delays of M2 and M3 against M1, in s.
pub fn delays_of(recording: &Recording, method: Method) -> [f64; 2] {
    let channels = channels(recording);
    DelayFinder::new(&ARRAY, RATE, channels[0].len(), options(method))
        .unwrap()
        .delays(channels, GO_ON)
        .unwrap()
        .delays
}
