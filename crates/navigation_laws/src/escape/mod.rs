//! The law of a robot within a ring of sensors: from readings to a direction of escape.

pub mod states;
pub mod trigger;

pub use states::{Decider, Direction, EscapeAction, Policy};
pub use trigger::{Rule, normal_distances, trigger_distances};
