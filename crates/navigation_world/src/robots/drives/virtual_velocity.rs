//! Two wheels that turn toward the velocity of a virtual mass, which the forces of a law push:
//! Avi (2019).

use nalgebra::Vector2;

use crate::robots::differential::{VelocityDrive, VelocityRule};
use crate::robots::drives::{Drive, Moved};
use crate::world::frame::Frame;

/// The robot, at the origin at first, where it looks along x.
#[derive(Clone, Debug)]
pub struct VirtualVelocity {
    drive: VelocityDrive,
    rule: VelocityRule,
    step: f64,
    /// Change of the virtual velocity by a force that acts for a step, in m/s per N.
    gain: f64,
    frame: Frame,
    /// Virtual velocity in m/s.
    velocity: Vector2<f64>,
    /// Speeds (left, right) of the wheels in m/s.
    wheels: [f64; 2],
}

impl VirtualVelocity {
    /// At rest, with its motion step in s.
    #[must_use]
    pub fn new(drive: VelocityDrive, rule: VelocityRule, step: f64) -> Self {
        Self {
            drive,
            rule,
            step,
            gain: step / drive.mass,
            frame: Frame {
                position: Vector2::zeros(),
                direction: Vector2::x(),
            },
            velocity: Vector2::zeros(),
            wheels: [0.0; 2],
        }
    }

    /// Place and front.
    #[must_use]
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Virtual velocity in m/s.
    #[inline]
    #[must_use]
    pub fn velocity(&self) -> Vector2<f64> {
        self.velocity
    }

    /// Speeds (left, right) of the wheels until the next sample, in m/s.
    #[inline]
    #[must_use]
    pub fn wheels(&self) -> [f64; 2] {
        self.wheels
    }
}

impl Drive for VirtualVelocity {
    /// Force in N.
    type Order = Vector2<f64>;
    type Reading = Moved;

    #[inline]
    fn hold(&mut self, force: &Vector2<f64>) {
        let mut velocity = self.velocity + force * self.gain;
        let speed = velocity.dot(&velocity).sqrt();
        if speed > self.drive.wheel_speed {
            velocity *= self.drive.wheel_speed / speed;
        }
        self.velocity = velocity;
        self.wheels = self.drive.wheels(self.frame.inward(velocity));
    }

    #[inline]
    fn step(&mut self) -> Moved {
        let twist = self.drive.twist(self.wheels);
        self.frame = twist.moved(&self.frame, self.step, self.drive.integration);
        let velocity = self.frame.direction * twist.speed;
        if self.rule == VelocityRule::Reset {
            self.velocity = velocity;
        }
        Moved {
            frame: self.frame,
            velocity,
            speed: twist.speed,
            turn_rate: twist.turn_rate,
        }
    }
}
