//! One episode: a robot under a law in a scenario, one control period after the other.
//!
//! The order is sense, decide, move. What the controller sees is measured once, at the start of a
//! control period; it then decides, or is told what to do, and the robot moves until the next one.

use std::sync::Arc;

use crate::error::{Failure, Result};
use crate::lanes::{Planar, Vector2};
use crate::laws::{Command, Situation, Stop, force_toward};
use crate::robots::drives::{Drive, Fix, Order, Reading};
use crate::run::Interrupted;
use crate::run::built::Built;
use crate::run::built::history::{BuiltTrajectory, Everything, Listener};
use crate::run::built::sight::Sight;
use crate::run::built::{clock_of, robot_of};
use crate::run::group::{AnyLaw, Steering};
use crate::run::options::Clock;
use crate::run::outcome::{Outcome, RunSummary};
use crate::run::runs::Runs;
use crate::run::scene::{Scene, bodies_at};
use crate::world::geometry::{Body, RobotState};
use crate::world::scenario::Scenario;

/// What drives the robot in a control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// The law of the episode.
    Law,
    /// A force in N.
    Force([f64; 2]),
    /// A velocity in m/s that the robot should have at the next sample.
    Velocity([f64; 2]),
}

/// State of the robot as measured at the last sample.
#[derive(Clone, Copy, Debug)]
struct Known {
    robot: RobotState<f64>,
    /// The pose, `None` where it is known exactly.
    fix: Option<Fix>,
    /// Whether the robot is outside every active region, as far as it knows.
    clear: bool,
}

/// A run that is under way, and what is kept of it.
pub struct Episode<L = Everything> {
    scenario: Arc<Scenario>,
    law: Option<Box<dyn Steering>>,
    robot: Box<dyn Drive>,
    listener: L,
    clock: Clock,
    stop_on_contact: bool,
    scene: Scene<Arc<Scenario>>,
    sight: Sight,
    known: Known,
    runs: Runs<Arc<Scenario>, f64>,
    reading: Reading,
    /// Electrical loss so far in J.
    energy: f64,
    /// Motion steps so far.
    step: usize,
}

impl Episode {
    /// A robot at the start of a scenario; everything is recorded. Without a law it is told what to
    /// do in every control period.
    ///
    /// # Errors
    /// An option is out of range, or the law cannot work in the scenario.
    pub fn new(scenario: Arc<Scenario>, law: Option<&AnyLaw>, built: &Built) -> Result<Self> {
        Self::heard(scenario, law, built, |scenario, wheels| {
            Everything::new(scenario, wheels)
        })
    }

    /// What is left of the run so far, with its present state as the last row. The outcome counts
    /// once the run is finished.
    #[must_use]
    pub fn recorded(&self) -> (RunSummary, BuiltTrajectory) {
        let mut listener = self.listener.clone();
        let (row, summary) = self.closing();
        row.tell(&mut listener);
        (summary, listener.finish())
    }
}

impl<L: Listener> Episode<L> {
    /// The same with a listener of its own, made for a scenario and a number of wheels.
    pub(crate) fn heard(
        scenario: Arc<Scenario>,
        law: Option<&AnyLaw>,
        built: &Built,
        listener: impl FnOnce(&Scenario, usize) -> L,
    ) -> Result<Self> {
        let robot = robot_of(&scenario, built)?;
        let clock = clock_of(&scenario, built)?;
        let scene = Scene::new(Arc::clone(&scenario), 1, false);
        let bodies = &scene.frames[0];
        let reading = Reading::at(&built.start_in(&scenario));
        let sight = Sight::new(&scenario, built, bodies)?;
        let steering = law.map(|law| law.driven().steering(sight.known(&scenario)));
        let mut episode = Self {
            law: steering.transpose()?,
            listener: listener(&scenario, robot.wheels()),
            clock,
            stop_on_contact: built.stop_on_contact,
            sight,
            known: Known {
                robot: reading.robot,
                fix: None,
                clear: true,
            },
            runs: Runs::new(Arc::clone(&scenario), clock, bodies),
            reading,
            energy: 0.0,
            step: 0,
            scene,
            robot,
            scenario,
        };
        episode.sense()?;
        Ok(episode)
    }

    /// The scenario.
    #[must_use]
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Whether the run has ended.
    #[must_use]
    pub fn finished(&self) -> bool {
        !self.runs.running
    }

    /// How the run ended, `None` while it is under way.
    #[must_use]
    pub fn outcome(&self) -> Option<Outcome> {
        self.finished().then(|| self.runs.totals(0, &()).outcome)
    }

    /// Present time in s, or when the run ended.
    #[must_use]
    pub fn time(&self) -> f64 {
        if self.finished() {
            self.runs.first_end()
        } else {
            self.clock.time(self.step)
        }
    }

    /// What the controller sees now; after the end of the run, at the end of its last motion step.
    #[must_use]
    pub fn situation(&self) -> Situation<'_, f64> {
        self.seen(Stop::never())
    }

    fn seen<'a>(&'a self, stop: Stop<'a>) -> Situation<'a, f64> {
        let heading = self.known.fix.and_then(|fix| fix.heading);
        Situation {
            time: self.clock.time(self.step),
            bodies: self.sight.bodies(&self.scene.frames[0]),
            robot: self.known.robot,
            heading: heading.unwrap_or_else(|| self.robot.known_heading()),
            interval: self.clock.interval,
            stop,
        }
    }

    /// Decides, moves for one control period, and senses what comes of it. Does nothing once the
    /// run has ended, or without a law where the law is to decide.
    ///
    /// # Errors
    /// The force or the state is not finite, or the caller asked to stop; the episode then stands
    /// where it was.
    pub fn period(&mut self, request: Request, interrupted: Interrupted<'_>) -> Result<()> {
        if self.finished() {
            return Ok(());
        }
        let time = self.clock.time(self.step);
        self.runs.check_finite(time)?;
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        let Some(command) = self.decide(request, interrupted) else {
            return Ok(());
        };
        self.runs.check_force(command.force, time)?;
        self.runs.count_sample();
        self.robot.hold(&Order {
            force: command.force,
            fix: self.known.fix,
            clear: self.known.clear,
        });
        self.listener
            .sample(&command, self.known.robot.position.lane(0));
        self.travel();
        self.sense()
    }

    /// What is asked for until the next sample.
    fn decide(&mut self, request: Request, interrupted: Interrupted<'_>) -> Option<Command<f64>> {
        let mut law = self.law.take();
        let situation = self.seen(Stop(interrupted));
        let command = match request {
            Request::Law => law.as_mut().map(|law| law.command(&situation)),
            Request::Force(force) => Some(Command::plain(Vector2::splat(force))),
            Request::Velocity(desired) => {
                let mass = self.scenario.robot.mass;
                let force = force_toward(Vector2::splat(desired), &situation, mass);
                Some(Command::plain(force))
            }
        };
        self.law = law;
        command
    }

    /// Motion steps up to the next sample, or to the end of the run.
    fn travel(&mut self) {
        loop {
            let time = self.clock.time(self.step);
            let bodies = &self.scene.frames[0];
            self.listener.row(time, &self.reading, self.energy, bodies);
            self.reading = self.robot.step();
            let later = self.clock.time(self.step + 1);
            self.energy += self.reading.loss * self.account(later);
            if self.stop_on_contact {
                self.runs.stop_at_contact(later);
            }
            self.step += 1;
            let whole = self.step.is_multiple_of(self.clock.steps_per_sample);
            if whole || self.step == self.clock.steps || self.finished() {
                return;
            }
            self.look_around();
        }
    }

    /// Accounts for a motion step; returns the share of it that belongs to the run.
    fn account(&mut self, later: f64) -> f64 {
        let (runs, reading) = (&mut self.runs, &self.reading);
        let before = runs.position;
        runs.position = reading.robot.position;
        runs.velocity = reading.robot.velocity;
        runs.speed = reading.speed;
        runs.account(&self.scene.frames[1], before, later, true);
        if runs.running {
            return 1.0;
        }
        let step = self.clock.step;
        (runs.first_end() - (later - step)) / step
    }

    /// Brings obstacles and sensors to the present motion step.
    fn look_around(&mut self) {
        self.scene.advance(&self.clock, self.step);
        let time = self.clock.time(self.step);
        self.sight.show(time, &self.reading, &self.scene.frames[0]);
    }

    /// Measures once, unless the run ends here.
    fn sense(&mut self) -> Result<()> {
        self.look_around();
        let time = self.clock.time(self.step);
        self.runs.check_finite(time)?;
        if self.step == self.clock.steps {
            self.runs.end(self.runs.running, time);
        }
        if self.runs.running {
            self.runs.rest(time);
        }
        let heading = self.robot.known_heading();
        let bodies = &self.scene.frames[0];
        let seen = self.sight.look(time, &self.reading, heading, bodies);
        self.known = Known {
            robot: seen.robot,
            fix: seen.fix,
            clear: seen.clear(),
        };
        Ok(())
    }

    /// Runs to the end under the law.
    ///
    /// # Errors
    /// As [`Self::period`].
    pub(crate) fn run(mut self, interrupted: Interrupted<'_>) -> Result<(RunSummary, L)> {
        while !self.finished() {
            self.period(Request::Law, interrupted)?;
        }
        let (row, summary) = self.closing();
        row.tell(&mut self.listener);
        Ok((summary, self.listener))
    }

    /// The present state as the last row, and what is left of the run.
    fn closing(&self) -> (LastRow, RunSummary) {
        let mut reading = self.reading;
        reading.robot.position = self.runs.position;
        let time = self.time();
        let row = LastRow {
            time,
            reading,
            energy: self.energy,
            bodies: bodies_at(&self.scenario, time),
        };
        let mut summary = self.runs.summary(0, &());
        if !self.robot.is_ideal() {
            summary.energy = self.energy;
        }
        (row, summary)
    }
}

/// State at the end of what is recorded.
struct LastRow {
    time: f64,
    reading: Reading,
    energy: f64,
    bodies: Vec<Body>,
}

impl LastRow {
    fn tell(&self, listener: &mut impl Listener) {
        listener.end(self.time, &self.reading, self.energy, &self.bodies);
    }
}
