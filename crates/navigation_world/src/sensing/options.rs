//! One kind for all sensors, from the list in `sensing/mod.rs`. Neither the loop nor the binding knows one of
//! those that ride on a robot by name.

use crate::arguments::{Arguments, Named};
use crate::sensing::cameras::{ObstacleCamera, RobotCamera};
use crate::sensing::lidar::Lidar;
use crate::sensing::sensor::{RobotSensor, Sensor};
use crate::sensing::vision::Vision;
use crate::world::map::StaticMap;
use crate::world::obstacle::Regions;
use crate::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};

/// Makes a sensor of its arguments.
type Make = fn(&dyn Arguments) -> Result<SensorOptions>;

/// A sensor by the place where it is.
enum MountedSensor<'a> {
    AboveRobot(&'a Vision),
    AboveObstacles(&'a Vision),
    OnRobot(&'a dyn RobotSensor),
}

macro_rules! sensor_options {
    ($($module:ident::$sensor:ident),+ $(,)?) => {
        /// A sensor of a robot, or above the scene, before it is put to work.
        #[derive(Clone, Debug, PartialEq)]
        #[allow(clippy::large_enum_variant)] // a few for each robot
        pub enum SensorOptions {
            /// A camera that sees the robot.
            RobotCamera(Vision),
            /// A camera that sees the obstacles that move.
            ObstacleCamera(Vision),
            /// A lidar on the robot.
            Lidar(Lidar),
            $(#[doc = concat!("[`", stringify!($sensor), "`](crate::sensing::", stringify!($module), ") on the robot.")]
            $sensor(crate::sensing::$module::$sensor)),+
        }

        /// Sensors that ride on a robot, by name.
        const SENSORS: &[(&str, Make)] = &[$((crate::sensing::$module::$sensor::NAME, |given| {
            crate::sensing::$module::$sensor::made_of(given).map(SensorOptions::$sensor)
        })),+];

        impl SensorOptions {
            /// Where it is.
            fn place(&self) -> MountedSensor<'_> {
                match self {
                    Self::RobotCamera(vision) => MountedSensor::AboveRobot(vision),
                    Self::ObstacleCamera(vision) => MountedSensor::AboveObstacles(vision),
                    Self::Lidar(lidar) => MountedSensor::OnRobot(lidar),
                    $(Self::$sensor(sensor) => MountedSensor::OnRobot(sensor)),+
                }
            }
        }
    };
}
robot_sensors!(sensor_options);

/// The sensor of a name, whose options are valid.
///
/// # Errors
/// There is no such sensor, an argument is missing, or an option is out of range.
pub fn sensor_named(name: &str, given: &dyn Arguments) -> Result<SensorOptions> {
    let Some((_, make)) = SENSORS.iter().find(|(known, _)| *known == name) else {
        let names: Vec<_> = SENSORS.iter().map(|(name, _)| *name).collect();
        let rule = format!("be one of {}", names.join(", "));
        let given = Given::Word(name.to_owned());
        return Err(Failure::invalid("sensor", rule, given));
    };
    make(given)
}

impl SensorOptions {
    /// Map around the sensor, beside the obstacles of a scenario.
    #[must_use]
    pub fn map(&self) -> Option<&StaticMap> {
        if let Self::Lidar(lidar) = self {
            Some(&lidar.map)
        } else {
            None
        }
    }

    /// The sensor at work in a scenario, the one with an index among several; `mark` is the distance
    /// of the second mark of the robot from its center in m.
    ///
    /// # Errors
    /// An option is out of range in this scenario.
    pub fn at_work(&self, scenario: &Scenario, mark: f64, index: u64) -> Result<Box<dyn Sensor>> {
        match self.place() {
            MountedSensor::AboveRobot(vision) => {
                Ok(Box::new(RobotCamera::new(scenario, vision, mark)?))
            }
            MountedSensor::AboveObstacles(vision) => {
                Ok(Box::new(ObstacleCamera::new(scenario, vision)?))
            }
            MountedSensor::OnRobot(sensor) => sensor.at_work(scenario, index),
        }
    }

    /// Regions of what it sees in a scenario, and the distance from the center of the robot within
    /// which it sees in m; `None` if what it sees has the regions of the scenario.
    ///
    /// # Errors
    /// The regions cannot be computed.
    pub fn sight(&self, scenario: &Scenario) -> Result<Option<(Regions, f64)>> {
        match self.place() {
            MountedSensor::AboveRobot(_) | MountedSensor::AboveObstacles(_) => Ok(None),
            MountedSensor::OnRobot(sensor) => sensor.sight(scenario),
        }
    }

    /// Set for a camera, which measures in place of the scenario.
    #[must_use]
    pub fn is_camera(&self) -> bool {
        !matches!(self.place(), MountedSensor::OnRobot(_))
    }
}
