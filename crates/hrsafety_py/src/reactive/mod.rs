//! Reactive avoidance: conversions only, everything is computed by the core.

pub mod follower;
pub mod localization;
pub mod skirt;
