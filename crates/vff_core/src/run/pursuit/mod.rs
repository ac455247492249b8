//! A robot and somebody who sees it: an episode in which one obstacle answers to the robot.
//!
//! The obstacles of an episode walk ways that are known before; here the last one of the scenario
//! decides at every motion step. The robot senses, decides and moves as it does there.

mod pursuer;

pub use pursuer::{NUMBERS, Pursuer};

use nalgebra::Vector2;

use crate::error::{Failure, Given, Result};
use crate::lanes::Planar;
use crate::laws::{Situation, Stop};
use crate::robots::drives::{MotorDrive, Order, Reading};
use crate::run::Interrupted;
use crate::run::built::{Built, clock_of, robot_under};
use crate::run::group::{AnyLaw, Steering};
use crate::run::options::Clock;
use crate::run::outcome::CONTACT_SPEED;
use crate::run::scene::bodies_at;
use crate::sensing::measurement::Noise;
use crate::world::geometry::Body;
use crate::world::motion::BodyState;
use crate::world::scenario::Scenario;

/// What came of an episode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter {
    /// Least distance of the surfaces in m while the robot moved toward somebody; infinite if it
    /// never did.
    pub least_toward: f64,
    /// The same at any speed, however slow: the theorem of the shield holds there, too.
    pub least_ahead: f64,
    /// Least distance of the surfaces in m.
    pub least: f64,
    /// When the robot arrived, in s; NaN if it did not.
    pub arrival_time: f64,
    /// Least distance from the goal in m.
    pub to_go: f64,
    /// Largest speed in m/s.
    pub top_speed: f64,
    /// When the episode ended, in s.
    pub end_time: f64,
}

impl Encounter {
    /// Whether the robot moved toward somebody whom it touched.
    #[must_use]
    pub fn at_fault(&self) -> bool {
        self.least_toward <= 0.0
    }
}

/// Rows of an episode, one a control period.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pursued {
    /// Instants in s.
    pub time: Vec<f64>,
    /// Positions of the robot in m, x and y in turn.
    pub position: Vec<f64>,
    /// Its velocities in m/s.
    pub velocity: Vec<f64>,
    /// Positions of the pursuer in m.
    pub pursuer: Vec<f64>,
}

/// What the robot knows of him: late and noisy positions, velocities from their differences.
struct Tracked {
    noise: Option<(Noise, f64)>,
    /// Positions at the motion steps so far, in m.
    places: Vec<Vector2<f64>>,
    last: Option<Vector2<f64>>,
}

impl Tracked {
    fn new(scenario: &Scenario, start: [f64; 2]) -> Self {
        let stream = scenario.obstacles.len() as u64;
        let measurement = scenario
            .measurement
            .filter(|found| found.of_obstacle(false));
        let noise = measurement.map(|found| {
            let noise = Noise::new(found, scenario.seed, stream);
            (noise, found.latency())
        });
        Self {
            noise,
            places: vec![start.into()],
            last: None,
        }
    }

    /// State as measured once a control period.
    fn measure(&mut self, clock: &Clock, velocity: Vector2<f64>) -> BodyState {
        let now = self.places.len() - 1;
        let here = self.places[now];
        let (mut place, mut speed) = (here, velocity);
        if let Some((noise, latency)) = &mut self.noise {
            let back = *latency / clock.step;
            let whole = (now as f64 - back).max(0.0);
            let first = whole_of(whole).min(now);
            let share = whole - first as f64;
            let next = self.places[(first + 1).min(now)];
            place = self.places[first] * (1.0 - share) + next * share;
            place += Vector2::from(noise.draw());
            speed = self
                .last
                .map_or(velocity, |last| (place - last) / clock.interval);
            self.last = Some(place);
        }
        BodyState {
            position: place.into(),
            velocity: speed.into(),
            acceleration: [0.0; 2],
            present: true,
        }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of motion steps
fn whole_of(steps: f64) -> usize {
    (steps + 1e-9).floor() as usize
}

/// An episode under way.
struct Pursuit<'a> {
    scenario: &'a Scenario,
    pursuer: &'a Pursuer,
    clock: Clock,
    robot: Box<dyn MotorDrive>,
    law: Box<dyn Steering>,
    tracked: Tracked,
    reading: Reading,
    found: Encounter,
    step: usize,
}

/// Runs a robot under a law against a pursuer, who takes the place of the last obstacle; the others
/// walk as the scenario says. Ends at the arrival or at the time limit; `rows`: what happened.
///
/// # Errors
/// There is no obstacle, an option is out of range, the law cannot work in the scenario, the force
/// became non-finite, or the caller asked to stop.
pub fn pursue(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &Built,
    pursuer: &Pursuer,
    rows: Option<&mut Pursued>,
    interrupted: Interrupted<'_>,
) -> Result<Encounter> {
    if scenario.obstacles.is_empty() {
        let rule = "hold an obstacle whose place the pursuer takes";
        let given = Given::Found("none".into());
        return Err(Failure::invalid("obstacles", rule, given));
    }
    let robot = robot_under(scenario, built, Some(law))?;
    let reading = Reading::at(&built.start_in(scenario));
    Pursuit {
        scenario,
        pursuer,
        clock: clock_of(scenario, built)?,
        robot,
        law: law.driven().steering(scenario)?,
        tracked: Tracked::new(scenario, pursuer.start),
        reading,
        found: Encounter {
            least_toward: f64::INFINITY,
            least_ahead: f64::INFINITY,
            least: f64::INFINITY,
            arrival_time: f64::NAN,
            to_go: f64::INFINITY,
            top_speed: 0.0,
            end_time: 0.0,
        },
        step: 0,
    }
    .run(rows, interrupted)
}

impl Pursuit<'_> {
    fn run(
        mut self,
        mut rows: Option<&mut Pursued>,
        interrupted: Interrupted<'_>,
    ) -> Result<Encounter> {
        while self.step < self.clock.steps && self.found.arrival_time.is_nan() {
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            if let Some(rows) = rows.as_deref_mut() {
                self.keep(rows);
            }
            self.decide(interrupted)?;
            for _ in 0..self.clock.steps_per_sample {
                self.travel();
            }
        }
        if let Some(rows) = rows {
            self.keep(rows);
        }
        self.found.end_time = self.clock.time(self.step);
        Ok(self.found)
    }

    fn place(&self) -> Vector2<f64> {
        self.tracked.places[self.step]
    }

    /// Obstacles at the present motion step, the pursuer last.
    fn bodies(&self, state: BodyState) -> Vec<Body> {
        let mut bodies = bodies_at(self.scenario, self.clock.time(self.step));
        if let Some(last) = bodies.last_mut() {
            last.state = state;
        }
        bodies
    }

    /// Velocity of the pursuer now, in m/s.
    fn chased(&self) -> Vector2<f64> {
        let time = self.clock.time(self.step);
        self.pursuer
            .velocity(time, self.place(), &self.reading.robot)
    }

    fn decide(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        let velocity = self.chased();
        let state = self.tracked.measure(&self.clock, velocity);
        let bodies = self.bodies(state);
        let time = self.clock.time(self.step);
        let command = self.law.command(&Situation {
            time,
            bodies: &bodies,
            robot: self.reading.robot,
            heading: self.robot.known_heading(),
            interval: self.clock.interval,
            stop: Stop(interrupted),
        });
        if !command.force.norm().is_finite() {
            return Err(Failure::NonFinite { run: 0, time });
        }
        self.robot.hold(&Order {
            force: command.force,
            fix: None,
            clear: true,
        });
        Ok(())
    }

    /// One motion step of both.
    fn travel(&mut self) {
        let next = self.place() + self.chased() * self.clock.step;
        self.reading = self.robot.step();
        self.tracked.places.push(next);
        self.step += 1;
        self.look();
    }

    /// Takes down distances and speeds of the present motion step.
    fn look(&mut self) {
        let robot = self.reading.robot;
        let state = BodyState {
            position: self.place().into(),
            velocity: [0.0; 2],
            acceleration: [0.0; 2],
            present: true,
        };
        let bodies = self.bodies(state);
        let moves = robot.velocity.norm() > CONTACT_SPEED;
        for (body, placed) in bodies.iter().zip(&self.scenario.obstacles) {
            if !body.state.present {
                continue;
            }
            let offset = body.offset(robot.position);
            let clearance = offset.distance_squared.sqrt() - placed.contact_distance;
            self.found.least = self.found.least.min(clearance);
            // Rounding of a robot that rests moves it nowhere.
            if robot.velocity.dot(&offset.vector) < -1e-9 {
                self.found.least_ahead = self.found.least_ahead.min(clearance);
                if moves {
                    self.found.least_toward = self.found.least_toward.min(clearance);
                }
            }
        }
        self.found.top_speed = self.found.top_speed.max(robot.velocity.norm());
        let to_go = (Vector2::from(self.scenario.goal) - robot.position).norm();
        self.found.to_go = self.found.to_go.min(to_go);
        if to_go <= self.scenario.rules.arrival_tolerance && self.found.arrival_time.is_nan() {
            self.found.arrival_time = self.clock.time(self.step);
        }
    }

    fn keep(&self, rows: &mut Pursued) {
        let robot = self.reading.robot;
        rows.time.push(self.clock.time(self.step));
        rows.position.extend(robot.position.lane(0));
        rows.velocity.extend(robot.velocity.lane(0));
        rows.pursuer.extend(self.place().iter());
    }
}
