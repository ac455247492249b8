//! A law on a robot: observations come from outside, whenever they do, and commands go out.
//!
//! Told the same at the same instants, it commands the same as in a run, bit for bit. What comes late
//! counts with its age, what comes out of order does not count, and what does not come leaves the last
//! of it standing, ever older.

mod clock;
mod told;

pub use told::{HeldOrder, Observation, Sighting, Timing};

use crate::run::any_law::AnyLaw;
use crate::run::as_built::sight::hidden;
use clock::{ANY, Held, LATE, Last, Reckoned, STANDS};
use navigation_laws::shield::{Course, ShieldLimits, Status};
use navigation_laws::{Law, Scan, Shown, Situation, Stop};
use navigation_world::robots::differential::Twist;
use navigation_world::sensing::lidar::{Lidar, Scans};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::motion::BodyState;
use navigation_world::world::scenario::Scenario;
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result, finite, finite_pair, not_negative};
use numeric::lanes::Vector2;

/// Whoever was not seen for so long is forgotten once his place is seen to be empty, in s.
const FORGOTTEN: f64 = 2.0;

/// A law on a robot, with what it remembers.
pub struct Controller {
    scenario: Scenario,
    law: Box<dyn Law<f64>>,
    scans: Option<Scans>,
    /// Obstacles as last known, then points of the lidar.
    bodies: Vec<Body>,
    /// When each obstacle was measured, in s.
    measured: Vec<f64>,
    /// Whether the instant of that was told.
    dated: Vec<bool>,
    /// How much longer ago than the clock tells each of them may have been measured, in s, then each point scanned.
    hidden: Vec<f64>,
    hidden_points: f64,
    /// Age in s, at most, of what is told without its instant.
    latency: f64,
    /// How old what is known of each body can be, in s.
    ages: Vec<f64>,
    /// How much longer than the clock tells it may be since the law was asked last, in s.
    more: f64,
    /// Ends of the beams of the scan that is told, in m.
    ends: Vec<[f64; 2]>,
    /// Time that a clock lacks that was set back for good, in s.
    lacking: f64,
    last: Option<Last>,
}

impl Controller {
    /// Of a law in a scenario, whose obstacles that can move are places for those who will be seen; a
    /// lidar adds its points. `latency`: age in s, at most, of what is told without its instant.
    ///
    /// # Errors
    /// The law cannot work in the scenario, or does not steer a robot with two wheels, or the latency is
    /// negative.
    pub fn new(
        scenario: Scenario,
        law: &AnyLaw,
        lidar: Option<&Lidar>,
        latency: f64,
    ) -> Result<Self> {
        not_negative("latency", latency)?;
        if scenario.differential.is_some() && !law.steers_by_velocity() {
            let rule = "have a shield, which steers a robot with two wheels by velocities";
            let given = Given::Found("a law without".into());
            return Err(Failure::invalid("law", rule, given));
        }
        law.suits(&scenario)?;
        let scans = lidar.map(|lidar| Scans::new(&scenario, lidar, 0));
        let scans = scans.transpose()?;
        let mut known = scenario.clone();
        let points = scans.iter().flat_map(Scans::points);
        known.obstacles.extend(points.cloned());
        let bodies = known.obstacles.iter().map(|placed| {
            let mut body = hidden(placed);
            body.state.present = placed.stationary;
            body
        });
        Ok(Self {
            law: law.with_own_gains(&known)?,
            measured: vec![f64::NEG_INFINITY; scenario.obstacles.len()],
            dated: vec![true; scenario.obstacles.len()],
            hidden: vec![0.0; scenario.obstacles.len()],
            hidden_points: 0.0,
            latency,
            ages: vec![0.0; known.obstacles.len()],
            bodies: bodies.collect(),
            scans,
            scenario,
            more: 0.0,
            ends: Vec::new(),
            lacking: 0.0,
            last: None,
        })
    }

    /// Order to the robot, from the measurements so far.
    ///
    /// # Errors
    /// A value is not finite, an obstacle does not exist or stands, a measurement is of a time to come, a
    /// scan does not suit the lidar, or the law answers no finite force.
    pub fn update(&mut self, told: &Observation<'_>, stop: Stop<'_>) -> Result<HeldOrder> {
        self.check(told)?;
        let mut now = told.time + self.lacking;
        let (more, reading) = match self.reckon(now, told.robot) {
            Reckoned::Counts(more, reading) => (more, reading),
            Reckoned::Held(held) => return Ok(self.run_on(held, now, told.robot)),
            Reckoned::Restarts(lacking) => {
                self.lacking += lacking;
                now += lacking;
                (ANY, None)
            }
        };
        let by_own_clock = |seen: &Sighting| Sighting {
            time: seen.time.map(|time| time + self.lacking),
            ..*seen
        };
        let seen: Vec<Sighting> = told.seen.iter().map(by_own_clock).collect();
        let told = Observation {
            time: now,
            seen: &seen,
            ..*told
        };
        self.learn(&told, more);
        let order = match told.robot {
            Some(robot) => {
                let order = self.decide(&told, robot, stop)?;
                self.run_on_if_off(order, now, reading)
            }
            None => self.brake(told.time),
        };
        let before = self.last.map(|last| last.time);
        let trace = self.law.trace();
        self.last = Some(Last {
            time: told.time,
            spacing: before.map_or(f64::INFINITY, |before| told.time - before),
            clock: told.time,
            restarted: told.time,
            set_back: false,
            order,
            shield: trace.and_then(|trace| trace.shield),
        });
        Ok(order)
    }

    fn check(&self, told: &Observation<'_>) -> Result<()> {
        finite("time", told.time)?;
        finite("heading", told.heading)?;
        if let Some(robot) = told.robot {
            finite_pair("position", robot.position.into())?;
            finite_pair("velocity", robot.velocity.into())?;
        }
        for (place, seen) in told.seen.iter().enumerate() {
            finite_pair(&format!("people[{place}].position"), seen.position)?;
            if !unknown(seen.velocity) {
                finite_pair(&format!("people[{place}].velocity"), seen.velocity)?;
            }
            let name = format!("people[{place}].time");
            let time = finite(&name, seen.time.unwrap_or(told.time))?;
            if time > told.time {
                let rule = format!("not be later than the update, {} s", told.time);
                return Err(Failure::invalid(&name, rule, Given::Number(time)));
            }
        }
        let indices = told.seen.iter().map(|seen| seen.index);
        for index in indices.chain(told.gone.iter().copied()) {
            let placed = self.scenario.obstacles.get(index);
            if placed.is_none_or(|placed| placed.stationary) {
                let rule = "be the number of an obstacle that can move";
                return Err(Failure::invalid("people", rule, Given::Count(index as u64)));
            }
        }
        Ok(())
    }

    /// Takes down what is new; so much more time than the clock tells may have gone by since the last update, in s.
    fn learn(&mut self, told: &Observation<'_>, more: f64) {
        let before = self.last.map_or(f64::NEG_INFINITY, |last| last.time);
        for hidden in &mut self.hidden {
            *hidden = hidden.max(more);
        }
        self.hidden_points = self.hidden_points.max(more);
        self.more += more;
        for seen in told.seen {
            // An older measurement of somebody who is there tells nothing.
            let there = self.bodies[seen.index].state.present;
            let time = seen.time.unwrap_or(told.time);
            if there && time < self.measured[seen.index] {
                continue;
            }
            let state = &self.bodies[seen.index].state;
            let elapsed = time - self.measured[seen.index];
            let velocity = match seen.velocity {
                known if !unknown(known) => known,
                // By the way since the last measurement.
                _ if there && elapsed > 0.0 => {
                    let way = Vector2::from(seen.position) - Vector2::from(state.position);
                    (way / elapsed).into()
                }
                _ if there => state.velocity,
                _ => [0.0; 2],
            };
            self.measured[seen.index] = time;
            self.dated[seen.index] = seen.time.is_some();
            self.hidden[seen.index] = if time < before { more } else { 0.0 };
            self.bodies[seen.index].state = BodyState {
                position: seen.position,
                velocity,
                acceleration: [0.0; 2],
                present: true,
            };
        }
        for index in told.gone {
            self.bodies[*index].state.present = false;
        }
    }

    /// How old each of what is known can be at a time in s: since it was measured, or was told if only
    /// that is known, and then it was measured some time before.
    fn date(&mut self, now: f64) {
        let (people, points) = self.ages.split_at_mut(self.measured.len());
        let told = self.measured.iter().zip(&self.dated).zip(&self.hidden);
        for ((age, ((measured, dated), hidden)), placed) in
            people.iter_mut().zip(told).zip(&self.scenario.obstacles)
        {
            *age = if placed.stationary {
                0.0
            } else {
                (now - measured).max(0.0) + if *dated { 0.0 } else { self.latency } + hidden
            };
        }
        let instants = self.scans.iter().flat_map(Scans::instants);
        for (age, scanned) in points.iter_mut().zip(instants) {
            *age = (now - scanned).max(0.0) + self.latency + self.hidden_points;
        }
    }

    /// How long ago each obstacle was measured, in s.
    fn since(&self, now: f64) -> impl Iterator<Item = f64> + '_ {
        let told = self.measured.iter().zip(&self.scenario.obstacles);
        told.map(move |(measured, placed)| {
            if placed.stationary {
                0.0
            } else {
                (now - measured).max(0.0)
            }
        })
    }

    /// Who is there, as far as is known, in the order of the obstacles of the scenario.
    pub fn present(&self) -> impl Iterator<Item = bool> + '_ {
        let people = self.bodies.iter().take(self.measured.len());
        people.map(|body| body.state.present)
    }

    /// Who of them was seen in the last update where the law reckoned with nobody.
    #[must_use]
    pub fn unexpected(&self) -> Vec<usize> {
        let unseen = self.law.unseen();
        unseen.map_or_else(Vec::new, |unseen| unseen.unexpected.to_vec())
    }

    /// Forgets who was lost where a scan sees nobody.
    fn scan(&mut self, now: f64, frame: &Frame, ranges: &[f64]) -> Result<()> {
        let people = self.measured.len();
        let since: Vec<f64> = self.since(now).collect();
        let Some(scans) = &mut self.scans else {
            let rule = "be None for a controller without a lidar";
            let given = Given::Found("ranges".into());
            return Err(Failure::invalid("scan", rule, given));
        };
        scans.read(ranges, now, frame, &mut self.bodies[people..])?;
        if scans.instants().iter().all(|scanned| *scanned == now) {
            self.hidden_points = 0.0;
        }
        let bodies = self.bodies[..people].iter_mut();
        for (body, since) in bodies.zip(since) {
            let placed = PlacedShape {
                center: body.state.position.into(),
                shape: body.shape,
            };
            let lost = body.state.present && since > FORGOTTEN;
            if lost && scans.saw_empty(frame, &placed) {
                body.state.present = false;
            }
        }
        Ok(())
    }

    fn decide(
        &mut self,
        told: &Observation<'_>,
        robot: RobotState<f64>,
        stop: Stop<'_>,
    ) -> Result<HeldOrder> {
        let frame = Frame::at(robot.position.into(), told.heading);
        if let Some(ranges) = told.scan {
            self.scan(told.time, &frame, ranges)?;
        }
        self.show(&frame, told.scan);
        self.date(told.time);
        let period = self.scenario.rules.control_period;
        let late = self
            .last
            .is_some_and(|last| told.time - last.time > LATE * period);
        let command = self.law.command(&Situation {
            time: told.time,
            bodies: &self.bodies,
            ages: &self.ages,
            robot,
            heading: told.heading,
            interval: period,
            scan: Scan {
                shown: if self.ends.is_empty() {
                    Shown::Nothing
                } else {
                    Shown::Beams {
                        from: robot.position.into(),
                        ends: &self.ends,
                    }
                },
                more: self.more,
                ..Scan::default()
            },
            stop,
        });
        self.more = 0.0;
        if !command.force.norm().is_finite() {
            let time = told.time;
            return Err(Failure::non_finite(0, time));
        }
        let trace = self.law.trace();
        let planned = trace.and_then(|trace| trace.course);
        let course = planned.unwrap_or_else(|| self.unverified(told.time, &robot, command.force));
        let to_goal = Vector2::from(self.scenario.goal) - robot.position;
        let since = course.since(told.time);
        let next = since + course.period();
        Ok(HeldOrder {
            force: command.force,
            velocity: course.velocity(next),
            twist: course.twist(next),
            course: Some((course, since)),
            off_plan: trace.and_then(|trace| trace.off_plan),
            status: trace.map(|trace| trace.status),
            taken_over: trace.is_some_and(|trace| trace.taken_over),
            timing: if late { Timing::Late } else { Timing::Regular },
            arrived: to_goal.norm() <= self.scenario.rules.arrival_tolerance,
            clock_set_back: None,
            oldest: self.oldest(told.time),
            unknown_beams: self.unknown_beams(),
        })
    }

    /// Computes the ends of the beams of a scan.
    fn show(&mut self, frame: &Frame, ranges: Option<&[f64]>) {
        self.ends.clear();
        if let Some((scans, ranges)) = self.scans.as_ref().zip(ranges) {
            scans.ends(frame, ranges, &mut self.ends);
        }
    }

    /// Motion of a robot without a shield: it takes up the command of the law, and brakes if nothing follows.
    fn unverified(&self, time: f64, robot: &RobotState<f64>, force: Vector2<f64>) -> Course {
        let (point, period) = (&self.scenario.robot, self.scenario.rules.control_period);
        let asked = point.acceleration(force) * period;
        let reached = robot.velocity + point.change(robot.velocity, asked, period);
        let (velocity, _) = point.limited_velocity::<f64>(reached);
        let limits = ShieldLimits {
            radius: point.radius,
            max_speed: point.max_speed,
            max_acceleration: point.guaranteed_acceleration(),
            period,
        };
        Course::of_velocity(time, robot, velocity, &limits)
    }

    /// The rest of the last plan, for a robot that does not know where it is.
    fn brake(&self, now: f64) -> HeldOrder {
        let course = self.last.and_then(|last| last.order.course);
        let course = course.map(|(course, _)| (course, course.since(now).max(0.0)));
        HeldOrder {
            timing: Timing::Lost,
            oldest: self.oldest(now),
            ..self.rest(course)
        }
    }

    /// The rest of the last plan after an update that counts for nothing. Nobody knows how much time went by: as much as
    /// the clock came on since the update before, a control period where it went back or stands, and at least as much
    /// as the robot can be farther on in its plan.
    fn run_on(&mut self, held: Held, now: f64, robot: Option<RobotState<f64>>) -> HeldOrder {
        let Some(last) = self.last else {
            return self.rest(None);
        };
        let period = self.scenario.rules.control_period;
        let gone = now - last.clock;
        let gone = if gone < STANDS * period { period } else { gone };
        let course = last.order.course;
        let by_clock = course.map(|(course, _)| (course, course.since(now)));
        let off = by_clock
            .zip(robot)
            .zip(last.shield)
            .filter(|_| now > last.time);
        let run_on = |(course, since): (Course, f64)| {
            let latest = held.latest.unwrap_or(since).min(course.end());
            (course, latest.max(since + gone))
        };
        let order = HeldOrder {
            timing: Timing::OutOfOrder,
            off_plan: off.and_then(|(((course, since), robot), shield)| {
                shield.refuted(&course, since, &robot)
            }),
            clock_set_back: held.set_back,
            oldest: last.order.oldest + gone,
            ..self.rest(course.map(run_on))
        };
        self.last = Some(Last {
            clock: now,
            restarted: if now < last.clock {
                now
            } else {
                last.restarted.min(now)
            },
            set_back: last.set_back || held.set_back.is_some(),
            order,
            ..last
        });
        order
    }

    /// Rest of a plan, from a time of it in s on; the robot rests where there is none.
    fn rest(&self, course: Option<(Course, f64)>) -> HeldOrder {
        let zero = Vector2::zeros();
        let velocities = course.map_or([zero; 2], |(course, since)| {
            [since, since + course.period()].map(|time| course.velocity(time))
        });
        let (robot, period) = (&self.scenario.robot, self.scenario.rules.control_period);
        let wheels = self.scenario.differential.is_some();
        let twist = course.and_then(|(course, since)| course.twist(since + course.period()));
        HeldOrder {
            force: (velocities[1] - velocities[0]) * (robot.mass / period),
            velocity: velocities[1],
            // A robot with two wheels that knows of no plan stands.
            twist: twist.or(wheels.then(Twist::default)),
            course,
            off_plan: None,
            status: Some(Status::Braking),
            taken_over: false,
            timing: Timing::Lost,
            arrived: self.last.is_some_and(|last| last.order.arrived),
            clock_set_back: None,
            oldest: 0.0,
            unknown_beams: self.unknown_beams(),
        }
    }

    fn oldest(&self, now: f64) -> f64 {
        let known = self.since(now).zip(&self.hidden);
        let ages = known.map(|(since, hidden)| if *hidden < ANY { since } else { f64::INFINITY });
        let people = self.bodies.iter().zip(ages);
        let present = people.filter(|(body, _)| body.state.present);
        present.map(|(_, age)| age).fold(0.0, f64::max)
    }

    fn unknown_beams(&self) -> usize {
        self.scans.as_ref().map_or(0, Scans::unknown)
    }
}

/// Whether nobody measured a velocity.
fn unknown(velocity: [f64; 2]) -> bool {
    velocity.iter().all(|part| part.is_nan())
}
