//! The kernel of runs of ideal point masses: side by side in lanes, or one after the other.

pub(crate) mod group;
mod integrators;
pub(crate) mod kernel;
pub(crate) mod scenes;
mod sensors;
