//! Ultrasonic ranging: shapes, rays, beams, temperature, noise, cross-talk, firing order.

pub mod array;
pub mod beam;
pub mod ranging;
pub mod shapes;

pub use array::{Firing, Mount, SonarArray};
pub use beam::{Beam, Pose};
pub use ranging::{DEFAULT_TEMPERATURE, Ranging, speed_of_sound};
pub use shapes::{Disc, Rectangle, Shape, Wall};
