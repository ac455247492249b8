//! Interface of sensors: watch the scene, and tell the controller of the robot or of obstacles.

use crate::sensing::scanner::Scanner;
use crate::world::frame::{Frame, Heading};
use crate::world::geometry::{Body, RobotState};
use crate::world::obstacle::Regions;
use crate::world::scenario::{PlacedObstacle, Scenario};
use crate::world::shape::PlacedShape;
use numeric::error::Result;
use numeric::lanes::Vector2;

/// The scene as it is.
#[derive(Clone, Copy, Debug)]
pub struct Truth<'a> {
    /// Time in s.
    pub time: f64,
    /// State of the robot.
    pub robot: RobotState<f64>,
    /// Heading of the robot.
    pub heading: Heading,
    /// The obstacles.
    pub bodies: &'a [Body],
    /// Outlines of what gives echoes, where a world keeps them beside its bodies or in place of them.
    pub outlines: &'a [PlacedShape],
    /// Where a sound comes from, in m, if there is one.
    pub source: Option<Vector2<f64>>,
}

impl<'a> Truth<'a> {
    /// A robot with a heading in rad among obstacles.
    #[must_use]
    pub fn among(time: f64, robot: RobotState<f64>, heading: f64, bodies: &'a [Body]) -> Self {
        Self {
            time,
            robot,
            heading: Heading::Angle(heading),
            bodies,
            outlines: &[],
            source: None,
        }
    }

    /// A robot at a place with a front and a velocity in m/s, and nothing around it.
    #[inline]
    #[must_use]
    pub fn alone(time: f64, frame: &Frame, velocity: Vector2<f64>) -> Self {
        Self {
            time,
            robot: RobotState {
                position: frame.position,
                velocity,
            },
            heading: Heading::Direction(frame.direction),
            bodies: &[],
            outlines: &[],
            source: None,
        }
    }

    /// Where the robot is and where it looks.
    #[inline]
    #[must_use]
    pub fn frame(&self) -> Frame {
        Frame {
            position: self.robot.position,
            direction: self.heading.direction(),
        }
    }
}

/// The robot as a sensor knows it.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    /// Position in m and velocity in m/s.
    pub robot: RobotState<f64>,
    /// Heading in rad, if it is measured.
    pub heading: Option<f64>,
}

/// Last scan of a lidar.
#[derive(Clone, Copy, Debug)]
pub struct LidarScan<'a> {
    /// The lidar.
    pub scanner: &'a Scanner,
    /// When it was made in s.
    pub time: f64,
    /// In m: `range_max` where nothing was hit, NaN where a beam dropped out; empty before the first scan.
    pub ranges: &'a [f64],
}

/// A sensor on the robot or above the scene. What it does not tell of, another one may; what none
/// tells of is known exactly.
pub trait Sensor: Send {
    /// Watches the scene at the start of a motion step.
    fn watch(&mut self, _truth: &Truth<'_>) {}

    /// Tells of the robot at a sample: at every one, or at none.
    fn locate(&mut self, _truth: &Truth<'_>) -> Option<Located> {
        None
    }

    /// Obstacles that a law under this sensor can know at a time, at most; `None` if the sensor
    /// does not tell of obstacles.
    fn obstacles(&self) -> Option<&[PlacedObstacle]> {
        None
    }

    /// Tells of these obstacles at a sample, after all sensors have told of the robot; `known` is
    /// the robot as it knows itself.
    fn observe(&mut self, _truth: &Truth<'_>, _known: &Frame, _bodies: &mut [Body]) {}

    /// Goal in m to which the sensor sends the robot, once it has found one.
    fn goal(&self) -> Option<Vector2<f64>> {
        None
    }

    /// Last scan that has arrived, of a lidar.
    fn scan(&self) -> Option<LidarScan<'_>> {
        None
    }

    /// Tells how old at a time in s what it told of these obstacles is; of now, unless it knows better.
    fn date(&self, _time: f64, _ages: &mut [f64]) {}
}

/// A sensor that rides on a robot, before it is put to work: its readings are points of what is around,
/// with regions of their own.
pub trait RobotSensor {
    /// The sensor at work in a scenario, the one with an index among several.
    ///
    /// # Errors
    /// An option is out of range in this scenario.
    fn at_work(&self, scenario: &Scenario, index: u64) -> Result<Box<dyn Sensor>>;

    /// Regions of what it reads, for the robot of a scenario, and the distance from the center of the robot within which
    /// it reads, in m; `None` for a sensor that does not tell of obstacles.
    ///
    /// # Errors
    /// Errors of [`crate::world::region::radii`].
    fn sight(&self, scenario: &Scenario) -> Result<Option<(Regions, f64)>>;
}
