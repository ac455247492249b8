//! How alike two channels are at every lag.
//!
//! Lag `j` sets sample `k` of the first channel beside sample `k + j` of the other one, so that a
//! positive lag means that the other one receives it later. Lags are signed: with one-sided lags a source
//! on the other side could not be seen.

use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::Interrupted;
use numeric::error::{Failure, Result};

/// Lanes of the sums, for speed; part of the result's last bits.
const LANES: usize = 8;
/// Parts of the spectrum below this share of its largest value have no phase that could be used.
const NO_PHASE: f64 = 1e-12;

type Number = Complex<f64>;

/// Which likeness of two channels is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Mean square of the difference, over the samples that overlap: corrected (5), whose similarity
    /// is its inverse. Small is alike.
    MeanSquare,
    /// Mean product over the samples that overlap, by FFT.
    CrossCorrelation,
    /// Correlation of the phases alone (GCC-PHAT), by FFT, of frequencies in a band in Hz.
    Phase {
        /// Lowest and highest frequency, in Hz.
        band: [f64; 2],
    },
}

impl Method {
    /// Whether a small value means that the channels are alike.
    #[must_use]
    pub fn small_is_alike(self) -> bool {
        matches!(self, Self::MeanSquare)
    }
}

/// Mean square differences at the lags `-limit ..= limit`; channels are of one length above `limit`.
///
/// # Errors
/// The caller asks to stop.
pub fn mean_square(
    first: &[f64],
    other: &[f64],
    limit: usize,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    let count = first.len();
    let mean = |place: usize| {
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        let shift = place.abs_diff(limit);
        let sum = if place < limit {
            square_sum(&first[shift..], other)
        } else {
            square_sum(first, &other[shift..])
        };
        Ok(sum / (count - shift) as f64)
    };
    (0..=2 * limit).map(mean).collect()
}

/// Sum of the squared differences of the samples that two slices have in common.
fn square_sum(one: &[f64], other: &[f64]) -> f64 {
    let count = one.len().min(other.len());
    let (one, other) = (&one[..count], &other[..count]);
    let mut lanes = [0.0; LANES];
    let (ones, others) = (one.chunks_exact(LANES), other.chunks_exact(LANES));
    let rest: f64 = ones
        .remainder()
        .iter()
        .zip(others.remainder())
        .map(|(a, b)| (a - b) * (a - b))
        .sum();
    for (a, b) in ones.zip(others) {
        for lane in 0..LANES {
            let difference = a[lane] - b[lane];
            lanes[lane] += difference * difference;
        }
    }
    lanes.iter().sum::<f64>() + rest
}

/// Cross-correlation of the first channel with the other two by FFT, with its plans and buffers.
pub struct Correlator {
    count: usize,
    limit: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    first: Vec<Number>,
    others: Vec<Number>,
    scratch: Vec<Number>,
}

impl Correlator {
    /// Plans for channels with so many samples and lags up to a limit below that.
    #[must_use]
    pub fn new(count: usize, limit: usize) -> Self {
        // Lags beyond the limit may wrap around: nobody looks at them.
        let size = smooth_size(count + limit);
        let mut planner = FftPlanner::new();
        let (forward, inverse) = (
            planner.plan_fft_forward(size),
            planner.plan_fft_inverse(size),
        );
        let scratch = forward
            .get_inplace_scratch_len()
            .max(inverse.get_inplace_scratch_len());
        let zero = Number::new(0.0, 0.0);
        Self {
            count,
            limit,
            forward,
            inverse,
            first: vec![zero; size],
            others: vec![zero; size],
            scratch: vec![zero; scratch],
        }
    }

    /// Likeness of M1 with M2 and with M3 at the lags `-limit ..= limit`.
    ///
    /// Two real channels share each transform, and so do the two real results.
    ///
    /// # Errors
    /// The caller asks to stop, which is looked at between the transforms.
    pub fn curves(
        &mut self,
        channels: [&[f64]; 3],
        phase_of: Option<PhaseBins>,
        interrupted: Interrupted<'_>,
    ) -> Result<[Vec<f64>; 2]> {
        let attend = || {
            if interrupted() {
                Err(Failure::Interrupted)
            } else {
                Ok(())
            }
        };
        let zero = Number::new(0.0, 0.0);
        self.first.fill(zero);
        self.others.fill(zero);
        for (bin, value) in self.first.iter_mut().zip(channels[0]) {
            *bin = Number::new(*value, 0.0);
        }
        let pairs = channels[1].iter().zip(channels[2]);
        for (bin, (second, third)) in self.others.iter_mut().zip(pairs) {
            *bin = Number::new(*second, *third);
        }
        attend()?;
        self.forward
            .process_with_scratch(&mut self.first, &mut self.scratch);
        attend()?;
        self.forward
            .process_with_scratch(&mut self.others, &mut self.scratch);
        attend()?;
        let scale = match phase_of {
            None => {
                self.multiply();
                1.0
            }
            Some(bins) => self.multiply_phases(bins),
        };
        attend()?;
        self.inverse
            .process_with_scratch(&mut self.others, &mut self.scratch);
        Ok(self.unpacked(scale, phase_of.is_none()))
    }

    /// Products with the conjugate spectrum of M1.
    fn multiply(&mut self) {
        for (other, first) in self.others.iter_mut().zip(&self.first) {
            // Both cross spectra at once: the packing is linear.
            *other *= first.conj();
        }
    }

    /// Phases of the cross spectra, packed; returns how many bins count.
    fn multiply_phases(&mut self, bins: PhaseBins) -> f64 {
        let size = self.others.len();
        let largest = self.first.iter().map(Number::norm_sqr).fold(0.0, f64::max);
        let heard = self.others.iter().map(Number::norm_sqr).fold(0.0, f64::max);
        let least = NO_PHASE * (largest * heard).sqrt();
        let zero = Number::new(0.0, 0.0);
        let mut used = 0.0;
        for low in 0..=size / 2 {
            let high = (size - low) % size;
            let (a, b) = (self.others[low], self.others[high].conj());
            let inside = (bins.first..=bins.last).contains(&low);
            // Spectra of M2 and M3 at the lower of the two frequencies.
            let second = (a + b) * 0.5;
            let third = (a - b) * Number::new(0.0, -0.5);
            let [p, q] = [second, third].map(|spectrum| {
                let cross = spectrum * self.first[low].conj();
                let size = cross.norm();
                if inside && size > least {
                    cross / size
                } else {
                    zero
                }
            });
            let i = Number::new(0.0, 1.0);
            self.others[low] = p + i * q;
            self.others[high] = p.conj() + i * q.conj();
            if inside {
                used += if low == high { 1.0 } else { 2.0 };
            }
        }
        if used > 0.0 { used } else { 1.0 }
    }

    /// The lags that count, as means over the overlap, or as shares of the bins that count.
    fn unpacked(&self, scale: f64, mean: bool) -> [Vec<f64>; 2] {
        let size = self.others.len();
        let lags = (0..=2 * self.limit).map(|place| {
            let value = self.others[(place + size - self.limit) % size];
            let missing = place.abs_diff(self.limit);
            if mean {
                value / (size as f64 * (self.count - missing) as f64)
            } else {
                value / scale
            }
        });
        lags.map(|value| (value.re, value.im)).unzip().into()
    }
}

/// Bins of a spectrum whose phases count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhaseBins {
    first: usize,
    last: usize,
}

impl PhaseBins {
    /// Bins of a band in Hz in a transform of a correlator.
    #[must_use]
    pub fn of(correlator: &Correlator, band: [f64; 2], sample_rate: f64) -> Self {
        let per_hertz = correlator.others.len() as f64 / sample_rate;
        Self {
            first: (band[0] * per_hertz).ceil() as usize,
            last: (band[1] * per_hertz).floor() as usize,
        }
    }
}

/// Smallest product of powers of 2, 3 and 5 that is large enough: such transforms are fast.
fn smooth_size(least: usize) -> usize {
    let mut best = least.max(1).next_power_of_two();
    let mut fives = 1;
    while fives < best {
        let mut odd = fives;
        while odd < best {
            let mut size = odd;
            while size < least {
                size *= 2;
            }
            best = best.min(size);
            odd *= 3;
        }
        fives *= 5;
    }
    best
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::{Correlator, smooth_size};
    use numeric::error::Failure;

    #[test]
    fn it_stops_before_each_transform() {
        let channel = [0.5; 100];
        for looks in 0..4 {
            let looked = AtomicUsize::new(0);
            let stopped = || looked.fetch_add(1, Ordering::Relaxed) >= looks;
            let found = Correlator::new(100, 5).curves([&channel; 3], None, &stopped);
            assert!(matches!(found, Err(Failure::Interrupted)), "{looks}");
        }
        assert!(
            Correlator::new(100, 5)
                .curves([&channel; 3], None, &|| false)
                .is_ok()
        );
    }

    #[test]
    fn smooth_sizes_are_the_next_products_of_two_three_and_five() {
        let smooth = |mut n: usize| {
            for prime in [2, 3, 5] {
                while n.is_multiple_of(prime) {
                    n /= prime;
                }
            }
            n == 1
        };
        for least in 1..3001 {
            let next = (least..4096).find(|n| smooth(*n)).unwrap();
            assert_eq!(smooth_size(least), next, "{least}");
        }
    }
}
