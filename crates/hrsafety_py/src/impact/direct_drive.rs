//! Simulated direct-drive joint in an impact.

use impact_core::joint::direct_drive::{self, DriveImpact};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::fields;
use crate::impact::parameters::{Foam, Head};
use crate::keywords::{Keywords, parameter_class, taken};
use crate::watch::{Report, watched};

parameter_class! {
    /// Direct-drive joint with its controller.
    DirectDrive(direct_drive::DirectDrive) {
        inertia, lever_arm, torque_constant, amplifier_gain, viscous_friction, static_friction,
        voltage_limit, proportional, derivative,
    }

    /// Mass, damping and stiffness without friction and limit.
    fn linear(&self) -> (f64, f64, f64) {
        let manipulator = self.0.linear();
        (manipulator.mass, manipulator.damping, manipulator.stiffness)
    }
}

/// Histories of a direct-drive joint in an impact.
#[pyfunction]
#[pyo3(signature = (drive, foam, head, **given))]
pub fn simulate_direct_drive<'py>(
    py: Python<'py>,
    drive: &DirectDrive,
    foam: &Foam,
    head: &Head,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let impact = taken!(given: DriveImpact { closing_speed, manipulator_speed, duration, step });
    given.done()?;
    let (drive, foam, head) = (&drive.0, &foam.0, &head.0);
    let run = watched(py, Report::none(), |control| {
        let interrupted = || control.interrupted();
        direct_drive::simulate_direct_drive(drive, foam, head, &impact, &interrupted)
    })?;
    Ok(fields! { py;
        vector run: time, manipulator_position, manipulator_velocity, head_position, head_velocity,
            head_acceleration, contact_force, compression, command, requested_command;
        value run: peak_head_acceleration, peak_contact_force, max_compression, impact_duration,
            saturated_time;
        value saturated_from = run.saturated_from.unwrap_or(f64::NAN);
    })
}
