//! Criteria of moving windows on the continuous acceleration of the head.
//!
//! The velocity `V` of the head against the torso is the integral of its acceleration `a`, so the
//! mean over a window is a difference of two velocities.

mod head_injury;
#[cfg(test)]
mod tests;

pub use head_injury::injury;

use crate::roots::{root, stationary, turning_point};

/// A window and what it gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The value.
    pub value: f64,
    /// Start, in s.
    pub start: f64,
    /// End, in s.
    pub end: f64,
}

/// Largest mean over windows of a width, and largest level held through one of them; `None` if
/// the interval is shorter. The function gives `V`, `a`, `a'` and `a''`.
pub fn held(
    jet: impl Fn(f64) -> [f64; 4],
    end: f64,
    width: f64,
    pieces: usize,
) -> Option<(Window, Window)> {
    if end < width {
        return None;
    }
    let window = |start: f64, value: f64| Window {
        value,
        start,
        end: start + width,
    };
    let troughs = troughs(&jet, end, pieces);
    let mean = |start: f64| (jet(start + width)[0] - jet(start)[0]) / width;
    let level = |start: f64| {
        let inside = |trough: &&[f64; 2]| trough[0] > start && trough[0] < start + width;
        troughs
            .iter()
            .filter(inside)
            .fold(jet(start)[1].min(jet(start + width)[1]), |least, trough| {
                least.min(trough[1])
            })
    };
    let mut best = (window(0.0, mean(0.0)), window(0.0, level(0.0)));
    let mut offer = |start: f64| {
        let other = (mean(start), level(start));
        if other.0 > best.0.value {
            best.0 = window(start, other.0);
        }
        if other.1 > best.1.value {
            best.1 = window(start, other.1);
        }
    };
    // Either optimum has equal accelerations at both ends, or starts or stops with the interval.
    let difference = |start: f64| {
        let [left, right] = [jet(start), jet(start + width)];
        [right[1] - left[1], right[2] - left[2]]
    };
    stationary(difference, 0.0, end - width, pieces, &mut offer);
    offer(end - width);
    Some(best)
}

/// Times and values of the local minima of the acceleration.
fn troughs(jet: &impl Fn(f64) -> [f64; 4], end: f64, pieces: usize) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let slope = |time: f64| {
        let [_, _, first, second] = jet(time);
        [first, second]
    };
    stationary(slope, 0.0, end, pieces, |time| {
        let [_, acceleration, _, curve] = jet(time);
        if curve > 0.0 {
            found.push([time, acceleration]);
        }
    });
    found
}

/// First time in an interval at which the acceleration goes below zero; `jet` gives `V`, `a`,
/// `a'` and `a''`, `noise` how far below zero is nothing but rounding. Touching zero is no crossing.
pub fn first_fall(
    jet: impl Fn(f64) -> [f64; 4],
    from: f64,
    to: f64,
    noise: impl Fn(f64) -> f64,
) -> Option<f64> {
    let pair = |time: f64| {
        let [_, value, slope, _] = jet(time);
        [value, slope]
    };
    let [low, high] = [jet(from), jet(to)];
    // Noise is computed where something is below zero: it takes longer than everything else.
    if high[1] < 0.0 && high[1] < -noise(to) {
        return Some(if low[1] > 0.0 {
            root(pair, from, to)
        } else {
            from
        });
    }
    if low[2] < 0.0 && high[2] > 0.0 && low[1] > 0.0 {
        let bottom = turning_point(&pair, from, to);
        let lowest = jet(bottom)[1];
        if lowest < 0.0 && lowest < -noise(bottom) {
            return Some(root(pair, from, bottom));
        }
    }
    None
}
