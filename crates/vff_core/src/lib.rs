//! Everything that moves on the floor: a run is a world, a robot, its sensors and a law.
//!
//! Equations of the force field follow L. Zeng, "Design and control of human-friendly robots",
//! doctoral thesis, Canada, 2011, chapters 5 to 7 and appendices B to D, with their misprints
//! corrected; each module names its own sources. SI units and radians throughout.

#![forbid(unsafe_code)]

pub use numeric::{error, lanes};

pub mod arguments;
pub mod crowd;
pub mod laws;
pub mod robots;
pub mod run;
pub mod search;
pub mod sensing;
pub mod world;
