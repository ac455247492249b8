//! Square cells around a robot, filled by its scans.

mod walk;

pub use walk::walk;
