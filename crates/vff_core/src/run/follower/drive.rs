//! Differential drive: wheels, limits, motion over one step.

use crate::error::{Result, not_negative, positive};
use crate::sensing::sonar::Pose;

/// A robot with two driven wheels that does not go back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
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
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            mass: 3.94,
            body_radius: 0.25,
            wheel_base: 0.41,
            wheel_speed: 0.72,
            heading_gain: 4.0,
            least_speed: 0.02,
        }
    }
}

impl Drive {
    /// Passes numbers that can be.
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
    pub fn wheels(&self, [forward, left]: [f64; 2]) -> [f64; 2] {
        let speed = (forward * forward + left * left).sqrt();
        let turning = if speed < self.least_speed {
            0.0
        } else {
            self.heading_gain * left.atan2(forward)
        };
        let ahead = forward.max(0.0);
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

    /// Pose after wheels at (left, right) m/s have turned for a step in s: along the chord of the
    /// arc, with its length taken for that of the arc.
    #[inline]
    #[must_use]
    pub fn moved(&self, pose: &Pose, [left, right]: [f64; 2], step: f64) -> Pose {
        let way = 0.5 * (left + right) * step;
        let turn = (right - left) / self.wheel_base * step;
        let (sin, cos) = (0.5 * turn).sin_cos();
        let half = Pose {
            position: pose.position,
            direction: pose.outward([cos, sin]),
        };
        let [x, y] = half.direction;
        Pose {
            position: [pose.position[0] + way * x, pose.position[1] + way * y],
            direction: half.outward([cos, sin]),
        }
    }
}
