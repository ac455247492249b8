//! Ring of ultrasonic sensors around a robot with three omni-wheels: Gussu and Lin (2017) as
//! corrected. x points east, y north, angles are counterclockwise from x.

pub mod batch;
pub mod ring;
pub mod robot;
pub mod scene;
pub mod states;
pub mod trigger;

pub use batch::{TestPlan, TestRow, test_batch};
pub use ring::Ring;
pub use robot::{Course, Skirt, SkirtOptions, Travel};
pub use scene::{DiscScene, DiscSceneOptions};
pub use states::{Action, Direction, Policy};
pub use trigger::{Rule, normal_distances};
