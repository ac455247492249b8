//! Avoidance from sensors: a robot that follows a sound by virtual impedance, and an ultrasonic
//! skirt around a tri-omni-wheel robot.
//!
//! SI units and radians throughout.

#![forbid(unsafe_code)]

pub use groundwork::error;

pub mod follower;
pub mod impedance;
pub mod localization;
pub mod parallel;
pub mod random;
pub mod skirt;
pub mod sonar;
