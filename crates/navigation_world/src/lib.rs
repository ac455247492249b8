//! The world of a run: what there is, the robots in it, and what their sensors know of it.
//!
//! Equations of the force field follow L. Zeng, "Design and control of human-friendly robots",
//! doctoral thesis, Canada, 2011, chapters 5 to 7 and appendices B to D, with their misprints
//! corrected; each module names its own sources. SI units and radians throughout.

#![forbid(unsafe_code)]

pub mod arguments;
pub mod robots;
pub mod sensing;
pub mod world;
