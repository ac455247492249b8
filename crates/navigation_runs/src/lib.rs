//! Runs: robots that sense, decide and move, alone or among people that react, and searches over runs.
//!
//! Equations of the force field follow L. Zeng, "Design and control of human-friendly robots",
//! doctoral thesis, Canada, 2011, chapters 5 to 7 and appendices B to D, with their misprints
//! corrected; each module names its own sources. SI units and radians throughout.

#![forbid(unsafe_code)]

pub mod crowd;
pub mod run;
pub mod search;
