//! Three-wheel holonomic robot: point mass with limits, wheel kinematics, feed-forward currents.

use crate::robots::wheels::omni_rows;
use crate::world::geometry::RobotState;
use crate::world::region::RobotLimits;
use numeric::error::{Result, not_negative, positive};
use numeric::lanes::{Real, Vector2};

/// Wheel speeds below this stand for standstill, so that friction has no sign, in rad/s.
const WHEEL_STANDSTILL: f64 = 1e-9;

/// Wheels and motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheels {
    /// Wheel radius `r_w` in m.
    pub radius: f64,
    /// Winding resistance `R_a` in ohm.
    pub resistance: f64,
    /// `J/K` of each wheel in A s^2.
    pub inertia: [f64; 3],
    /// `B/K` of each wheel in A s.
    pub viscous_friction: [f64; 3],
    /// `tau/K` of each wheel in A.
    pub static_friction: [f64; 3],
}

/// Robot that accelerates in any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HolonomicRobot {
    /// Mass `M_r` in kg.
    pub mass: f64,
    /// Radius `rho_r` in m.
    pub radius: f64,
    /// Largest speed in m/s.
    pub max_speed: f64,
    /// Largest acceleration in m/s^2.
    pub max_acceleration: f64,
    /// Largest deceleration in m/s^2; the largest acceleration where it is `None`.
    pub max_deceleration: Option<f64>,
    /// Wheels and motors.
    pub wheels: Wheels,
}

impl Default for HolonomicRobot {
    /// The robot of Zeng (2011), chapter 6; radius and resistance of the wheels are a calibration.
    fn default() -> Self {
        Self {
            mass: 4.4,
            radius: 0.2,
            max_speed: 0.7,
            max_acceleration: 10.0,
            max_deceleration: None,
            wheels: Wheels {
                radius: 0.10,
                resistance: 4.86,
                inertia: [0.0073, 0.0074, 0.0065],
                viscous_friction: [0.0019, 0.0020, 0.0024],
                static_friction: [0.19, 0.22, 0.18],
            },
        }
    }
}

impl HolonomicRobot {
    /// Returns the robot if its values are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        positive("radius", self.radius)?;
        positive("max_speed", self.max_speed)?;
        positive("max_acceleration", self.max_acceleration)?;
        positive("max_deceleration", self.deceleration())?;
        positive("wheel_radius", self.wheels.radius)?;
        not_negative("winding_resistance", self.wheels.resistance)?;
        for wheel in 0..3 {
            let wheels = &self.wheels;
            for (name, value) in [
                ("wheel_inertia", wheels.inertia[wheel]),
                ("wheel_viscous_friction", wheels.viscous_friction[wheel]),
                ("wheel_static_friction", wheels.static_friction[wheel]),
            ] {
                // Batches check millions of robots: a name is put together only for an error.
                if not_negative(name, value).is_err() {
                    not_negative(&format!("{name}[{wheel}]"), value)?;
                }
            }
        }
        Ok(self)
    }

    /// Limits for the size of regions.
    #[must_use]
    pub fn limits(&self) -> RobotLimits {
        RobotLimits {
            radius: self.radius,
            max_speed: self.max_speed,
            max_acceleration: self.guaranteed_acceleration(),
            turn_time: 0.0,
        }
    }

    /// Largest deceleration in m/s^2.
    #[inline]
    #[must_use]
    pub fn deceleration(&self) -> f64 {
        self.max_deceleration.unwrap_or(self.max_acceleration)
    }

    /// Acceleration in m/s^2 that it has in every direction, whatever its velocity is.
    #[inline]
    #[must_use]
    pub fn guaranteed_acceleration(&self) -> f64 {
        self.max_acceleration.min(self.deceleration())
    }

    /// Acceleration from a commanded force: `F/m`, shortened to the larger one of the largest
    /// acceleration and the largest deceleration; which of them holds, the velocity tells.
    #[inline(always)]
    pub fn acceleration<R: Real>(&self, force: Vector2<R>) -> Vector2<R> {
        let most = self.max_acceleration.max(self.deceleration());
        limited(force * R::splat(1.0 / self.mass), most).0
    }

    /// The change of velocity in m/s that a step in s makes of one that is asked for.
    ///
    /// Along the velocity and across it is at most `a T`. Where it points backwards it lies in the
    /// half ellipse with the half axes `d T` against the velocity and `a T` across it, `d` the largest
    /// deceleration; with `d > a` a change of more than `a T` ends where the robot brakes no longer.
    #[inline(always)]
    pub fn change<R: Real>(
        &self,
        velocity: Vector2<R>,
        asked: Vector2<R>,
        step: f64,
    ) -> Vector2<R> {
        match self.max_deceleration {
            None => asked,
            Some(deceleration) => {
                let most = [self.max_acceleration * step, deceleration * step];
                shortened(velocity, asked, most)
            }
        }
    }

    /// Velocity shortened to the largest speed, and the speed that is left.
    #[inline(always)]
    pub fn limited_velocity<R: Real>(&self, velocity: Vector2<R>) -> (Vector2<R>, R) {
        limited(velocity, self.max_speed)
    }

    /// One step of semi-implicit Euler: adds a change of velocity in m/s, then moves with the new
    /// velocity; returns the speed in m/s.
    #[inline(always)]
    pub fn advance<R: Real>(&self, state: &mut RobotState<R>, push: Vector2<R>, step: f64) -> R {
        let push = self.change(state.velocity, push, step);
        let (velocity, speed) = self.limited_velocity(state.velocity + push);
        state.velocity = velocity;
        state.position += velocity * R::splat(step);
        speed
    }
}

/// A change of velocity shortened to what a robot can add to its speed, and take from it, in m/s.
#[inline(always)]
fn shortened<R: Real>(
    velocity: Vector2<R>,
    asked: Vector2<R>,
    [faster, slower]: [f64; 2],
) -> Vector2<R> {
    let magnitude = asked.dot(&asked).sqrt();
    let against = -velocity.dot(&asked) / magnitude;
    let share = against / velocity.dot(&velocity).sqrt();
    let along = share * share;
    let across = (R::splat(1.0) - along).max(R::zero());
    // Products of limits may exceed every number, their ratio may not.
    let ratio = slower / faster;
    let most = if slower > faster {
        let root = (along * R::splat(1.0 / (ratio * ratio)) + across).sqrt();
        (R::splat(faster) / root).min(against).max(R::splat(faster))
    } else {
        let root = (along + across * R::splat(ratio * ratio)).sqrt();
        (R::splat(slower) / root).min(R::splat(faster))
    };
    // Neither holds for the NaN of what stands or asks for nothing.
    let most = R::select(against.gt(R::zero()), most, R::splat(faster));
    let factor = R::select(magnitude.gt(most), most / magnitude, R::splat(1.0));
    asked * factor
}

/// A vector shortened to a largest magnitude, and its magnitude then.
#[inline(always)]
fn limited<R: Real>(vector: Vector2<R>, limit: f64) -> (Vector2<R>, R) {
    let limit = R::splat(limit);
    let magnitude = vector.dot(&vector).sqrt();
    // A factor of one leaves every bit as it is. No branch: at full speed it would be taken.
    let factor = R::select(magnitude.gt(limit), limit / magnitude, R::splat(1.0));
    (vector * factor, magnitude.min(limit))
}

/// Speed of the wheel with a row of the kinematics, in rad/s.
#[inline(always)]
fn wheel_speed<R: Real>([x, y]: &[f64; 2], velocity: &Vector2<R>) -> R {
    velocity.x * R::splat(*x) + velocity.y * R::splat(*y)
}

/// Wheel speeds and currents at one heading.
#[derive(Clone, Copy, Debug)]
pub struct WheelModel {
    /// Wheel speed for a unit velocity along x and y: rows of (D.1.4) divided by `r_w`, in 1/m.
    rows: [[f64; 2]; 3],
    wheels: Wheels,
    /// `J/K` of each wheel over one motion step, in A s.
    inertia_per_step: [f64; 3],
    /// Motion step in s.
    step: f64,
}

impl WheelModel {
    /// Model of a robot at a constant heading, for one motion step.
    #[must_use]
    pub fn new(robot: &HolonomicRobot, heading: f64, step: f64) -> Self {
        let (sin, cos) = heading.sin_cos();
        let per_meter = 1.0 / robot.wheels.radius;
        let rows = omni_rows().map(|[forward, left]| {
            [
                (forward * cos - left * sin) * per_meter,
                (forward * sin + left * cos) * per_meter,
            ]
        });
        Self {
            rows,
            wheels: robot.wheels,
            inertia_per_step: robot.wheels.inertia.map(|inertia| inertia / step),
            step,
        }
    }

    /// Wheel speeds in rad/s.
    #[inline(always)]
    pub fn speeds<R: Real>(&self, velocity: Vector2<R>) -> [R; 3] {
        // Written out: a map over the rows is not always compiled in its place.
        let [first, second, third] = &self.rows;
        [
            wheel_speed(first, &velocity),
            wheel_speed(second, &velocity),
            wheel_speed(third, &velocity),
        ]
    }

    /// Motor currents in A from the wheel speeds before and after a step, (D.3.2) with 1 A/V:
    /// `i = J/K theta'' + B/K theta' + tau/K sgn(theta')`.
    #[inline(always)]
    pub fn currents<R: Real>(&self, before: &[R; 3], after: &[R; 3]) -> [R; 3] {
        let mut currents = *after;
        for (wheel, current) in currents.iter_mut().enumerate() {
            let speed = after[wheel];
            let per_step = R::splat(self.inertia_per_step[wheel]);
            let friction = R::splat(self.wheels.static_friction[wheel]).copysign(speed);
            let moving = R::splat(WHEEL_STANDSTILL).le(speed.abs());
            let friction = R::select(moving, friction, R::zero());
            *current = (speed - before[wheel]) * per_step
                + speed * R::splat(self.wheels.viscous_friction[wheel])
                + friction;
        }
        currents
    }

    /// Loss for a unit of the sum of squared currents over one step, in J/A^2.
    #[must_use]
    pub fn loss_per_square(&self) -> f64 {
        self.wheels.resistance * self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn third_wheel_stands_still_along_x() {
        let model = WheelModel::new(&HolonomicRobot::default(), 0.0, 0.01);
        let speeds = model.speeds(Vector2::new(0.7, 0.0));
        assert!((speeds[0] + 6.062_177_826_491_07).abs() < 1e-12 && speeds[2] == 0.0);
        let currents = model.currents(&speeds, &speeds);
        assert_eq!(currents[2], 0.0);
        assert!((currents[0] + 0.0019 * 6.062_177_826_491_07 + 0.19).abs() < 1e-12);
    }

    #[test]
    fn heading_turns_the_wheels() {
        let robot = HolonomicRobot::default();
        let turned = WheelModel::new(&robot, 0.4, 0.01);
        let straight = WheelModel::new(&robot, 0.0, 0.01);
        let (sin, cos) = 0.4f64.sin_cos();
        let world = turned.speeds(Vector2::new(0.3 * cos - 0.2 * sin, 0.3 * sin + 0.2 * cos));
        let own = straight.speeds(Vector2::new(0.3, 0.2));
        for wheel in 0..3 {
            assert!((world[wheel] - own[wheel]).abs() < 1e-14);
        }
    }

    #[test]
    fn an_error_names_the_wheel() {
        let mut robot = HolonomicRobot::default();
        robot.wheels.static_friction[1] = -0.1;
        let words = robot.checked().unwrap_err().to_string();
        assert!(words.contains("wheel_static_friction[1]"), "{words}");
    }

    #[test]
    fn it_brakes_and_accelerates_within_limits_of_their_own() {
        for deceleration in [2.0, 10.0, 30.0] {
            let robot = HolonomicRobot {
                max_speed: 100.0,
                max_deceleration: Some(deceleration),
                ..HolonomicRobot::default()
            };
            let change = |velocity: [f64; 2], asked: [f64; 2]| {
                let found = robot.change::<f64>(velocity.into(), asked.into(), 0.1);
                [found.x, found.y]
            };
            assert_eq!(change([5.0, 0.0], [9.0, 0.0]), [1.0, 0.0]);
            assert_eq!(change([5.0, 0.0], [0.0, 9.0]), [0.0, 1.0]);
            assert_eq!(change([0.0, 0.0], [0.0, -9.0]), [0.0, -1.0]);
            assert_eq!(change([5.0, 0.0], [0.0, 0.0]), [0.0, 0.0]);
            let [x, y] = change([5.0, 0.0], [-9.0, 0.0]);
            assert!((x + 0.1 * deceleration).abs() < 1e-15 && y == 0.0);
            // Backwards it comes with the acceleration again.
            let [x, _] = change([0.2, 0.0], [-9.0, 0.0]);
            let most = if deceleration < 10.0 { 0.2 } else { 1.0 };
            assert!((x + most).abs() < 1e-15, "{x}");
            let [x, y] = change([5.0, 0.0], [-9.0, 9.0]);
            let ellipse = (x / deceleration).hypot(y / 10.0);
            assert!((ellipse - 0.1).abs() < 1e-14 && (x + y).abs() < 1e-14);
        }
    }

    #[test]
    fn limits_of_any_size_give_numbers() {
        for acceleration in [1e-300, 1.0, 1e300] {
            for deceleration in [1e-300, 1.0, 1e300] {
                let robot = HolonomicRobot {
                    max_acceleration: acceleration,
                    max_deceleration: Some(deceleration),
                    ..HolonomicRobot::default()
                };
                for asked in [[-1.0, 0.0], [0.0, 1.0], [-1.0, 1.0], [1.0, 1.0], [0.0; 2]] {
                    let found = robot.change::<f64>([0.5, 0.0].into(), asked.into(), 0.01);
                    assert!(
                        found.x.is_finite() && found.y.is_finite(),
                        "{robot:?} {asked:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn without_a_deceleration_of_its_own_no_bit_changes() {
        let robot = HolonomicRobot::default();
        let asked = Vector2::new(-0.3, 0.1);
        assert_eq!(
            robot.change::<f64>(Vector2::new(0.7, 0.0), asked, 0.01),
            asked
        );
        assert_eq!(robot.deceleration(), robot.max_acceleration);
        assert_eq!(robot.limits().max_acceleration, 10.0);
    }

    #[test]
    fn limits_shorten_without_turning() {
        let robot = HolonomicRobot::default();
        let acceleration = robot.acceleration(Vector2::new(300.0, -400.0));
        assert!((acceleration.x - 6.0).abs() < 1e-12 && (acceleration.y + 8.0).abs() < 1e-12);
        let (velocity, speed) = robot.limited_velocity(Vector2::new(0.3, 0.4));
        assert_eq!((velocity.x, velocity.y, speed), (0.3, 0.4, 0.5));
    }
}
