//! Injury criteria of sampled acceleration signals.
//!
//! Samples may have any spacing and any sign; accelerations are in g, so the head injury criterion
//! has its usual unit g^2.5 s. Criteria of the continuous response of the impact model live with the
//! response itself.

mod cells;
mod closed_form;
mod injury;
mod push;
mod recorded;
pub(crate) mod search;
mod shape;
mod tops;
mod windows;

pub use closed_form::{hic_half_sine, hic_square, hic_triangle};
pub use injury::{HeadInjury, hic};
pub use push::push_around;
pub use recorded::{Recorded, Recording};
pub use shape::{PulseShape, shape_until};
pub use windows::{Level, contiguous_level, moving_average};

use crate::error::{Failure, Given, Result, proceed};
use numeric::threads::Interrupted;

/// Share of the window by which rounding of the sample times may lengthen it: 150 intervals of
/// 0.1 ms are a window of 15 ms, whatever the last bits of their difference say.
const WINDOW_SLACK: f64 = 1e-9;

/// Samples between two looks whether to stop: less than a millisecond of any pass.
const CHECK: usize = 1 << 18;

/// A signal that passed the checks.
#[derive(Clone, Copy)]
struct Signal<'a> {
    time: &'a [f64],
    value: &'a [f64],
}

impl<'a> Signal<'a> {
    fn new_until(
        time: &'a [f64],
        acceleration_g: &'a [f64],
        interrupted: Interrupted<'_>,
    ) -> Result<Self> {
        check_length("time", time)?;
        for start in (0..time.len()).step_by(CHECK) {
            proceed(interrupted)?;
            // Neighbors across the border belong to both.
            let end = time.len().min(start + CHECK + 1);
            check_rising("time", &time[start..end])?;
        }
        if acceleration_g.len() != time.len() {
            return Err(Failure::invalid(
                "acceleration_g",
                "have as many samples as time",
                Given::Count(acceleration_g.len() as u64),
            ));
        }
        for part in acceleration_g.chunks(CHECK) {
            proceed(interrupted)?;
            check_finite("acceleration_g", part)?;
        }
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
        self.integral_until(&|| false).unwrap_or_default()
    }

    fn integral_until(&self, interrupted: Interrupted<'_>) -> Result<Vec<f64>> {
        let mut sum = 0.0_f64;
        let mut lost = 0.0_f64;
        let mut result = vec![0.0; self.time.len()];
        let mut pairs = self.time.windows(2).zip(self.value.windows(2));
        for part in result[1..].chunks_mut(CHECK) {
            proceed(interrupted)?;
            for (place, (times, values)) in part.iter_mut().zip(&mut pairs) {
                let increment = 0.5 * (values[0] + values[1]) * (times[1] - times[0]);
                let next = sum + increment;
                let part = next - sum;
                lost += (sum - (next - part)) + (increment - part);
                sum = next;
                *place = sum + lost;
            }
        }
        Ok(result)
    }
}

/// One value for each index, unless the caller asks to stop.
fn collected<T>(
    count: usize,
    interrupted: Interrupted<'_>,
    mut value: impl FnMut(usize) -> T,
) -> Result<Vec<T>> {
    let mut result = Vec::with_capacity(count);
    for start in (0..count).step_by(CHECK) {
        proceed(interrupted)?;
        result.extend((start..count.min(start + CHECK)).map(&mut value));
    }
    Ok(result)
}

/// Passes times whose steps are not longer than a window: between two samples that far apart a
/// criterion knows nothing.
///
/// # Errors
/// A longer step; most often times are in milliseconds.
pub fn check_step(time: &[f64], window: f64, interrupted: Interrupted<'_>) -> Result<()> {
    let limit = window * (1.0 + WINDOW_SLACK);
    for start in (0..time.len()).step_by(CHECK) {
        proceed(interrupted)?;
        let part = &time[start..time.len().min(start + CHECK + 1)];
        let long = |pair: &[f64]| pair[1] - pair[0] > limit;
        if !part.windows(2).fold(false, |any, pair| any | long(pair)) {
            continue;
        }
        if let Some(place) = part.windows(2).position(long) {
            let step = part[place + 1] - part[place];
            let index = start + place;
            let rule = format!(
                "have steps of at most {window} s, the window of the criterion, also between samples \
                 {index} and {}",
                index + 1
            );
            let given = Given::Number(step);
            return Err(Failure::invalid("time", rule, given).mended_by(
                "times are in seconds: divide milliseconds by 1000; a record that is sampled so \
                 coarsely cannot be judged",
            ));
        }
    }
    Ok(())
}

/// Passes at least two finite times in rising order.
pub(crate) fn check_time(name: &str, time: &[f64]) -> Result<()> {
    check_length(name, time)?;
    check_rising(name, time)
}

fn check_length(name: &str, time: &[f64]) -> Result<()> {
    if time.len() < 2 {
        return Err(Failure::invalid(
            name,
            "have at least 2 samples",
            Given::Count(time.len() as u64),
        ));
    }
    Ok(())
}

fn check_rising(name: &str, time: &[f64]) -> Result<()> {
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
