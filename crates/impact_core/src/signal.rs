//! Injury criteria of sampled acceleration signals.
//!
//! Samples may have any spacing and any sign; accelerations are in g, so the head injury criterion
//! has its usual unit g^2.5 s. Criteria of the continuous response of the impact model live with the
//! response itself.

mod cells;
mod closed_form;
mod injury;
mod recorded;
pub(crate) mod search;
mod windows;

pub use closed_form::{hic_half_sine, hic_square, hic_triangle};
pub use injury::{HeadInjury, hic};
pub use recorded::Recording;
pub use windows::{Level, contiguous_level, moving_average};

use crate::error::{Failure, Given, Result};

/// Share of the window by which rounding of the sample times may lengthen it: 150 intervals of
/// 0.1 ms are a window of 15 ms, whatever the last bits of their difference say.
const WINDOW_SLACK: f64 = 1e-9;

/// A signal that passed the checks.
#[derive(Clone, Copy)]
struct Signal<'a> {
    time: &'a [f64],
    value: &'a [f64],
}

impl<'a> Signal<'a> {
    fn new(time: &'a [f64], acceleration_g: &'a [f64]) -> Result<Self> {
        check_time("time", time)?;
        if acceleration_g.len() != time.len() {
            return Err(Failure::invalid(
                "acceleration_g",
                "have as many samples as time",
                Given::Count(acceleration_g.len() as u64),
            ));
        }
        check_finite("acceleration_g", acceleration_g)?;
        Ok(Self {
            time,
            value: acceleration_g,
        })
    }

    fn span(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// Integral from the first sample to every sample by the trapezoid rule, with compensated
    /// summation: a long record loses nothing in differences between neighbors.
    fn integral(&self) -> Vec<f64> {
        let mut sum = 0.0_f64;
        let mut lost = 0.0_f64;
        let mut result = vec![0.0; self.time.len()];
        let pairs = self.time.windows(2).zip(self.value.windows(2));
        for (place, (times, values)) in result[1..].iter_mut().zip(pairs) {
            let increment = 0.5 * (values[0] + values[1]) * (times[1] - times[0]);
            let next = sum + increment;
            let part = next - sum;
            lost += (sum - (next - part)) + (increment - part);
            sum = next;
            *place = sum + lost;
        }
        result
    }
}

/// Passes at least two finite times in rising order.
pub(crate) fn check_time(name: &str, time: &[f64]) -> Result<()> {
    if time.len() < 2 {
        return Err(Failure::invalid(
            name,
            "have at least 2 samples",
            Given::Count(time.len() as u64),
        ));
    }
    check_finite(name, time)?;
    let rises = |pair: &[f64]| pair[0] < pair[1];
    // Without a branch per sample; the culprit is looked for only when there is one.
    if time.windows(2).fold(true, |all, pair| all & rises(pair)) {
        return Ok(());
    }
    let fallen = time.windows(2).find(|pair| !rises(pair));
    Err(Failure::invalid(
        name,
        "rise from sample to sample",
        Given::Number(fallen.map_or(f64::NAN, |pair| pair[1])),
    ))
}

/// Passes finite samples.
pub(crate) fn check_finite(name: &str, values: &[f64]) -> Result<()> {
    if values
        .iter()
        .fold(true, |all, value| all & value.is_finite())
    {
        return Ok(());
    }
    let culprit = values.iter().find(|value| !value.is_finite());
    Err(Failure::invalid(
        name,
        "be finite",
        Given::Number(culprit.copied().unwrap_or(f64::NAN)),
    ))
}
