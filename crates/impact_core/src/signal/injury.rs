//! Head injury criterion of a sampled signal.

#[cfg(test)]
mod tests;

use super::cells::Cells;
use super::search::{Best, Block, Leaf, higher, lower, search_until};
use super::{CHECK, collected};
use super::{Signal, WINDOW_SLACK};
use crate::error::{Result, positive, proceed};
use numeric::threads::Interrupted;

/// Samples in one undivided block.
const BLOCK: usize = 8;

/// Improvements of the best of them, at most.
const ROUNDS: usize = 8;

/// Windows that are tried before the search, at most.
const SEEDS: usize = 256;

/// Largest value of the head injury criterion and where it is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadInjury {
    /// Value, in g^2.5 s; 0 where no window has a positive mean.
    pub value: f64,
    /// Start of the window, in s.
    pub start: f64,
    /// End of the window, in s; equal to the start where the value is 0.
    pub end: f64,
}

/// Head injury criterion: the maximum of `(t2 - t1) mean^2.5` over all windows `t2 - t1 <= window`,
/// with the mean acceleration in g (zeng2011, 2.1.1, with the power where it belongs).
///
/// Windows start and end at samples and the mean is the trapezoid sum; with `interpolate` the signal
/// is piecewise linear and the ends are free. Windows with a negative mean count 0. A window of
/// samples may be longer than `window` by 1e-9 of it, for rounding of the times.
///
/// The maximum is global: see the module of the search for how it stays near O(n).
///
/// # Errors
/// Times that do not rise, fewer than two samples, unequal lengths, numbers that are not finite, a
/// window that is not positive, or the caller asked to stop.
pub fn hic(
    time: &[f64],
    acceleration_g: &[f64],
    window: f64,
    interpolate: bool,
    interrupted: Interrupted<'_>,
) -> Result<HeadInjury> {
    let signal = Signal::new_until(time, acceleration_g, interrupted)?;
    positive("window", window)?;
    let peak = highest(acceleration_g);
    proceed(interrupted)?;
    if peak <= 0.0 {
        return Ok(HeadInjury {
            value: 0.0,
            start: time[0],
            end: time[0],
        });
    }
    // Scaled to a peak of 1: fifth powers neither overflow nor vanish.
    let scaled = collected(time.len(), interrupted, |k| acceleration_g[k] / peak)?;
    let signal = Signal {
        value: &scaled,
        ..signal
    };
    let integral = signal.integral_until(interrupted)?;
    let best = if interpolate {
        let cells = Cells::new_until(signal, &integral, window, interrupted)?;
        let known = seed(time, &integral, window, interrupted)?;
        let blocks = cells.blocks_until(interrupted)?;
        search_until(blocks, window, &cells, known, interrupted)?
    } else {
        let window = longest_window(time, window * (1.0 + WINDOW_SLACK), interrupted)?;
        let samples = Samples {
            signal,
            integral: &integral,
            window,
        };
        let known = seed(time, &integral, window, interrupted)?;
        let blocks = samples.blocks(interrupted)?;
        let found = search_until(blocks, window, &samples, known, interrupted)?;
        samples.summed_again(found)
    };
    if best.squared == 0.0 {
        return Ok(HeadInjury {
            value: 0.0,
            start: time[0],
            end: time[0],
        });
    }
    Ok(HeadInjury {
        value: best.length * (peak * best.integral / best.length).powf(2.5),
        start: best.start,
        end: best.end,
    })
}

/// The largest of finite values, in lanes that the compiler can keep side by side.
fn highest(values: &[f64]) -> f64 {
    let mut lanes = [f64::NEG_INFINITY; 8];
    let (chunks, rest) = values.as_chunks::<8>();
    for chunk in chunks {
        for (lane, &value) in lanes.iter_mut().zip(chunk) {
            *lane = if value > *lane { value } else { *lane };
        }
    }
    lanes
        .iter()
        .chain(rest)
        .copied()
        .fold(f64::NEG_INFINITY, f64::max)
}

/// The longest window of samples that is not longer than `limit`. As a limit of its own it makes the
/// bounds sharp: the slack for rounding would leave room above every full window.
fn longest_window(time: &[f64], limit: f64, interrupted: Interrupted<'_>) -> Result<f64> {
    let mut start = 0;
    let mut longest = 0.0_f64;
    for part in time.chunks(CHECK) {
        proceed(interrupted)?;
        for &end in part {
            while end - time[start] > limit {
                start += 1;
            }
            if end - time[start] > longest {
                longest = end - time[start];
            }
        }
    }
    Ok(longest)
}

/// A good window between samples: the best of some full windows, improved end by end.
fn seed(time: &[f64], integral: &[f64], window: f64, interrupted: Interrupted<'_>) -> Result<Best> {
    let last = time.len() - 1;
    let mut best = Best::NONE;
    let (mut start, mut end) = (0, last);
    // Whether this window is the best one now.
    let mut better = |from: usize, to: usize| {
        let before = best.squared;
        let ends = [time[from], time[to]];
        best.offer(ends, ends[1] - ends[0], integral[to] - integral[from]);
        best.squared > before
    };
    let mut reach = 0;
    for from in (0..last).step_by(time.len().div_ceil(SEEDS)) {
        proceed(interrupted)?;
        while reach < last && time[reach + 1] - time[from] <= window {
            reach += 1;
        }
        if reach > from && better(from, reach) {
            (start, end) = (from, reach);
        }
    }
    for _ in 0..ROUNDS {
        proceed(interrupted)?;
        let before = (start, end);
        for from in (0..end).rev() {
            if time[end] - time[from] > window {
                break;
            }
            if better(from, end) {
                start = from;
            }
        }
        for to in start + 1..=last {
            if time[to] - time[start] > window {
                break;
            }
            if better(start, to) {
                end = to;
            }
        }
        if before == (start, end) {
            break;
        }
    }
    Ok(best)
}

/// Windows that start and end at samples.
struct Samples<'a> {
    signal: Signal<'a>,
    integral: &'a [f64],
    window: f64,
}

impl Samples<'_> {
    fn blocks(&self, interrupted: Interrupted<'_>) -> Result<Vec<Block>> {
        let last_sample = self.integral.len() - 1;
        collected(last_sample / BLOCK + 1, interrupted, |index| {
            let first = BLOCK * index;
            let last = last_sample.min(first + BLOCK - 1);
            let mut low = self.integral[first];
            let mut high = low;
            let mut steepest = f64::NEG_INFINITY;
            for &integral in &self.integral[first + 1..=last] {
                low = lower(low, integral);
                high = higher(high, integral);
            }
            let next = last_sample.min(last + 1);
            for pair in self.signal.value[first..=next].windows(2) {
                steepest = higher(steepest, 0.5 * (pair[0] + pair[1]));
            }
            Block {
                first: self.signal.time[first],
                last: self.signal.time[last],
                first_integral: self.integral[first],
                last_integral: self.integral[last],
                low,
                high,
                steepest,
            }
        })
    }
}

impl Samples<'_> {
    /// The window with its integral summed over its own samples: the difference of two integrals
    /// from the first sample on has lost digits where those are much larger.
    fn summed_again(&self, best: Best) -> Best {
        let place = |at: f64| self.signal.time.partition_point(|&time| time < at);
        if best.squared == 0.0 {
            return best;
        }
        let range = place(best.start)..=place(best.end);
        let part = Signal {
            time: &self.signal.time[range.clone()],
            value: &self.signal.value[range],
        };
        let integral = part.integral().last().copied().unwrap_or(best.integral);
        Best { integral, ..best }
    }
}

impl Leaf for Samples<'_> {
    fn visit(&self, left: usize, right: usize, best: &mut Best) {
        let time = self.signal.time;
        let ends = BLOCK * right..time.len().min(BLOCK * (right + 1));
        for start in BLOCK * left..time.len().min(BLOCK * (left + 1)) {
            for end in ends.start.max(start + 1)..ends.end {
                if time[end] - time[start] <= self.window {
                    let ends = [time[start], time[end]];
                    let integral = self.integral[end] - self.integral[start];
                    best.offer(ends, ends[1] - ends[0], integral);
                }
            }
        }
    }
}
