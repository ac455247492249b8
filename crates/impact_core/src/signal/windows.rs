//! Criteria over windows of one fixed width: largest moving average and longest-held level.
//!
//! The signal is linear between its samples. As the window moves, its two ends pass the samples one
//! after the other; between two such events both ends lie in known intervals and the best position
//! has a formula, so both criteria take O(n).

use std::collections::VecDeque;

use super::{CHECK, Signal, WINDOW_SLACK};
use crate::error::{Failure, Given, Result, positive, proceed};
use numeric::threads::Interrupted;

/// Value of a criterion and the window it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Value, in g.
    pub value: f64,
    /// Start of the window, in s.
    pub start: f64,
    /// End of the window, in s.
    pub end: f64,
}

/// Largest mean over windows that are exactly `width` wide (the 3 ms average with 0.003 s).
///
/// # Errors
/// A bad signal, a width that is not positive, a signal shorter than the width, or the caller asked to stop.
pub fn moving_average(
    time: &[f64],
    acceleration_g: &[f64],
    width: f64,
    interrupted: Interrupted<'_>,
) -> Result<Level> {
    let signal = Signal::new_until(time, acceleration_g, interrupted)?;
    let width = fitting_width(&signal, width)?;
    let integral = signal.integral_until(interrupted)?;
    let mut best = Level::at(f64::NEG_INFINITY, 0.0, width);
    for (index, piece) in Pieces::new(signal, width).enumerate() {
        if index % CHECK == 0 {
            proceed(interrupted)?;
        }
        let mut starts = [piece.earliest, piece.latest, piece.earliest];
        let [from, to] = [piece.start_slope, piece.end_slope];
        if from > to {
            let turn = piece.earliest + (piece.end_value - piece.start_value) / (from - to);
            starts[2] = turn.clamp(piece.earliest, piece.latest);
        }
        for start in starts {
            let ends = [
                signal.integral_at(&integral, piece.start_cell, start),
                signal.integral_at(&integral, piece.end_cell, start + width),
            ];
            best.raise((ends[1] - ends[0]) / width, start, width);
        }
    }
    Ok(best)
}

/// Highest level that the signal keeps for `width` without a break (the 3 ms clip with 0.003 s).
///
/// # Errors
/// A bad signal, a width that is not positive, a signal shorter than the width, or the caller asked to stop.
pub fn contiguous_level(
    time: &[f64],
    acceleration_g: &[f64],
    width: f64,
    interrupted: Interrupted<'_>,
) -> Result<Level> {
    let signal = Signal::new_until(time, acceleration_g, interrupted)?;
    let width = fitting_width(&signal, width)?;
    let mut best = Level::at(f64::NEG_INFINITY, 0.0, width);
    // Samples inside the window that are lower than all later ones, in order.
    let mut lowest: VecDeque<usize> = VecDeque::new();
    let mut entered = 0;
    for (index, piece) in Pieces::new(signal, width).enumerate() {
        if index % CHECK == 0 {
            proceed(interrupted)?;
        }
        while entered < piece.end_cell {
            entered += 1;
            while lowest
                .back()
                .is_some_and(|&k| acceleration_g[k] >= acceleration_g[entered])
            {
                lowest.pop_back();
            }
            lowest.push_back(entered);
        }
        while lowest.front().is_some_and(|&k| k <= piece.start_cell) {
            lowest.pop_front();
        }
        let inside = lowest.front().map_or(f64::INFINITY, |&k| acceleration_g[k]);
        // Where the two ends are equal.
        let crossing = piece.earliest
            + (piece.end_value - piece.start_value) / (piece.start_slope - piece.end_slope);
        let crossing = if crossing.is_finite() {
            crossing.clamp(piece.earliest, piece.latest)
        } else {
            piece.earliest
        };
        for start in [piece.earliest, piece.latest, crossing] {
            let moved = start - piece.earliest;
            let ends = (piece.start_value + piece.start_slope * moved)
                .min(piece.end_value + piece.end_slope * moved);
            best.raise(inside.min(ends), start, width);
        }
    }
    Ok(best)
}

impl Level {
    fn at(value: f64, start: f64, width: f64) -> Self {
        Self {
            value,
            start,
            end: start + width,
        }
    }

    fn raise(&mut self, value: f64, start: f64, width: f64) {
        if value > self.value {
            *self = Self::at(value, start, width);
        }
    }
}

fn fitting_width(signal: &Signal<'_>, width: f64) -> Result<f64> {
    positive("width", width)?;
    let span = signal.span();
    if width > span * (1.0 + WINDOW_SLACK) {
        return Err(Failure::invalid(
            "time",
            "span at least the width of the window",
            Given::Number(span),
        ));
    }
    Ok(width.min(span))
}

impl Signal<'_> {
    fn slope(&self, cell: usize) -> f64 {
        (self.value[cell + 1] - self.value[cell]) / (self.time[cell + 1] - self.time[cell])
    }

    fn value_at(&self, cell: usize, time: f64) -> f64 {
        self.value[cell] + self.slope(cell) * (time - self.time[cell])
    }

    fn integral_at(&self, integral: &[f64], cell: usize, time: f64) -> f64 {
        let offset = time - self.time[cell];
        integral[cell] + offset * (self.value[cell] + 0.5 * self.slope(cell) * offset)
    }
}

/// Positions of the window with both ends in fixed intervals of the signal.
struct WindowRange {
    start_cell: usize,
    end_cell: usize,
    /// Range of the window's start.
    earliest: f64,
    latest: f64,
    /// Values at both ends of the window at its earliest position, and their slopes.
    start_value: f64,
    end_value: f64,
    start_slope: f64,
    end_slope: f64,
}

/// Walks through all pieces.
struct Pieces<'a> {
    signal: Signal<'a>,
    width: f64,
    start_cell: usize,
    end_cell: usize,
    start: f64,
    done: bool,
}

impl<'a> Pieces<'a> {
    fn new(signal: Signal<'a>, width: f64) -> Self {
        let start = signal.time[0];
        let last = signal.time.len() - 2;
        let end_cell = (0..last)
            .find(|&k| signal.time[k + 1] > start + width)
            .unwrap_or(last);
        Self {
            signal,
            width,
            start_cell: 0,
            end_cell,
            start,
            done: false,
        }
    }
}

impl Iterator for Pieces<'_> {
    type Item = WindowRange;

    fn next(&mut self) -> Option<WindowRange> {
        if self.done {
            return None;
        }
        let signal = self.signal;
        let (start_cell, end_cell) = (self.start_cell, self.end_cell);
        let last = signal.time.len() - 2;
        let start_leaves = signal.time[start_cell + 1];
        let end_leaves = signal.time[end_cell + 1] - self.width;
        let earliest = self.start;
        let latest = start_leaves.min(end_leaves).max(earliest);
        if end_leaves <= start_leaves {
            self.done = end_cell == last;
            self.end_cell += 1;
        }
        if start_leaves <= end_leaves {
            self.start_cell += 1;
            self.done |= self.start_cell > last;
        }
        self.start = latest;
        Some(WindowRange {
            start_cell,
            end_cell,
            earliest,
            latest,
            start_value: signal.value_at(start_cell, earliest),
            end_value: signal.value_at(end_cell, earliest + self.width),
            start_slope: signal.slope(start_cell),
            end_slope: signal.slope(end_cell),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    /// Formulas evaluated in another order.
    const ROUNDING: f64 = 1e-12;

    fn value_at(time: &[f64], value: &[f64], at: f64) -> f64 {
        let k = time
            .partition_point(|&time| time <= at)
            .clamp(1, time.len() - 1);
        value[k - 1] + (value[k] - value[k - 1]) * (at - time[k - 1]) / (time[k] - time[k - 1])
    }

    /// Mean and minimum over one window, directly.
    fn direct(time: &[f64], value: &[f64], start: f64, end: f64) -> (f64, f64) {
        let mut points = vec![(start, value_at(time, value, start))];
        for (&at, &value) in time.iter().zip(value) {
            if at > start && at < end {
                points.push((at, value));
            }
        }
        points.push((end, value_at(time, value, end)));
        let integral: f64 = points
            .windows(2)
            .map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0))
            .sum();
        let lowest = points
            .iter()
            .fold(f64::INFINITY, |low, point| low.min(point.1));
        (integral / (end - start), lowest)
    }

    fn any_signal() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
        let step = prop_oneof![Just(1e-4), 1e-5..2e-3_f64];
        proptest::collection::vec((step, -50.0..80.0_f64), 60..120).prop_map(|samples| {
            let mut now = 0.0;
            samples
                .into_iter()
                .map(|(step, value)| {
                    now += step;
                    (now, value)
                })
                .unzip()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 64,
            rng_seed: RngSeed::Fixed(2),
            ..ProptestConfig::default()
        })]

        #[test]
        fn windows_give_their_values_and_none_is_better((time, value) in any_signal()) {
            let width = 0.003;
            let (first, last) = (time[0], time[time.len() - 1]);
            prop_assume!(last - first > width);
            let average = moving_average(&time, &value, width, &|| false).unwrap();
            let held = contiguous_level(&time, &value, width, &|| false).unwrap();
            let average_again = direct(&time, &value, average.start, average.end).0;
            let held_again = direct(&time, &value, held.start, held.end).1;
            prop_assert!((average.value - average_again).abs() < 1e-9);
            prop_assert!((held.value - held_again).abs() < 1e-9);
            for k in 0..=3000 {
                let start = first + (last - first - width) * f64::from(k) / 3000.0;
                let (mean, lowest) = direct(&time, &value, start, start + width);
                prop_assert!(mean <= average.value + 1e-9);
                prop_assert!(lowest <= held.value + 1e-9);
            }
        }
    }

    #[test]
    fn a_triangle_has_formulas() {
        let (time, value) = ([0.0, 0.006, 0.012], [0.0, 60.0, 0.0]);
        let average = moving_average(&time, &value, 0.003, &|| false).unwrap();
        let held = contiguous_level(&time, &value, 0.003, &|| false).unwrap();
        assert!((average.value - 52.5).abs() < 60.0 * ROUNDING);
        assert!((held.value - 45.0).abs() < 60.0 * ROUNDING);
        for level in [average, held] {
            assert!(
                (level.start - 0.0045).abs() < ROUNDING && (level.end - 0.0075).abs() < ROUNDING
            );
        }
    }

    #[test]
    fn a_constant_is_its_own_criterion() {
        let time: Vec<f64> = (0..31).map(|k| f64::from(k) * 1e-4).collect();
        let value = [-2.5; 31];
        assert!(
            (moving_average(&time, &value, 0.003, &|| false)
                .unwrap()
                .value
                + 2.5)
                .abs()
                < ROUNDING
        );
        assert!(
            (contiguous_level(&time, &value, 0.003, &|| false)
                .unwrap()
                .value
                + 2.5)
                .abs()
                < ROUNDING
        );
    }

    #[test]
    fn short_signals_are_refused() {
        let (time, value) = ([0.0, 0.001, 0.002], [1.0, 2.0, 1.0]);
        for criterion in [moving_average, contiguous_level] {
            let message = criterion(&time, &value, 0.003, &|| false)
                .unwrap_err()
                .to_string();
            assert_eq!(
                message,
                "time must span at least the width of the window, got 0.002"
            );
            assert!(criterion(&time, &value, -0.003, &|| false).is_err());
        }
    }
}
