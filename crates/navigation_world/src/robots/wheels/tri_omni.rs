//! Three omni-wheels at 90, 210 and 330 deg: (11) to (14) of Gussu and Lin (2017) with signs and
//! columns restored.

use numeric::error::{Failure, Given, Result, positive};

/// Half of the square root of 3.
const HALF_ROOT_3: f64 = 0.866_025_403_784_438_6;

/// Unit tangents `a_1`, `b_1`, `c_1` of the wheels, counterclockwise: Table 2 with its lost row.
pub const TANGENTS: [[f64; 2]; 3] = [[-1.0, 0.0], [0.5, -HALF_ROOT_3], [0.5, HALF_ROOT_3]];

/// A platform with three omni-wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriOmni {
    /// Radius `r_w` of the wheels, in m.
    pub wheel_radius: f64,
    /// Width `b_w` of the wheels, in m.
    pub wheel_width: f64,
    /// Radius R of the chassis, in m.
    pub chassis_radius: f64,
}

impl TriOmni {
    /// Returns the sizes if they are valid.
    ///
    /// # Errors
    /// A size is not positive, or the wheels are too wide for the chassis.
    pub fn checked(self) -> Result<Self> {
        positive("wheel_radius", self.wheel_radius)?;
        positive("wheel_width", self.wheel_width)?;
        positive("chassis_radius", self.chassis_radius)?;
        if self.arm() <= 0.0 {
            let rule = "be smaller than twice chassis_radius";
            return Err(Failure::invalid(
                "wheel_width",
                rule,
                Given::Number(self.wheel_width),
            ));
        }
        Ok(self)
    }

    /// Distance R - `b_w`/2 of the wheel centers from the center, in m.
    #[must_use]
    pub fn arm(&self) -> f64 {
        self.chassis_radius - 0.5 * self.wheel_width
    }

    /// Wheel speeds in rad/s, positive about the outward axle, for a velocity in m/s in the frame
    /// of the body and a yaw rate in rad/s: omega = -(t . v + (R - `b_w`/2) phi') / `r_w`, (14).
    #[inline]
    #[must_use]
    pub fn wheel_speeds(&self, velocity: [f64; 2], yaw_rate: f64) -> [f64; 3] {
        TANGENTS.map(|[x, y]| {
            -(x * velocity[0] + y * velocity[1] + self.arm() * yaw_rate) / self.wheel_radius
        })
    }

    /// Velocity in m/s and yaw rate in rad/s for wheel speeds in rad/s: with the rim speeds
    /// s = -`r_w` omega, v = 2/3 sum s t and phi' = mean(s) / (R - `b_w`/2).
    #[inline]
    #[must_use]
    pub fn body_velocity(&self, wheel_speeds: [f64; 3]) -> ([f64; 2], f64) {
        let [one, two, three] = wheel_speeds.map(|speed| -self.wheel_radius * speed);
        let along = |axis: usize| {
            2.0 / 3.0
                * (one * TANGENTS[0][axis] + two * TANGENTS[1][axis] + three * TANGENTS[2][axis])
        };
        let yaw_rate = (one + two + three) / (3.0 * self.arm());
        ([along(0), along(1)], yaw_rate)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::TriOmni;

    const ROBOT: TriOmni = TriOmni {
        wheel_radius: 0.0625,
        wheel_width: 0.038,
        chassis_radius: 0.33,
    };

    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    }

    /// Velocity of the point of a wheel that touches the ground, along the wheel: that of the body
    /// at the hub and that of the turning wheel, in three dimensions.
    fn slip(angle: f64, velocity: [f64; 2], yaw_rate: f64, wheel_speed: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        let hub = [ROBOT.arm() * cos, ROBOT.arm() * sin, ROBOT.wheel_radius];
        let turning = cross([0.0, 0.0, yaw_rate], hub);
        let axle = [wheel_speed * cos, wheel_speed * sin, 0.0];
        let rolling = cross(axle, [0.0, 0.0, -ROBOT.wheel_radius]);
        let point = [
            velocity[0] + turning[0] + rolling[0],
            velocity[1] + turning[1] + rolling[1],
        ];
        // The rollers let the point move along the axle, not across it.
        point[1] * cos - point[0] * sin
    }

    proptest! {
        #[test]
        fn no_wheel_slips(x in -2.0..2.0_f64, y in -2.0..2.0_f64, yaw in -3.0..3.0_f64) {
            let speeds = ROBOT.wheel_speeds([x, y], yaw);
            for (angle, speed) in [90.0_f64, 210.0, 330.0].into_iter().zip(speeds) {
                prop_assert!(slip(angle.to_radians(), [x, y], yaw, speed).abs() < 1e-14 * 4.0);
            }
        }

        #[test]
        fn the_inverse_is_the_inverse(
            x in -1.0..1.0_f64, y in -1.0..1.0_f64, yaw in -1.0..1.0_f64
        ) {
            let (velocity, rate) = ROBOT.body_velocity(ROBOT.wheel_speeds([x, y], yaw));
            prop_assert!((velocity[0] - x).abs() < 1e-14);
            prop_assert!((velocity[1] - y).abs() < 1e-14);
            prop_assert!((rate - yaw).abs() < 1e-14);
        }
    }

    #[test]
    fn magnitudes_alone_make_the_robot_spin() {
        for degrees in [0.0_f64, 30.0, 60.0, 90.0, 200.0, 300.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let speeds = ROBOT.wheel_speeds([0.3 * cos, 0.3 * sin], 0.0);
            let (_, rate) = ROBOT.body_velocity(speeds.map(f64::abs));
            assert!((-0.65..-0.55).contains(&rate), "{degrees} {rate}");
        }
    }
}
