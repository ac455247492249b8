//! People that react to each other and to robots, all in one world that moves in step.
//!
//! [`models`] has a file per pedestrian model; [`neighbors`] says who is near whom, [`world`] what there is, and
//! [`simulation`] what an episode of it consists of, stepped by the loop of [`crate::run`].

pub mod agent;
mod agent_lanes;
mod batch;
mod certificate;
mod divergence;
pub mod environments;
pub mod metrics;
pub mod models;
pub mod neighbors;
pub mod pedestrian;
pub mod people;
mod record;
mod rescue;
pub mod robots;
mod sight;
pub mod simulation;
pub mod snapshot;
mod social_force;
mod sources;
mod tasks;
mod velocity_programs;
pub mod walls;
pub mod world;
mod world_lanes;

pub use batch::simulate_worlds;
pub use certificate::{Certificate, certify, certify_all};
pub use divergence::{Diverged, Divergence};
pub use models::Model;
pub use record::Trajectories;
pub use simulation::{DecisionRoom, Simulation};
pub use social_force::SocialForce;
pub use tasks::Task;
pub use world::CrowdWorld;
