//! Parameters from measurements: foams from static and drop tests, a direct-drive joint from
//! open-loop tests, controller gains for a wanted stiffness, control of the cylinder (zeng2011,
//! appendix A).

mod cylinder;
mod drive;
mod drop_test;
mod foam;
mod least_squares;
mod line;

pub use cylinder::{CylinderController, DesiredMotion};
pub use drive::{
    DirectDriveFit, DriveConstants, OpenLoop, PdGains, Tube, TubeInertia, fit_open_loop,
    identify_direct_drive, pd_gains, tube_inertia,
};
pub use drop_test::{DropContact, DropModel, drop_trajectory};
pub use foam::{Drop, FoamFit, FoamFitSettings, identify_foam};
pub use line::{Line, fit_static, student_quantile};

use crate::error::{Failure, Given, Result};
use crate::signal::check_finite;

/// Passes finite samples, as many as another argument has and not fewer than `least`.
fn check_samples(
    name: &str,
    values: &[f64],
    partner: usize,
    least: usize,
    requirement: &'static str,
) -> Result<()> {
    if values.len() != partner || values.len() < least {
        let count = Given::Count(values.len() as u64);
        return Err(Failure::invalid(name, requirement, count));
    }
    check_finite(name, values)
}

/// Returns the probability if it lies strictly between 0 and 1.
fn check_confidence(confidence: f64) -> Result<f64> {
    if confidence > 0.0 && confidence < 1.0 {
        Ok(confidence)
    } else {
        Err(Failure::invalid(
            "confidence",
            "lie between 0 and 1",
            Given::Number(confidence),
        ))
    }
}
