//! Laws that run on robots: they choose a twist from what is around now, on the way to a goal.
//!
//! Shared by all of them: the gap to people and walls, what it costs, the way that a guide plans, and the motions that
//! a robot can make next. There are no cells: costs are Nav2's of exact distances, so commands are near its commands
//! and not equal to them.

mod gaps;
mod law;
mod motion;
mod side_by_side;
#[cfg(test)]
mod tests;
mod way;

pub use gaps::{Gaps, Inflation, MovingShape, PeopleMotion, Walls};
pub use law::{Steered, Tuned, TwistFamily};
pub(crate) use law::{finite_number, numbers};
pub use motion::{AxisLimits, Pose, arc, evenly, wrap};
pub(crate) use side_by_side::{Each, EachVector, LaneGaps, WIDTH, all};
pub use way::Way;

use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Robot, goal and surroundings at one instant.
#[derive(Clone, Copy, Debug)]
pub struct LocalView<'a> {
    /// Position in m and heading in rad.
    pub pose: Pose,
    /// Velocity forward and to the left in m/s, turn rate in rad/s.
    pub twist: [f64; 3],
    /// Where it heads for next, in m.
    pub local_goal: Vector,
    /// Way to the goal, whose end that is.
    pub way: &'a Way,
    /// Control period in s.
    pub period: f64,
    /// Largest speed in m/s.
    pub max_speed: f64,
    /// People and walls as measured.
    pub gaps: &'a Gaps<'a>,
}

impl LocalView<'_> {
    /// The goal at the end of the way, in m.
    #[must_use]
    pub fn goal(&self) -> Vector {
        self.way.end()
    }
}

/// Motion that a law commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// It drives.
    #[default]
    Track,
    /// It turns in place.
    Rotate,
    /// Nothing that it may command is free: it stands.
    Blocked,
}

impl Mode {
    /// The mode in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Track => "track",
            Self::Rotate => "rotate",
            Self::Blocked => "blocked",
        }
    }
}

/// A chosen twist.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwistChoice {
    /// Velocity forward and to the left in m/s, turn rate in rad/s.
    pub twist: [f64; 3],
    /// Score of the best twist, if there is one.
    pub score: Option<f64>,
    /// Whether the robot drives, turns in place or stands.
    pub mode: Mode,
}

impl TwistChoice {
    /// Nothing is allowed: the command is 0.
    pub const BLOCKED: Self = Self {
        twist: [0.0; 3],
        score: None,
        mode: Mode::Blocked,
    };
}

/// A law at work on one robot.
pub trait TwistPlanner: Send + 'static {
    /// Twist until the next sample.
    fn choose(&mut self, view: &LocalView<'_>) -> TwistChoice;

    /// Goes on with a plan of twists and the number of the call, if it keeps any.
    fn resume(&mut self, _plan: &[[f64; 3]], _call: u32) {}

    /// Twists that it plans after the last choice; empty for one that plans none.
    fn planned(&self) -> &[[f64; 3]] {
        &[]
    }
}
