//! Recording of a burst by three microphones and a converter.

use super::Interrupted;
use super::burst::{Signal, doppler_factor};
use super::microphones::MicrophoneArray;
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};
use numeric::random::Stream;

/// Most samples of a channel.
const MOST_SAMPLES: f64 = 1e8;
const MOST_BITS: u32 = 32;
/// Samples between two looks whether to stop.
const CHECK: usize = 1 << 14;

/// Analog-to-digital converter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    /// Samples per second, in Hz.
    pub sample_rate: f64,
    /// Number of bits; no rounding and no limit when `None`.
    pub bits: Option<u32>,
}

impl Converter {
    /// The converter, if its numbers can be.
    ///
    /// # Errors
    /// The rate is not finite and positive, or the bits are not 2 to 32.
    pub fn checked(self) -> Result<Self> {
        positive("sample_rate", self.sample_rate)?;
        match self.bits {
            Some(bits) if !(2..=MOST_BITS).contains(&bits) => {
                let given = Given::Count(u64::from(bits));
                Err(Failure::invalid("bits", "be 2 to 32 or None", given))
            }
            _ => Ok(self),
        }
    }

    /// Value that is put out, and whether the input was beyond the scale from -1 to 1.
    fn convert(&self, value: f64) -> (f64, bool) {
        let Some(bits) = self.bits else {
            return (value, false);
        };
        let steps = 2.0_f64.powi(bits as i32 - 1);
        let level = (value * steps).round();
        let kept = level.clamp(-steps, steps - 1.0);
        (kept / steps, kept != level)
    }
}

/// Where and how a burst is heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hearing {
    /// Range from M2 when the burst arrives, in m.
    pub range: f64,
    /// Bearing then, in rad.
    pub bearing: f64,
    /// Speed of the microphones towards the source, in m/s.
    pub observer_speed: f64,
    /// Speed of the source towards the microphones, in m/s.
    pub source_speed: f64,
    /// Root mean square of the noise of each sample, as a share of full scale.
    pub noise: f64,
    /// Time from the first sample to the first arrival, in s; negative when the record begins
    /// within the burst.
    pub lead: f64,
    /// Samples of each channel; those from the lead before the burst to as long after it when
    /// `None`.
    pub samples: Option<usize>,
}

/// Samples of M1, M2, M3, one channel after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Samples of all channels, as shares of full scale.
    pub samples: Vec<f64>,
    /// Samples of each channel that were beyond the scale.
    pub clipped: [usize; 3],
}

impl Hearing {
    /// Samples of each channel.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn count(&self, signal: &Signal, array: &MicrophoneArray, rate: f64) -> Result<usize> {
        positive("range", self.range)?;
        finite("bearing", self.bearing)?;
        not_negative("noise", self.noise)?;
        finite("lead", self.lead)?;
        let factor = doppler_factor(array.speed_of_sound, self.observer_speed, self.source_speed)?;
        if let Some(samples) = self.samples {
            if samples as f64 > MOST_SAMPLES {
                let given = Given::Count(samples as u64);
                return Err(Failure::invalid("samples", "be at most 1e8", given));
            }
            return Ok(samples);
        }
        let spread = 2.0 * array.spacing / array.speed_of_sound;
        let length = 2.0 * self.lead + signal.burst().duration / factor + spread;
        let count = (length * rate).ceil();
        if !(1.0..=MOST_SAMPLES).contains(&count) {
            let given = Given::Number(self.lead);
            let rule = "leave at least one and at most 1e8 samples";
            return Err(Failure::invalid("lead", rule, given));
        }
        Ok(count as usize)
    }
}

/// Records a burst: amplitude falls with 1/R, arrival with R/c, motion changes all frequencies
/// alike, and every sample of every channel has its own Gaussian noise before it is converted.
///
/// `run` picks the noise among those of a seed.
///
/// # Errors
/// A number is out of range, the burst has frequencies that the converter cannot sample, or the
/// caller asks to stop.
pub fn record(
    signal: &Signal,
    array: &MicrophoneArray,
    converter: &Converter,
    hearing: &Hearing,
    seed: u64,
    run: u64,
    interrupted: Interrupted<'_>,
) -> Result<Recording> {
    let rate = converter.checked()?.sample_rate;
    let count = hearing.count(signal, &array.checked()?, rate)?;
    let factor = doppler_factor(
        array.speed_of_sound,
        hearing.observer_speed,
        hearing.source_speed,
    )?;
    if signal.burst().highest() * factor >= 0.5 * rate {
        let given = Given::Number(rate);
        let rule = "be more than twice the highest frequency that arrives";
        return Err(Failure::invalid("sample_rate", rule, given));
    }
    let distances = array.distances(hearing.range, hearing.bearing);
    let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
    if nearest <= 0.0 {
        let given = Given::Number(hearing.range);
        return Err(Failure::invalid("range", "keep off the microphones", given));
    }
    let mut samples = Vec::with_capacity(3 * count);
    let mut clipped = [0; 3];
    for (channel, distance) in distances.into_iter().enumerate() {
        let mut stream = Stream::new(seed, run.wrapping_mul(3).wrapping_add(channel as u64));
        let begin = hearing.lead + (distance - nearest) / array.speed_of_sound;
        let heard = |k: usize| signal.at(factor * (k as f64 / rate - begin)) / distance;
        let mut noise = [0.0; 2];
        for k in 0..count {
            if k % CHECK == 0 && interrupted() {
                return Err(Failure::Interrupted);
            }
            if hearing.noise > 0.0 && k % 2 == 0 {
                noise = stream.normals();
            }
            let (value, beyond) = converter.convert(heard(k) + hearing.noise * noise[k % 2]);
            samples.push(value);
            clipped[channel] += usize::from(beyond);
        }
    }
    Ok(Recording { samples, clipped })
}
