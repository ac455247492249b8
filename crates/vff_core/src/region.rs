//! Sizes of the critical and active regions from the limits of robot and obstacle.

use crate::error::{Failure, Given, Result, positive};
use crate::obstacle::{Obstacle, Regions, Shape};

/// Limits of a robot that size the regions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotLimits {
    /// Radius `rho_r` in m.
    pub radius: f64,
    /// Largest speed `V` in m/s.
    pub max_speed: f64,
    /// Largest acceleration `a` in m/s^2.
    pub max_acceleration: f64,
    /// Time it needs to turn before it can move sideways, in s; 0 for a holonomic robot.
    pub turn_time: f64,
}

/// Smallest safe regions, Zeng (2011), section 5.3.
///
/// `delta_r = V T_s + a dt1^2/2`, `delta_o = V_o (dt1 + T_s)`, `dt1 = t_a = V/a`;
/// disc: `r3 = delta_r + delta_o + rho_o + rho_r`, `r2 = (V + V_o)(dt2 + T_s)`;
/// rectangle: `r3 = delta_r + rho_r`, `r2 = V (dt2 + T_s)`;
/// `dt2 = (r3 + B - a t_a^2/2)/V + t_a + t_turn`, `B` half the faced side of a rectangle,
/// 0 for a disc.
///
/// # Errors
/// The control period or the faced side is not positive, or a disc is given a faced side.
pub fn radii(
    robot: &RobotLimits,
    obstacle: &Obstacle,
    control_period: f64,
    faced_side: Option<f64>,
) -> Result<Regions> {
    let period = positive("control_period", control_period)?;
    let (speed, acceleration) = (robot.max_speed, robot.max_acceleration);
    let stopping_time = speed / acceleration;
    let ramp = 0.5 * acceleration * stopping_time * stopping_time;
    let robot_way = speed * period + ramp;
    let (critical_radius, half_side, closing) = match obstacle.shape {
        Shape::Disc { radius } => {
            if let Some(side) = faced_side {
                let rule = "be given for a rectangle only";
                return Err(Failure::invalid("faced_side", rule, Given::Number(side)));
            }
            let obstacle_speed = obstacle.max_speed();
            let obstacle_way = obstacle_speed * (stopping_time + period);
            (
                robot_way + obstacle_way + radius + robot.radius,
                0.0,
                speed + obstacle_speed,
            )
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
            (robot_way + robot.radius, half_side, speed)
        }
    };
    let avoiding_time =
        (critical_radius + half_side - ramp) / speed + stopping_time + robot.turn_time;
    Ok(Regions {
        critical_radius,
        active_radius: closing * (avoiding_time + period),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Motion;
    use crate::obstacle::Limits;

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
            let regions = radii(&robot(turn_time), obstacle, 0.06, side).unwrap();
            assert!((regions.critical_radius - critical).abs() < 5.1e-5);
            assert!((regions.active_radius - active).abs() < 5.1e-5);
        }
    }
}
