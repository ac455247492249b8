//! Square cells around a robot, filled by its scans.

mod cells;
mod rolling;
#[cfg(test)]
mod tests;
mod walk;

pub use cells::{Cells, Kind, Known};
pub use rolling::{MapOptions, RollingMap, Scan};
pub use walk::{walk, walk_while};
