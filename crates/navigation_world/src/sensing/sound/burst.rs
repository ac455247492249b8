//! Sounds that a source sends: band-limited noise, sweeps, tones.

use std::f64::consts::{PI, SQRT_2, TAU};

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::interpolation::Interpolator;
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::random::Stream;

/// Samples of the noise for each period of its highest frequency; half of the Nyquist frequency is
/// what the interpolator is made for.
const OVERSAMPLING: f64 = 4.0;
/// Stream of the noise that a burst consists of; streams from 0 up belong to the microphones.
const CONTENT: u64 = u64::MAX;
/// Most samples that the noise of a burst may have: its transform takes a tenth of a second. At 8 kHz
/// that is a minute.
const MOST_SAMPLES: f64 = 2_097_152.0;

/// Waveform of a burst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sound {
    /// Gaussian noise between two frequencies in Hz.
    Noise {
        /// Lowest frequency, in Hz.
        low: f64,
        /// Highest frequency, in Hz.
        high: f64,
        /// Seed of the noise.
        seed: u64,
    },
    /// A frequency that rises evenly from one to another, in Hz.
    Sweep {
        /// First frequency, in Hz.
        low: f64,
        /// Last frequency, in Hz.
        high: f64,
    },
    /// One frequency.
    Tone {
        /// The frequency, in Hz.
        frequency: f64,
    },
}

/// A sound of limited length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burst {
    /// Waveform.
    pub sound: Sound,
    /// Length, in s.
    pub duration: f64,
    /// Root mean square at 1 m from the source, as a share of the converter's full scale.
    pub level: f64,
    /// Time over which it begins and ends, in s.
    pub ramp: f64,
}

impl Burst {
    /// The burst, if its numbers can be.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("duration", self.duration)?;
        positive("level", self.level)?;
        not_negative("ramp", self.ramp)?;
        if 2.0 * self.ramp > self.duration {
            let given = Given::Number(self.ramp);
            return Err(Failure::invalid(
                "ramp",
                "be at most half of duration",
                given,
            ));
        }
        match self.sound {
            Sound::Tone { frequency } => {
                positive("frequency", frequency)?;
            }
            Sound::Noise { low, high, .. } | Sound::Sweep { low, high } => {
                positive("low", low)?;
                positive("high", high)?;
                if low >= high {
                    let given = Given::Number(high);
                    return Err(Failure::invalid("high", "be above low", given));
                }
            }
        }
        if matches!(self.sound, Sound::Noise { .. }) {
            let samples = self.duration * OVERSAMPLING * self.highest();
            if samples > MOST_SAMPLES {
                let given = Given::Number(self.duration);
                let rule = "be shorter for so high a frequency";
                return Err(Failure::invalid("duration", rule, given));
            }
            if self.bins().is_none() {
                let given = Given::Number(self.duration);
                let rule = "be long enough for a frequency of the band";
                return Err(Failure::invalid("duration", rule, given));
            }
        }
        Ok(self)
    }

    /// Highest frequency, in Hz.
    #[must_use]
    pub fn highest(&self) -> f64 {
        match self.sound {
            Sound::Noise { high, .. } | Sound::Sweep { high, .. } => high,
            Sound::Tone { frequency } => frequency,
        }
    }

    /// First and last multiple of the base frequency `1 / period` in the band of the noise.
    fn bins(&self) -> Option<(usize, usize)> {
        let Sound::Noise { low, high, .. } = self.sound else {
            return None;
        };
        let period = self.noise_samples() as f64 / (OVERSAMPLING * high);
        let (first, last) = ((low * period).ceil(), (high * period).floor());
        (first <= last).then_some((first as usize, last as usize))
    }

    fn noise_samples(&self) -> usize {
        (self.duration * OVERSAMPLING * self.highest()).ceil() as usize
    }
}

/// A burst as a function of time, at 1 m from the source.
#[derive(Clone, Debug)]
pub struct Signal {
    burst: Burst,
    noise: Vec<f64>,
    interpolator: Interpolator,
}

impl Signal {
    /// The burst as a function; noise is drawn once.
    ///
    /// # Errors
    /// A number of the burst is out of range.
    pub fn new(burst: Burst) -> Result<Self> {
        let burst = burst.checked()?;
        Ok(Self {
            burst,
            noise: noise_of(&burst),
            interpolator: Interpolator::new(),
        })
    }

    /// The burst.
    #[must_use]
    pub fn burst(&self) -> &Burst {
        &self.burst
    }

    /// Sound at a time after the beginning (s), as a share of full scale.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let Burst {
            sound,
            duration,
            level,
            ramp,
        } = self.burst;
        if !(0.0..=duration).contains(&time) {
            return 0.0;
        }
        let value = match sound {
            Sound::Noise { high, .. } => self
                .interpolator
                .periodic(&self.noise, OVERSAMPLING * high * time),
            Sound::Sweep { low, high } => {
                let cycles = time * (low + (high - low) * time / (2.0 * duration));
                SQRT_2 * (TAU * cycles).sin()
            }
            Sound::Tone { frequency } => SQRT_2 * (TAU * frequency * time).sin(),
        };
        let edge = time.min(duration - time);
        let swell = if edge < ramp {
            0.5 * (1.0 - (PI * edge / ramp).cos())
        } else {
            1.0
        };
        level * swell * value
    }
}

/// Noise with a root mean square of one that repeats itself; empty for other sounds.
fn noise_of(burst: &Burst) -> Vec<f64> {
    let (Sound::Noise { seed, .. }, Some((first, last))) = (burst.sound, burst.bins()) else {
        return Vec::new();
    };
    let count = burst.noise_samples();
    let mut stream = Stream::new(seed, CONTENT);
    let mut spectrum = vec![Complex::new(0.0, 0.0); count];
    for bin in spectrum.iter_mut().take(last + 1).skip(first) {
        let [re, im] = stream.normals();
        *bin = Complex::new(re, im);
    }
    // The real part of one-sided spectra is the noise.
    FftPlanner::new()
        .plan_fft_inverse(count)
        .process(&mut spectrum);
    let square: f64 = spectrum.iter().map(|value| value.re * value.re).sum();
    let scale = (count as f64 / square).sqrt();
    spectrum.iter().map(|value| scale * value.re).collect()
}

/// Frequency that is heard, corrected (1): `f (c + v_obs) / (c - v_src)` with speeds (m/s) that are
/// positive when they close the distance.
///
/// # Errors
/// A number is not finite, the frequency or the speed of sound not positive, or a speed not below
/// that of sound.
pub fn doppler_frequency(
    frequency: f64,
    speed_of_sound: f64,
    observer_speed: f64,
    source_speed: f64,
) -> Result<f64> {
    positive("frequency", frequency)?;
    Ok(frequency * doppler_factor(speed_of_sound, observer_speed, source_speed)?)
}

/// Factor of all frequencies by motion, see [`doppler_frequency`].
///
/// # Errors
/// A number is not finite, the speed of sound not positive, or a speed not below it.
pub fn doppler_factor(speed_of_sound: f64, observer_speed: f64, source_speed: f64) -> Result<f64> {
    positive("speed_of_sound", speed_of_sound)?;
    for (name, speed) in [
        ("observer_speed", observer_speed),
        ("source_speed", source_speed),
    ] {
        if speed.is_nan() || speed.abs() >= speed_of_sound {
            let rule = "be finite and slower than sound";
            return Err(Failure::invalid(name, rule, Given::Number(speed)));
        }
    }
    Ok((speed_of_sound + observer_speed) / (speed_of_sound - source_speed))
}
