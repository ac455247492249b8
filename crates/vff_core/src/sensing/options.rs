//! The one list of sensors that a robot can have. Neither the loop nor the binding knows one of those that
//! ride on a robot by name.

use crate::arguments::Arguments;
use crate::error::{Failure, Given, Result};
use crate::sensing::cameras::{ObstacleCamera, RobotCamera};
use crate::sensing::lidar::{Lidar, Scans};
use crate::sensing::sensor::Sensor;
use crate::sensing::ultrasonic::{Echoes, Ultrasonic};
use crate::sensing::vision::Vision;
use crate::world::map::StaticMap;
use crate::world::obstacle::Regions;
use crate::world::scenario::Scenario;

/// Makes a sensor of its arguments.
type Make = fn(&dyn Arguments) -> Result<SensorOptions>;

/// Sensors that ride on a robot, by name.
const SENSORS: [(&str, Make); 1] = [("ultrasonic", |given| {
    Ultrasonic::of(given).map(SensorOptions::Ultrasonic)
})];

/// The sensor of a name, whose options are valid.
///
/// # Errors
/// There is no such sensor, an argument is missing, or an option is out of range.
pub fn sensor_named(name: &str, given: &dyn Arguments) -> Result<SensorOptions> {
    let known = SENSORS.iter().find(|(known, _)| *known == name);
    let Some((_, make)) = known else {
        let names = SENSORS.map(|(name, _)| name).join(", ");
        let given = Given::Word(name.to_owned());
        return Err(Failure::invalid(
            "sensor",
            format!("be one of {names}"),
            given,
        ));
    };
    make(given)
}

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
    /// What stands around it beside the obstacles of a scenario.
    pub(crate) fn map(&self) -> Option<&StaticMap> {
        match self {
            Self::Lidar(lidar) => Some(&lidar.map),
            Self::RobotCamera(_) | Self::ObstacleCamera(_) | Self::Ultrasonic(_) => None,
        }
    }

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

    /// Regions of what it sees in a scenario, and the distance from the center of the robot within
    /// which it sees in m; `None` if what it sees has the regions of the scenario.
    ///
    /// # Errors
    /// The regions cannot be computed.
    pub fn sight(&self, scenario: &Scenario) -> Result<Option<(Regions, f64)>> {
        match self {
            Self::RobotCamera(_) | Self::ObstacleCamera(_) => Ok(None),
            Self::Ultrasonic(array) => Ok(Some((array.regions(scenario)?, array.reach()))),
            Self::Lidar(lidar) => Ok(Some((lidar.regions(scenario)?, lidar.range_max))),
        }
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
