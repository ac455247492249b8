//! Three omni-wheels that follow the velocity of the point mass which a law drives.

use crate::robots::drives::driven::{DrivenWheels, WheelSize};
use crate::robots::drives::{Drive, MotorDrive, Order, PointMass, Reading, Start, WHEELS};
use crate::robots::wheels::{OmniKinematics, Slip, WheelDrive};
use crate::world::geometry::RobotState;
use numeric::error::Result;
use numeric::lanes::{Planar, Vector2};

/// The robot. It takes its heading for that of the start: nothing measures it.
#[derive(Clone, Debug)]
pub struct OmniRobot {
    reference: PointMass,
    kinematics: OmniKinematics,
    wheels: DrivenWheels,
    wanted_heading: f64,
    position: Vector2<f64>,
    heading: f64,
    step: f64,
}

impl OmniRobot {
    /// A robot at rest with its wheels.
    ///
    /// # Errors
    /// The kinematics, or a wheel, is out of range.
    pub fn new(
        start: &Start,
        drives: &[WheelDrive],
        (kinematics, slip): (OmniKinematics, Slip),
    ) -> Result<Self> {
        let kinematics = kinematics.checked()?;
        let size = WheelSize {
            radius: kinematics.wheel_radius,
            resistance: start.point.wheels.resistance,
        };
        let heading = start.heading;
        Ok(Self {
            reference: PointMass::new(start),
            kinematics,
            wheels: DrivenWheels::new(drives, slip, size, start.step)?,
            wanted_heading: heading,
            position: Vector2::splat(start.position),
            heading,
            step: start.step,
        })
    }
}

impl MotorDrive for OmniRobot {
    fn wheels(&self) -> usize {
        WHEELS
    }

    fn known_heading(&self) -> f64 {
        self.wanted_heading
    }
}

impl Drive for OmniRobot {
    type Order = Order;
    type Reading = Reading;

    fn hold(&mut self, order: &Order) {
        self.reference.hold(order.force);
    }

    fn step(&mut self) -> Reading {
        self.reference.advance();
        let [x, y] = self.reference.state.velocity.lane(0);
        let kinematics = self.kinematics;
        let wanted = kinematics.wheel_speeds_in_world([x, y, 0.0], self.wanted_heading);
        let (mut position, mut heading, period) = (self.position, self.heading, self.wheels.period);
        let mut velocity = Vector2::zeros();
        self.wheels.step(wanted, |rolling, _| {
            let turn = kinematics.body_velocity(rolling)[2] * period;
            let [x, y, _] = kinematics.world_velocity(rolling, heading + 0.5 * turn);
            velocity = Vector2::new(x, y);
            position += velocity * period;
            heading += turn;
        });
        let way = position - self.position;
        (self.position, self.heading) = (position, heading);
        Reading {
            robot: RobotState { position, velocity },
            speed: way.dot(&way).sqrt() / self.step,
            heading,
            wheel_speeds: self.wheels.speeds,
            currents: self.wheels.currents,
            loss: self.wheels.loss,
            reference: self.reference.state.position,
        }
    }
}
