//! Gain sets and scenes side by side in lanes.

pub(super) mod group;
pub(crate) mod kernels;
mod rollout;
pub(crate) mod scenes;
