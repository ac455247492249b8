//! Delays of a sound between microphones, from samples.

use super::Interrupted;
use super::correlation::{Correlator, Method, PhaseBins, mean_square};
use super::microphones::MicrophoneArray;
use numeric::error::{Failure, Given, Result, positive};

/// Most samples that are compared: their transforms take a fraction of a second.
const MOST_COMPARED: usize = 1 << 22;

/// How delays are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DelayOptions {
    /// Signals that are compared.
    pub method: Method,
    /// Whether the peak is placed between samples, by a parabola through three values; whole samples
    /// as in (6) otherwise.
    pub between_samples: bool,
    /// Number of consecutive samples that are compared; all of them when `None`.
    pub window: Option<usize>,
    /// First sample of the window; where its energy is largest when `None`.
    pub start: Option<usize>,
}

/// Delays of M2 and M3 against M1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delays {
    /// `dt_12` and `dt_13`, in s; NaN when a channel is silent.
    pub delays: [f64; 2],
    /// Lags of the peaks, in whole samples.
    pub lags: [i64; 2],
    /// Correlation coefficients of the channels at these lags, from -1 to 1.
    pub likeness: [f64; 2],
    /// First sample of the window.
    pub start: usize,
}

/// Likeness over lag, of M1 with M2 and with M3.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// Largest lags on either side; values stand at `-limit ..= limit`.
    pub limits: [usize; 2],
    /// Values, see [`Method`].
    pub values: [Vec<f64>; 2],
}

/// Finds delays in recordings of one length, keeping plans and buffers.
pub struct DelayFinder {
    options: DelayOptions,
    sample_rate: f64,
    count: usize,
    window: usize,
    limits: [usize; 2],
    correlator: Option<Correlator>,
    centered: [Vec<f64>; 3],
    silent: [bool; 3],
}

impl DelayFinder {
    /// A finder for channels of so many samples.
    ///
    /// # Errors
    /// An option is out of range or the window not longer than the lags that have to be searched.
    pub fn new(
        array: &MicrophoneArray,
        sample_rate: f64,
        count: usize,
        options: DelayOptions,
    ) -> Result<Self> {
        let rate = positive("sample_rate", sample_rate)?;
        let limits = array.checked()?.lag_limits(rate);
        let window = options.window.unwrap_or(count);
        check_window(&options, window, count, limits[1])?;
        if let Method::Phase { band: [low, high] } = options.method
            && !(0.0 <= low && low < high && high <= 0.5 * rate)
        {
            let rule = "rise from 0 or more to half the sample rate or less";
            let given = Given::Pair([low, high]);
            return Err(Failure::invalid("band", rule, given));
        }
        let by_transform = options.method != Method::MeanSquare;
        Ok(Self {
            options,
            sample_rate: rate,
            count,
            window,
            limits,
            correlator: by_transform.then(|| Correlator::new(window, limits[1])),
            centered: [const { Vec::new() }; 3],
            silent: [false; 3],
        })
    }

    /// Likeness over lag within the window.
    ///
    /// # Errors
    /// The channels have another length, a sample is not finite, or the caller asks to stop.
    pub fn curves(
        &mut self,
        channels: [&[f64]; 3],
        interrupted: Interrupted<'_>,
    ) -> Result<Curves> {
        self.center(channels)?;
        self.likeness(interrupted)
    }

    /// Delays from the window.
    ///
    /// # Errors
    /// The channels have another length, a sample is not finite, or the caller asks to stop.
    pub fn delays(
        &mut self,
        channels: [&[f64]; 3],
        interrupted: Interrupted<'_>,
    ) -> Result<Delays> {
        let start = self.center(channels)?;
        let curves = self.likeness(interrupted)?;
        let mut found = Delays {
            delays: [f64::NAN; 2],
            lags: [0; 2],
            likeness: [f64::NAN; 2],
            start,
        };
        for pair in 0..2 {
            if self.silent[0] || self.silent[pair + 1] {
                continue;
            }
            let (first, other) = (&self.centered[0], &self.centered[pair + 1]);
            let (lag, share) = self.peak(&curves.values[pair], curves.limits[pair]);
            found.lags[pair] = lag;
            found.delays[pair] = (lag as f64 + share) / self.sample_rate;
            found.likeness[pair] = coefficient(first, other, lag);
        }
        Ok(found)
    }

    /// Cuts the window out and takes the mean off each channel; returns the window's first sample.
    fn center(&mut self, channels: [&[f64]; 3]) -> Result<usize> {
        for channel in channels {
            if channel.len() != self.count {
                let given = Given::Count(channel.len() as u64);
                let rule = "have channels of the length that the finder is for";
                return Err(Failure::invalid("samples", rule, given));
            }
            if let Some(value) = channel.iter().find(|value| !value.is_finite()) {
                let given = Given::Number(*value);
                return Err(Failure::invalid("samples", "be finite", given));
            }
        }
        let start = self
            .options
            .start
            .unwrap_or_else(|| loudest(channels, self.window));
        for (place, channel) in channels.into_iter().enumerate() {
            let samples = &channel[start..start + self.window];
            let mean = samples.iter().sum::<f64>() / self.window as f64;
            // Rounding of the mean must not pass for sound.
            self.silent[place] = samples.iter().all(|value| *value == samples[0]);
            self.centered[place].clear();
            self.centered[place].extend(samples.iter().map(|value| value - mean));
        }
        Ok(start)
    }

    fn likeness(&mut self, interrupted: Interrupted<'_>) -> Result<Curves> {
        let [first, second, third] = self.centered.each_ref().map(Vec::as_slice);
        let mut values = match &mut self.correlator {
            None => [
                mean_square(first, second, self.limits[0], interrupted)?,
                mean_square(first, third, self.limits[1], interrupted)?,
            ],
            Some(correlator) => {
                let bins = match self.options.method {
                    Method::Phase { band } => {
                        Some(PhaseBins::of(correlator, band, self.sample_rate))
                    }
                    _ => None,
                };
                correlator.curves([first, second, third], bins, interrupted)?
            }
        };
        // A transform has the lags of the outer pair for both.
        let spare = values[0].len() / 2 - self.limits[0];
        values[0].truncate(2 * self.limits[0] + 1 + spare);
        values[0].drain(..spare);
        Ok(Curves {
            limits: self.limits,
            values,
        })
    }

    /// Lag of the best value, and where between its neighbors the peak is.
    fn peak(&self, values: &[f64], limit: usize) -> (i64, f64) {
        let small = self.options.method.small_is_alike();
        let mut best = 0;
        for (place, value) in values.iter().enumerate() {
            if (small && *value < values[best]) || (!small && *value > values[best]) {
                best = place;
            }
        }
        let lag = best as i64 - limit as i64;
        let inside = best > 0 && best + 1 < values.len();
        if !self.options.between_samples || !inside {
            return (lag, 0.0);
        }
        let [before, at, after] = [values[best - 1], values[best], values[best + 1]];
        let bend = before - 2.0 * at + after;
        let share = if bend == 0.0 {
            0.0
        } else {
            0.5 * (before - after) / bend
        };
        (lag, share)
    }
}

fn check_window(options: &DelayOptions, window: usize, count: usize, limit: usize) -> Result<()> {
    if window <= limit {
        let (name, given) = match options.window {
            Some(window) => ("window", window),
            None => ("samples", count),
        };
        let rule = "have more samples than the longest lag that is searched";
        return Err(Failure::invalid(name, rule, Given::Count(given as u64)));
    }
    if window > MOST_COMPARED {
        let given = Given::Count(window as u64);
        let rule = "be at most 4194304 samples";
        return Err(Failure::invalid("window", rule, given));
    }
    if window > count {
        let given = Given::Count(window as u64);
        return Err(Failure::invalid("window", "fit into the recording", given));
    }
    match options.start {
        Some(start) if start > count - window => {
            let given = Given::Count(start as u64);
            Err(Failure::invalid(
                "start",
                "leave room for the window",
                given,
            ))
        }
        _ => Ok(()),
    }
}

fn energy(samples: &[f64]) -> f64 {
    samples.iter().map(|value| value * value).sum()
}

/// Correlation coefficient of two channels at a lag.
fn coefficient(first: &[f64], other: &[f64], lag: i64) -> f64 {
    let shift = lag.unsigned_abs() as usize;
    let (one, two) = if lag >= 0 {
        (&first[..first.len() - shift], &other[shift..])
    } else {
        (&first[shift..], &other[..other.len() - shift])
    };
    let product: f64 = one.iter().zip(two).map(|(a, b)| a * b).sum();
    let size = (energy(one) * energy(two)).sqrt();
    if size > 0.0 { product / size } else { 0.0 }
}

/// First sample of the window with the largest energy of all channels together.
fn loudest(channels: [&[f64]; 3], window: usize) -> usize {
    let count = channels[0].len();
    if window == count {
        return 0;
    }
    let means = channels.map(|channel| channel.iter().sum::<f64>() / count as f64);
    let power = |k: usize| -> f64 {
        channels
            .iter()
            .zip(means)
            .map(|(channel, mean)| (channel[k] - mean).powi(2))
            .sum()
    };
    let mut sum: f64 = (0..window).map(power).sum();
    let (mut best, mut largest) = (0, sum);
    for start in 1..=count - window {
        sum += power(start + window - 1) - power(start - 1);
        if sum > largest {
            (best, largest) = (start, sum);
        }
    }
    best
}
