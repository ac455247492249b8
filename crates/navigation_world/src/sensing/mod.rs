//! Sensors with noise and latency, cameras, sonar, sound; estimators.

/// Sensors that ride on a robot and are made by name, by their files; [`options`] makes one kind of them.
macro_rules! robot_sensors {
    ($list:ident) => {
        $list! {
            ultrasonic::Ultrasonic,
            sound_localizer::SoundLocalizer,
            odometry::Odometry,
        }
    };
}

pub mod camera;
pub(crate) mod cameras;
pub mod estimator;
pub mod fixes;
pub mod lidar;
mod linearized;
mod marks;
pub mod measurement;
pub mod noisy;
pub mod odometry;
mod options;
mod rotation;
pub mod sampled;
pub mod scanner;
pub mod sensor;
pub mod sonar;
pub mod sound;
pub mod sound_localizer;
pub mod ultrasonic;
pub mod vision;

pub use camera::{Camera, CameraPose, Lens};
pub use cameras::ObstacleCamera;
pub use estimator::{Estimate, Estimator, Track};
pub use fixes::{FixNoise, Fixes, Heard};
pub use lidar::Lidar;
pub use linearized::{LinearizedCamera, PARAMETERS};
pub use options::{SensorOptions, sensor_named};
pub use sensor::{Located, RobotSensor, Sensor, Truth};
pub use sound_localizer::SoundLocalizer;
pub use ultrasonic::Ultrasonic;
pub use vision::{PositionError, Vision, VisionSensor};
