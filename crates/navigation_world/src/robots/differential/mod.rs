//! Two-wheel robot: tracking of a reference robot that moves in any direction.
//!
//! A Cartesian law drives a reference point mass, (7.2.1) of Zeng (2011); a [`Tracker`] turns its
//! motion into forward speed and turn rate; [`DifferentialDrive`] moves the robot on exact arcs
//! within its limits. A law that brings its own torque steers through [`VirtualTorque`].

mod drive;
mod full_speed;
mod goal;
mod nonlinear;
mod reference;
mod torque;
mod track;
mod tracker;
mod velocity_drive;

pub use drive::wrapped;
pub use drive::{DifferentialDrive, DifferentialLimits, Integration, Pose, Twist};
pub use full_speed::FullSpeed;
pub use goal::ExponentialGoal;
pub use nonlinear::{ErrorFrame, Nonlinear, ReferenceTurn};
pub use reference::{Reference, ReferencePath};
pub use torque::{TorqueSteering, VirtualTorque};
pub use track::{TrackOptions, TrackRow, TrackRun, TrackStart, track, track_batch};
pub use tracker::{Tracker, Tracking};
pub use velocity_drive::{VelocityDrive, VelocityRule};
