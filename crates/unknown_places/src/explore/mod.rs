//! A robot with two wheels on its way through a place that it knows from its scans alone.
//!
//! Map, guide and rollouts choose where to go; the verified plan decides whether it may. In a static world where whatever
//! lies in cells that count as free is within the margin of the point of an occupied cell, the robot touches nothing,
//! whatever guide, goal and rollouts say: every piece that it executes belongs to a verified plan, and braking continues
//! with it. Things thinner than the beams are apart, glass, and what is not in the plane of the scan are not covered.

mod controller;
mod explorer;
mod recovery;
mod rollouts;
mod verify;

pub use controller::{Controller, Doubts, Order, TimedScan, Trust};
pub use explorer::{Decision, Explorer, ExplorerOptions, Robot, Status};
pub use rollouts::{COMMANDS, Rated, Reach, Rollouts};
pub use verify::{Chassis, Obstacle};
