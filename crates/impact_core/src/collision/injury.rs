//! Head injury criterion of the motion of a body.

use super::MotionSample;
use crate::windows::injury;

/// Nodes of the search for the best window.
const PIECES: usize = 256;

/// Criterion of windows up to a width on the steps of a motion, `T^-1.5 (dV)^2.5`, in units of m and s.
///
/// Between the ends of a step the speed is the polynomial of degree 5 that has speed, acceleration and jerk
/// of both.
#[must_use]
pub fn injury_of(steps: &[MotionSample], width: f64) -> f64 {
    let Some(last) = steps.last() else {
        return f64::NAN;
    };
    let (end, rest) = (last.time, steps[0].body_speed);
    let (pairs, _) = steps.as_chunks::<2>();
    let jet = |time: f64| {
        let after = pairs.partition_point(|[_, last]| last.time < time);
        let [first, last] = &pairs[after.min(pairs.len() - 1)];
        let mut jet = between(first, last, time);
        jet[0] -= rest;
        jet
    };
    injury(jet, end, width, PIECES).value
}

/// Speed and its first three derivatives between two nodes.
fn between(first: &MotionSample, last: &MotionSample, time: f64) -> [f64; 4] {
    let length = last.time - first.time;
    if length <= 0.0 {
        return [
            first.body_speed,
            first.body_acceleration,
            first.body_jerk,
            0.0,
        ];
    }
    let x = (time - first.time) / length;
    let (slope, bend) = (
        length * first.body_acceleration,
        length * length * first.body_jerk,
    );
    // What the parabola from the first node misses at the last one.
    let gap = last.body_speed - first.body_speed - slope - 0.5 * bend;
    let slope_gap = length * last.body_acceleration - slope - bend;
    let bend_gap = length * length * last.body_jerk - bend;
    let third = 10.0 * gap - 4.0 * slope_gap + 0.5 * bend_gap;
    let fourth = -15.0 * gap + 7.0 * slope_gap - bend_gap;
    let fifth = 6.0 * gap - 3.0 * slope_gap + 0.5 * bend_gap;
    [
        first.body_speed + x * (slope + x * (0.5 * bend + x * (third + x * (fourth + x * fifth)))),
        (slope + x * (bend + x * (3.0 * third + x * (4.0 * fourth + x * 5.0 * fifth)))) / length,
        (bend + x * (6.0 * third + x * (12.0 * fourth + x * 20.0 * fifth))) / length.powi(2),
        (6.0 * third + x * (24.0 * fourth + x * 60.0 * fifth)) / length.powi(3),
    ]
}
