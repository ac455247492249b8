//! Two wheels steered toward a velocity: Avi (2019).

use nalgebra::Vector2;

use super::drive::{Integration, Twist};
use crate::world::frame::Frame;
use numeric::error::{Result, not_negative, positive};

/// Rule for the virtual velocity between two steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VelocityRule {
    /// It is integrated on.
    #[default]
    Integrated,
    /// It starts every step from the velocity of the robot.
    Reset,
}

/// A robot with two driven wheels that turns toward a wanted velocity and never drives backward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityDrive {
    /// Mass `M_s` in the virtual impedance, in kg.
    pub mass: f64,
    /// Radius of the disc that models the body, in m.
    pub body_radius: f64,
    /// Distance between the wheels, in m.
    pub wheel_base: f64,
    /// Largest speed of a wheel, and of the virtual velocity, in m/s.
    pub wheel_speed: f64,
    /// Turning speed per heading error, in 1/s.
    pub heading_gain: f64,
    /// Virtual speed below which the robot does not turn, in m/s.
    pub least_speed: f64,
    /// Integration over a step; the chord is that of the source.
    pub integration: Integration,
}

impl Default for VelocityDrive {
    fn default() -> Self {
        Self {
            mass: 3.94,
            body_radius: 0.25,
            wheel_base: 0.41,
            wheel_speed: 0.72,
            heading_gain: 4.0,
            least_speed: 0.02,
            integration: Integration::Chord,
        }
    }
}

impl VelocityDrive {
    /// Returns the drive if its numbers are in range.
    ///
    /// # Errors
    /// A number is not finite, or out of range.
    pub fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        positive("body_radius", self.body_radius)?;
        positive("wheel_base", self.wheel_base)?;
        positive("wheel_speed", self.wheel_speed)?;
        not_negative("heading_gain", self.heading_gain)?;
        not_negative("least_speed", self.least_speed)?;
        Ok(self)
    }

    /// Speeds (left, right) of the wheels in m/s that follow a virtual velocity given in the axes
    /// of the robot: `omega = gain e`, `v = |V| max(cos e, 0)`, scaled together to the limit.
    #[inline]
    #[must_use]
    pub fn wheels(&self, wanted: Vector2<f64>) -> [f64; 2] {
        let speed = wanted.dot(&wanted).sqrt();
        let turning = if speed < self.least_speed {
            0.0
        } else {
            self.heading_gain * wanted.y.atan2(wanted.x)
        };
        let ahead = wanted.x.max(0.0);
        let difference = 0.5 * self.wheel_base * turning;
        let wheels = [ahead - difference, ahead + difference];
        let fastest = wheels[0].abs().max(wheels[1].abs());
        if fastest > self.wheel_speed {
            let share = self.wheel_speed / fastest;
            wheels.map(|wheel| share * wheel)
        } else {
            wheels
        }
    }

    /// Motion of the body with wheels at (left, right) m/s.
    #[inline]
    #[must_use]
    pub fn twist(&self, [left, right]: [f64; 2]) -> Twist {
        Twist {
            speed: 0.5 * (left + right),
            turn_rate: (right - left) / self.wheel_base,
        }
    }

    /// Frame of the robot after wheels at (left, right) m/s have turned for a step in s.
    #[inline]
    #[must_use]
    pub fn moved(&self, frame: &Frame, wheels: [f64; 2], step: f64) -> Frame {
        self.twist(wheels).moved(frame, step, self.integration)
    }
}
