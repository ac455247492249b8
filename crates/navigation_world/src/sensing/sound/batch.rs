//! Many fixes at once.

use super::fix::{Covariance, Fix, FixStatus, locate};
use super::microphones::MicrophoneArray;
use numeric::error::{Failure, Given, Result};
use numeric::parallel::{Work, each_run};

/// Rows of a task; the bits of a row do not depend on it.
const BLOCK: usize = 4096;

/// Columns of fixes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FixColumns {
    /// Ranges from M2, in m.
    pub range: Vec<f64>,
    /// Bearings, in rad.
    pub bearing: Vec<f64>,
    /// Covariances of range (m) and bearing (rad): four numbers of a matrix for every fix.
    pub covariance: Vec<f64>,
    /// Curvatures `c (t_1 - 2 t_2 + t_3)`, in m.
    pub curvature: Vec<f64>,
    /// Places of the statuses in [`FixStatus::ALL`].
    pub status: Vec<u8>,
}

impl FixColumns {
    fn with_capacity(rows: usize) -> Self {
        Self {
            range: Vec::with_capacity(rows),
            bearing: Vec::with_capacity(rows),
            covariance: Vec::with_capacity(4 * rows),
            curvature: Vec::with_capacity(rows),
            status: Vec::with_capacity(rows),
        }
    }

    fn push(&mut self, fix: &Fix) {
        let Covariance {
            first,
            mixed,
            second,
        } = fix.covariance;
        self.range.push(fix.range);
        self.bearing.push(fix.bearing);
        self.covariance
            .extend_from_slice(&[first, mixed, mixed, second]);
        self.curvature.push(fix.curvature);
        self.status.push(code(fix.status));
    }

    fn extend(&mut self, part: &Self) {
        self.range.extend_from_slice(&part.range);
        self.bearing.extend_from_slice(&part.bearing);
        self.covariance.extend_from_slice(&part.covariance);
        self.curvature.extend_from_slice(&part.curvature);
        self.status.extend_from_slice(&part.status);
    }
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
        let mut fixes = FixColumns::with_capacity(part.len());
        for (a, b) in pairs {
            fixes.push(&locate(array, [*a, *b], delays_covariance));
        }
        (work.progress)(part.len());
        Ok(fixes)
    })?;
    let mut all = FixColumns::with_capacity(rows);
    // Each block is freed when it has been taken over, so that a stop has little left to free.
    for part in blocks {
        if (work.interrupted)() {
            return Err(Failure::Interrupted);
        }
        all.extend(&part);
    }
    Ok(all)
}

fn code(status: FixStatus) -> u8 {
    match status {
        FixStatus::Fix => 0,
        FixStatus::NoDelay => 1,
        FixStatus::TooLong => 2,
        FixStatus::NoCurvature => 3,
    }
}
