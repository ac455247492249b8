//! Navigation of mobile robots by virtual force fields among people and things.
//!
//! Equations follow L. Zeng, "Design and control of human-friendly robots", doctoral thesis,
//! Canada, 2011, chapters 5 and 6 and appendices B to D, with their misprints corrected.
//! SI units and radians throughout.

#![forbid(unsafe_code)]

pub use groundwork::error;

pub mod angle;
pub mod forces;
pub mod gains;
pub mod lanes;
pub mod laws;
pub mod measurement;
pub mod metrics;
pub mod motion;
pub mod obstacle;
pub mod optimize;
pub mod planners;
pub mod region;
pub mod robots;
pub mod scenario;
pub mod sensing;
pub mod simulate;
