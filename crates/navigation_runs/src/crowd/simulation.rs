//! A world of people and robots as an episode of the one loop.
//!
//! Everybody moves in step: at an instant people and robots decide from the same snapshot, then all move. A step
//! of the world is what a control period is elsewhere; models with a smaller largest step split it into equal
//! motion steps, in each of which people decide anew. Robots decide in the first one, if it is time to.

use std::sync::Arc;

use smallvec::SmallVec;

use crate::crowd::agent::Agent;
use crate::crowd::divergence::{Diverged, Divergence};
use crate::crowd::pedestrian::PersonDecision;
use crate::crowd::people::{Companions, Groups, OfPeople, PersonState, Presence};
use crate::crowd::record::{Trajectories, check_rows, whole_steps};
use crate::crowd::robots::CrowdRobot;
use crate::crowd::snapshot::{CrowdSetting, Models, Snapshot};
use crate::crowd::sources::Source;
use crate::crowd::world::{CrowdWorld, count_of};
use crate::run::{Clock, Episode, Interrupted, Parts, Request};
use navigation_laws::Situation;
use numeric::error::Result;

/// Room for the decisions of everybody at an instant; nothing in it outlasts the instant, so that worlds that are
/// stepped in turn can share it and find it in the cache.
#[derive(Clone, Debug, Default)]
pub struct DecisionRoom {
    decisions: Vec<PersonDecision>,
    snapshot: Snapshot,
}

/// Parts of an episode of a crowd.
struct CrowdParts {
    world: Arc<CrowdWorld>,
    people: OfPeople<PersonState>,
    robots: SmallVec<[CrowdRobot; 1]>,
    /// The robots as others see them.
    bodies: SmallVec<[Agent; 1]>,
    sources: Vec<Source>,
    groups: Groups,
    room: Box<DecisionRoom>,
    /// Whether people have made the next motion, together with those of other worlds; and whether somebody may no
    /// longer be at a finite place then.
    moved: Option<bool>,
    reach: f64,
    /// Whether somebody follows a recording.
    replays: bool,
    /// How often somebody was set back at a wall, and the largest squared speed in m^2/s^2 of those who decide.
    wall_rescues: u64,
    fastest_squared: f64,
    record: Option<Trajectories>,
    /// Whether robots without a law have eyes, too.
    observed: bool,
    /// Steps of the world so far.
    instant: usize,
    diverged: Option<Divergence>,
    over: bool,
}

fn clock_of(world: &CrowdWorld) -> Result<Clock> {
    let parts = world.parts()?;
    let steps = count_of(whole_steps(world));
    Ok(Clock {
        step: world.step / parts as f64,
        steps_per_sample: parts,
        steps: steps * parts,
        interval: world.step,
    })
}

impl CrowdParts {
    fn new(world: Arc<CrowdWorld>, record: bool) -> Self {
        Self {
            people: OfPeople::with_capacity(world.people.len()),
            robots: SmallVec::with_capacity(world.robots.len()),
            bodies: SmallVec::with_capacity(world.robots.len()),
            sources: Vec::new(),
            groups: Groups::default(),
            room: Box::default(),
            moved: None,
            reach: 0.0,
            replays: false,
            wall_rescues: 0,
            fastest_squared: 0.0,
            record: record.then(Trajectories::default),
            observed: false,
            instant: 0,
            diverged: None,
            over: false,
            world,
        }
    }

    /// Brings everything to the start of the world.
    fn open(&mut self, part: f64) -> Result<()> {
        let world = &self.world;
        let numbered = world.people.iter().enumerate();
        self.people.clear();
        self.people.extend(
            numbered.map(|(number, setup)| PersonState::at_start(setup, world.seed, number)),
        );
        self.replays = self.people.iter().any(|person| person.recorded);
        (self.wall_rescues, self.fastest_squared) = (0, 0.0);
        self.groups.fill(&self.people);
        self.robots.clear();
        for index in 0..world.robots.len() {
            let motors = self.record.is_some();
            let options = (part, motors, self.observed);
            let robot = CrowdRobot::new(world, &self.people, index, options);
            let robot = robot.map_err(|error| error.within(&format!("robots[{index}]")))?;
            self.robots.push(robot);
        }
        self.moved = None;
        self.sources.clear();
        let sources = world.sources.iter().enumerate();
        self.sources
            .extend(sources.map(|(index, setup)| Source::new(setup, world.seed, index)));
        self.reach = world.reach();
        self.instant = 0;
        self.diverged = None;
        self.over = false;
        if let Some(record) = &mut self.record {
            record.open(self.people.len(), count_of(whole_steps(world)) + 1);
        }
        self.show_robots();
        Ok(())
    }

    fn show_robots(&mut self) {
        let robots = self.robots.iter().enumerate();
        self.bodies.clear();
        self.bodies
            .extend(robots.map(|(index, robot)| robot.agent(index)));
    }

    /// Decides for all people and moves them for a time in s; whether somebody may no longer be at a finite place.
    fn move_people(&mut self, part: f64) -> bool {
        let (world, people) = (&self.world, &mut self.people);
        if people.is_empty() {
            return false;
        }
        if let Some(doubtful) = self.moved.take() {
            return doubtful;
        }
        let DecisionRoom {
            decisions,
            snapshot,
        } = &mut *self.room;
        let setting = CrowdSetting {
            walls: &world.walls,
            company: &Companions {
                groups: &self.groups,
                people,
                period: world.period,
            },
            period: world.period,
            reach: self.reach,
            step: part,
        };
        let model_of = |number: usize| &world.models[people[number].model as usize];
        let models = match &world.models[..] {
            [model] => Models::Shared(model),
            _ => Models::Of(&model_of),
        };
        let walker_of = |number: usize| people[number].walker(number);
        let everybody = (people.len(), walker_of);
        snapshot.decide(&setting, everybody, &self.bodies, models, decisions);
        let mut finite = true;
        for (number, (person, decision)) in people.iter_mut().zip(&*decisions).enumerate() {
            if person.decides() {
                person.heading = decision.heading;
                let model = &world.models[person.model as usize];
                let from = person.position;
                person.move_by(decision.order, model, part);
                self.fastest_squared = self
                    .fastest_squared
                    .max(person.velocity.dot(&person.velocity));
                if !world.walls.is_empty() {
                    self.wall_rescues += u64::from(person.keep_off(&world.walls, from));
                }
                if person.to_line {
                    person.look_at_lines(world.route(number, person.source), from);
                }
                finite &= person.is_finite();
            }
        }
        // Recordings move those who do not decide.
        self.replays || !finite
    }

    /// Moves those who follow a recording or pursue the first robot, by a motion step.
    fn replay(&mut self, clock: &Clock, step: usize) {
        if !self.replays {
            return;
        }
        for (person, setup) in self.people.iter_mut().zip(&self.world.people) {
            if let Some(motion) = &setup.recorded {
                person.replay(motion, clock.time(step + 1));
            } else if let Some((pursuer, robot)) = setup.pursuer.zip(self.robots.first()) {
                let from = person.position;
                person.velocity = pursuer.velocity(clock.time(step), from, &robot.state());
                person.position += person.velocity * clock.step;
                person.keep_off(&self.world.walls, from);
            }
        }
    }

    /// Notes who is no longer at a finite place, at a time in s; `people`: whether that may be a person.
    fn find_divergence(&mut self, time: f64, people: bool) {
        let lost = |person: &PersonState| person.is_present() && !person.is_finite();
        let person = || self.people.iter().position(lost).map(Diverged::Person);
        let person = people.then(person).flatten();
        let robot = || {
            let found = self.robots.iter().position(|robot| !robot.is_finite());
            found.map(Diverged::Robot)
        };
        let agent = person.or_else(robot);
        self.diverged = agent.map(|agent| Divergence { time, agent });
    }

    /// Whether nothing is left to happen.
    fn is_settled(&self) -> bool {
        self.sources.is_empty()
            && self.robots.iter().all(CrowdRobot::has_arrived)
            && self
                .people
                .iter()
                .all(|person| matches!(person.presence, Presence::Staying | Presence::Left))
    }
}

impl Parts for CrowdParts {
    type Request = ();

    fn ended(&self) -> bool {
        self.over || self.diverged.is_some()
    }

    fn decide(&mut self, time: f64, _request: (), interrupted: Interrupted<'_>) -> Result<bool> {
        let (world, people, bodies) = (&self.world, &self.people, &self.bodies);
        let now = (self.instant, time);
        for (index, robot) in self.robots.iter_mut().enumerate() {
            let decided = robot.decide(world, people, bodies, now, (index, interrupted));
            if !decided.map_err(|error| error.within(&format!("robots[{index}]")))? {
                let agent = Diverged::Robot(index);
                self.diverged = Some(Divergence { time, agent });
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn travel(&mut self, clock: &Clock, step: usize) {
        let doubtful = self.move_people(clock.step);
        self.replay(clock, step);
        for robot in &mut self.robots {
            robot.advance();
        }
        self.show_robots();
        self.find_divergence(clock.time(step + 1), doubtful);
    }

    fn look_around(&mut self, _clock: &Clock, _step: usize) {}

    fn check(&self, _time: f64) -> Result<()> {
        // A state that is not finite ends the world: it is an outcome, not an error.
        Ok(())
    }

    fn time_over(&mut self, _time: f64) {
        self.over = true;
    }

    /// Waypoints, arrivals and exits; then people come, so that everybody is there for the next snapshot.
    fn sense(&mut self, clock: &Clock, step: usize) {
        if self.diverged.is_some() {
            return;
        }
        let time = clock.time(step);
        self.instant = step / clock.steps_per_sample;
        for (number, person) in self.people.iter_mut().enumerate() {
            if !person.needs_setup() {
                continue;
            }
            if let Some(source) = person.source {
                let source = &self.world.sources[source as usize];
                person.follow(&source.traits.route, time);
            } else {
                let setup = &self.world.people[number];
                person.enter(setup, time);
                person.follow(&setup.traits.route, time);
            }
        }
        for robot in &mut self.robots {
            robot.watch(&self.world, &self.people, &self.bodies, time);
        }
        self.over |= self.is_settled();
        if !self.over {
            for (index, source) in self.sources.iter_mut().enumerate() {
                source.admit(&self.world, index, time, &mut self.people, &self.robots);
            }
        }
        if let Some(record) = &mut self.record {
            record.push(time, &self.people, &self.robots);
        }
    }
}

/// A world under way: people decide by themselves, robots by their laws or by what they are told.
///
/// It can be started again in another world; its memory is used again.
pub struct Simulation(Episode<CrowdParts>);

impl Simulation {
    /// A world at its start, which others may share; `record`: with everybody's places at every step.
    ///
    /// # Errors
    /// The world breaks a rule, or a law cannot work in it.
    pub fn new(world: impl Into<Arc<CrowdWorld>>, record: bool) -> Result<Self> {
        Self::starting(CrowdParts::new(world.into(), record))
    }

    /// A recorded world at its start, all robots of which can be observed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn observed(world: impl Into<Arc<CrowdWorld>>) -> Result<Self> {
        let world = world.into();
        let robots = world.robots.len();
        CrowdWorld::check_sightings(robots * (robots + world.people.len()))?;
        Self::starting(CrowdParts {
            observed: true,
            ..CrowdParts::new(world, true)
        })
    }

    fn starting(mut parts: CrowdParts) -> Result<Self> {
        parts.world.check()?;
        let clock = clock_of(&parts.world)?;
        if parts.record.is_some() {
            check_rows(&parts.world)?;
        }
        parts.open(clock.step)?;
        Episode::starting(parts, clock).map(Self)
    }

    /// Starts again in the same world after a change: another seed, other places.
    ///
    /// # Errors
    /// Starts again, with the errors of [`Self::new`]; the simulation cannot be stepped then.
    pub fn restart(&mut self, change: impl FnOnce(&mut CrowdWorld)) -> Result<()> {
        let parts = &mut self.0.parts;
        change(Arc::make_mut(&mut parts.world));
        parts.over = true;
        parts.world.check()?;
        let clock = clock_of(&parts.world)?;
        parts.open(clock.step)?;
        self.0.restart(clock)
    }

    /// Tells a robot what to do from its next decision on; [`Request::Law`]: what its law says, or to stand
    /// without one.
    pub fn ask(&mut self, robot: usize, request: Request) {
        if let Some(robot) = self.0.parts.robots.get_mut(robot) {
            robot.ask(request);
        }
    }

    /// Situation of the controller of a robot, measured at the start of its control period; `None` without such a
    /// robot, or one without sensing.
    ///
    /// # Errors
    /// Its law cannot work among the people who have come.
    pub fn observe(&mut self, robot: usize) -> Result<Option<Situation<'_, f64>>> {
        let now = self.0.stepped();
        let parts = &mut self.0.parts;
        let Some(observer) = parts.robots.get_mut(robot) else {
            return Ok(None);
        };
        let at = (parts.instant, now);
        let seen = observer.observe(&parts.world, &parts.people, &parts.bodies, at, robot);
        seen.map_err(|error| error.within(&format!("robots[{robot}]")))
    }

    /// Which robots decide in the next step: their control periods begin, and they have not arrived.
    #[must_use]
    pub fn deciding(&self) -> Vec<bool> {
        let instant = self.0.parts.instant;
        let robots = self.robots().iter();
        robots.map(|robot| robot.decides_at(instant)).collect()
    }

    /// Advances by steps of the world until a control period of a robot begins, or it has ended.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn period(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        loop {
            self.step(interrupted)?;
            let (instant, robots) = (self.0.parts.instant, self.robots());
            let begins = robots.is_empty() || robots.iter().any(|robot| robot.is_due(instant));
            if begins || self.finished() {
                return Ok(());
            }
        }
    }

    /// Exchanges the room for decisions with another one.
    pub fn exchange_room(&mut self, room: &mut Box<DecisionRoom>) {
        std::mem::swap(&mut self.0.parts.room, room);
    }

    /// Advances by one step of the world. Does nothing once it has ended.
    ///
    /// # Errors
    /// The caller asked to stop.
    #[inline]
    pub fn step(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        self.0.period((), interrupted)
    }

    /// The first part of a step of the world: robots decide; `false` if it has ended.
    ///
    /// # Errors
    /// First half of [`Self::step`].
    pub(super) fn begin(&mut self, interrupted: Interrupted<'_>) -> Result<bool> {
        self.0.begin((), interrupted)
    }

    /// The second part, again and again: people decide and all move, people only if they have not done so; whether
    /// they have to once more.
    pub(super) fn advance(&mut self) -> bool {
        self.0.advance()
    }

    /// The last part: who has arrived, come or left.
    ///
    /// # Errors
    /// Second half of [`Self::step`].
    pub(super) fn end(&mut self) -> Result<()> {
        self.0.end()
    }

    /// The people, to be moved together with those of other worlds by what they decide; `doubtful`: whether somebody
    /// may no longer be at a finite place then.
    pub(super) fn move_people(&mut self, doubtful: bool) -> &mut [PersonState] {
        self.0.parts.moved = Some(doubtful);
        &mut self.0.parts.people
    }

    /// Whether the people have made the next motion.
    pub(super) fn people_have_moved(&self) -> bool {
        self.0.parts.moved.is_some()
    }

    /// The robots as others see them.
    pub(super) fn bodies(&self) -> &[Agent] {
        &self.0.parts.bodies
    }

    /// Time that a decision of people holds, in s.
    pub(super) fn part(&self) -> f64 {
        self.0.motion_step()
    }

    /// Advances to the end.
    ///
    /// # Errors
    /// Steps to the end like [`Self::step`].
    pub fn completed(self, interrupted: Interrupted<'_>) -> Result<Self> {
        let mut ended = self.0.run(interrupted)?;
        if let Some(record) = &mut ended.parts.record {
            record.close();
        }
        Ok(Self(ended))
    }

    /// True after the end: the time is over, all people have arrived, or the run has diverged.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.0.finished()
    }

    /// Time in s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.0.stepped()
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> &CrowdWorld {
        &self.0.parts.world
    }

    /// The people, those who have left included.
    #[must_use]
    pub fn people(&self) -> &[PersonState] {
        &self.0.parts.people
    }

    /// The robots.
    #[must_use]
    pub fn robots(&self) -> &[CrowdRobot] {
        &self.0.parts.robots
    }

    /// How often somebody was set back who would have passed a wall or come too near to it.
    #[must_use]
    pub fn wall_rescues(&self) -> u64 {
        self.0.parts.wall_rescues
    }

    /// Largest speed in m/s at which somebody moved who decides, before walls took of it; not of people who were moved
    /// together with those of other worlds, whose models bound it.
    #[must_use]
    pub fn max_person_speed(&self) -> f64 {
        self.0.parts.fastest_squared.sqrt()
    }

    /// Who is no longer at a finite place, if somebody is not.
    #[must_use]
    pub fn divergence(&self) -> Option<Divergence> {
        self.0.parts.diverged
    }

    /// Hands over what was recorded, and records no more.
    pub fn take_recorded(&mut self) -> Option<Trajectories> {
        self.0.parts.record.take()
    }

    /// Trajectories so far, if they are recorded.
    #[must_use]
    pub fn recorded(&self) -> Option<&Trajectories> {
        self.0.parts.record.as_ref()
    }
}
