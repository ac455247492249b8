//! Ultrasonic ranging: rays, beams, temperature, noise, cross-talk, firing order.

pub mod array;
pub mod beam;
pub mod ranging;

pub use array::{Firing, SonarArray};
pub use beam::Beam;
pub use ranging::{DEFAULT_TEMPERATURE, Ranging, speed_of_sound};
