//! Controller of the pneumatic cylinder that stands for the torso in the experiments.

use crate::error::{Result, finite, not_negative, positive};

/// Feed-forward and proportional-derivative control of the piston (zeng2011, A.3.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderController {
    /// Command per desired acceleration `K_ffa`, in V s^2/m.
    pub acceleration_gain: f64,
    /// Command per desired velocity `K_ffv`, in V s/m.
    pub velocity_gain: f64,
    /// Command per error of position `K_p`, in V/m.
    pub proportional: f64,
    /// Command per error of velocity `K_d`, in V s/m.
    pub derivative: f64,
    /// Sample time `T_s`, in s.
    pub sample_time: f64,
}

/// Wanted motion of the piston.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesiredMotion {
    /// `p_d`, in m.
    pub position: f64,
    /// `p_d'`, in m/s.
    pub velocity: f64,
    /// `p_d''`, in m/s^2.
    pub acceleration: f64,
}

impl CylinderController {
    /// Returns the controller if its values are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        not_negative("acceleration_gain", self.acceleration_gain)?;
        not_negative("velocity_gain", self.velocity_gain)?;
        not_negative("proportional", self.proportional)?;
        not_negative("derivative", self.derivative)?;
        positive("sample_time", self.sample_time)?;
        Ok(self)
    }

    /// Command of the valve `K_ffa p_d'' + K_ffv p_d' + K_p (p_d - p) + K_d (p_d' - p')`, in V, at
    /// position and velocity of the piston, in m and m/s.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn command(&self, desired: &DesiredMotion, position: f64, velocity: f64) -> Result<f64> {
        finite("desired_position", desired.position)?;
        finite("desired_velocity", desired.velocity)?;
        finite("desired_acceleration", desired.acceleration)?;
        finite("position", position)?;
        finite("velocity", velocity)?;
        Ok(self.acceleration_gain * desired.acceleration
            + self.velocity_gain * desired.velocity
            + self.proportional * (desired.position - position)
            + self.derivative * (desired.velocity - velocity))
    }
}
