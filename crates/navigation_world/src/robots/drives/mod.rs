//! How a commanded force becomes motion, one motion step after the other.

mod driven;
mod limited_omni;
mod omni;
mod point_mass;
mod two_wheels;
mod velocity;
mod virtual_velocity;

pub use limited_omni::{LimitedOmni, OmniCommand, OmniLimits};
pub use omni::OmniRobot;
pub use point_mass::{IdealHolonomic, PointMass};
pub use two_wheels::TwoWheels;
pub use two_wheels::{PoseFusion, SteeringLaw};
pub use velocity::{MOST_TURN, velocity_of};
pub use virtual_velocity::VirtualVelocity;

use crate::robots::HolonomicRobot;
use crate::robots::differential::Twist;
use crate::world::frame::Frame;
use crate::world::geometry::RobotState;
use numeric::lanes::{Planar, Vector2};

/// Most wheels of a robot.
pub(crate) const WHEELS: usize = 3;

/// Where a run starts.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// The point mass that the law drives.
    pub point: HolonomicRobot,
    /// Position in m.
    pub position: [f64; 2],
    /// Heading in rad.
    pub heading: f64,
    /// Goal in m.
    pub goal: [f64; 2],
    /// Motion step in s.
    pub step: f64,
    /// Control period in s.
    pub period: f64,
}

/// Where a robot is, and what its motors do, at the end of a motion step.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// Position in m and velocity in m/s.
    pub robot: RobotState<f64>,
    /// Mean speed over the step in m/s.
    pub speed: f64,
    /// Heading in rad.
    pub heading: f64,
    /// Wheel speeds in rad/s.
    pub wheel_speeds: [f64; WHEELS],
    /// Motor currents in A.
    pub currents: [f64; WHEELS],
    /// Electrical loss over the step in J.
    pub loss: f64,
    /// Position of the point mass that the law drives, in m.
    pub reference: Vector2<f64>,
}

impl Reading {
    /// A robot at rest.
    #[must_use]
    pub fn at(start: &Start) -> Self {
        let position = Vector2::splat(start.position);
        Self {
            robot: RobotState {
                position,
                velocity: Vector2::zeros(),
            },
            speed: 0.0,
            heading: start.heading,
            wheel_speeds: [0.0; WHEELS],
            currents: [0.0; WHEELS],
            loss: 0.0,
            reference: position,
        }
    }
}

/// A measured pose.
#[derive(Clone, Copy, Debug)]
pub struct PoseFix {
    /// Position in m.
    pub position: Vector2<f64>,
    /// Heading in rad, if it is measured.
    pub heading: Option<f64>,
}

/// Order to a robot at a sample.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    /// Commanded force in N.
    pub force: Vector2<f64>,
    /// Commanded twist of a robot with two wheels, in place of the velocity that the force reaches.
    pub twist: Option<Twist>,
    /// The pose as measured now, `None` where it is known exactly.
    pub fix: Option<PoseFix>,
    /// Set where the robot is outside every active region, as far as it knows.
    pub clear: bool,
}

/// Where a robot without a model of its motors is at the end of a motion step.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Place and front.
    pub frame: Frame,
    /// Velocity in m/s.
    pub velocity: Vector2<f64>,
    /// Speed along its course over the step in m/s.
    pub speed: f64,
    /// Turn rate over the step in rad/s.
    pub turn_rate: f64,
}

/// Drive that turns the orders of a law into motion, one motion step after the other.
pub trait Drive {
    /// Type of its orders.
    type Order;
    /// Type of its readings at the end of a motion step.
    type Reading;
    /// Holds an order until the next sample.
    fn hold(&mut self, order: &Self::Order);
    /// Moves by one motion step.
    fn step(&mut self) -> Self::Reading;
}

/// A drive whose motors are modeled, under a law that asks for forces.
pub trait MotorDrive: Drive<Order = Order, Reading = Reading> + Send {
    /// Number of its wheels.
    fn wheels(&self) -> usize;
    /// True where its energy is that of ideal wheels on a point mass.
    fn is_ideal(&self) -> bool {
        false
    }
    /// Heading in rad as the robot itself knows it between measurements.
    fn known_heading(&self) -> f64;
}
