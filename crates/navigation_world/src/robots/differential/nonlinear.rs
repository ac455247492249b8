//! Tracking law (7.2.2)-(7.2.3) of Zeng (2011), after Klancar and Skrjanc (2007).

use super::drive::{DifferentialLimits, Pose, Twist, wrapped};
use super::reference::Reference;
use numeric::error::{Result, positive};

/// Axes in which the position error stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ErrorFrame {
    /// Axes of the robot: `x_e` ahead, `y_e` to the left, as Klancar and Skrjanc have them.
    #[default]
    Robot,
    /// Axes of the world, as (7.2.2) is printed.
    World,
}

/// Where the turn rate `omega_d` of the reference comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceTurn {
    /// `d phi_d/dt`, cut to the turn rate that the robot can reach.
    #[default]
    Derivative,
    /// `phi_e/T_s`, as printed.
    HeadingErrorPerPeriod,
}

/// `v = v_d cos phi_e + K_x x_e`, `omega = omega_d + K_y y_e + K_phi phi_e`, (7.2.2), with
/// `omega_n = sqrt(omega_d^2 + k v_d^2)`, `K_x = K_phi = 2 xi omega_n`, `K_y = k v_d`, (7.2.3).
///
/// It has no gain toward a reference that stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nonlinear {
    /// `xi`, dimensionless, in (0, 1) in the source.
    pub damping_ratio: f64,
    /// `k` in rad^2/m^2.
    pub gain: f64,
    /// Axes of the position error.
    pub frame: ErrorFrame,
    /// Source of `omega_d`.
    pub turn: ReferenceTurn,
}

impl Default for Nonlinear {
    fn default() -> Self {
        Self {
            damping_ratio: 0.95,
            gain: 10.0,
            frame: ErrorFrame::Robot,
            turn: ReferenceTurn::Derivative,
        }
    }
}

impl Nonlinear {
    /// Passes gains that are finite and positive.
    ///
    /// # Errors
    /// Names the gain that is not.
    pub fn checked(self) -> Result<Self> {
        positive("damping_ratio", self.damping_ratio)?;
        positive("gain", self.gain)?;
        Ok(self)
    }

    /// Speed and turn rate; `direction` is `phi_d` in rad, `turn` is `d phi_d/dt` in rad/s and
    /// `period` the control period in s.
    #[must_use]
    pub(crate) fn twist(
        &self,
        pose: &Pose,
        reference: &Reference,
        (direction, turn): (f64, f64),
        limits: &DifferentialLimits,
        period: f64,
    ) -> Twist {
        let offset = [
            reference.position[0] - pose.position[0],
            reference.position[1] - pose.position[1],
        ];
        let (sin, cos) = pose.heading.sin_cos();
        let [ahead, left] = match self.frame {
            ErrorFrame::Robot => [
                cos * offset[0] + sin * offset[1],
                cos * offset[1] - sin * offset[0],
            ],
            ErrorFrame::World => offset,
        };
        let heading_error = wrapped(direction - pose.heading);
        let turn = match self.turn {
            ReferenceTurn::Derivative => turn,
            ReferenceTurn::HeadingErrorPerPeriod => heading_error / period,
        };
        let speed = reference.speed();
        let natural = turn.hypot(self.gain.sqrt() * speed);
        let damped = 2.0 * self.damping_ratio * natural;
        limits.within(Twist {
            speed: speed * heading_error.cos() + damped * ahead,
            turn_rate: turn + self.gain * speed * left + damped * heading_error,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_axes_differ_once_the_robot_looks_elsewhere() {
        let reference = Reference {
            position: [0.0, 0.1],
            velocity: [0.0, 0.5],
            acceleration: [0.0; 2],
        };
        let up = Pose {
            position: [0.0; 2],
            heading: std::f64::consts::FRAC_PI_2,
        };
        let limits = DifferentialLimits {
            max_speed: 10.0,
            max_turn_rate: 100.0,
            ..DifferentialLimits::default()
        };
        let law = Nonlinear::default();
        let motion = (up.heading, 0.0);
        let twist = law.twist(&up, &reference, motion, &limits, 0.06);
        // K_x = 2 * 0.95 * sqrt(10) * 0.5 = 3.0042, all of the error is ahead.
        let damped = 2.0 * 0.95 * 10f64.sqrt() * 0.5;
        assert!((twist.speed - (0.5 + 0.1 * damped)).abs() < 1e-15);
        assert!(twist.turn_rate.abs() < 1e-15);
        let printed = Nonlinear {
            frame: ErrorFrame::World,
            ..law
        };
        let twist = printed.twist(&up, &reference, motion, &limits, 0.06);
        assert!((twist.speed - 0.5).abs() < 1e-15 && (twist.turn_rate - 0.5).abs() < 1e-15);
    }
}
