//! The one list of sensors that a robot can have.

use crate::error::Result;
use crate::sensing::cameras::{ObstacleCamera, RobotCamera};
use crate::sensing::lidar::{Lidar, Scans};
use crate::sensing::sensor::Sensor;
use crate::sensing::ultrasonic::{Echoes, Ultrasonic};
use crate::sensing::vision::Vision;
use crate::world::scenario::Scenario;

/// A sensor of a robot, or above the scene, before it is put to work.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // a few for each robot
pub enum SensorOptions {
    /// A camera that sees the robot.
    RobotCamera(Vision),
    /// A camera that sees the obstacles that move.
    ObstacleCamera(Vision),
    /// Ultrasonic sensors on the robot.
    Ultrasonic(Ultrasonic),
    /// A lidar on the robot.
    Lidar(Lidar),
}

impl SensorOptions {
    /// The sensor at work in a scenario, the one with an index among several; `mark` is the distance
    /// of the second mark of the robot from its center in m.
    ///
    /// # Errors
    /// An option is out of range in this scenario.
    pub(crate) fn at_work(
        &self,
        scenario: &Scenario,
        mark: f64,
        index: u64,
    ) -> Result<Box<dyn Sensor>> {
        Ok(match self {
            Self::RobotCamera(vision) => Box::new(RobotCamera::new(scenario, vision, mark)?),
            Self::ObstacleCamera(vision) => Box::new(ObstacleCamera::new(scenario, vision)?),
            Self::Ultrasonic(array) => Box::new(Echoes::new(scenario, array, index)?),
            Self::Lidar(lidar) => Box::new(Scans::new(scenario, lidar, index)?),
        })
    }

    /// Whether it is a camera, which measures in place of the scenario.
    #[must_use]
    pub fn is_camera(&self) -> bool {
        match self {
            Self::RobotCamera(_) | Self::ObstacleCamera(_) => true,
            Self::Ultrasonic(_) | Self::Lidar(_) => false,
        }
    }
}
