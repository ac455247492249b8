//! An omnidirectional robot with a speed of travel and a limit of its acceleration; it turns only
//! where it stands: Gussu and Lin (2017).

use nalgebra::Vector2;

use crate::robots::drives::{Drive, Moved};
use crate::world::frame::Frame;

/// Order to the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OmniCommand {
    /// Keep the course over ground.
    Keep,
    /// Stand and turn.
    Turn,
    /// Travel at an angle in rad from the front of the body.
    Toward(f64),
}

/// How fast it travels.
#[derive(Clone, Copy, Debug)]
pub struct OmniLimits {
    /// Speed in m/s.
    pub speed: f64,
    /// Largest acceleration in m/s^2.
    pub acceleration: f64,
    /// Yaw rate where it turns, in rad/s.
    pub turn_rate: f64,
}

/// The robot.
#[derive(Clone, Debug)]
pub struct LimitedOmni {
    limits: OmniLimits,
    step: f64,
    frame: Frame,
    heading: f64,
    velocity: Vector2<f64>,
    turns: bool,
    /// Direction of travel from the front of the body, in rad.
    direction: f64,
    /// Direction of travel over ground, and its angle in rad.
    target: Vector2<f64>,
    course: f64,
}

impl LimitedOmni {
    /// At rest at the origin, about to travel at an angle in rad; with its motion step in s.
    #[must_use]
    pub fn new(limits: OmniLimits, course: f64, step: f64) -> Self {
        let (sin, cos) = course.sin_cos();
        Self {
            limits,
            step,
            frame: Frame::at([0.0, 0.0], 0.0),
            heading: 0.0,
            velocity: Vector2::zeros(),
            turns: false,
            direction: course,
            target: Vector2::new(cos, sin),
            course,
        }
    }
}

impl Drive for LimitedOmni {
    type Order = OmniCommand;
    type Reading = Moved;

    #[inline]
    fn hold(&mut self, course: &OmniCommand) {
        self.turns = *course == OmniCommand::Turn;
        if self.turns {
            self.heading += self.limits.turn_rate * self.step;
        }
        if let OmniCommand::Toward(direction) = course {
            self.direction = *direction;
        }
        let angle = self.heading + self.direction;
        // Mostly told again where it travels already.
        if *course != OmniCommand::Keep && angle.to_bits() != self.course.to_bits() {
            let (sin, cos) = angle.sin_cos();
            (self.target, self.course) = (Vector2::new(cos, sin), angle);
        }
    }

    #[inline]
    fn step(&mut self) -> Moved {
        if self.turns {
            self.frame = Frame::at(self.frame.position.into(), self.heading);
        }
        let speed = if self.turns { 0.0 } else { self.limits.speed };
        let change = self.target * speed - self.velocity;
        let size = change.dot(&change).sqrt();
        let most = self.limits.acceleration * self.step;
        let share = if size > most { most / size } else { 1.0 };
        self.velocity += change * share;
        self.frame.position += self.velocity * self.step;
        Moved {
            frame: self.frame,
            velocity: self.velocity,
            speed: self.velocity.norm(),
            turn_rate: if self.turns {
                self.limits.turn_rate
            } else {
                0.0
            },
        }
    }
}
