//! Sizes of the critical and active regions from the limits of robot and obstacle.

use crate::sensing::measurement::Measurement;
use crate::world::obstacle::{Obstacle, Regions, Shape};
use numeric::error::{Failure, Given, Result, not_negative, positive};

/// Limits of a robot that size the regions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotLimits {
    /// Radius `rho_r` in m.
    pub radius: f64,
    /// Largest speed `V` in m/s.
    pub max_speed: f64,
    /// Acceleration `a` in m/s^2 that it has in every direction.
    pub max_acceleration: f64,
    /// Time it needs to turn before it can move sideways, in s; 0 for a holonomic robot.
    pub turn_time: f64,
}

/// Sensing errors that regions are sized for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensing {
    /// How positions are measured; exactly if `None`.
    pub measurement: Option<Measurement>,
    /// Age of the measured positions in s, in place of that of the measurement.
    pub latency: Option<f64>,
    /// Largest error of the measured distance in m, in place of that of the measurement.
    pub position_error: Option<f64>,
}

impl Sensing {
    /// All as a measurement has it.
    #[must_use]
    pub fn by(measurement: Option<Measurement>) -> Self {
        Self {
            measurement,
            latency: None,
            position_error: None,
        }
    }

    /// Largest difference in m between the known and the true distance of a robot from an obstacle.
    ///
    /// The known distance is that of two measured positions. Each lies at most the error bound from
    /// where the body was, and the body has gone at most its speed times the latency since.
    fn slack(&self, robot: &RobotLimits, obstacle: &Obstacle) -> Result<f64> {
        let stationary = obstacle.motion.is_stationary();
        let of_robot = self.measurement.is_some_and(|found| found.of_robot());
        let of_obstacle = match &self.measurement {
            Some(measurement) => measurement.of_obstacle(stationary),
            None => self.latency.is_some(),
        };
        let given = |share: bool, value: f64| if share { value } else { 0.0 };
        let latency = match self.latency {
            Some(latency) => not_negative("latency", latency)?,
            None => self.measurement.map_or(0.0, |found| found.latency()),
        };
        let error = match self.position_error {
            Some(error) => not_negative("position_error", error)?,
            None => self.measurement.map_or(0.0, |found| {
                let bound = found.error_bound();
                given(of_robot, bound) + given(of_obstacle, bound)
            }),
        };
        let of_obstacle = if of_obstacle {
            obstacle.max_speed()
        } else {
            0.0
        };
        Ok((given(of_robot, robot.max_speed) + of_obstacle) * latency + error)
    }
}

/// Smallest safe regions, Zeng (2011), section 5.3, and what late and noisy sensing adds.
///
/// `delta_r = V T_s + a dt1^2/2`, `delta_o = V_o (dt1 + T_s)`, `dt1 = t_a = V/a`;
/// disc: `r3 = delta_r + delta_o + rho_o + rho_r + delta`, `r2 = (V + V_o)(dt2 + T_s) + delta`;
/// rectangle: `r3 = delta_r + delta_o + rho_r + delta`, `r2 = (V + V_o) (dt2 + T_s) + delta`, in the
/// source for one that stands, `V_o = 0`;
/// `dt2 = (r3 + B - a t_a^2/2)/V + t_a + t_turn`, `B` half the faced side of a rectangle,
/// 0 for a disc; `delta` the largest difference between the known and the true distance, 0 with
/// exact sensing, the case of the source.
///
/// # Errors
/// The control period or the faced side is not positive, a disc is given a faced side, or latency
/// or position error is negative or not finite.
pub fn radii(
    robot: &RobotLimits,
    obstacle: &Obstacle,
    control_period: f64,
    faced_side: Option<f64>,
    sensing: &Sensing,
) -> Result<Regions> {
    let period = positive("control_period", control_period)?;
    let (speed, acceleration) = (robot.max_speed, robot.max_acceleration);
    let stopping_time = speed / acceleration;
    let ramp = 0.5 * acceleration * stopping_time * stopping_time;
    let robot_way = speed * period + ramp;
    let obstacle_speed = obstacle.max_speed();
    let obstacle_way = obstacle_speed * (stopping_time + period);
    let (critical_radius, half_side) = match obstacle.shape {
        Shape::Disc { radius } => {
            if let Some(side) = faced_side {
                let rule = "be given for a rectangle only";
                return Err(Failure::invalid("faced_side", rule, Given::Number(side)));
            }
            (robot_way + obstacle_way + radius + robot.radius, 0.0)
        }
        Shape::Rectangle {
            half_length,
            half_width,
            ..
        } => {
            let half_side = match faced_side {
                Some(side) => 0.5 * positive("faced_side", side)?,
                None => half_length.max(half_width),
            };
            (robot_way + obstacle_way + robot.radius, half_side)
        }
    };
    let closing = speed + obstacle_speed;
    let slack = sensing.slack(robot, obstacle)?;
    let critical_radius = critical_radius + slack;
    let avoiding_time =
        (critical_radius + half_side - ramp) / speed + stopping_time + robot.turn_time;
    Ok(Regions {
        critical_radius,
        active_radius: closing * (avoiding_time + period) + slack,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensing::measurement::{Distribution, Noisy};
    use crate::world::motion::Motion;
    use crate::world::obstacle::Limits;

    fn robot(turn_time: f64) -> RobotLimits {
        RobotLimits {
            radius: 0.2,
            max_speed: 0.7,
            max_acceleration: 10.0,
            turn_time,
        }
    }

    #[test]
    fn radii_are_those_of_the_source() {
        // Printed to four decimals: specification of the regions, Zeng (2011), sections 6.3, 7.3.
        let person = Obstacle::disc(
            0.4,
            Motion::at_rest([0.0; 2]),
            Limits {
                max_speed: Some(1.0),
                ..Limits::default()
            },
        )
        .unwrap();
        let disc = Obstacle::disc_at_rest([0.0; 2], 0.1, Limits::default()).unwrap();
        let wall = Obstacle::rectangle([0.0; 2], [1.4, 0.6], 0.0, Limits::default()).unwrap();
        let turn = (std::f64::consts::PI / 70.0).sqrt();
        for (obstacle, side, turn_time, critical, active) in [
            (&person, None, 0.0, 0.7965, 2.0959),
            (&person, None, turn, 0.7965, 2.4560),
            (&disc, None, 0.0, 0.3665, 0.4330),
            (&disc, None, turn, 0.3665, 0.5813),
            (&wall, Some(0.6), 0.0, 0.2665, 0.6330),
            (&wall, Some(0.6), turn, 0.2665, 0.7813),
        ] {
            let regions =
                radii(&robot(turn_time), obstacle, 0.06, side, &Sensing::default()).unwrap();
            assert!((regions.critical_radius - critical).abs() < 5.1e-5);
            assert!((regions.active_radius - active).abs() < 5.1e-5);
        }
    }
    #[test]
    fn late_and_noisy_sensing_adds_its_largest_error() {
        let person = Obstacle::disc(
            0.4,
            Motion::moving([0.0; 2], [1.0, 0.0], [0.0; 2], None).unwrap(),
            Limits {
                max_speed: Some(1.6),
                ..Limits::default()
            },
        )
        .unwrap();
        let wall = Obstacle::rectangle([0.0; 2], [1.4, 0.6], 0.0, Limits::default()).unwrap();
        let measured = |noisy| {
            let found = Measurement::new(0.025, Distribution::Uniform, noisy).unwrap();
            Sensing::by(Some(found.late(0.1).unwrap()))
        };
        let error = 0.025 * std::f64::consts::SQRT_2;
        for (obstacle, noisy, slack) in [
            (&person, Noisy::Obstacles, 0.16 + error),
            (&person, Noisy::Robot, 0.07 + error),
            (&person, Noisy::Both, 0.23 + 2.0 * error),
            (&wall, Noisy::Obstacles, 0.0),
            (&wall, Noisy::Robot, 0.07 + error),
            (&wall, Noisy::Both, 0.07 + error),
        ] {
            let [exact, late] = [Sensing::default(), measured(noisy)]
                .map(|sensing| radii(&robot(0.0), obstacle, 0.06, None, &sensing).unwrap());
            assert!((late.critical_radius - exact.critical_radius - slack).abs() < 1e-12);
            let share = if obstacle == &person { 2.3 } else { 0.7 } / 0.7;
            let grown = late.active_radius - exact.active_radius;
            assert!((grown - (share + 1.0) * slack).abs() < 1e-12);
        }
    }
}
