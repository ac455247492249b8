//! Safety filters: the permitted velocity nearest to a wanted one, by the rules that the field uses.
//!
//! Each filter says what it did ([`FilterStatus`]); none is a shield: what each assumes stands with it.

mod choice;
mod program;
mod rules;
#[cfg(test)]
mod tests;

pub use choice::Filter;
pub use program::{Answer, Disc, Hard, LinearBound, solve};
pub use rules::{
    ApproachMonitor, Barrier, BarrierUnicycle, CollisionCone, ResponsibilityRule, VelocityClamp,
};

use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// A person as measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// Position in m.
    pub position: Vector,
    /// Velocity in m/s.
    pub velocity: Vector,
    /// Radius in m.
    pub radius: f64,
}

/// Robot, people and walls as a filter knows them.
#[derive(Clone, Copy, Debug)]
pub struct Sighted<'a> {
    /// Position of the robot in m.
    pub position: Vector,
    /// Its velocity in m/s.
    pub velocity: Vector,
    /// Its heading in rad.
    pub heading: f64,
    /// Its radius in m.
    pub radius: f64,
    /// Largest speed in m/s, acceleration in m/s^2, turn rate in rad/s; `None` for no bound.
    pub max_speed: f64,
    /// Largest acceleration in m/s^2, where it is asked for.
    pub max_acceleration: Option<f64>,
    /// Largest turn rate in rad/s.
    pub max_turn_rate: f64,
    /// Control period in s.
    pub period: f64,
    /// People.
    pub people: &'a [Near],
    /// Boundary points of what stands, in m.
    pub points: &'a [Vector],
}

/// Fate of a wanted velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterStatus {
    /// It let it through.
    Kept,
    /// It changed it as its rule asks.
    Changed,
    /// Nothing obeys the rule: the violation is least.
    Infeasible,
    /// Somebody is within the distance that the rule keeps: the robot brakes.
    Touching,
    /// No share of it is safe: 0.
    Stopped,
}

impl FilterStatus {
    /// The status in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Changed => "changed",
            Self::Infeasible => "infeasible",
            Self::Touching => "touching",
            Self::Stopped => "stopped",
        }
    }
}

/// A filtered velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filtered {
    /// In m/s.
    pub velocity: Vector,
    /// Fate of the wanted velocity.
    pub status: FilterStatus,
    /// By how much the rule is violated.
    pub slack: f64,
    /// Share of the wanted velocity, of filters that shorten it.
    pub share: f64,
}
