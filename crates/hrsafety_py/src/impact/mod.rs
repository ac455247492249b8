//! Impact: conversions only, everything is computed by the core.

pub mod cylinder;
pub mod design;
pub mod direct_drive;
pub mod history;
pub mod identify;
pub mod joints;
pub mod many;
pub mod parameters;
pub mod signal;
pub mod single;
