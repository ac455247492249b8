//! Arms as trees of joints, and the effective mass of their points in a contact.
//!
//! At a point that is fixed to a link, with world axes, the mobility is
//! `L = J M^-1 J^T` (1/kg), and the effective mass along a unit vector `u` is
//! `1/(u^T L u)`. `M` is the joint-space mass matrix, by the composite-rigid-body algorithm
//! (R. Featherstone, *Rigid Body Dynamics Algorithms*, 2008, section 6.2), `J` the Jacobian of
//! the velocity of the point. Joints that mimic others fold both: `M' = G^T M G`, `J' = J G`.
//!
//! `element` reads XML elements, `foreign` knows other formats, `description` holds the contents of a URDF,
//! `shape` the sizes of its links, `sources` masses and a base that a URDF does not hold, `tree` checks how they hang together, `body` holds inertias, `build` makes
//! the `model` of the arm; `survey` finds signs that it may not be real, `pose` is the kernel, `mobility`
//! gives effective masses from `L`, `batch` does both for arrays.

pub mod batch;
pub mod body;
pub mod build;
pub mod description;
mod element;
mod foreign;
pub mod mobility;
pub mod model;
pub mod pose;
pub mod shape;
pub mod sources;
pub mod survey;
mod tree;

pub use batch::{Broadcast, Places};
pub use build::{Options, Payload};
pub use mobility::Mobility;
pub use model::{Arm, JointKind};
