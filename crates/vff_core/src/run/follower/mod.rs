//! The robot that follows a sound: differential drive, leader, dead reckoning, runs and batches of runs.

pub mod batch;
pub mod drive;
pub mod episode;
pub mod fix;
pub mod layouts;
pub mod record;
pub mod scene;
pub mod settings;

pub use batch::{run_batch, touching_layouts};
pub use drive::Drive;
pub use episode::{Contact, Follower, Outcome};
pub use fix::{FixNoise, Fixes};
pub use layouts::{Layouts, Setting};
pub use record::{Recording, record};
pub use scene::{Leader, Mover, Scene};
pub use settings::{Sensors, Settings, VelocityRule};
