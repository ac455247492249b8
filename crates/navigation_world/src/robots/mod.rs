//! Robots: how a commanded force becomes motion, and what it costs.

pub mod differential;
pub mod drives;
mod holonomic;
pub mod wheels;

pub use holonomic::{HolonomicRobot, WheelModel, Wheels};

use crate::world::region::RobotLimits;
use numeric::error::{Failure, Given, Result, not_negative, positive};

/// Driven wheels and motors of a two-wheel robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialWheels {
    /// Wheel radius `r_w` in m.
    pub radius: f64,
    /// Span `l` between the wheels in m.
    pub span: f64,
    /// Winding resistance `R_a` in ohm.
    pub resistance: f64,
    /// `J/K` of each wheel in A s^2.
    pub inertia: [f64; 2],
    /// `B/K` of each wheel in A s.
    pub viscous_friction: [f64; 2],
    /// `tau/K` of each wheel in A.
    pub static_friction: [f64; 2],
}

/// A two-wheel robot; its regions are larger by the time it needs to turn.
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
    /// Largest deceleration in m/s^2; the largest acceleration where it is `None`.
    pub max_deceleration: Option<f64>,
    /// Largest angular acceleration in rad/s^2.
    pub max_angular_acceleration: f64,
    /// Largest turn rate in rad/s beside that of the wheels at the largest speed, if there is one.
    pub max_turn_rate: Option<f64>,
    /// Largest change of the turn rate in rad/s^2 beside the largest angular acceleration, if there is one.
    pub max_turn_acceleration: Option<f64>,
    /// Share of the largest speed that the robot which it follows may use, so that it can catch up.
    pub reference_speed_share: f64,
    /// Wheels and motors.
    pub wheels: DifferentialWheels,
}

impl Default for DifferentialDriveRobot {
    /// The robot of Zeng (2011), chapter 7 and Table E.2; the resistance is that of the
    /// motor's datasheet.
    fn default() -> Self {
        Self {
            mass: 3.7,
            radius: 0.2,
            max_speed: 0.7,
            max_acceleration: 10.0,
            max_deceleration: None,
            max_angular_acceleration: 70.0,
            max_turn_rate: None,
            max_turn_acceleration: None,
            reference_speed_share: 0.9,
            wheels: DifferentialWheels {
                radius: 0.025,
                span: 0.28,
                resistance: 1.16,
                inertia: [0.0079, 0.0057],
                viscous_friction: [0.0032, 0.0030],
                static_friction: [0.18, 0.28],
            },
        }
    }
}

impl DifferentialDriveRobot {
    /// Returns the robot if its values are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        positive("radius", self.radius)?;
        positive("max_speed", self.max_speed)?;
        positive("max_acceleration", self.max_acceleration)?;
        positive("max_angular_acceleration", self.max_angular_acceleration)?;
        for (name, limit) in [
            ("max_deceleration", self.max_deceleration),
            ("max_turn_rate", self.max_turn_rate),
            ("max_turn_acceleration", self.max_turn_acceleration),
        ] {
            limit.map_or(Ok(0.0), |limit| positive(name, limit))?;
        }
        let share = positive("reference_speed_share", self.reference_speed_share)?;
        if share > 1.0 {
            let rule = "be positive and at most 1";
            let given = Given::Number(share);
            return Err(Failure::invalid("reference_speed_share", rule, given));
        }
        positive("wheel_radius", self.wheels.radius)?;
        positive("wheel_span", self.wheels.span)?;
        not_negative("winding_resistance", self.wheels.resistance)?;
        for wheel in 0..2 {
            let inertia = self.wheels.inertia[wheel];
            not_negative(&format!("wheel_inertia[{wheel}]"), inertia)?;
            let friction = self.wheels.viscous_friction[wheel];
            not_negative(&format!("wheel_viscous_friction[{wheel}]"), friction)?;
            let friction = self.wheels.static_friction[wheel];
            not_negative(&format!("wheel_static_friction[{wheel}]"), friction)?;
        }
        Ok(self)
    }

    /// The robot that a law drives and that this one follows: a point mass with the same mass,
    /// size and acceleration, and a share of the speed.
    #[must_use]
    pub fn reference(&self) -> HolonomicRobot {
        HolonomicRobot {
            mass: self.mass,
            radius: self.radius,
            max_speed: self.max_speed * self.reference_speed_share,
            max_acceleration: self.max_acceleration,
            max_deceleration: self.max_deceleration,
            ..HolonomicRobot::default()
        }
    }

    /// Largest turn rate in rad/s: at most `2 V/l`, at which the wheels run at the largest speed against
    /// each other.
    #[must_use]
    pub fn turn_rate(&self) -> f64 {
        let of_wheels = 2.0 * self.max_speed / self.wheels.span;
        self.max_turn_rate
            .map_or(of_wheels, |most| most.min(of_wheels))
    }

    /// Largest change of the turn rate in rad/s^2.
    #[must_use]
    pub fn turn_acceleration(&self) -> f64 {
        let most = self.max_angular_acceleration;
        self.max_turn_acceleration
            .map_or(most, |given| given.min(most))
    }

    /// Time in s for a quarter of a turn: `sqrt(pi / alpha)`, and `pi/(2 omega) + omega/(2 alpha)` where a
    /// largest turn rate is given and reached before.
    fn turn_time(&self) -> f64 {
        let turn = self.turn_acceleration();
        let time = (std::f64::consts::PI / turn).sqrt();
        match self.max_turn_rate {
            Some(_) if turn * time > self.turn_rate() => {
                let rate = self.turn_rate();
                std::f64::consts::FRAC_PI_2 / rate + 0.5 * rate / turn
            }
            _ => time,
        }
    }

    /// Limits for the size of regions.
    #[must_use]
    pub fn limits(&self) -> RobotLimits {
        RobotLimits {
            radius: self.radius,
            max_speed: self.max_speed,
            max_acceleration: self.reference().guaranteed_acceleration(),
            turn_time: self.turn_time(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_turns_slower_needs_longer_for_a_quarter_of_a_turn() {
        let robot = DifferentialDriveRobot::default();
        let time = robot.limits().turn_time;
        assert_eq!(time, (std::f64::consts::PI / 70.0).sqrt());
        let limited = |rate, acceleration| DifferentialDriveRobot {
            max_turn_rate: rate,
            max_turn_acceleration: acceleration,
            ..robot
        };
        let of_wheels = limited(None, None).turn_rate();
        assert_eq!(limited(Some(100.0), Some(1e3)).turn_rate(), of_wheels);
        assert_eq!(limited(None, Some(1e3)).limits().turn_time, time);
        assert!((limited(None, Some(17.5)).limits().turn_time - 2.0 * time).abs() < 1e-15);
        // At 1 rad/s: half a radian of it while the rate rises and falls by 1 rad/s^2.
        let slow = limited(Some(1.0), Some(1.0)).limits().turn_time;
        assert!((slow - (std::f64::consts::FRAC_PI_2 + 0.5)).abs() < 1e-15);
    }

    #[test]
    fn limits_that_are_given_are_positive() {
        let robot = DifferentialDriveRobot {
            max_turn_rate: Some(0.0),
            ..DifferentialDriveRobot::default()
        };
        let words = robot.checked().unwrap_err().to_string();
        assert!(words.contains("max_turn_rate"), "{words}");
    }
}
