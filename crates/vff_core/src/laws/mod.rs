//! Navigation laws behind one interface.

mod virtual_force_field;

pub use virtual_force_field::{FieldTerms, ForceFieldLaw, ObstacleTerms, VirtualForceField};

use crate::forces::geometry::{Body, RobotState};
use crate::lanes::{Real, Vec2};

/// What a law knows when it is asked for a force.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a, R> {
    /// Obstacles as measured.
    pub bodies: &'a [Body],
    /// Robots as measured, one a lane.
    pub robot: RobotState<R>,
    /// How long the force will act, in s.
    pub interval: f64,
}

/// What a law answers.
#[derive(Clone, Copy, Debug)]
pub struct Command<R> {
    /// Force in N, before the limits of the robot.
    pub force: Vec2<R>,
    /// Stabilizing force within it, in N.
    pub stabilizing: Vec2<R>,
    /// Lyapunov function in N^2, NaN where it is not defined or was not asked for.
    pub lyapunov: R,
}

/// A law for robots side by side; it may remember what it needs between two samples.
pub trait Law<R: Real> {
    /// Force for the time until the next sample.
    fn command(&mut self, situation: &Situation<'_, R>) -> Command<R>;
}
