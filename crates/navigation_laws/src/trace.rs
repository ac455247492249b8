//! Record of the parts around a law.

use crate::foresight::Foreseen;
use crate::shield::{Course, Deviation, Shield, Status};
use numeric::lanes::Vector2;

/// Record of the parts in the last control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// Velocity that the law wanted, or the takeover, within its limit, in m/s.
    pub wanted: Vector2<f64>,
    /// Velocity that is commanded in m/s.
    pub command: Vector2<f64>,
    /// Whether the law was taken over from.
    pub taken_over: bool,
    /// Treatment of the wanted velocity.
    pub status: Status,
    /// The plan that the robot executes, if there is a shield.
    pub course: Option<Course>,
    /// How far it was measured to be from the plan before, if that refutes what the shield assumes.
    pub off_plan: Option<Deviation>,
    /// Assumptions of the shield, if there is one.
    pub shield: Option<Shield>,
}

/// Plan behind the command of the last control period, from where the robot was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Examined {
    /// Least distance between the half disc ahead and everywhere that others can be, over the plan, in m; infinite
    /// without others.
    pub margin: f64,
    /// Instants of the plan from 0 to rest, in s.
    pub time: Vec<f64>,
    /// Position of the robot at them in m.
    pub position: Vec<[f64; 2]>,
    /// How far each obstacle can have come from where it was measured when the robot rests, in m; 0 for what stands.
    pub reach: Vec<f64>,
    /// Way and people that foresight expects, if it decided.
    pub foreseen: Option<Foreseen>,
}
