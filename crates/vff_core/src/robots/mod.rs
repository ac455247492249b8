//! Robots: how a commanded force becomes motion, and what it costs.

mod holonomic;

pub use holonomic::{HolonomicRobot, WheelModel, Wheels};

use crate::error::{Result, positive};
use crate::region::RobotLimits;

/// Limits of a two-wheel robot; its regions are larger by the time it needs to turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialDriveRobot {
    /// Mass in kg.
    pub mass: f64,
    /// Radius in m.
    pub radius: f64,
    /// Largest speed in m/s.
    pub max_speed: f64,
    /// Largest acceleration in m/s^2.
    pub max_acceleration: f64,
    /// Largest angular acceleration in rad/s^2.
    pub max_angular_acceleration: f64,
}

impl DifferentialDriveRobot {
    /// Passes a robot whose values are finite and positive.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        positive("radius", self.radius)?;
        positive("max_speed", self.max_speed)?;
        positive("max_acceleration", self.max_acceleration)?;
        positive("max_angular_acceleration", self.max_angular_acceleration)?;
        Ok(self)
    }

    /// Limits for the size of regions; `t_turn = sqrt(pi / alpha_max)`.
    #[must_use]
    pub fn limits(&self) -> RobotLimits {
        RobotLimits {
            radius: self.radius,
            max_speed: self.max_speed,
            max_acceleration: self.max_acceleration,
            turn_time: (std::f64::consts::PI / self.max_angular_acceleration).sqrt(),
        }
    }
}
