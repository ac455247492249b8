//! Ultrasonic ranging: rays, beams, temperature, noise, cross-talk, firing order.

pub mod array;
pub mod beam;
pub(crate) mod echoing;
pub mod ranging;
pub mod ring;

pub use array::{Firing, SonarArray};
pub use beam::Beam;
pub use echoing::Sonar;
pub use ranging::{DEFAULT_TEMPERATURE, Ranging, speed_of_sound};
pub use ring::Ring;
