//! What the controller knows of itself and of the obstacles.

use crate::error::Result;
use crate::lanes::{Planar, Vector2};
use crate::robots::drives::{Fix, Reading};
use crate::run::built::Built;
use crate::sensing::VisionSensor;
use crate::sensing::measurement::{Measurement, Noise};
use crate::sensing::sampled::{Past, Sensor};
use crate::world::geometry::{Body, RobotState};
use crate::world::motion::BodyState;
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Stream of the noise of the second mark; obstacles count up from 1, and a camera takes the highest
/// bit for its lost frames.
const MARK_STREAM: u64 = 1 << 62;

/// What the controller knows at a sample.
pub(crate) struct Seen<'a> {
    /// State of the robot.
    pub robot: RobotState<f64>,
    /// The obstacles.
    pub bodies: &'a [Body],
    /// The pose as measured, `None` where it is known exactly.
    pub fix: Option<Fix>,
}

impl Seen<'_> {
    /// Whether the robot is outside every active region.
    pub fn clear(&self) -> bool {
        self.bodies.iter().all(|body| {
            let reach = body.regions.active_radius;
            let squared = body.offset(self.robot.position).distance_squared;
            !body.state.present || squared >= reach * reach
        })
    }
}

/// Positions with an error once a control period.
struct Samples {
    sensor: Sensor,
    mark: Option<Noise>,
    last_measured: Option<Vector2<f64>>,
    /// Past places of the center and of the second mark, of a robot that is measured late.
    past: Option<[Past<f64>; 2]>,
}

/// Cameras with periods of their own.
struct Cameras {
    /// The center of the robot and its second mark.
    robot: Option<[VisionSensor; 2]>,
    obstacles: Vec<Option<VisionSensor>>,
}

/// Who looks.
enum Eye {
    /// Everything is known exactly.
    Exact,
    /// As the scenario measures.
    Samples(Box<Samples>),
    /// As the robot is built.
    Cameras(Box<Cameras>),
}

impl Eye {
    fn new(scenario: &Scenario, built: &Built) -> Result<Self> {
        if built.robot_vision.is_some() || built.obstacle_vision.is_some() {
            return Ok(Self::Cameras(Box::new(Cameras::new(scenario, built)?)));
        }
        let Some(sensor) = Sensor::new(scenario) else {
            return Ok(Self::Exact);
        };
        let measured = scenario.measurement.filter(Measurement::of_robot);
        Ok(Self::Samples(Box::new(Samples {
            sensor,
            mark: measured.map(|noise| Noise::new(noise, scenario.seed, MARK_STREAM)),
            last_measured: None,
            past: Past::new(scenario, built.step).map(|past| [past.clone(), past]),
        })))
    }
}

impl Cameras {
    fn new(scenario: &Scenario, built: &Built) -> Result<Self> {
        let seed = scenario.seed;
        for vision in [&built.robot_vision, &built.obstacle_vision]
            .into_iter()
            .flatten()
        {
            vision.check_frames(scenario.rules.time_limit)?;
        }
        let pair = built.robot_vision.as_ref().map(|vision| -> Result<_> {
            let center = VisionSensor::new(vision, seed, 0)?;
            Ok([center, VisionSensor::new(vision, seed, MARK_STREAM)?])
        });
        let of_body = |(stream, placed): (u64, &PlacedObstacle)| {
            let vision = built.obstacle_vision.as_ref();
            let vision = vision.filter(|_| !placed.stationary);
            let sensor = vision.map(|vision| VisionSensor::new(vision, seed, stream));
            sensor.transpose()
        };
        let obstacles = (1..).zip(&scenario.obstacles).map(of_body);
        Ok(Self {
            robot: pair.transpose()?,
            obstacles: obstacles.collect::<Result<_>>()?,
        })
    }

    /// State of the robot and its pose, both as known; none where it is known exactly.
    fn robot(&self, time: f64, start: RobotState<f64>) -> Option<(RobotState<f64>, Fix)> {
        let [center, mark] = self.robot.as_ref()?;
        let place = center.estimate(time);
        let robot = place.map_or(start, |found| RobotState {
            position: Vector2::splat(found.position),
            velocity: Vector2::splat(found.velocity),
        });
        // Marks of one picture only: between two pictures the robot has moved on.
        let same = |at: f64| place.is_some_and(|found| found.measured_at == at);
        let marked = mark.estimate(time).filter(|found| same(found.measured_at));
        let heading =
            marked.map(|found| heading_of(robot.position, Vector2::splat(found.position)));
        let position = robot.position;
        Some((robot, Fix { position, heading }))
    }
}

/// What the controller sees of the scene.
pub(crate) struct Sight {
    eye: Eye,
    mark_distance: f64,
    start: RobotState<f64>,
    seen: Vec<Body>,
}

impl Sight {
    pub fn new(scenario: &Scenario, built: &Built, bodies: &[Body]) -> Result<Self> {
        Ok(Self {
            eye: Eye::new(scenario, built)?,
            mark_distance: built.fusion.mark,
            start: RobotState {
                position: Vector2::splat(scenario.start),
                velocity: Vector2::zeros(),
            },
            seen: bodies.to_vec(),
        })
    }

    /// Shows the scene at an instant, at the begin of every motion step.
    pub fn show(&mut self, time: f64, reading: &Reading, actual: &[Body]) {
        let cameras = match &mut self.eye {
            Eye::Exact => return,
            Eye::Samples(samples) => {
                if let Some([center, mark]) = &mut samples.past {
                    center.push(reading.robot.position);
                    mark.push(mark_of(reading, self.mark_distance));
                }
                return;
            }
            Eye::Cameras(cameras) => cameras,
        };
        if let Some([center, mark]) = &mut cameras.robot {
            center.sample(time, reading.robot.position.lane(0));
            mark.sample(time, mark_of(reading, self.mark_distance).lane(0));
        }
        for (sensor, body) in cameras.obstacles.iter_mut().zip(actual) {
            match sensor {
                Some(sensor) if body.state.present => sensor.sample(time, body.state.position),
                Some(sensor) => sensor.absent(time),
                None => {}
            }
        }
    }

    /// The obstacles as known since the last look.
    pub fn bodies<'a>(&'a self, actual: &'a [Body]) -> &'a [Body] {
        match self.eye {
            Eye::Exact => actual,
            Eye::Samples(_) | Eye::Cameras(_) => &self.seen,
        }
    }

    /// What is known at a sample.
    pub fn look<'a>(&'a mut self, time: f64, reading: &Reading, actual: &'a [Body]) -> Seen<'a> {
        match &mut self.eye {
            Eye::Exact => Seen {
                robot: reading.robot,
                bodies: actual,
                fix: None,
            },
            Eye::Samples(samples) => {
                let measured = samples.sensor.measure(time, actual, &mut self.seen);
                let mut robot = reading.robot;
                let mut place = mark_of(reading, self.mark_distance);
                if let Some([center, mark]) = &samples.past {
                    robot.position = center.delayed(robot.position);
                    place = mark.delayed(place);
                }
                let robot = measured.of_robot(robot, &mut samples.last_measured);
                let fix = samples.mark.as_mut().map(|mark| {
                    let place = place + Vector2::splat(mark.draw());
                    Fix {
                        position: robot.position,
                        heading: Some(heading_of(robot.position, place)),
                    }
                });
                Seen {
                    robot,
                    bodies: &self.seen,
                    fix,
                }
            }
            Eye::Cameras(cameras) => {
                let sensors = cameras.obstacles.iter();
                for ((known, body), sensor) in self.seen.iter_mut().zip(actual).zip(sensors) {
                    known.state = sensor
                        .as_ref()
                        .map_or(body.state, |sensor| state_of(sensor, time, body.state));
                }
                let known = cameras.robot(time, self.start);
                Seen {
                    robot: known.map_or(reading.robot, |(robot, _)| robot),
                    bodies: &self.seen,
                    fix: known.map(|(_, fix)| fix),
                }
            }
        }
    }
}

/// Where the second mark is.
fn mark_of(reading: &Reading, distance: f64) -> Vector2<f64> {
    let (sin, cos) = reading.heading.sin_cos();
    let ahead = Vector2::new(cos, sin);
    reading.robot.position + ahead * distance
}

/// Heading in rad from the measured places of both marks, (7.3.1) of Zeng (2011).
fn heading_of(position: Vector2<f64>, mark: Vector2<f64>) -> f64 {
    let ahead = mark - position;
    ahead.y.atan2(ahead.x)
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
