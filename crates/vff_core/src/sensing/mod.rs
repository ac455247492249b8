//! What a robot with a camera knows: projection, delayed and noisy positions, velocity estimates.

pub mod camera;
pub mod estimator;
mod linearized;
pub mod measurement;
mod rotation;
pub mod sampled;
pub mod sonar;
pub mod sound;
pub mod vision;

pub use camera::{Camera, CameraPose, Lens};
pub use estimator::{Estimate, Estimator, Track};
pub use linearized::{LinearizedCamera, PARAMETERS};
pub use vision::{PositionError, Vision, VisionSensor};
