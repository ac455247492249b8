//! One step of the embedded Runge-Kutta pair of orders 5 and 4 of Dormand and Prince (1980).

use super::mechanics::{CollisionState, History, Mechanics};

const NODES: [f64; 5] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0];
const STAGES: [[f64; 5]; 5] = [
    [0.2, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
];
const RESULT: [f64; 6] = [
    35.0 / 384.0,
    0.0,
    500.0 / 1113.0,
    125.0 / 192.0,
    -2187.0 / 6784.0,
    11.0 / 84.0,
];
const ERROR: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// End of a step.
#[derive(Clone, Copy)]
pub struct Step<const N: usize> {
    /// State at its end.
    pub state: CollisionState<N>,
    /// Derivative there.
    pub rates: CollisionState<N>,
    /// Estimate of the error of each entry.
    pub error: CollisionState<N>,
    /// Forces at its end.
    pub local: super::mechanics::Local,
}

/// A step of some length.
#[inline]
pub fn step<const N: usize>(
    mechanics: &Mechanics<'_, N>,
    past: &History,
    time: f64,
    state: &CollisionState<N>,
    first: &CollisionState<N>,
    length: f64,
) -> Step<N> {
    let mut slopes = [[0.0; N]; 7];
    slopes[0] = *first;
    for (index, (weights, node)) in STAGES.iter().zip(NODES).enumerate() {
        let mut inner = *state;
        for (weight, slope) in weights.iter().zip(&slopes[..=index]) {
            for (entry, rate) in inner.iter_mut().zip(slope) {
                *entry += length * weight * rate;
            }
        }
        let local = mechanics.local(time + node * length, &inner, past);
        slopes[index + 1] = mechanics.rates(&inner, &local);
    }
    let mut end = *state;
    for (weight, slope) in RESULT.iter().zip(&slopes) {
        for (entry, rate) in end.iter_mut().zip(slope) {
            *entry += length * weight * rate;
        }
    }
    let local = mechanics.local(time + length, &end, past);
    slopes[6] = mechanics.rates(&end, &local);
    let mut error = [0.0; N];
    for (weight, slope) in ERROR.iter().zip(&slopes) {
        for (entry, rate) in error.iter_mut().zip(slope) {
            *entry += length * weight * rate;
        }
    }
    Step {
        state: end,
        rates: slopes[6],
        error,
        local,
    }
}
