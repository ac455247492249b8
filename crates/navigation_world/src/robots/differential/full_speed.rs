//! Tracking law that holds up to the full speed of the robot.

use super::drive::{DifferentialLimits, Pose, Twist, wrapped};
use super::reference::Reference;
use numeric::error::{Result, positive};

/// A wanted velocity below this has no direction, in m/s.
pub(crate) const STANDSTILL: f64 = 1e-6;

/// Drives along `U = V_d + K_p (P_d - P)` and turns toward it.
///
/// With `alpha = angle(U) - phi`: `v = |U| max(cos alpha, 0)` and
/// `omega = omega_d cos alpha + K_h alpha`, each within its limit. `omega_d` is the turn rate of
/// the reference velocity. The robot never drives backward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullSpeed {
    /// `K_p` in 1/s.
    pub position_gain: f64,
    /// `K_h` in 1/s.
    pub heading_gain: f64,
}

impl Default for FullSpeed {
    fn default() -> Self {
        Self {
            position_gain: 2.0,
            heading_gain: 6.0,
        }
    }
}

impl FullSpeed {
    /// Passes gains that are finite and positive.
    ///
    /// # Errors
    /// Names the gain that is not.
    pub fn checked(self) -> Result<Self> {
        positive("position_gain", self.position_gain)?;
        positive("heading_gain", self.heading_gain)?;
        Ok(self)
    }

    /// Speed and turn rate; `turn` is `omega_d` in rad/s.
    #[must_use]
    pub fn twist(
        &self,
        pose: &Pose,
        reference: &Reference,
        turn: f64,
        limits: &DifferentialLimits,
    ) -> Twist {
        let along = |i: usize| {
            reference.velocity[i] + self.position_gain * (reference.position[i] - pose.position[i])
        };
        let wanted = [along(0), along(1)];
        let speed = wanted[0].hypot(wanted[1]);
        if speed < STANDSTILL {
            return Twist::default();
        }
        let angle = wrapped(wanted[1].atan2(wanted[0]) - pose.heading);
        let cos = angle.cos();
        limits.within(Twist {
            speed: speed * cos.max(0.0),
            turn_rate: turn * cos + self.heading_gain * angle,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_on_the_spot_before_it_drives() {
        let law = FullSpeed::default();
        let limits = DifferentialLimits::default();
        let ahead = Reference::at_rest([1.0, 0.0]);
        let pose = |heading| Pose {
            position: [0.0; 2],
            heading,
        };
        let twist = law.twist(&pose(2.0), &ahead, 0.0, &limits);
        assert_eq!((twist.speed, twist.turn_rate), (0.0, -5.0));
        let twist = law.twist(&pose(0.5), &ahead, 0.0, &limits);
        assert_eq!((twist.speed, twist.turn_rate), (0.7, -3.0));
        let twist = law.twist(&pose(0.5), &Reference::at_rest([0.0; 2]), 0.0, &limits);
        assert_eq!(twist, Twist::default());
    }

    #[test]
    fn asks_for_the_motion_of_the_reference_when_on_it() {
        let reference = Reference {
            position: [2.0, 1.0],
            velocity: [0.3, 0.4],
            acceleration: [-0.4, 0.3],
        };
        let pose = Pose {
            position: [2.0, 1.0],
            heading: 0.4f64.atan2(0.3),
        };
        let limits = DifferentialLimits::default();
        let turn = reference.turn_rate().unwrap();
        let twist = FullSpeed::default().twist(&pose, &reference, turn, &limits);
        assert!((twist.speed - 0.5).abs() < 1e-15 && (twist.turn_rate - 1.0).abs() < 1e-14);
    }
}
