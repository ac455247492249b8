//! The world of a run: motions, shapes, obstacles with their regions, scenarios.

pub mod geometry;
pub mod motion;
pub mod obstacle;
pub mod region;
pub mod scenario;
