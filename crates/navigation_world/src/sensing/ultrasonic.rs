//! An ultrasonic array as a sensor: every echo becomes a point of an obstacle's boundary.

use nalgebra::Vector2;
use numeric::random::Stream;

use crate::arguments::{Arguments, Named};
use crate::sensing::sensor::{RobotSensor, Sensor, Truth};
use crate::sensing::sonar::{Beam, Firing, Ranging, Sonar, SonarArray};
use crate::world::frame::Frame;
use crate::world::geometry::Body;
use crate::world::motion::BodyState;
use crate::world::obstacle::{Obstacle, Regions};
use crate::world::region::{self, Sensing};
use crate::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::{Result, not_negative};

/// Streams of the noise of arrays, counted up from here; that of the second mark is higher.
const ECHO_STREAM: u64 = 1 << 61;

/// An array of sonars on a robot, and what its echoes are taken for.
///
/// An echo is taken for a body of radius 0 at the reading along the axis of its beam. Bodies that
/// give no echo are not known to the law.
#[derive(Clone, Debug, PartialEq)]
pub struct Ultrasonic {
    /// The sensors in the axes of the robot.
    pub array: SonarArray,
    /// Largest speed of what is seen, for which regions are sized, in m/s.
    pub max_speed: f64,
    /// Speed toward the robot at which what is seen is taken to move, in m/s.
    pub assumed_speed: f64,
}

impl Named for Ultrasonic {
    const NAME: &'static str = "ultrasonic";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let ranging = Ranging {
            least: given.number("least_range")?,
            most: given.number("most_range")?,
            noise: given.number("range_noise")?,
            ..Ranging::default()
        };
        let places = given.places("mounts")?.into_iter();
        let mounts = places.map(|[x, y, axis]| Frame::at([x, y], axis)).collect();
        let beam = Beam::new(given.number("beam_width")?, given.count("rays")?)?;
        let firing = Firing::named(&given.word("firing")?)?;
        Self {
            array: SonarArray::new(mounts, beam, ranging, firing)?,
            max_speed: given.number("max_speed")?,
            assumed_speed: given.number("assumed_speed")?,
        }
        .checked()
    }
}

impl Ultrasonic {
    /// Returns the array if its speeds are in range.
    ///
    /// # Errors
    /// A speed is negative or not finite.
    pub fn checked(self) -> Result<Self> {
        not_negative("max_speed", self.max_speed)?;
        not_negative("assumed_speed", self.assumed_speed)?;
        Ok(self)
    }

    /// Regions of what it reads; an array that fires in turn is late by a round.
    ///
    /// # Errors
    /// Errors of [`region::radii`].
    pub fn regions(&self, scenario: &Scenario) -> Result<Regions> {
        let round = self.array.mounts().len()
            / self
                .array
                .firing()
                .fired(self.array.mounts().len(), 0)
                .len();
        let period = scenario.control_period();
        let sensing = Sensing {
            latency: Some((round - 1) as f64 * period),
            ..Sensing::default()
        };
        let point = Obstacle::point(self.max_speed);
        region::radii(&scenario.limits(), &point, period, None, &sensing)
    }

    /// Every sensor reads echoes along its axis there.
    fn reach(&self) -> f64 {
        let forward = |mount: &Frame| mount.inward(mount.position).x;
        let mounts = self.array.mounts().iter();
        self.array.ranging().reach() + mounts.map(forward).fold(f64::INFINITY, f64::min)
    }
}

impl RobotSensor for Ultrasonic {
    fn at_work(&self, scenario: &Scenario, index: u64) -> Result<Box<dyn Sensor>> {
        Ok(Box::new(Echoes::new(scenario, self, index)?))
    }

    fn sight(&self, scenario: &Scenario) -> Result<Option<(Regions, f64)>> {
        Ok(Some((self.regions(scenario)?, self.reach())))
    }
}

/// An array at work.
struct Echoes {
    assumed_speed: f64,
    obstacles: Vec<PlacedObstacle>,
    sonar: Sonar,
    /// Last points of the sensors in the world, in m.
    points: Vec<Option<Vector2<f64>>>,
    samples: usize,
}

impl Echoes {
    /// The array of a robot in a scenario, the one with an index among several.
    pub fn new(scenario: &Scenario, options: &Ultrasonic, index: u64) -> Result<Self> {
        let count = options.array.mounts().len();
        let placed = PlacedObstacle {
            obstacle: Obstacle::point(options.max_speed),
            regions: options.regions(scenario)?,
            contact_distance: scenario.limits().radius,
            stationary: false,
            speed_bound: Some(options.max_speed),
        };
        Ok(Self {
            obstacles: vec![placed; count],
            sonar: Sonar::new(
                &options.array,
                Stream::new(scenario.seed, ECHO_STREAM + index),
                f64::INFINITY,
            ),
            points: vec![None; count],
            samples: 0,
            assumed_speed: options.assumed_speed,
        })
    }
}

impl Sensor for Echoes {
    fn obstacles(&self) -> Option<&[PlacedObstacle]> {
        Some(&self.obstacles)
    }

    fn observe(&mut self, truth: &Truth<'_>, known: &Frame, bodies: &mut [Body]) {
        self.sonar.observe(truth, known, &mut []);
        let array = self.sonar.array();
        for sensor in array.firing().fired(self.points.len(), self.samples) {
            let beam = known.carrying(&array.mounts()[sensor]);
            let reading = self.sonar.readings()[sensor];
            let point = beam.position + beam.direction * reading;
            self.points[sensor] = reading.is_finite().then_some(point);
        }
        self.samples += 1;
        for (body, point) in bodies.iter_mut().zip(&self.points) {
            body.state = state_of(*point, known.position, self.assumed_speed);
        }
    }
}

/// State of a point that moves toward a robot at a speed in m/s.
fn state_of(point: Option<Vector2<f64>>, robot: Vector2<f64>, speed: f64) -> BodyState {
    let toward = point.map_or(Vector2::zeros(), |point| robot - point);
    let distance = toward.norm();
    let velocity = if distance > 0.0 {
        toward * (speed / distance)
    } else {
        Vector2::zeros()
    };
    BodyState {
        position: point.unwrap_or(robot).into(),
        velocity: velocity.into(),
        acceleration: [0.0; 2],
        present: point.is_some(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::HolonomicRobot;
    use crate::world::geometry::RobotState;
    use crate::world::obstacle::Shape;
    use crate::world::scenario::Rules;

    fn echoes(firing: Firing, assumed_speed: f64) -> Echoes {
        let mounts = vec![Frame::at([0.2, 0.0], 0.0), Frame::at([0.0, 0.2], 1.57)];
        let ranging = Ranging {
            noise: 0.0,
            ..Ranging::default()
        };
        let options = Ultrasonic {
            array: SonarArray::new(mounts, Beam::new(0.4, 9).unwrap(), ranging, firing).unwrap(),
            max_speed: 1.0,
            assumed_speed,
        };
        let (robot, rules) = (HolonomicRobot::default(), Rules::default());
        let scenario = Scenario::new(robot, [0.0; 2], [9.0, 0.0], Vec::new(), rules).unwrap();
        Echoes::new(&scenario, &options, 0).unwrap()
    }

    fn disc(position: [f64; 2]) -> Body {
        Body {
            shape: Shape::Disc { radius: 0.3 },
            regions: Regions {
                critical_radius: 0.5,
                active_radius: 1.0,
            },
            state: BodyState {
                position,
                velocity: [0.0; 2],
                acceleration: [0.0; 2],
                present: true,
            },
        }
    }

    /// Sees discs from a place of the robot, which looks along x.
    fn seen(echoes: &mut Echoes, place: [f64; 2], discs: &[Body]) -> Vec<BodyState> {
        let mut bodies = [disc([0.0; 2]), disc([0.0; 2])];
        let robot = RobotState {
            position: place.into(),
            velocity: Vector2::zeros(),
        };
        let truth = Truth::among(0.0, robot, 0.0, discs);
        echoes.observe(&truth, &Frame::at(place, 0.0), &mut bodies);
        bodies.iter().map(|body| body.state).collect()
    }

    #[test]
    fn an_echo_is_a_point_on_the_boundary_and_no_echo_is_nothing() {
        let found = seen(
            &mut echoes(Firing::Together, 0.5),
            [1.0, 2.0],
            &[disc([3.0, 2.0])],
        );
        assert!((found[0].position[0] - 2.7).abs() < 1e-12);
        assert!((found[0].position[1] - 2.0).abs() < 1e-12);
        // It is taken to come toward the robot.
        assert!((found[0].velocity[0] + 0.5).abs() < 1e-12 && found[0].velocity[1].abs() < 1e-12);
        assert!(found[0].present && !found[1].present);
        let mut away = disc([3.0, 2.0]);
        away.state.present = false;
        let found = seen(&mut echoes(Firing::Together, 0.5), [1.0, 2.0], &[away]);
        assert!(!found[0].present);
    }

    #[test]
    fn in_turn_a_point_stays_where_it_was_while_the_robot_moves() {
        let mut echoes = echoes(Firing::InTurn, 0.0);
        let post = [disc([3.0, 0.0])];
        let first = seen(&mut echoes, [0.0, 0.0], &post)[0];
        let second = seen(&mut echoes, [0.5, 0.0], &post);
        assert!(first.present && second[0].present);
        assert_eq!(first.position, second[0].position);
        // The post is gone when the first sensor fires again.
        assert!(!seen(&mut echoes, [0.5, 0.0], &[])[0].present);
    }
}
