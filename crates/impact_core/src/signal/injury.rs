//! Head injury criterion of a sampled signal.

use super::cells::Cells;
use super::search::{Best, Block, Leaf, higher, lower, search};
use super::{Signal, WINDOW_SLACK};
use crate::error::{Result, positive};

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
/// window that is not positive.
pub fn hic(
    time: &[f64],
    acceleration_g: &[f64],
    window: f64,
    interpolate: bool,
) -> Result<HeadInjury> {
    let signal = Signal::new(time, acceleration_g)?;
    positive("window", window)?;
    let peak = highest(acceleration_g);
    if peak <= 0.0 {
        return Ok(HeadInjury {
            value: 0.0,
            start: time[0],
            end: time[0],
        });
    }
    // Scaled to a peak of 1: fifth powers neither overflow nor vanish.
    let scaled: Vec<f64> = acceleration_g.iter().map(|value| value / peak).collect();
    let signal = Signal {
        value: &scaled,
        ..signal
    };
    let integral = signal.integral();
    let best = if interpolate {
        let cells = Cells::new(signal, &integral, window);
        let known = seed(time, &integral, window);
        search(cells.blocks(), window, &cells, known)
    } else {
        let window = longest_window(time, window * (1.0 + WINDOW_SLACK));
        let samples = Samples {
            signal,
            integral: &integral,
            window,
        };
        let known = seed(time, &integral, window);
        samples.summed_again(search(samples.blocks(), window, &samples, known))
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
fn longest_window(time: &[f64], limit: f64) -> f64 {
    let mut start = 0;
    let mut longest = 0.0_f64;
    for &end in time {
        while end - time[start] > limit {
            start += 1;
        }
        if end - time[start] > longest {
            longest = end - time[start];
        }
    }
    longest
}

/// A good window between samples: the best of some full windows, improved end by end.
fn seed(time: &[f64], integral: &[f64], window: f64) -> Best {
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
        while reach < last && time[reach + 1] - time[from] <= window {
            reach += 1;
        }
        if reach > from && better(from, reach) {
            (start, end) = (from, reach);
        }
    }
    for _ in 0..ROUNDS {
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
    best
}

/// Windows that start and end at samples.
struct Samples<'a> {
    signal: Signal<'a>,
    integral: &'a [f64],
    window: f64,
}

impl Samples<'_> {
    fn blocks(&self) -> Vec<Block> {
        let last_sample = self.integral.len() - 1;
        (0..=last_sample)
            .step_by(BLOCK)
            .map(|first| {
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
            .collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::{hic_half_sine, hic_square, hic_triangle};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    /// Against all windows, one by one: rounding of the integrals only.
    const BRUTE_FORCE: f64 = 1e-12;
    /// Against formulas, with the interpolating form.
    const FORMULA: f64 = 1e-9;

    fn all_sample_windows(time: &[f64], value: &[f64], window: f64) -> f64 {
        let mut best = 0.0_f64;
        for start in 0..time.len() {
            let mut integral = 0.0;
            for end in start + 1..time.len() {
                let length = time[end] - time[start];
                if length > window * (1.0 + WINDOW_SLACK) {
                    break;
                }
                integral += 0.5 * (value[end] + value[end - 1]) * (time[end] - time[end - 1]);
                if integral > 0.0 {
                    best = best.max(length * (integral / length).powf(2.5));
                }
            }
        }
        best
    }

    fn all_cells(time: &[f64], value: &[f64], window: f64) -> f64 {
        let peak = value.iter().copied().fold(0.0, f64::max);
        let scaled: Vec<f64> = value.iter().map(|value| value / peak).collect();
        let signal = Signal {
            time,
            value: &scaled,
        };
        let cells = Cells::new(signal, &signal.integral(), window);
        let mut best = Best::NONE;
        for left in 0..time.len() - 1 {
            for right in left..time.len() - 1 {
                cells.visit(left, right, &mut best);
            }
        }
        best.squared.sqrt() * peak.powf(2.5)
    }

    /// Windows whose ends lie anywhere on a grid that is finer than the samples.
    fn fine_grid(time: &[f64], value: &[f64], window: f64, parts: usize) -> f64 {
        let mut fine_time = vec![time[0]];
        let mut fine_value = vec![value[0]];
        for k in 1..time.len() {
            for part in 1..=parts {
                let share = part as f64 / parts as f64;
                fine_time.push(time[k - 1] + share * (time[k] - time[k - 1]));
                fine_value.push(value[k - 1] + share * (value[k] - value[k - 1]));
            }
        }
        all_sample_windows(&fine_time, &fine_value, window)
    }

    fn close(value: f64, expected: f64, tolerance: f64) -> bool {
        (value - expected).abs() <= tolerance * expected.abs()
    }

    fn any_signal() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
        let step = prop_oneof![Just(1e-4), 1e-5..2e-3];
        let shape = prop_oneof![
            Just((0.0, 1.0)),
            Just((1.0, 0.0)),
            Just((1.0, 0.2)),
            Just((1.0, 0.01)),
        ];
        (2_usize..180, shape, 0.001..0.05).prop_flat_map(move |(samples, (pulse, noise), width)| {
            let steps = proptest::collection::vec(step.clone(), samples);
            let values = proptest::collection::vec(-1.0..1.0_f64, samples);
            (steps, values, 0.0..0.05_f64, -20.0..20.0_f64).prop_map(
                move |(steps, values, center, offset)| {
                    let mut now = offset;
                    let time: Vec<f64> = steps
                        .iter()
                        .map(|step| {
                            now += step;
                            now
                        })
                        .collect();
                    let value = time
                        .iter()
                        .zip(&values)
                        .map(|(time, value)| {
                            let place: f64 = (time - offset - center) / width;
                            80.0 * (pulse * (-place * place).exp() + noise * value)
                        })
                        .collect();
                    (time, value)
                },
            )
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 300,
            rng_seed: RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        #[test]
        fn samples_equal_brute_force((time, value) in any_signal(), window in prop_oneof![Just(0.015), Just(0.036), 0.0005..0.1]) {
            let found = hic(&time, &value, window, false).unwrap();
            let expected = all_sample_windows(&time, &value, window);
            prop_assert!(close(found.value, expected, BRUTE_FORCE), "{} {}", found.value, expected);
        }

        #[test]
        fn free_ends_equal_all_cells((time, value) in any_signal(), window in prop_oneof![Just(0.015), Just(0.036), 0.0005..0.1]) {
            prop_assume!(value.iter().any(|&value| value > 0.0));
            let found = hic(&time, &value, window, true).unwrap();
            let expected = all_cells(&time, &value, window);
            prop_assert!(close(found.value, expected, BRUTE_FORCE), "{} {}", found.value, expected);
            let rounding = 4.0 * f64::EPSILON * time[0].abs().max(found.end.abs());
            prop_assert!(found.end - found.start <= window + rounding);
        }

        #[test]
        fn nothing_on_a_fine_grid_beats_free_ends((time, value) in any_signal(), window in 0.0005..0.1) {
            let (time, value) = (&time[..time.len().min(40)], &value[..time.len().min(40)]);
            let found = hic(time, value, window, true).unwrap().value;
            let grid = fine_grid(time, value, window, 24);
            prop_assert!(grid <= found * (1.0 + 1e-8) , "{found} {grid}");
        }

        #[test]
        fn the_window_gives_the_value((time, value) in any_signal()) {
            let found = hic(&time, &value, 0.015, false).unwrap();
            if found.value > 0.0 {
                let start = time.iter().position(|&time| time == found.start).unwrap();
                let end = time.iter().position(|&time| time == found.end).unwrap();
                let again = all_sample_windows(&time[start..=end], &value[start..=end], 1.0);
                prop_assert!(close(again, found.value, BRUTE_FORCE));
            }
        }
    }

    fn pulse(samples: usize, duration: f64, shape: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..samples)
            .map(|k| duration * k as f64 / (samples - 1) as f64)
            .collect();
        let value = time.iter().map(|time| shape(time / duration)).collect();
        (time, value)
    }

    #[test]
    fn half_sine_of_5_ms_and_100_g_is_207_3() {
        let (time, value) = pulse(2001, 0.005, |share| {
            100.0 * (std::f64::consts::PI * share).sin()
        });
        for interpolate in [false, true] {
            let found = hic(&time, &value, 0.015, interpolate).unwrap();
            assert!((found.value - 207.3).abs() < 0.05, "{found:?}");
        }
    }

    #[test]
    fn half_sines_reach_the_formula() {
        for window in [0.015, 0.036, 0.002] {
            // Chords of the sine are low by (pi / n)^2 / 12.
            let (time, value) = pulse(100_001, 0.02, |share| {
                100.0 * (std::f64::consts::PI * share).sin()
            });
            let found = hic(&time, &value, window, true).unwrap().value;
            let expected = hic_half_sine(100.0, 0.02, window).unwrap();
            assert!(
                close(found, expected, FORMULA),
                "{window} {}",
                found / expected - 1.0
            );
        }
    }

    #[test]
    fn triangles_and_squares_are_exact() {
        for window in [0.015, 0.036, 0.004] {
            for peak in [0.5, 0.2, 0.9] {
                let (time, value) = ([0.0, 0.02 * peak, 0.02], [0.0, 50.0, 0.0]);
                let found = hic(&time, &value, window, true).unwrap().value;
                let expected = hic_triangle(50.0, 0.02, window).unwrap();
                assert!(
                    close(found, expected, 1e-13),
                    "{window} {}",
                    found / expected - 1.0
                );
            }
            for samples in [2, 3, 64, 4001] {
                let (time, value) = pulse(samples, 0.02, |_| 50.0);
                let found = hic(&time, &value, window, true).unwrap().value;
                let expected = hic_square(50.0, 0.02, window).unwrap();
                assert!(
                    close(found, expected, 1e-13),
                    "{window} {samples} {}",
                    found / expected - 1.0
                );
            }
        }
    }

    #[test]
    fn negative_signals_count_0() {
        let (time, value) = pulse(100, 0.02, |share| -1.0 - share);
        for interpolate in [false, true] {
            let found = hic(&time, &value, 0.015, interpolate).unwrap();
            assert_eq!((found.value, found.start, found.end), (0.0, 0.0, 0.0));
        }
    }

    #[test]
    fn times_may_be_rounded() {
        let time: Vec<f64> = (0..2001).map(|k| 3.0 + f64::from(k) * 1e-4).collect();
        let value = vec![10.0; 2001];
        let found = hic(&time, &value, 0.015, false).unwrap();
        assert!(close(found.value, 0.015 * 10.0_f64.powf(2.5), 1e-9));
    }

    #[test]
    fn huge_and_tiny_signals_keep_their_digits() {
        let (time, value) = pulse(301, 0.03, |share| (9.0 * share).sin());
        let plain = hic(&time, &value, 0.015, true).unwrap().value;
        for factor in [1e-90_f64, 1e90] {
            let scaled: Vec<f64> = value.iter().map(|value| value * factor).collect();
            let found = hic(&time, &scaled, 0.015, true).unwrap().value;
            assert!(close(found, plain * factor.powf(2.5), 1e-12));
        }
    }

    #[test]
    fn bad_signals_are_named() {
        let good = [0.0, 1.0, 2.0];
        assert!(hic(&good[..1], &good[..1], 0.015, false).is_err());
        assert!(hic(&good, &good[..2], 0.015, false).is_err());
        assert!(hic(&[0.0, 2.0, 1.0], &good, 0.015, false).is_err());
        assert!(hic(&[0.0, 1.0, 1.0], &good, 0.015, false).is_err());
        assert!(hic(&good, &[0.0, f64::NAN, 1.0], 0.015, false).is_err());
        assert!(hic(&[0.0, 1.0, f64::INFINITY], &good, 0.015, false).is_err());
        assert!(hic(&good, &good, 0.0, false).is_err());
        assert!(hic(&good, &good, f64::NAN, true).is_err());
    }
}
