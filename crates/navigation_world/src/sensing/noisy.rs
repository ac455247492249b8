//! Noisy and late positions as a sensor: the measurement of a scenario.

use crate::sensing::marks::{self, MARK_STREAM};
use crate::sensing::measurement::{Measurement, Noise};
use crate::sensing::sampled::{self, Past};
use crate::sensing::sensor::{Located, Sensor, Truth};
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::scenario::{PlacedObstacle, Scenario};
use numeric::lanes::{Planar, Vector2};

/// Positions with an error once a control period.
pub struct NoisyPositions {
    sensor: sampled::SampledScene,
    mark: Option<Noise>,
    mark_distance: f64,
    last_measured: Option<Vector2<f64>>,
    /// Past places of the center and of the second mark, of a robot that is measured late.
    past: Option<[Past<f64>; 2]>,
    /// The obstacles, if they are measured.
    obstacles: Option<Vec<PlacedObstacle>>,
    measured: Vec<Body>,
}

impl NoisyPositions {
    /// Sensor of a scenario, with the time between two looks at the scene in s and the distance of the second mark in m;
    /// `None` if everything is known exactly.
    pub fn new(
        scenario: &Scenario,
        step: f64,
        mark_distance: f64,
        bodies: &[Body],
    ) -> Option<Self> {
        let measurement = scenario.measurement?;
        let of_robot = Some(measurement).filter(Measurement::of_robot);
        let of_obstacles = measurement.of_obstacle(false);
        Some(Self {
            sensor: sampled::SampledScene::new(scenario, step)?,
            mark: of_robot.map(|noise| Noise::new(noise, scenario.seed, MARK_STREAM)),
            mark_distance,
            last_measured: None,
            past: Past::new(scenario, step).map(|past| [past.clone(), past]),
            obstacles: of_obstacles.then(|| scenario.obstacles.clone()),
            measured: bodies.to_vec(),
        })
    }
}

impl Sensor for NoisyPositions {
    fn watch(&mut self, truth: &Truth<'_>) {
        self.sensor.watch(truth.bodies);
        if let Some([center, mark]) = &mut self.past {
            center.push(truth.robot.position);
            mark.push(marks::second(truth, self.mark_distance));
        }
    }

    fn locate(&mut self, truth: &Truth<'_>) -> Option<Located> {
        let errors = self
            .sensor
            .measure(truth.time, truth.bodies, &mut self.measured);
        let mark = self.mark.as_mut()?;
        let mut robot = truth.robot;
        let mut place = marks::second(truth, self.mark_distance);
        if let Some([center, mark]) = &self.past {
            robot.position = center.delayed(robot.position);
            place = mark.delayed(place);
        }
        let robot = errors.of_robot(robot, &mut self.last_measured);
        let place = place + Vector2::splat(mark.draw());
        Some(Located {
            robot,
            heading: Some(marks::heading(robot.position, place)),
        })
    }

    fn obstacles(&self) -> Option<&[PlacedObstacle]> {
        self.obstacles.as_deref()
    }

    fn observe(&mut self, _truth: &Truth<'_>, _known: &Frame, bodies: &mut [Body]) {
        for (body, measured) in bodies.iter_mut().zip(&self.measured) {
            body.state = measured.state;
        }
    }
}
