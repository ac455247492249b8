//! Everything that moves on the floor: a run is a world, a robot, its sensors and a law.
//!
//! Equations of the force field follow L. Zeng, "Design and control of human-friendly robots",
//! doctoral thesis, Canada, 2011, chapters 5 to 7 and appendices B to D, with their misprints
//! corrected; each module names its own sources. SI units and radians throughout.
//!
//! The parts are crates of their own, so that they are compiled side by side; this one gathers them.

#![forbid(unsafe_code)]

pub use navigation_laws as laws;
pub use navigation_runs::{crowd, run, search};
pub use navigation_world::{arguments, robots, sensing, world};
pub use numeric::{error, lanes};
pub use unknown_places as unknown;
