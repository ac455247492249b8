//! Contact along the program of a robot: masses of its points, allowed speeds, the fastest motion that keeps them.
//!
//! A path `q(s)` consists of cubic `path` pieces, `spline` lays them through given values. `masses` are those of a point
//! in a motion, `contact` holds points with the limits of their contacts and finds the hardest one. `strips` are the
//! limits of acceleration on one interval, `profile` is the fastest motion along a path within given caps, `bounds` are
//! these caps, and `retime` verifies the motion between the nodes and lowers caps that are exceeded. `zones` are
//! speeds as they are typed into a pendant, `draws` motions of an arm without a program.

pub mod bounds;
pub mod contact;
pub mod draws;
pub mod masses;
pub mod path;
pub mod profile;
pub mod retime;
pub mod rows;
pub mod spline;
pub mod strips;
#[cfg(test)]
mod tests;
pub mod zones;

pub use contact::{ContactNormal, MassRule, PathContact, PointLimit, SpeedTable};
pub use masses::PointMotion;
pub use path::JointPath;
pub use retime::{MotionLimits, Reason, Retimed, Verification, retime};
