//! Many fixes at once.

use super::fix::{Covariance, Fix, FixStatus, locate};
use super::microphones::MicrophoneArray;
use crate::error::{Failure, Given, Result};
use crate::parallel::{Work, each_run};

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 4096;

/// Columns of fixes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FixColumns {
    /// Ranges from M2, in m.
    pub range: Vec<f64>,
    /// Bearings, in rad.
    pub bearing: Vec<f64>,
    /// Variances of range, in m^2.
    pub range_variance: Vec<f64>,
    /// Covariances of range and bearing, in m rad.
    pub covariance: Vec<f64>,
    /// Variances of bearing, in rad^2.
    pub bearing_variance: Vec<f64>,
    /// Curvatures `c (t_1 - 2 t_2 + t_3)`, in m.
    pub curvature: Vec<f64>,
    /// Places of the statuses in [`FixStatus::ALL`].
    pub status: Vec<u8>,
}

/// A fix for every pair of delays of M2 and M3 against M1 (s).
///
/// # Errors
/// The columns differ in length, the array cannot be, or the caller asks to stop.
pub fn locate_many(
    array: &MicrophoneArray,
    delay_12: &[f64],
    delay_13: &[f64],
    delays_covariance: &Covariance,
    work: Work<'_>,
) -> Result<FixColumns> {
    array.checked()?;
    let rows = delay_12.len();
    if rows != delay_13.len() {
        let given = Given::Count(delay_13.len() as u64);
        return Err(Failure::invalid(
            "delay_13",
            "be as many as delay_12",
            given,
        ));
    }
    // Rows count as progress, not blocks.
    let silent = Work {
        progress: &|_| (),
        ..work
    };
    let blocks = each_run(rows.div_ceil(BLOCK), silent, |block| {
        let part = block * BLOCK..rows.min((block + 1) * BLOCK);
        let pairs = delay_12[part.clone()].iter().zip(&delay_13[part.clone()]);
        let fixes: Vec<Fix> = pairs
            .map(|(a, b)| locate(array, [*a, *b], delays_covariance))
            .collect();
        (work.progress)(part.len());
        Ok(fixes)
    })?;
    Ok(columns(blocks.iter().flatten(), rows))
}

fn columns<'a>(fixes: impl Iterator<Item = &'a Fix>, rows: usize) -> FixColumns {
    let column = || Vec::with_capacity(rows);
    let mut all = FixColumns {
        range: column(),
        bearing: column(),
        range_variance: column(),
        covariance: column(),
        bearing_variance: column(),
        curvature: column(),
        status: Vec::with_capacity(rows),
    };
    for fix in fixes {
        all.range.push(fix.range);
        all.bearing.push(fix.bearing);
        all.range_variance.push(fix.covariance.first);
        all.covariance.push(fix.covariance.mixed);
        all.bearing_variance.push(fix.covariance.second);
        all.curvature.push(fix.curvature);
        all.status.push(code(fix.status));
    }
    all
}

fn code(status: FixStatus) -> u8 {
    match status {
        FixStatus::Fix => 0,
        FixStatus::NoDelay => 1,
        FixStatus::TooLong => 2,
        FixStatus::NoCurvature => 3,
    }
}
