//! A robot and somebody who sees it: an episode in which one obstacle answers to the robot.
//!
//! The obstacles of an episode walk ways that are known before; here the last one of the scenario
//! decides at every motion step. The robot senses, decides and moves as it does there, with the same
//! sensors; only what the measurement of the scenario tells of the last obstacle is computed here,
//! from the way that it took.

mod hidden;
mod lurker;
mod outline;
mod pursuer;

pub use hidden::{HiddenEncounter, HiddenHunt};
pub use lurker::Lurker;
pub use pursuer::{NUMBERS, Pursuer};

use nalgebra::Vector2;

use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::as_built::sight::{BuiltSensors, SensedState};
use crate::run::as_built::{AsBuilt, clock_of, robot_under};
use crate::run::episode::{Episode, Parts};
use crate::run::navigation::MeasuredState;
use crate::run::options::Clock;
use crate::run::outcome::{CONTACT_SPEED, ContactCounts, DECIDED_OVERLAP};
use crate::run::scene::bodies_at;
use crate::run::walls::Maps;
use crate::run::way::Way;
use navigation_laws::Law;
use navigation_laws::{Situation, Stop, send};
use navigation_world::robots::drives::{MotorDrive, Reading};
use navigation_world::sensing::measurement::Noise;
use navigation_world::world::geometry::Body;
use navigation_world::world::motion::BodyState;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Planar;

/// Result of an episode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter {
    /// Least distance of the surfaces in m while the robot moved toward somebody, up to the first overlap with them
    /// by [`DECIDED_OVERLAP`], or touched a map; infinite if it never did.
    pub least_toward: f64,
    /// Least distance of `least_toward` at any speed, however slow: the theorem of the shield holds there, too.
    pub least_ahead: f64,
    /// Least distance of the surfaces in m, from maps too.
    pub least: f64,
    /// Numbers of first contacts: those at fault are told by [`Self::least_toward`].
    pub contacts: ContactCounts,
    /// When the robot arrived, in s; NaN if it did not.
    pub arrival_time: f64,
    /// Least distance from the goal in m.
    pub to_go: f64,
    /// Largest speed in m/s.
    pub top_speed: f64,
    /// When the episode ended, in s.
    pub end_time: f64,
    /// Largest speed of the robot in m/s while it touched somebody toward whom it moved; 0 if it did not.
    pub fault_speed: f64,
    /// In how many control periods the last obstacle was neither seen nor where the law reckoned with somebody whom it
    /// does not see.
    pub overlooked: u32,
}

impl Encounter {
    /// Whether the robot moved toward somebody whom it touched, before they overlapped by [`DECIDED_OVERLAP`].
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
    /// Time in s between two instants at which it is kept where people can be who are not seen.
    pub every: Option<f64>,
    /// These instants in s, and the centers of the cells in m.
    pub hidden: Vec<(f64, Vec<[f64; 2]>)>,
}

/// The way that he took, and what a measurement tells of it: late and noisy positions, velocities
/// from their differences.
struct Tracked {
    /// `None` where the scenario measures no obstacles: sensors, if any, tell of him.
    noise: Option<(Noise, f64)>,
    /// Motion step in s.
    step: f64,
    /// Positions at the motion steps so far, in m.
    places: Vec<Vector2<f64>>,
    last: Option<Vector2<f64>>,
}

impl Tracked {
    fn new(scenario: &Scenario, start: [f64; 2], step: f64) -> Self {
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
            step,
            places: vec![start.into()],
            last: None,
        }
    }

    /// Present position in m.
    fn here(&self) -> Vector2<f64> {
        self.places[self.places.len() - 1]
    }

    /// State as measured once a control period, with his velocity now in m/s; `None` where the
    /// scenario does not measure it.
    fn measure(&mut self, interval: f64, velocity: Vector2<f64>) -> Option<BodyState> {
        let now = self.places.len() - 1;
        let (noise, latency) = self.noise.as_mut()?;
        let back = *latency / self.step;
        let whole = (now as f64 - back).max(0.0);
        let first = whole_of(whole).min(now);
        let share = whole - first as f64;
        let next = self.places[(first + 1).min(now)];
        let place = self.places[first] * (1.0 - share) + next * share;
        let place = place + Vector2::from(noise.draw());
        let speed = self.last.map_or(velocity, |last| (place - last) / interval);
        self.last = Some(place);
        Some(state_at(place, speed))
    }
}

/// Somebody who is there.
fn state_at(place: Vector2<f64>, velocity: Vector2<f64>) -> BodyState {
    BodyState {
        position: place.into(),
        velocity: velocity.into(),
        acceleration: [0.0; 2],
        present: true,
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of motion steps
fn whole_of(steps: f64) -> usize {
    (steps + 1e-9).floor() as usize
}

/// Contacts with an obstacle.
#[derive(Clone, Copy, Default)]
struct Followed {
    /// From its center to the robot at the last motion step, in m, if it was there.
    before: Option<Vector2<f64>>,
    touched: bool,
    /// Whether they have overlapped by [`DECIDED_OVERLAP`].
    decided: bool,
}

/// Parts of an encounter: a robot under a law, and a person who answers to it.
struct PursuitParts<'a> {
    scenario: &'a Scenario,
    pursuer: &'a Pursuer,
    /// The pursuer, if he comes out of hiding.
    lurker: Option<Lurker>,
    /// How long a force acts, in s.
    interval: f64,
    robot: Box<dyn MotorDrive>,
    law: Box<dyn Law<f64>>,
    tracked: Tracked,
    maps: Maps,
    sight: BuiltSensors,
    known: MeasuredState,
    /// Obstacles as the law knows them.
    seen: Vec<Body>,
    reading: Reading,
    /// Of the robot at the last two motion steps, in rad, and the time between them in s.
    headings: [f64; 2],
    step: f64,
    followed: Vec<Followed>,
    found: Encounter,
    rows: Option<&'a mut Pursued>,
    /// Present instant in s.
    time: f64,
    /// Whether the time is over.
    over: bool,
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
    built: &AsBuilt,
    pursuer: &Pursuer,
    rows: Option<&mut Pursued>,
    interrupted: Interrupted<'_>,
) -> Result<Encounter> {
    encounter(scenario, law, built, (pursuer, None), rows, interrupted)
}

/// An episode with a pursuer, who may come out of hiding.
fn encounter(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &AsBuilt,
    (pursuer, lurker): (&Pursuer, Option<Lurker>),
    rows: Option<&mut Pursued>,
    interrupted: Interrupted<'_>,
) -> Result<Encounter> {
    if scenario.obstacles.is_empty() {
        let rule = "hold an obstacle whose place the pursuer takes";
        let given = Given::Found("none".into());
        return Err(Failure::invalid("obstacles", rule, given));
    }
    law.suits(scenario)?;
    let robot = robot_under(scenario, built, Some(law))?;
    let clock = clock_of(scenario, built)?;
    let reading = Reading::at(&built.start_in(scenario));
    let sight = BuiltSensors::new(scenario, built, &bodies_at(scenario, 0.0))?;
    let parts = PursuitParts {
        scenario,
        pursuer,
        lurker,
        interval: clock.interval,
        robot,
        law: law.with_own_gains(sight.known(scenario))?,
        tracked: Tracked::new(scenario, pursuer.start, clock.step),
        maps: Maps::of(scenario, law.map(), &built.sensors),
        sight,
        known: MeasuredState::exactly(reading.robot),
        seen: Vec::new(),
        headings: [reading.heading; 2],
        step: clock.step,
        reading,
        followed: vec![Followed::default(); scenario.obstacles.len()],
        found: Encounter {
            least_toward: f64::INFINITY,
            least_ahead: f64::INFINITY,
            least: f64::INFINITY,
            contacts: ContactCounts::default(),
            arrival_time: f64::NAN,
            to_go: f64::INFINITY,
            top_speed: 0.0,
            end_time: 0.0,
            fault_speed: 0.0,
            overlooked: 0,
        },
        rows,
        time: 0.0,
        over: false,
    };
    let mut ended = Episode::starting(parts, clock)?.run(interrupted)?.parts;
    ended.keep();
    ended.found.end_time = ended.time;
    Ok(ended.found)
}

impl PursuitParts<'_> {
    fn place(&self) -> Vector2<f64> {
        self.tracked.here()
    }

    /// Obstacles as they are at the present motion step, the pursuer last.
    fn bodies(&self) -> Vec<Body> {
        let mut bodies = bodies_at(self.scenario, self.time);
        if let Some(last) = bodies.last_mut() {
            last.state = state_at(self.place(), self.chased());
            last.state.present = self.is_there();
        }
        bodies
    }

    /// Whether the pursuer is there.
    fn is_there(&self) -> bool {
        let lurker = self.lurker.as_ref();
        lurker.is_none_or(|lurker| lurker.is_there(self.time))
    }

    /// Takes down whether the law knows of the pursuer, or reckons with somebody there whom it does not see.
    fn check_belief(&mut self) {
        let last = self.scenario.obstacles.len() - 1;
        if let Some(unseen) = self.law.unseen().filter(|_| self.is_there()) {
            let known = unseen.tracked.get(last).is_some_and(|tracked| *tracked);
            if !known && !unseen.belief.covers(self.place()) {
                self.found.overlooked += 1;
            }
        }
    }

    /// Velocity of the pursuer now, in m/s.
    fn chased(&self) -> Vector2<f64> {
        if let Some(lurker) = &self.lurker {
            return lurker.velocity(self.time, self.place(), self.reading.robot.position);
        }
        self.pursuer
            .velocity(self.time, self.place(), &self.reading.robot)
    }

    /// Takes down the distance from the maps on the straight way from a place, each contact with which is the
    /// robot's own fault.
    fn look_at_walls(&mut self, from: Vector2<f64>) {
        if self.maps.is_empty() {
            return;
        }
        let (place, radius) = (self.reading.robot.position, self.scenario.robot.radius);
        let outlined = self.scenario.footprint.as_deref();
        let off_outline = outlined.map(|outline| self.outline_off_walls(outline, from));
        let found = &mut self.found;
        let most = found.least.max(0.0) + radius + 1.0;
        let off = off_outline.unwrap_or_else(|| {
            let off = self.maps.clearance_up_to(place, most) - radius;
            let near = off > 0.0 && off <= (place - from).norm();
            let passed = near.then(|| self.maps.segment_clearance(from, place) - radius);
            passed.filter(|passed| *passed < 0.0).unwrap_or(off)
        });
        found.least = found.least.min(off);
        if off <= 0.0 {
            found.least_toward = found.least_toward.min(off);
            if found.contacts.walls == 0 {
                found.contacts.walls = 1;
                // A wall stands: a robot that moves comes toward it.
                let moves = self.reading.robot.velocity.norm() > CONTACT_SPEED;
                found.contacts.toward += u32::from(moves);
                found.contacts.standing += u32::from(!moves);
            }
        }
    }

    /// Takes down distances and speeds of the motion step from a place to the present one.
    fn look(&mut self, from: Vector2<f64>) {
        let robot = self.reading.robot;
        let bodies = self.bodies();
        self.headings = [self.headings[1], self.reading.heading];
        self.look_at_walls(from);
        for (index, body) in bodies.iter().enumerate() {
            let seen = robot.position - Vector2::from(body.state.position);
            let before = self.followed[index].before.replace(seen);
            let apart = index + 1 == bodies.len()
                && self.lurker.as_ref().is_some_and(|lurker| {
                    lurker.is_behind_wall(robot.position, body.state.position.into())
                });
            if body.state.present && !apart && self.scenario.footprint.is_some() {
                self.look_at_outline(index, body, before.unwrap_or(seen), from);
            } else if body.state.present && !apart {
                self.look_at(index, body, before.unwrap_or(seen));
            } else {
                self.followed[index].before = None;
            }
        }
        self.found.top_speed = self.found.top_speed.max(robot.velocity.norm());
        let to_go = (Vector2::from(self.scenario.goal) - robot.position).norm();
        self.found.to_go = self.found.to_go.min(to_go);
        if to_go <= self.scenario.rules.arrival_tolerance && self.found.arrival_time.is_nan() {
            self.found.arrival_time = self.time;
        }
    }

    /// Takes down what comes of an obstacle, from whose center the robot was seen as given before.
    fn look_at(&mut self, index: usize, body: &Body, before: Vector2<f64>) {
        let robot = self.reading.robot;
        let reach = self.scenario.obstacles[index].contact_distance;
        let offset = body.offset(robot.position);
        let clearance = offset.distance_squared.sqrt() - reach;
        self.found.least = self.found.least.min(clearance);
        // Rounding of a robot that rests moves it nowhere.
        let toward = |offset: Vector2<f64>| robot.velocity.dot(&offset) < -1e-9;
        let moves = robot.velocity.norm() > CONTACT_SPEED;
        let way = Way {
            shape: body.shape,
            from: before,
            to: robot.position - Vector2::from(body.state.position),
        };
        let met = way.contact(reach, clearance <= 0.0);
        if let Some(met) = met.as_ref().filter(|_| clearance > 0.0) {
            self.found.least = self.found.least.min(met.least - reach);
        }
        let followed = &mut self.followed[index];
        if followed.decided {
            return;
        }
        let (mut gap, mut ahead) = (clearance, toward(offset.vector));
        let mut first = ahead;
        if let Some(met) = met.as_ref().filter(|met| clearance > 0.0 || met.decided) {
            gap = (met.least - reach).max(-DECIDED_OVERLAP);
            let ends = met.shares.map(|share| toward(way.offset(share)));
            (first, ahead) = (ends[0], ends[0] || ends[1]);
            followed.decided = met.decided;
        }
        if met.is_some() && !followed.touched {
            followed.touched = true;
            let counts = &mut self.found.contacts;
            *match (moves, first) {
                (true, true) => &mut counts.toward,
                (true, false) => &mut counts.away,
                (false, _) => &mut counts.standing,
            } += 1;
        }
        if ahead {
            self.found.least_ahead = self.found.least_ahead.min(gap);
            if moves {
                self.found.least_toward = self.found.least_toward.min(gap);
                if gap <= 0.0 {
                    let speed = robot.velocity.norm();
                    self.found.fault_speed = self.found.fault_speed.max(speed);
                }
            }
        }
    }

    fn keep(&mut self) {
        let (robot, place) = (self.reading.robot, self.place());
        let Some(rows) = self.rows.as_deref_mut() else {
            return;
        };
        rows.time.push(self.time);
        rows.position.extend(robot.position.lane(0));
        rows.velocity.extend(robot.velocity.lane(0));
        rows.pursuer.extend(place.iter());
        let due = rows.every.is_some_and(|every| {
            let last = rows.hidden.last().map_or(0.0, |(time, _)| *time);
            self.time >= last + every - 1e-9
        });
        if let Some(unseen) = self.law.unseen().filter(|_| due) {
            rows.hidden.push((self.time, unseen.places()));
        }
    }
}

impl Parts for PursuitParts<'_> {
    type Request = ();

    fn ended(&self) -> bool {
        self.over || !self.found.arrival_time.is_nan()
    }

    fn decide(&mut self, time: f64, _request: (), interrupted: Interrupted<'_>) -> Result<bool> {
        let (robot, own) = (self.reading.robot.position, self.place());
        if let Some(lurker) = self.lurker.as_mut().filter(|lurker| lurker.is_there(time)) {
            lurker.look(robot, &[own]);
        }
        if let Some(goal) = self.sight.goal() {
            send(&mut *self.law, goal)?;
        }
        let command = self.law.command(&Situation {
            time,
            bodies: &self.seen,
            ages: self.sight.ages(),
            robot: self.known.robot,
            heading: self.known.heading(&*self.robot),
            interval: self.interval,
            scan: self.sight.scan(),
            stop: Stop(interrupted),
        });
        if !command.force.norm().is_finite() {
            return Err(Failure::non_finite(0, time));
        }
        self.keep();
        self.check_belief();
        self.robot
            .hold(&self.known.order(command.force, self.law.twist()));
        Ok(true)
    }

    fn travel(&mut self, clock: &Clock, step: usize) {
        let way = self.chased() * clock.step;
        let next = match &self.lurker {
            Some(lurker) => lurker.moved(self.place(), way),
            None => self.place() + way,
        };
        let from = self.reading.robot.position;
        self.reading = self.robot.step();
        self.tracked.places.push(next);
        self.time = clock.time(step + 1);
        self.look(from);
    }

    fn look_around(&mut self, clock: &Clock, step: usize) {
        let bodies = self.bodies();
        self.sight.show(clock.time(step), &self.reading, &bodies);
    }

    fn check(&self, time: f64) -> Result<()> {
        let robot = self.reading.robot;
        if (robot.position + robot.velocity + self.place())
            .norm()
            .is_finite()
        {
            return Ok(());
        }
        Err(Failure::non_finite(0, time))
    }

    fn time_over(&mut self, _time: f64) {
        self.over = true;
    }

    fn sense(&mut self, clock: &Clock, step: usize) {
        let (time, heading) = (clock.time(step), self.robot.known_heading());
        let bodies = self.bodies();
        let measured = self.tracked.measure(self.interval, self.chased());
        let there = self.is_there();
        let seen = self.sight.look(time, &self.reading, heading, &bodies);
        self.seen.clear();
        self.seen.extend_from_slice(seen.bodies);
        // A measurement tells of the obstacles of the scenario before any sensor does.
        let last = self.scenario.obstacles.len() - 1;
        if let (Some(state), Some(body)) = (measured, self.seen.get_mut(last)) {
            body.state = state;
            body.state.present = there;
        }
        self.known = MeasuredState::of(&SensedState {
            bodies: &self.seen,
            ..seen
        });
    }
}
