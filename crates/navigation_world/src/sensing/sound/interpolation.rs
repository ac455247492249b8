//! Values between samples: windowed sinc.

use std::f64::consts::PI;

/// Samples on either side that a value depends on.
const REACH: usize = 12;
const TAPS: usize = 2 * REACH;
/// Places between two samples at which the weights are tabulated; between them weights are linear,
/// with an error of 2e-6 of the largest one.
const PHASES: usize = 512;
/// Shape of the Kaiser window: for signals up to half of the Nyquist frequency the error of 24 taps
/// is 5e-9 of the signal.
const KAISER: f64 = 18.0;

/// Weights of the samples around a place.
#[derive(Clone, Debug)]
pub struct Interpolator {
    rows: Vec<[f64; TAPS]>,
}

impl Default for Interpolator {
    fn default() -> Self {
        Self::new()
    }
}

impl Interpolator {
    /// Tabulates the weights.
    #[must_use]
    pub fn new() -> Self {
        let middle = bessel_i0(KAISER);
        let rows = (0..=PHASES)
            .map(|phase| weights(phase as f64 / PHASES as f64, middle))
            .collect();
        Self { rows }
    }

    /// Value at a place, in samples from the first one, of a signal that repeats itself.
    #[must_use]
    pub fn periodic(&self, samples: &[f64], place: f64) -> f64 {
        let floor = place.floor();
        let phase = (place - floor) * PHASES as f64;
        let row = (phase as usize).min(PHASES - 1);
        let share = phase - row as f64;
        let (low, high) = (&self.rows[row], &self.rows[row + 1]);
        let count = samples.len().max(1) as i64;
        let first = (floor as i64 - REACH as i64 + 1).rem_euclid(count) as usize;
        let (below, above) = match samples.get(first..first + TAPS) {
            Some(near) => sums(near.iter(), low, high),
            None => sums(samples.iter().cycle().skip(first), low, high),
        };
        below + share * (above - below)
    }
}

/// Sums of samples with two rows of weights.
#[inline]
fn sums<'a>(
    samples: impl Iterator<Item = &'a f64>,
    low: &[f64; TAPS],
    high: &[f64; TAPS],
) -> (f64, f64) {
    samples
        .zip(low.iter().zip(high))
        .fold((0.0, 0.0), |(below, above), (sample, (w, v))| {
            (below + sample * w, above + sample * v)
        })
}

/// Weights of the samples `-REACH + 1 ..= REACH` at a place between 0 and 1, from the window's middle.
fn weights(place: f64, middle: f64) -> [f64; TAPS] {
    let mut row = [0.0; TAPS];
    for (tap, weight) in row.iter_mut().enumerate() {
        let x = tap as f64 - (REACH as f64 - 1.0) - place;
        let inside = 1.0 - (x / REACH as f64).powi(2);
        let sinc = if x == 0.0 {
            1.0
        } else {
            (PI * x).sin() / (PI * x)
        };
        if inside > 0.0 {
            *weight = sinc * bessel_i0(KAISER * inside.sqrt()) / middle;
        }
    }
    row
}

/// Modified Bessel function of the first kind and order zero, by its power series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let (mut term, mut sum, mut k) = (1.0, 1.0, 1.0);
    while term > sum * f64::EPSILON {
        term *= quarter / (k * k);
        sum += term;
        k += 1.0;
    }
    sum
}
