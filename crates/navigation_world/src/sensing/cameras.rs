//! Cameras as sensors: one that sees the robot, one that sees moving obstacles.

use crate::sensing::marks::{self, MARK_STREAM};
use crate::sensing::sensor::{Located, Sensor, Truth};
use crate::sensing::vision::{Vision, VisionSensor};
use crate::world::frame::Frame;
use crate::world::geometry::{Body, RobotState};
use crate::world::motion::BodyState;
use crate::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::Result;
use numeric::lanes::{Planar, Vector2};

/// A camera that sees the center of the robot and its second mark.
pub(crate) struct RobotCamera {
    center: VisionSensor,
    mark: VisionSensor,
    mark_distance: f64,
    start: RobotState<f64>,
}

impl RobotCamera {
    /// Of the robot of a scenario, with the distance of its second mark in m.
    pub fn new(scenario: &Scenario, vision: &Vision, mark_distance: f64) -> Result<Self> {
        vision.check_frames(scenario.rules.time_limit)?;
        Ok(Self {
            center: VisionSensor::new(vision, scenario.seed, 0)?,
            mark: VisionSensor::new(vision, scenario.seed, MARK_STREAM)?,
            mark_distance,
            start: RobotState {
                position: Vector2::splat(scenario.start),
                velocity: Vector2::zeros(),
            },
        })
    }
}

impl Sensor for RobotCamera {
    fn watch(&mut self, truth: &Truth<'_>) {
        let place = truth.robot.position;
        self.center.sample(truth.time, place.into());
        let mark = marks::second(truth, self.mark_distance);
        self.mark.sample(truth.time, mark.into());
    }

    fn locate(&mut self, truth: &Truth<'_>) -> Option<Located> {
        let place = self.center.estimate(truth.time);
        let robot = place.map_or(self.start, |found| RobotState {
            position: Vector2::splat(found.position),
            velocity: Vector2::splat(found.velocity),
        });
        // Marks of one picture only: between two pictures the robot has moved on.
        let same = |at: f64| place.is_some_and(|found| found.measured_at == at);
        let mark = self.mark.estimate(truth.time);
        let mark = mark.filter(|found| same(found.measured_at));
        let heading = mark.map(|found| marks::heading(robot.position, found.position.into()));
        Some(Located { robot, heading })
    }
}

/// A camera that sees the obstacles that move; those at rest are known.
pub struct ObstacleCamera {
    sensors: Vec<Option<VisionSensor>>,
    obstacles: Vec<PlacedObstacle>,
}

impl ObstacleCamera {
    /// Of the obstacles of a scenario.
    ///
    /// # Errors
    /// An option of the camera is out of range, or a run has more frames than it may.
    pub fn new(scenario: &Scenario, vision: &Vision) -> Result<Self> {
        vision.check_frames(scenario.rules.time_limit)?;
        let of_body = |(stream, placed): (u64, &PlacedObstacle)| {
            let moving = (!placed.stationary).then_some(vision);
            let sensor = moving.map(|vision| VisionSensor::new(vision, scenario.seed, stream));
            sensor.transpose()
        };
        let sensors = (1..).zip(&scenario.obstacles).map(of_body);
        Ok(Self {
            sensors: sensors.collect::<Result<_>>()?,
            obstacles: scenario.obstacles.clone(),
        })
    }
}

impl ObstacleCamera {
    /// Of everything that stands or moves, with one stream for each thing from the first one on, for
    /// a time in s.
    ///
    /// # Errors
    /// An option of the camera is out of range, or a run has more frames than it may.
    pub fn of_everything(
        count: usize,
        vision: &Vision,
        (seed, first): (u64, u64),
        duration: f64,
    ) -> Result<Self> {
        vision.check_frames(duration)?;
        let sensor = |(stream, _)| VisionSensor::new(vision, seed, stream).map(Some);
        Ok(Self {
            sensors: (first..).zip(0..count).map(sensor).collect::<Result<_>>()?,
            obstacles: Vec::new(),
        })
    }
}

impl Sensor for ObstacleCamera {
    fn watch(&mut self, truth: &Truth<'_>) {
        for (sensor, body) in self.sensors.iter_mut().zip(truth.bodies) {
            match sensor {
                Some(sensor) if body.state.present => {
                    sensor.sample(truth.time, body.state.position);
                }
                Some(sensor) => sensor.absent(truth.time),
                None => {}
            }
        }
    }

    fn obstacles(&self) -> Option<&[PlacedObstacle]> {
        Some(&self.obstacles)
    }

    fn observe(&mut self, truth: &Truth<'_>, _known: &Frame, bodies: &mut [Body]) {
        let actual = self.sensors.iter().zip(truth.bodies);
        for (known, (sensor, body)) in bodies.iter_mut().zip(actual) {
            let seen = |sensor: &VisionSensor| state_of(sensor, truth.time, body.state);
            known.state = sensor.as_ref().map_or(body.state, seen);
        }
    }

    fn date(&self, time: f64, ages: &mut [f64]) {
        for (age, sensor) in ages.iter_mut().zip(&self.sensors) {
            *age = sensor.as_ref().map_or(0.0, |sensor| sensor.age(time));
        }
    }
}

/// An obstacle as a camera knows it; absent before the first frame, its acceleration not known.
fn state_of(sensor: &VisionSensor, time: f64, actual: BodyState) -> BodyState {
    let hidden = BodyState {
        present: false,
        ..actual
    };
    sensor
        .estimate(time)
        .filter(|_| actual.present)
        .map_or(hidden, |found| BodyState {
            position: found.position,
            velocity: found.velocity,
            acceleration: [0.0; 2],
            present: true,
        })
}
