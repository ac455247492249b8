//! Wheel speeds from the motion of the robot, and back.

use numeric::error::{Result, positive};

/// Rim speed of each omni-wheel for a unit velocity forward and to the left, (D.1.2) with wheel
/// axes at 120, 240 and 0 degrees: `v_i = -x' sin z_i + y' cos z_i`.
pub(crate) fn omni_rows() -> [[f64; 2]; 3] {
    let half_root_3 = 0.5 * 3f64.sqrt();
    [[-half_root_3, -0.5], [half_root_3, -0.5], [0.0, 1.0]]
}

/// A velocity of the world seen from a robot that is turned by a heading.
fn into_robot([x, y, turn_rate]: [f64; 3], heading: f64) -> [f64; 3] {
    let (sin, cos) = heading.sin_cos();
    [x * cos + y * sin, y * cos - x * sin, turn_rate]
}

/// A velocity in the frame of a robot that is turned by a heading, seen from the world.
fn into_world([forward, left, turn_rate]: [f64; 3], heading: f64) -> [f64; 3] {
    let (sin, cos) = heading.sin_cos();
    [
        forward * cos - left * sin,
        forward * sin + left * cos,
        turn_rate,
    ]
}

/// Three omni-wheels at the corners of an equilateral triangle (D.1.2, D.1.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmniKinematics {
    /// Wheel radius `r_w` in m.
    pub wheel_radius: f64,
    /// Distance from the center of the robot to each wheel `l_w`, in m.
    pub center_distance: f64,
}

impl Default for OmniKinematics {
    /// Radius and distance are chosen, the source gives neither.
    fn default() -> Self {
        Self {
            wheel_radius: 0.025,
            center_distance: 0.17,
        }
    }
}

impl OmniKinematics {
    /// Passes lengths that are finite and positive.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("wheel_radius", self.wheel_radius)?;
        positive("center_distance", self.center_distance)?;
        Ok(self)
    }

    /// Wheel speeds in rad/s from the velocity forward and to the left in m/s and the turn rate in
    /// rad/s, (D.1.3).
    #[must_use]
    pub fn wheel_speeds(&self, [forward, left, turn_rate]: [f64; 3]) -> [f64; 3] {
        let turning = self.center_distance * turn_rate;
        omni_rows()
            .map(|[along, across]| (along * forward + across * left + turning) / self.wheel_radius)
    }

    /// Velocity forward and to the left in m/s and turn rate in rad/s from the wheel speeds in
    /// rad/s: the inverse of (D.1.3).
    #[must_use]
    pub fn body_velocity(&self, speeds: [f64; 3]) -> [f64; 3] {
        let [first, second, third] = speeds.map(|speed| speed * self.wheel_radius);
        [
            (second - first) / 3f64.sqrt(),
            (2.0 * third - first - second) / 3.0,
            (first + second + third) / (3.0 * self.center_distance),
        ]
    }

    /// Wheel speeds in rad/s from velocity in m/s and turn rate in the world, (D.1.4).
    #[must_use]
    pub fn wheel_speeds_in_world(&self, velocity: [f64; 3], heading: f64) -> [f64; 3] {
        self.wheel_speeds(into_robot(velocity, heading))
    }

    /// Velocity in m/s and turn rate in the world from the wheel speeds in rad/s.
    #[must_use]
    pub fn world_velocity(&self, speeds: [f64; 3], heading: f64) -> [f64; 3] {
        into_world(self.body_velocity(speeds), heading)
    }
}

/// Two driven wheels on one axis; wheel 1 is the right one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialKinematics {
    /// Wheel radius `r_w` in m.
    pub wheel_radius: f64,
    /// Span between the wheels `l` in m.
    pub span: f64,
}

impl Default for DifferentialKinematics {
    /// The robot of Zeng (2011), chapter 7.
    fn default() -> Self {
        Self {
            wheel_radius: 0.025,
            span: 0.28,
        }
    }
}

impl DifferentialKinematics {
    /// Passes lengths that are finite and positive.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("wheel_radius", self.wheel_radius)?;
        positive("span", self.span)?;
        Ok(self)
    }

    /// Wheel speeds in rad/s from speed in m/s and turn rate in rad/s, (E.1.3).
    #[must_use]
    pub fn wheel_speeds(&self, [speed, turn_rate]: [f64; 2]) -> [f64; 2] {
        let turning = 0.5 * self.span * turn_rate;
        [
            (speed + turning) / self.wheel_radius,
            (speed - turning) / self.wheel_radius,
        ]
    }

    /// Speed in m/s and turn rate in rad/s from the wheel speeds in rad/s, (E.1.4) with 4/l where
    /// 1/l is printed.
    #[must_use]
    pub fn body_velocity(&self, [right, left]: [f64; 2]) -> [f64; 2] {
        [
            0.5 * self.wheel_radius * (right + left),
            self.wheel_radius * (right - left) / self.span,
        ]
    }

    /// Velocity in m/s and turn rate in the world from the wheel speeds in rad/s, (E.1.5) with the
    /// same correction.
    #[must_use]
    pub fn world_velocity(&self, speeds: [f64; 2], heading: f64) -> [f64; 3] {
        let [speed, turn_rate] = self.body_velocity(speeds);
        into_world([speed, 0.0, turn_rate], heading)
    }

    /// Wheel speeds in rad/s from velocity in m/s and turn rate in the world, (E.1.6); what of the
    /// velocity is across the heading, the wheels cannot do.
    #[must_use]
    pub fn wheel_speeds_in_world(&self, velocity: [f64; 3], heading: f64) -> [f64; 2] {
        let [speed, _, turn_rate] = into_robot(velocity, heading);
        self.wheel_speeds([speed, turn_rate])
    }

    /// Speed across the heading in m/s, `x' sin phi - y' cos phi`, which the wheels keep at zero:
    /// (E.1.2) with the minus that is printed as a plus.
    #[must_use]
    pub fn sideways([x, y, turn_rate]: [f64; 3], heading: f64) -> f64 {
        -into_robot([x, y, turn_rate], heading)[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_drives_all_omni_wheels_alike() {
        let robot = OmniKinematics::default().checked().unwrap();
        let speeds = robot.wheel_speeds([0.0, 0.0, 2.0]);
        assert!(speeds.iter().all(|speed| (speed - 13.6).abs() < 1e-12));
    }

    #[test]
    fn forward_leaves_the_third_wheel_at_rest() {
        let speeds = OmniKinematics::default().wheel_speeds([0.5, 0.0, 0.0]);
        assert_eq!((speeds[0], speeds[2]), (-speeds[1], 0.0));
        assert!((speeds[1] - 17.320_508_075_688_77).abs() < 1e-12);
    }

    #[test]
    fn a_turn_to_the_left_drives_the_right_wheel() {
        let robot = DifferentialKinematics::default().checked().unwrap();
        let [right, left] = robot.wheel_speeds([0.0, 1.0]);
        assert!((right - 5.6).abs() < 1e-14 && right == -left);
        let turned = robot.world_velocity([4.0, 4.0], std::f64::consts::FRAC_PI_2);
        assert!(turned[0].abs() < 1e-16 && (turned[1] - 0.1).abs() < 1e-16 && turned[2] == 0.0);
    }

    #[test]
    fn the_printed_second_row_would_not_invert() {
        let robot = DifferentialKinematics::default();
        let [right, left] = robot.wheel_speeds([0.3, 1.5]);
        let printed = robot.wheel_radius / 4.0 * (right - left) / robot.span;
        assert!((robot.body_velocity([right, left])[1] - 1.5).abs() < 1e-14);
        assert!((4.0 * printed - 1.5).abs() < 1e-14);
    }

    #[test]
    fn lengths_must_be_positive() {
        let flat = OmniKinematics {
            wheel_radius: 0.0,
            ..OmniKinematics::default()
        };
        assert!(flat.checked().is_err());
        let narrow = DifferentialKinematics {
            span: f64::NAN,
            ..DifferentialKinematics::default()
        };
        assert!(narrow.checked().is_err());
    }
}
