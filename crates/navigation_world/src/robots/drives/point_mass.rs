//! The point mass that a law drives, alone or with the currents that ideal wheels take.

use crate::robots::drives::{Drive, MotorDrive, Order, Reading, Start, WHEELS};
use crate::robots::{HolonomicRobot, WheelModel};
use crate::world::geometry::RobotState;
use numeric::lanes::{Planar, Vector2};

/// The point mass that a law drives.
#[derive(Clone, Copy, Debug)]
pub struct PointMass {
    robot: HolonomicRobot,
    /// Position in m and velocity in m/s.
    pub state: RobotState<f64>,
    /// Speed in m/s.
    pub speed: f64,
    /// Acceleration in m/s^2, held as far as the velocity lets it.
    pub acceleration: Vector2<f64>,
    push: Vector2<f64>,
    step: f64,
}

impl PointMass {
    /// A point mass at rest.
    #[must_use]
    pub fn new(start: &Start) -> Self {
        Self {
            robot: start.point,
            state: RobotState {
                position: Vector2::splat(start.position),
                velocity: Vector2::zeros(),
            },
            speed: 0.0,
            acceleration: Vector2::zeros(),
            push: Vector2::zeros(),
            step: start.step,
        }
    }

    /// Holds a commanded force in N.
    pub fn hold(&mut self, force: Vector2<f64>) {
        self.acceleration = self.robot.acceleration(force);
        self.push = self.acceleration * self.step;
    }

    /// Velocity first, then position with the new velocity.
    pub fn advance(&mut self) {
        if self.robot.max_deceleration.is_some() {
            let change = self.robot.change(self.state.velocity, self.push, self.step);
            self.acceleration = change / self.step;
        }
        self.speed = self.robot.advance(&mut self.state, self.push, self.step);
    }
}

/// A robot whose motion is that of the point mass, with the currents that ideal wheels take.
#[derive(Clone, Debug)]
pub struct IdealHolonomic {
    point: PointMass,
    wheels: WheelModel,
    wheel_speeds: [f64; WHEELS],
    heading: f64,
}

impl IdealHolonomic {
    /// A robot at rest.
    #[must_use]
    pub fn new(start: &Start) -> Self {
        let heading = start.heading;
        let wheels = WheelModel::new(&start.point, heading, start.step);
        Self {
            point: PointMass::new(start),
            wheels,
            wheel_speeds: wheels.speeds(Vector2::zeros()),
            heading,
        }
    }
}

impl MotorDrive for IdealHolonomic {
    fn wheels(&self) -> usize {
        WHEELS
    }

    fn is_ideal(&self) -> bool {
        true
    }

    fn known_heading(&self) -> f64 {
        self.heading
    }
}

impl Drive for IdealHolonomic {
    type Order = Order;
    type Reading = Reading;

    fn hold(&mut self, order: &Order) {
        self.point.hold(order.force);
    }

    fn step(&mut self) -> Reading {
        self.point.advance();
        let speeds = self.wheels.speeds(self.point.state.velocity);
        let currents = self.wheels.currents(&self.wheel_speeds, &speeds);
        self.wheel_speeds = speeds;
        let [first, second, third] = currents;
        let squared = first * first + second * second + third * third;
        Reading {
            robot: self.point.state,
            speed: self.point.speed,
            heading: self.heading,
            wheel_speeds: speeds,
            currents,
            loss: squared * self.wheels.loss_per_square(),
            reference: self.point.state.position,
        }
    }
}
