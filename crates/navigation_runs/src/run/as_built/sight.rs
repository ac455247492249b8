//! Knowledge of the controller about itself and the obstacles: the sensors of a robot together.

use std::ops::Range;

use crate::run::as_built::AsBuilt;
use navigation_laws::{Lidars, Scan};
use navigation_world::robots::drives::{PoseFix, Reading};
use navigation_world::sensing::noisy::NoisyPositions;
use navigation_world::sensing::sensor::{Sensor, Truth};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::motion::BodyState;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::Result;
use numeric::lanes::Vector2;

/// Knowledge of the controller at a sample.
pub(crate) struct SensedState<'a> {
    /// State of the robot.
    pub robot: RobotState<f64>,
    /// The obstacles.
    pub bodies: &'a [Body],
    /// The pose as measured, `None` where it is known exactly.
    pub fix: Option<PoseFix>,
}

impl SensedState<'_> {
    /// Whether the robot is outside every active region.
    pub fn clear(&self) -> bool {
        self.bodies.iter().all(|body| {
            let reach = body.regions.active_radius;
            let squared = body.offset(self.robot.position).distance_squared;
            !body.state.present || squared >= reach * reach
        })
    }
}

/// The sensors of a robot.
pub(crate) struct BuiltSensors {
    sensors: Vec<Box<dyn Sensor>>,
    /// Which of the known obstacles each sensor tells of.
    told: Vec<Range<usize>>,
    /// The scenario as a law knows it, where that is not as it is.
    known: Option<Scenario>,
    seen: Vec<Body>,
    /// How old it is, in s.
    ages: Vec<f64>,
}

impl BuiltSensors {
    pub fn new(scenario: &Scenario, built: &AsBuilt, bodies: &[Body]) -> Result<Self> {
        let sensors = sensors_of(scenario, built, bodies)?;
        let mut obstacles: Vec<PlacedObstacle> = Vec::new();
        let mut told = Vec::with_capacity(sensors.len());
        for sensor in &sensors {
            let first = obstacles.len();
            obstacles.extend_from_slice(sensor.obstacles().unwrap_or_default());
            told.push(first..obstacles.len());
        }
        let tells = sensors.iter().any(|sensor| sensor.obstacles().is_some());
        let seen: Vec<Body> = obstacles.iter().map(hidden).collect();
        let scans = sensors.iter().filter_map(|sensor| sensor.scan());
        let known = tells.then(|| Scenario {
            obstacles,
            lidars: scans.map(|scan| scan.scanner.clone()).collect(),
            ..scenario.clone()
        });
        Ok(Self {
            sensors,
            told,
            known,
            ages: vec![0.0; seen.len()],
            seen,
        })
    }

    /// The scenario as a law knows it: with the obstacles that the sensors can tell of.
    pub fn known<'a>(&'a self, scenario: &'a Scenario) -> &'a Scenario {
        self.known.as_ref().unwrap_or(scenario)
    }

    /// Whether a law knows the obstacles that sensors tell of, in place of those that there are.
    pub fn tells(&self) -> bool {
        self.known.is_some()
    }

    /// Scan for the law: that of the lidars if sensors measure the obstacles, else all that a law scans by itself.
    pub fn scan(&self) -> Scan<'_> {
        if self.tells() {
            Scan {
                lidars: Lidars(&self.sensors),
                ..Scan::default()
            }
        } else {
            Scan::ALL
        }
    }

    /// Shows the scene at an instant, at the start of every motion step.
    pub fn show(&mut self, time: f64, reading: &Reading, actual: &[Body]) {
        let truth = truth_of(time, reading, actual);
        for sensor in &mut self.sensors {
            sensor.watch(&truth);
        }
    }

    /// Goal in m that a sensor has found, if one has.
    pub fn goal(&self) -> Option<Vector2<f64>> {
        self.sensors.iter().find_map(|sensor| sensor.goal())
    }

    /// The obstacles as known since the last look.
    pub fn bodies<'a>(&'a self, actual: &'a [Body]) -> &'a [Body] {
        if self.known.is_some() {
            &self.seen
        } else {
            actual
        }
    }

    /// How old what is known of the obstacles is, in s; empty where all of it is of now.
    pub fn ages(&self) -> &[f64] {
        &self.ages
    }

    /// Senses at a sample; `heading` in rad is what the robot itself takes it for.
    pub fn look<'a>(
        &'a mut self,
        time: f64,
        reading: &Reading,
        heading: f64,
        actual: &'a [Body],
    ) -> SensedState<'a> {
        let truth = truth_of(time, reading, actual);
        let mut located = None;
        for sensor in &mut self.sensors {
            // Every sensor is asked, so that its noise does not depend on the others.
            located = sensor.locate(&truth).or(located);
        }
        let robot = located.map_or(reading.robot, |found| found.robot);
        let measured = located.and_then(|found| found.heading);
        let known = Frame::at(robot.position.into(), measured.unwrap_or(heading));
        for (sensor, range) in self.sensors.iter_mut().zip(&self.told) {
            sensor.observe(&truth, &known, &mut self.seen[range.clone()]);
            sensor.date(time, &mut self.ages[range.clone()]);
        }
        SensedState {
            robot,
            bodies: self.bodies(actual),
            fix: located.map(|found| PoseFix {
                position: found.robot.position,
                heading: found.heading,
            }),
        }
    }
}

/// The sensors that a robot has in a scenario.
fn sensors_of(
    scenario: &Scenario,
    built: &AsBuilt,
    bodies: &[Body],
) -> Result<Vec<Box<dyn Sensor>>> {
    let mark = built.fusion.mark;
    let mut sensors: Vec<Box<dyn Sensor>> = Vec::new();
    if let Some(noisy) = NoisyPositions::new(scenario, built.step, mark, bodies) {
        sensors.push(Box::new(noisy));
    }
    for (index, options) in (0..).zip(&built.sensors) {
        sensors.push(options.at_work(scenario, mark, index)?);
    }
    Ok(sensors)
}

fn truth_of<'a>(time: f64, reading: &Reading, bodies: &'a [Body]) -> Truth<'a> {
    Truth::among(time, reading.robot, reading.heading, bodies)
}

/// An obstacle of which nothing has been told yet.
pub(crate) fn hidden(placed: &PlacedObstacle) -> Body {
    Body {
        shape: placed.obstacle.shape,
        regions: placed.regions,
        state: BodyState {
            present: false,
            ..placed.obstacle.motion.at(0.0, &mut 0)
        },
    }
}
