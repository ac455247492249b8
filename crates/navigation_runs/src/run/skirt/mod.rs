//! Ring of ultrasonic sensors around a robot with three omni-wheels: Gussu and Lin (2017) as
//! corrected. x points east, y north, angles are counterclockwise from x.

pub mod batch;
pub mod record;
pub mod robot;
pub mod scene;

pub use batch::{TestPlan, TestRow, test_batch};
pub use record::{SkirtRecord, SkirtSteps};
pub use robot::{Skirt, SkirtOptions, SkirtResult, SkirtTravel};
pub use scene::{DiscScene, DiscSceneOptions};

pub use navigation_laws::escape::{Direction, EscapeAction, Policy, Rule, normal_distances};
pub use navigation_world::sensing::sonar::Ring;
