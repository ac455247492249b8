//! The robot that follows a sound: its sensors, leader, runs and batches of runs.

pub mod batch;
pub mod episode;
pub mod layouts;
pub mod record;
pub mod sample;
pub mod scene;
pub mod settings;
mod surroundings;

pub use batch::{run_batch, touching_layouts};
pub use episode::{Follower, FollowerOutcome};
pub use layouts::{Layouts, Setting};
pub use record::{FollowerRecord, FollowerSteps};
pub use scene::{FollowerScene, Leader};
pub use settings::{Sensors, Settings};
pub use surroundings::ObstacleTouch;

pub use navigation_world::robots::differential::VelocityRule;
pub use navigation_world::sensing::{FixNoise, Fixes};
