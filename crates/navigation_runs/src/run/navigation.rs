//! Parts of a navigation run: a robot under a law in a scenario.
//!
//! The situation is measured once, at the start of a control period; the law or a command from outside then
//! decides, and the robot moves until the next sample.

use std::sync::Arc;

use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::as_built::AsBuilt;
use crate::run::as_built::history::{AsBuiltTrajectory, Everything, Listener};
use crate::run::as_built::sight::{BuiltSensors, SensedState};
use crate::run::as_built::{clock_of, robot_under};
use crate::run::episode::{Episode, Parts};
use crate::run::options::Clock;
use crate::run::outcome::{Outcome, RunSummary};
use crate::run::runs::LaneState;
use crate::run::scene::{Scene, bodies_at};
use crate::run::walls::Maps;
use navigation_laws::trace::{Examined, Trace};
use navigation_laws::{Command, Law, Situation, Stop, force_toward, send};
use navigation_world::robots::differential::Twist;
use navigation_world::robots::drives::{MotorDrive, Order, PoseFix, Reading};
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;
use numeric::lanes::{Planar, Vector2};
use unknown_places::explore::Explorer;

/// Source of the command of a control period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Request {
    /// The law of the episode.
    #[default]
    Law,
    /// A force in N.
    Force([f64; 2]),
    /// A velocity in m/s that the robot should have at the next sample.
    Velocity([f64; 2]),
    /// A twist that a robot with two wheels without a law of its own should have then; another robot stands.
    Twist(Twist),
}

/// State of the robot as measured at the last sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeasuredState {
    pub robot: RobotState<f64>,
    /// The pose, `None` where it is known exactly.
    pub fix: Option<PoseFix>,
    /// Whether the robot is outside every active region, as far as it knows.
    pub clear: bool,
}

impl MeasuredState {
    /// A robot that stands where it is, and knows it.
    pub fn exactly(robot: RobotState<f64>) -> Self {
        Self {
            robot,
            fix: None,
            clear: true,
        }
    }

    /// State from the readings of a sample.
    pub fn of(seen: &SensedState<'_>) -> Self {
        Self {
            robot: seen.robot,
            fix: seen.fix,
            clear: seen.clear(),
        }
    }

    /// The heading in rad as measured, or as the robot itself takes it.
    pub fn heading(&self, robot: &dyn MotorDrive) -> f64 {
        let measured = self.fix.and_then(|fix| fix.heading);
        measured.unwrap_or_else(|| robot.known_heading())
    }

    /// A force or twist with what the robot knows when it is told of it.
    pub fn order(&self, force: Vector2<f64>, twist: Option<Twist>) -> Order {
        Order {
            force,
            twist,
            fix: self.fix,
            clear: self.clear,
        }
    }
}

/// A robot under a law, or told what to do, in a scenario, and what is kept of its run.
pub struct Navigation<L = Everything> {
    scenario: Arc<Scenario>,
    law: Option<Box<dyn Law<f64>>>,
    robot: Box<dyn MotorDrive>,
    listener: L,
    stop_on_contact: bool,
    /// How long a force acts, in s.
    interval: f64,
    scene: Scene<Arc<Scenario>>,
    sight: BuiltSensors,
    known: MeasuredState,
    runs: LaneState<Arc<Scenario>, f64>,
    reading: Reading,
    /// Electrical loss so far in J.
    energy: f64,
}

impl Episode<Navigation> {
    /// A robot at the start of a scenario; everything is recorded. Without a law it is told what to
    /// do in every control period.
    ///
    /// # Errors
    /// An option is out of range, or the law cannot work in the scenario.
    pub fn new(scenario: Arc<Scenario>, law: Option<&AnyLaw>, built: &AsBuilt) -> Result<Self> {
        Self::with_listener(scenario, law, built, |scenario, wheels| {
            Everything::new(scenario, wheels)
        })
    }

    /// Rows of the run so far, with its present state as the last one. The outcome counts
    /// once the run is finished.
    #[must_use]
    pub fn recorded(&self) -> (RunSummary, AsBuiltTrajectory) {
        let mut listener = self.parts.listener.clone();
        let (row, summary) = self.parts.closing(self.time());
        row.tell(&mut listener);
        (summary, listener.finish())
    }
}

impl<L: Listener> Episode<Navigation<L>> {
    /// Run with a listener of its own, made for a scenario and a number of wheels.
    pub(crate) fn with_listener(
        scenario: Arc<Scenario>,
        law: Option<&AnyLaw>,
        built: &AsBuilt,
        listener: impl FnOnce(&Scenario, usize) -> L,
    ) -> Result<Self> {
        law.map_or(Ok(()), |law| law.suits(&scenario))?;
        let robot = robot_under(&scenario, built, law)?;
        let clock = clock_of(&scenario, built)?;
        let scene = Scene::new(Arc::clone(&scenario));
        let bodies = &scene.frames[0];
        let reading = Reading::at(&built.start_in(&scenario));
        let sight = BuiltSensors::new(&scenario, built, bodies)?;
        let steering = law.map(|law| law.with_own_gains(sight.known(&scenario)));
        let parts = Navigation {
            law: steering.transpose()?,
            listener: listener(&scenario, robot.wheels()),
            stop_on_contact: built.stop_on_contact,
            interval: clock.interval,
            sight,
            known: MeasuredState::exactly(reading.robot),
            runs: LaneState::new(
                Arc::clone(&scenario),
                clock,
                bodies.iter().copied(),
                Maps::of(&scenario, law.and_then(|law| law.map()), &built.sensors),
            ),
            reading,
            energy: 0.0,
            scene,
            robot,
            scenario,
        };
        Self::starting(parts, clock)
    }

    /// The scenario.
    #[must_use]
    pub fn scenario(&self) -> &Scenario {
        &self.parts.scenario
    }

    /// How the run ended, `None` while it is under way.
    #[must_use]
    pub fn outcome(&self) -> Option<Outcome> {
        self.finished()
            .then(|| self.parts.runs.totals(0, &()).outcome)
    }

    /// Present time in s, or when the run ended.
    #[must_use]
    pub fn time(&self) -> f64 {
        if self.finished() {
            self.parts.runs.first_end()
        } else {
            self.stepped()
        }
    }

    /// Trace of the parts around the law in the last control period, if there are any.
    #[must_use]
    pub fn trace(&self) -> Option<Trace> {
        self.parts.law.as_ref()?.trace()
    }

    /// Centers in m of the cells where people can be whom nobody sees, if the law reckons with them.
    #[must_use]
    pub fn unseen_places(&self) -> Option<Vec<[f64; 2]>> {
        Some(self.parts.law.as_ref()?.unseen()?.places())
    }

    /// Explored map of the law, if it makes its own map of scans.
    #[must_use]
    pub fn explored(&self) -> Option<&Explorer> {
        self.parts.law.as_ref()?.explored()
    }

    /// Plan that was verified in the last control period, if there is a shield.
    #[must_use]
    pub fn examined(&self) -> Option<Examined> {
        self.parts.law.as_ref()?.examined()
    }

    /// Situation of the controller now; after the end of the run, at the end of its last motion step.
    #[must_use]
    pub fn situation(&self) -> Situation<'_, f64> {
        self.parts.seen(self.stepped(), Stop::never())
    }

    /// Runs to the end under the law.
    ///
    /// # Errors
    /// Runs to the end, with the errors of [`Self::period`].
    pub(crate) fn completed(self, interrupted: Interrupted<'_>) -> Result<(RunSummary, L)> {
        let mut ended = self.run(interrupted)?;
        let (row, summary) = ended.parts.closing(ended.time());
        row.tell(&mut ended.parts.listener);
        Ok((summary, ended.parts.listener))
    }
}

impl<L: Listener> Parts for Navigation<L> {
    type Request = Request;

    fn ended(&self) -> bool {
        !self.runs.running
    }

    fn decide(
        &mut self,
        time: f64,
        request: Request,
        interrupted: Interrupted<'_>,
    ) -> Result<bool> {
        self.runs.check_finite(time)?;
        if let Some((law, goal)) = self.law.as_mut().zip(self.sight.goal()) {
            send(&mut **law, goal)?;
        }
        let Some(command) = self.command(time, request, interrupted) else {
            return Ok(false);
        };
        self.runs.check_force(command.force, time)?;
        self.runs.count_sample();
        let twist = match request {
            Request::Law => self.law.as_ref().and_then(|law| law.twist()),
            Request::Twist(twist) => Some(twist),
            Request::Force(_) | Request::Velocity(_) => None,
        };
        self.robot.hold(&self.known.order(command.force, twist));
        self.listener
            .sample(&command, self.known.robot.position.lane(0));
        Ok(true)
    }

    fn travel(&mut self, clock: &Clock, step: usize) {
        let (time, later) = (clock.time(step), clock.time(step + 1));
        let bodies = &self.scene.frames[0];
        self.listener.row(time, &self.reading, self.energy, bodies);
        self.reading = self.robot.step();
        self.energy += self.reading.loss * self.account(clock.step, later);
        if self.stop_on_contact {
            self.runs.stop_at_contact(later);
        }
    }

    fn look_around(&mut self, clock: &Clock, step: usize) {
        self.scene.advance(clock, step);
        self.sight
            .show(clock.time(step), &self.reading, &self.scene.frames[0]);
    }

    fn check(&self, time: f64) -> Result<()> {
        self.runs.check_finite(time)
    }

    fn time_over(&mut self, time: f64) {
        self.runs.end(self.runs.running, time);
    }

    fn sense(&mut self, clock: &Clock, step: usize) {
        let time = clock.time(step);
        if self.runs.running {
            self.runs.rest(time);
        }
        let heading = self.robot.known_heading();
        let bodies = &self.scene.frames[0];
        let seen = self.sight.look(time, &self.reading, heading, bodies);
        self.known = MeasuredState::of(&seen);
    }
}

impl<L: Listener> Navigation<L> {
    fn seen<'a>(&'a self, time: f64, stop: Stop<'a>) -> Situation<'a, f64> {
        Situation {
            time,
            bodies: self.sight.bodies(&self.scene.frames[0]),
            ages: self.sight.ages(),
            robot: self.known.robot,
            heading: self.known.heading(&*self.robot),
            interval: self.interval,
            scan: self.sight.scan(),
            stop,
        }
    }

    /// Command until the next sample.
    fn command(
        &mut self,
        time: f64,
        request: Request,
        interrupted: Interrupted<'_>,
    ) -> Option<Command<f64>> {
        let mut law = self.law.take();
        let situation = self.seen(time, Stop(interrupted));
        let toward =
            |desired| Command::plain(force_toward(desired, &situation, self.scenario.robot.mass));
        let command = match request {
            Request::Law => law.as_mut().map(|law| law.command(&situation)),
            Request::Force(force) => Some(Command::plain(Vector2::splat(force))),
            Request::Velocity(desired) => Some(toward(Vector2::splat(desired))),
            Request::Twist(_) => Some(toward(Vector2::zeros())),
        };
        self.law = law;
        command
    }

    /// Accounts for a motion step in s; returns the share of it that belongs to the run.
    fn account(&mut self, step: f64, later: f64) -> f64 {
        let (runs, reading) = (&mut self.runs, &self.reading);
        let before = runs.position;
        runs.position = reading.robot.position;
        runs.velocity = reading.robot.velocity;
        runs.speed = reading.speed;
        runs.face(reading.heading);
        runs.account(&self.scene.frames[1], before, later, true);
        if runs.running {
            return 1.0;
        }
        (runs.first_end() - (later - step)) / step
    }

    /// The present state as the last row at a time in s, and what is left of the run.
    fn closing(&self, time: f64) -> (LastRow, RunSummary) {
        let mut reading = self.reading;
        reading.robot.position = self.runs.position;
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
