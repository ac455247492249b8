//! The time loop of robots side by side, each in a scene with gains of its own: a lane whose run has
//! ended takes the next run, so that none is idle. The arithmetic of a run is that of one by itself, bit
//! for bit.

use crate::run::Interrupted;
use crate::run::lanes::integrators::{rk4, rk4_held, semi_implicit_euler};
use crate::run::lanes::scenes::{FeltObstacles, LaneObstacles, LaneScenes};
use crate::run::lanes::sensors::LaneSensors;
use crate::run::options::Integrator;
use crate::run::plan::RunPlan;
use crate::run::record::Recorder;
use crate::run::runs::{Dormant, LaneState};
use crate::run::walls::Maps;
use navigation_laws::{Law, Scan, Situation, Stop};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
use navigation_world::world::shape::Shape;
use numeric::error::{Failure, Result};
use numeric::lanes::{Lanes, Mask, Real, Truth, Vector2};

/// A run to be made.
#[derive(Clone, Copy)]
pub(crate) struct RunJob<'a> {
    pub scenario: &'a Scenario,
    /// Gains in the order of their names.
    pub gains: &'a [f64],
}

/// Runs of one task.
pub(crate) struct Group<'a> {
    pub jobs: &'a [RunJob<'a>],
    pub plan: &'a RunPlan,
    /// Whether the runs are alike until an obstacle acts.
    pub led: bool,
    pub interrupted: Interrupted<'a>,
}

impl Group<'_> {
    /// Whether all runs are in one scenario.
    fn shares_scenario(&self) -> bool {
        let first = self.jobs.first();
        first.is_some_and(|first| {
            let mut jobs = self.jobs.iter();
            jobs.all(|job| std::ptr::eq(job.scenario, first.scenario))
        })
    }
}

/// Control periods, times obstacles, between two questions whether to stop; about a millisecond.
const PERIODS_PER_QUESTION: usize = 2048;

/// Makes a lane, with its gains among those of all lanes, ready for the run that begins in it.
type Enter<'a, R, L> = &'a mut dyn FnMut(&mut Option<Box<L>>, usize, &[R], &Scenario) -> Result<()>;

/// A law at work in the lanes.
pub(crate) struct LawInLanes<'a, R, L: ?Sized> {
    /// Makes it ready for a run.
    pub enter: Enter<'a, R, L>,
    /// True for a law that is told of all obstacles.
    pub told_of_all: fn(&L) -> bool,
}

/// Runs that take turns in the lanes.
pub(crate) struct Relay<'a, R: Real> {
    plan: &'a RunPlan,
    obstacles: LaneObstacles<R>,
    felt: Option<FeltObstacles<R>>,
    sensors: Option<LaneSensors<'a, R>>,
    runs: LaneState<LaneScenes<'a>, R>,
    /// Motion steps since the start of the run of each lane.
    steps: R,
    /// Index of the run of each lane; `None` for a lane that is out of work.
    index: Vec<Option<usize>>,
    /// Motion steps until the first lane runs out of time.
    left: usize,
    /// Whether no obstacle has acted yet in runs that are alike until one does.
    led: bool,
    /// Where these were when one did, from where later runs start.
    leader: Option<Box<(LaneState<LaneScenes<'a>, R>, R)>>,
    /// Obstacles that a run by itself leaves alone.
    dormant: Option<Dormant<'a, R>>,
}

/// Runs the jobs of a group, which may be side by side; `keep` takes each run: its index, its state and
/// its lane there.
///
/// # Errors
/// An option is out of range, the law cannot work in a scenario, the state of a run became non-finite, or
/// the caller asked to stop.
#[inline(always)]
pub(crate) fn run_lanes<R: Staged, L: Law<R> + ?Sized, C: Recorder<R>>(
    group: &Group<'_>,
    maps: &Maps,
    LawInLanes {
        enter,
        told_of_all: is_told_of_all,
    }: LawInLanes<'_, R, L>,
    recorder: &mut C,
    mut keep: impl FnMut(usize, &LaneState<LaneScenes<'_>, R>, usize, &mut C),
) -> Result<()> {
    let Some(first) = group.jobs.first() else {
        return Ok(());
    };
    let mut relay: Relay<'_, R> = Relay::new(group, first.scenario, maps)?;
    let periods_per_question = (PERIODS_PER_QUESTION / (1 + relay.obstacles.told.len())).max(1);
    let (mut next, mut until_question) = (0, periods_per_question);
    let (mut law, mut told_of_all) = (None, true);
    // Runs in one scene that begin together feel its obstacles together.
    let together = group.shares_scenario();
    let mut gains: Vec<R> = first.gains.iter().map(|gain| R::splat(*gain)).collect();
    loop {
        let mut entered = R::Mask::none();
        let waits = together && relay.runs.running.any();
        for lane in 0..R::WIDTH {
            if relay.runs.running.lane(lane) {
                continue;
            }
            if let Some(index) = relay.index[lane].take() {
                relay.wake_all();
                keep(index, &relay.runs, lane, recorder);
                while relay.led && next < group.jobs.len() {
                    keep(next, &relay.runs, lane, recorder);
                    next += 1;
                }
            }
            if let Some(job) = group.jobs.get(next).filter(|_| !waits) {
                for (gain, own) in gains.iter_mut().zip(job.gains) {
                    gain.set(lane, *own);
                }
                enter(&mut law, lane, &gains, job.scenario)?;
                relay.enter(lane, next, job.scenario);
                recorder.enter(lane);
                entered.set(lane);
                next += 1;
            }
        }
        let Some(law) = law.as_deref_mut() else {
            return Ok(());
        };
        if entered.any() {
            relay.begin::<L, C>(entered, law);
            told_of_all = is_told_of_all(law);
        }
        if !relay.runs.running.any() {
            return Ok(());
        }
        relay.left = relay.steps_left();
        let before = relay.runs.running;
        while relay.runs.running == before {
            relay
                .period((law, told_of_all), recorder, Stop(group.interrupted))
                .map_err(|error| error.of_run(|lane| relay.index[lane].unwrap_or(0)))?;
            until_question -= 1;
            if law.thinks() || until_question == 0 {
                until_question = periods_per_question;
                if (group.interrupted)() {
                    return Err(Failure::Interrupted);
                }
            }
        }
    }
}

/// Numbers of runs for which a Runge-Kutta step may evaluate the force in every stage. Lanes hold it: no law is
/// compiled for stages of lanes.
pub(crate) trait Staged: Real {
    /// A Runge-Kutta step that is not under a held force.
    fn staged_step<L: Law<Self> + ?Sized>(relay: &mut Relay<'_, Self>, law: &mut L, stop: Stop<'_>);
}

impl Staged for f64 {
    fn staged_step<L: Law<f64> + ?Sized>(relay: &mut Relay<'_, f64>, law: &mut L, stop: Stop<'_>) {
        relay.rk4(law, stop);
    }
}

impl<const N: usize> Staged for Lanes<N> {
    #[inline(always)]
    fn staged_step<L: Law<Self> + ?Sized>(relay: &mut Relay<'_, Self>, _: &mut L, _: Stop<'_>) {
        rk4_held(&mut relay.runs);
    }
}

impl<'a, R: Staged> Relay<'a, R> {
    /// Lanes without work, all in one scenario.
    fn new(group: &Group<'a>, first: &'a Scenario, maps: &Maps) -> Result<Self> {
        let clock = group.plan.run.clock(first)?;
        let jobs = group.jobs.iter();
        let most = jobs.map(|job| job.scenario.obstacle_count()).max();
        let count = most.unwrap_or(0);
        let obstacles = LaneObstacles::all_in(first, count);
        let samples = clock.steps / clock.steps_per_sample + 1;
        let sensors = LaneSensors::new(first, &obstacles.bodies, samples);
        let scenes = LaneScenes::all_in(first);
        let mut runs = LaneState::at_start(scenes, clock, count, maps.clone());
        runs.running = R::Mask::none();
        let compact = R::WIDTH > 1 && sensors.is_none() && !group.shares_scenario();
        Ok(Self {
            plan: group.plan,
            felt: compact.then(|| FeltObstacles::of_at_most(count)),
            obstacles,
            sensors,
            runs,
            steps: R::zero(),
            index: vec![None; R::WIDTH],
            left: 0,
            led: group.plan.shortcuts && group.led,
            leader: None,
            dormant: None,
        })
    }

    /// Gives a lane another run, before its start.
    #[cold]
    #[inline(never)]
    fn enter(&mut self, lane: usize, index: usize, scenario: &'a Scenario) {
        let again = std::ptr::eq(self.runs.scenario.in_lane(lane), scenario);
        self.runs.scenario.enter(lane, scenario);
        self.steps.set(lane, 0.0);
        self.index[lane] = Some(index);
        self.obstacles.enter(lane, scenario, again);
        if !again {
            self.runs.take_obstacles(lane, scenario);
        }
        self.runs.enter(lane, scenario);
        if let Some(sensors) = &mut self.sensors {
            sensors.enter(lane, scenario);
        }
        if let Some((leader, steps)) = self.leader.as_deref_mut() {
            self.runs.follow(lane, leader);
            self.steps.set(lane, steps.lane(0));
        }
        if self.felt.is_some()
            && scenario
                .obstacles
                .iter()
                .any(|placed| !matches!(placed.obstacle.shape, Shape::Disc { .. }))
        {
            self.felt = None;
        }
    }

    /// The runs of some lanes begin.
    #[inline(never)]
    fn begin<L: Law<R> + ?Sized, C: Recorder<R>>(&mut self, lanes: R::Mask, law: &L) {
        self.place(self.time(), |_| true);
        self.runs.start(lanes);
        if self.leader.is_none() {
            self.runs.begin(lanes, &self.obstacles.bodies);
        }
        // A run by itself that knows everything exactly, and keeps no rows, need not look at what is far away.
        let plan = self.plan;
        let spares = R::WIDTH == 1 && !C::EVERY_STEP && !plan.run.is_staged() && !plan.shortcuts;
        let scenario = self.runs.scenario.in_lane(0);
        if spares && self.sensors.is_none() && Dormant::<R>::pays(scenario) {
            let (runs, obstacles) = (&mut self.runs, &mut self.obstacles);
            let felt_within = |placed: &_| law.felt_within(placed);
            self.dormant = Some(Dormant::begin(scenario, runs, obstacles, felt_within));
        }
    }

    /// Counts what a run by itself has left alone.
    #[inline(always)]
    fn wake_all(&mut self) {
        if R::WIDTH == 1
            && let Some(mut dormant) = self.dormant.take()
        {
            dormant.count_all(&mut self.runs);
        }
    }

    /// Instant of each lane, in s.
    #[inline(always)]
    fn time(&self) -> R {
        self.steps * R::splat(self.runs.clock.step)
    }

    /// Brings obstacles of every lane to its instant, in s, chosen by whether they are watched between two
    /// samples.
    #[inline(always)]
    fn place(&mut self, time: R, chosen: impl Fn(bool) -> bool) {
        let runs = &self.runs;
        let chosen = |slot: usize| chosen(runs.watched[slot]);
        self.obstacles.place(time, &runs.scenario, chosen);
    }

    /// Motion steps until the first lane runs out of time.
    fn steps_left(&self) -> usize {
        let total = self.runs.clock.steps;
        let done = |lane: usize| {
            let busy = self.runs.running.lane(lane);
            if busy { self.steps.lane(lane) } else { 0.0 }
        };
        let most = (0..R::WIDTH).map(done).fold(0.0, f64::max);
        total - whole(most)
    }

    /// A sample of the force and the motion steps until the next one.
    #[inline(always)]
    fn period<L: Law<R> + ?Sized, C: Recorder<R>>(
        &mut self,
        (law, told_of_all): (&mut L, bool),
        recorder: &mut C,
        stop: Stop<'_>,
    ) -> Result<()> {
        let time = self.time();
        self.runs.check_finite(time)?;
        self.runs.rest(time);
        if !self.runs.running.any() {
            return Ok(());
        }
        self.place(time, |watched| !watched);
        if R::WIDTH == 1
            && let Some(dormant) = &mut self.dormant
        {
            let step = whole(self.steps.lane(0));
            dormant.sample(&mut self.obstacles, &mut self.runs, step);
        }
        if self.plan.shortcuts {
            if self.led && self.runs.feels_any(&self.obstacles.bodies) {
                self.led = false;
                self.leader = Some(Box::new((self.runs.clone(), self.steps)));
            }
            self.runs.end_hopeless(&self.obstacles.bodies, time);
            if !self.runs.running.any() {
                return Ok(());
            }
        }
        self.sample((law, told_of_all), recorder, stop)?;
        for _ in 0..self.runs.clock.steps_per_sample {
            self.step(law, recorder, stop)?;
            if !self.runs.running.any() {
                break;
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn sample<L: Law<R> + ?Sized, C: Recorder<R>>(
        &mut self,
        (law, told_of_all): (&mut L, bool),
        recorder: &mut C,
        stop: Stop<'_>,
    ) -> Result<()> {
        let time = self.time();
        let (runs, all) = (&mut self.runs, &self.obstacles.bodies);
        let (position, velocity) = (runs.position, runs.velocity);
        let mut robot = RobotState { position, velocity };
        let mut bodies = &all[..];
        if let Some(sensors) = &mut self.sensors {
            if let Some(past) = &runs.past {
                robot.position = past.delayed(position);
            }
            let index = self.steps / R::splat(runs.clock.steps_per_sample as f64);
            let when = (time, index, runs.running);
            robot = sensors.measure(when, &runs.scenario, all, robot);
            bodies = &sensors.seen;
        } else if R::WIDTH == 1 {
            let dormant = self.dormant.as_mut();
            let everything = dormant.and_then(|dormant| dormant.everything(time, &runs.scenario));
            bodies = everything.unwrap_or(bodies);
        } else if let Some(felt) = self.felt.as_mut().filter(|_| !told_of_all) {
            bodies = felt.among(all, position, runs.running);
        }
        let common = runs.scenario.in_lane(0);
        let command = law.command(&Situation {
            time,
            bodies,
            ages: &[],
            robot,
            heading: common.rules.heading,
            interval: runs.clock.interval,
            scan: Scan::ALL,
            stop,
        });
        runs.check_force(command.force, time)?;
        if C::EVERY_STEP {
            runs.command = command;
        }
        runs.acceleration = common.robot.acceleration(command.force);
        runs.push = runs.acceleration * R::splat(runs.clock.step);
        runs.count_sample();
        runs.look_ahead(all);
        recorder.sample(&command, runs.running);
        Ok(())
    }

    /// A motion step under the held force.
    #[inline(always)]
    fn step<L: Law<R> + ?Sized, C: Recorder<R>>(
        &mut self,
        law: &mut L,
        recorder: &mut C,
        stop: Stop<'_>,
    ) -> Result<()> {
        if C::EVERY_STEP {
            let (time, runs) = (self.time().lane(0), &self.runs);
            let (position, velocity) = (runs.position, runs.velocity);
            let bodies = &self.obstacles.bodies;
            let command = &runs.command;
            recorder.row(time, position, velocity, &runs.currents, command, bodies);
        }
        let before: Vector2<R> = self.runs.position;
        match self.plan.run.integrator {
            Integrator::SemiImplicitEuler => semi_implicit_euler(&mut self.runs),
            Integrator::Rk4 if self.plan.run.hold => rk4_held(&mut self.runs),
            Integrator::Rk4 => R::staged_step(self, law, stop),
        }
        self.steps += R::splat(1.0);
        let later = self.time();
        self.place(later, |watched| watched || C::EVERY_STEP);
        let bodies = &self.obstacles.bodies;
        self.runs.account(bodies, before, later, C::EVERY_STEP);
        self.runs.remember();
        if R::WIDTH == 1
            && let Some(dormant) = &mut self.dormant
        {
            dormant.pass(&mut self.runs);
        }
        if self.plan.run.stop_on_contact {
            self.runs.stop_at_contact(later);
        }
        self.left -= 1;
        if self.left == 0 {
            self.run_out(later)?;
        }
        Ok(())
    }

    /// A motion step with the force evaluated in every stage.
    #[inline(never)]
    fn rk4<L: Law<R> + ?Sized>(&mut self, law: &mut L, stop: Stop<'_>) {
        let (scenes, clock, begun) = (self.runs.scenario, self.runs.clock, self.time());
        let heading = scenes.in_lane(0).rules.heading;
        let obstacles = &mut self.obstacles;
        let end = (self.steps + R::splat(1.0)) * R::splat(clock.step);
        rk4(&mut self.runs, |share, robot| {
            let time = begun + R::splat(share * clock.step);
            let shown = if share < 1.0 { time } else { end };
            obstacles.place(shown, &scenes, |_| true);
            let situation = Situation {
                time,
                bodies: &obstacles.bodies,
                ages: &[],
                robot,
                heading,
                interval: clock.interval,
                scan: Scan::ALL,
                stop,
            };
            law.command(&situation).force
        });
    }

    /// Ends the runs of lanes that have run out of time.
    #[cold]
    #[inline(never)]
    fn run_out(&mut self, time: R) -> Result<()> {
        let total = self.runs.clock.steps;
        let over = R::splat(total as f64).le(self.steps);
        self.runs.check_finite(time)?;
        self.runs.end(self.runs.running & over, time);
        self.left = self.steps_left();
        Ok(())
    }
}

/// A counted number of steps.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole, and not negative
fn whole(steps: f64) -> usize {
    steps as usize
}
