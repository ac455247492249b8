//! Robots as built: sensors, wheels, tracking.
pub(crate) mod as_built;
pub(crate) mod differential;
pub(crate) mod footprint;
pub(crate) mod sensing;
pub(crate) mod wheels;
