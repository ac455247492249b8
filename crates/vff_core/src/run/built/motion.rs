//! How a commanded force becomes motion.

use crate::lanes::{Planar, Vector2};
use crate::robots::{HolonomicRobot, WheelModel};
use crate::world::geometry::RobotState;
use crate::world::scenario::Scenario;

/// Most wheels of a robot.
pub(crate) const WHEELS: usize = 3;

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
    /// A robot at rest at the start of a scenario.
    pub fn at_start(scenario: &Scenario) -> Self {
        let position = Vector2::splat(scenario.start);
        Self {
            robot: RobotState {
                position,
                velocity: Vector2::zeros(),
            },
            speed: 0.0,
            heading: scenario.rules.heading,
            wheel_speeds: [0.0; WHEELS],
            currents: [0.0; WHEELS],
            loss: 0.0,
            reference: position,
        }
    }
}

/// A measured pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fix {
    /// Position in m.
    pub position: Vector2<f64>,
    /// Heading in rad, if it is measured.
    pub heading: Option<f64>,
}

/// What a robot is told at a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Order {
    /// Commanded force in N.
    pub force: Vector2<f64>,
    /// The pose as measured now, `None` where it is known exactly.
    pub fix: Option<Fix>,
    /// Whether it is outside every active region, as far as it knows.
    pub clear: bool,
}

/// What turns the force that a law holds into motion, one motion step after the other.
pub(crate) trait Drive: Send {
    /// Number of its wheels.
    fn wheels(&self) -> usize;
    /// Whether its energy is that of ideal wheels on a point mass.
    fn is_ideal(&self) -> bool {
        false
    }
    /// Heading in rad as the robot itself knows it between measurements.
    fn known_heading(&self) -> f64;
    /// Holds an order until the next sample.
    fn hold(&mut self, order: &Order);
    /// Goes on by one motion step.
    fn step(&mut self) -> Reading;
}

/// The point mass that a law drives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointMass {
    robot: HolonomicRobot,
    /// Position in m and velocity in m/s.
    pub state: RobotState<f64>,
    /// Speed in m/s.
    pub speed: f64,
    /// Held acceleration in m/s^2.
    pub acceleration: Vector2<f64>,
    push: Vector2<f64>,
    step: f64,
}

impl PointMass {
    pub fn new(scenario: &Scenario, step: f64) -> Self {
        Self {
            robot: scenario.robot,
            state: RobotState {
                position: Vector2::splat(scenario.start),
                velocity: Vector2::zeros(),
            },
            speed: 0.0,
            acceleration: Vector2::zeros(),
            push: Vector2::zeros(),
            step,
        }
    }

    /// Holds a commanded force in N.
    pub fn hold(&mut self, force: Vector2<f64>) {
        self.acceleration = self.robot.acceleration(force);
        self.push = self.acceleration * self.step;
    }

    /// Velocity first, then position with the new velocity.
    pub fn advance(&mut self) {
        let RobotState { position, velocity } = self.state;
        let (velocity, speed) = self.robot.limited_velocity(velocity + self.push);
        self.speed = speed;
        self.state = RobotState {
            position: position + velocity * self.step,
            velocity,
        };
    }
}

/// A robot whose motion is that of the point mass, with the currents that ideal wheels take.
#[derive(Clone, Debug)]
pub(crate) struct IdealHolonomic {
    point: PointMass,
    wheels: WheelModel,
    wheel_speeds: [f64; WHEELS],
    heading: f64,
}

impl IdealHolonomic {
    pub fn new(scenario: &Scenario, step: f64) -> Self {
        let heading = scenario.rules.heading;
        let wheels = WheelModel::new(&scenario.robot, heading, step);
        Self {
            point: PointMass::new(scenario, step),
            wheels,
            wheel_speeds: wheels.speeds(Vector2::zeros()),
            heading,
        }
    }
}

impl Drive for IdealHolonomic {
    fn wheels(&self) -> usize {
        WHEELS
    }

    fn is_ideal(&self) -> bool {
        true
    }

    fn known_heading(&self) -> f64 {
        self.heading
    }

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
