//! Controller of the pneumatic cylinder.

use impact_core::identify::{self, DesiredMotion};
use pyo3::prelude::*;

use crate::errors::CoreResult;
use crate::keywords::parameter_class;

parameter_class! {
    /// Controller of the pneumatic cylinder.
    CylinderController(identify::CylinderController) {
        acceleration_gain, velocity_gain, proportional, derivative, sample_time,
    }

    /// Command of the valve.
    #[pyo3(signature = (*, desired_position, desired_velocity, desired_acceleration, position,
        velocity))]
    fn command(
        &self,
        desired_position: f64,
        desired_velocity: f64,
        desired_acceleration: f64,
        position: f64,
        velocity: f64,
    ) -> CoreResult<f64> {
        let desired = DesiredMotion {
            position: desired_position,
            velocity: desired_velocity,
            acceleration: desired_acceleration,
        };
        Ok(self.0.command(&desired, position, velocity)?)
    }
}
