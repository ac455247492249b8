//! The time loop of robots side by side, each in a scene of its own: a lane whose run has ended
//! takes the next scene, so that none is idle. Every run has the bits of the kernel of one scene.

use crate::error::{Failure, Result};
use crate::lanes::{Mask, Real, Truth, Vector2, Wide};
use crate::laws::{SceneLaw, Situation, Stop};
use crate::run::Interrupted;
use crate::run::lanes::scenes::{FeltObstacles, LaneObstacle, LaneScenes};
use crate::run::options::{Clock, Integrator, Options};
use crate::run::rollout::{rk4_held, semi_implicit_euler};
use crate::run::runs::Runs;
use crate::run::walls::Maps;
use crate::world::geometry::{Body, RobotState};
use crate::world::scenario::Scenario;

/// Control periods, times obstacles, between two questions whether to stop; about a millisecond.
const PERIODS_PER_QUESTION: usize = 2048;

/// Scenes that take turns in the lanes.
struct Relay<'a, R: Real + Wide<R>> {
    scenes: LaneScenes<'a>,
    obstacles: Vec<LaneObstacle<R>>,
    bodies: Vec<Body<R>>,
    felt: FeltObstacles<R>,
    runs: Runs<LaneScenes<'a>, R>,
    /// Motion steps since the start of the run of each lane.
    steps: R,
    /// Index of the scene of each lane; `None` for a lane that is out of work.
    index: Vec<Option<usize>>,
    /// Motion steps until the first lane runs out of time.
    left: usize,
}

/// Runs a law through scenes that agree in robot and rules. `law` is at work in the scene with the
/// most obstacles; `keep` takes each run: its index, its state and its lane there.
///
/// # Errors
/// An option is out of range, the state of a run became non-finite, or the caller asked to stop.
#[inline(always)]
pub(crate) fn run_scenes<R: Real + Wide<R>, L: SceneLaw<R>>(
    scenes: &[&Scenario],
    law: &mut L,
    options: &Options,
    interrupted: Interrupted<'_>,
    mut keep: impl FnMut(usize, &Runs<LaneScenes<'_>, R>, usize),
) -> Result<()> {
    let Some(first) = scenes.first() else {
        return Ok(());
    };
    let clock = options.clock(first)?;
    let count = scenes.iter().map(|scene| scene.obstacle_count()).max();
    let mut relay: Relay<'_, R> = Relay::new(first, clock, count.unwrap_or(0));
    let periods_per_question = (PERIODS_PER_QUESTION / (1 + relay.bodies.len())).max(1);
    let (mut next, mut until_question) = (0, periods_per_question);
    loop {
        let mut entered = R::Mask::none();
        for lane in 0..R::WIDTH {
            if relay.runs.running.lane(lane) {
                continue;
            }
            if let Some(index) = relay.index[lane].take() {
                keep(index, &relay.runs, lane);
            }
            if let Some(scene) = scenes.get(next) {
                relay.enter(lane, next, scene);
                law.enter(lane, scene);
                entered.set(lane);
                next += 1;
            }
        }
        if entered.any() {
            relay.begin(entered);
        }
        if !relay.runs.running.any() {
            return Ok(());
        }
        relay.left = relay.steps_left();
        let before = relay.runs.running;
        while relay.runs.running == before {
            relay
                .period(law, options, Stop(interrupted))
                .map_err(|error| error.of_run(|lane| relay.index[lane].unwrap_or(0)))?;
            until_question -= 1;
            if law.thinks() || until_question == 0 {
                until_question = periods_per_question;
                if interrupted() {
                    return Err(Failure::Interrupted);
                }
            }
        }
    }
}

impl<'a, R: Real + Wide<R>> Relay<'a, R> {
    /// Lanes without work.
    fn new(first: &'a Scenario, clock: Clock, count: usize) -> Self {
        let scenes = LaneScenes::all_in(first);
        let (obstacles, bodies) = (0..count).map(|_| LaneObstacle::absent()).unzip();
        let bodies: Vec<Body<R>> = bodies;
        let mut runs = Runs::new(scenes, clock, bodies.iter().copied(), Maps::default());
        runs.running = R::Mask::none();
        Self {
            scenes,
            obstacles,
            felt: FeltObstacles::of_at_most(count),
            bodies,
            runs,
            steps: R::zero(),
            index: vec![None; R::WIDTH],
            left: 0,
        }
    }

    /// Gives a lane another scene, before its start.
    #[cold]
    #[inline(never)]
    fn enter(&mut self, lane: usize, index: usize, scene: &'a Scenario) {
        self.scenes.enter(lane, scene);
        self.steps.set(lane, 0.0);
        self.index[lane] = Some(index);
        let obstacles = self.obstacles.iter_mut().zip(&mut self.bodies);
        for (number, (obstacle, body)) in obstacles.enumerate() {
            obstacle.enter(lane, scene.obstacles.get(number), body);
        }
        self.runs.enter(lane, scene);
    }

    /// The runs of some lanes begin.
    #[inline(never)]
    fn begin(&mut self, lanes: R::Mask) {
        self.place(|_| true);
        self.runs.begin(lanes, self.scenes, &self.bodies);
    }

    /// Instant of each lane, in s.
    #[inline(always)]
    fn time(&self) -> R {
        self.steps * R::splat(self.runs.clock.step)
    }

    /// Brings obstacles of every lane to its instant, chosen by whether they are watched between two
    /// samples.
    #[inline(always)]
    fn place(&mut self, chosen: impl Fn(bool) -> bool) {
        let time = self.time();
        let obstacles = self.obstacles.iter_mut().zip(&mut self.bodies);
        for (number, (obstacle, body)) in obstacles.enumerate() {
            if chosen(self.runs.watched[number]) {
                obstacle.place(time, (&self.scenes, number), &mut body.state);
            }
        }
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
    fn period<L: SceneLaw<R>>(
        &mut self,
        law: &mut L,
        options: &Options,
        stop: Stop<'_>,
    ) -> Result<()> {
        let time = self.time();
        self.runs.check_finite(time)?;
        self.runs.rest(time);
        if !self.runs.running.any() {
            return Ok(());
        }
        self.place(|watched| !watched);
        self.sample(law, time, stop)?;
        for _ in 0..self.runs.clock.steps_per_sample {
            self.step(options)?;
            if !self.runs.running.any() {
                break;
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn sample<L: SceneLaw<R>>(&mut self, law: &mut L, time: R, stop: Stop<'_>) -> Result<()> {
        let runs = &mut self.runs;
        let (interval, step) = (runs.clock.interval, runs.clock.step);
        let bodies = if law.is_told_of_all() {
            &self.bodies
        } else {
            let felt = &mut self.felt;
            felt.among(&self.bodies, runs.position, runs.running)
        };
        let command = law.command(&Situation {
            time,
            bodies,
            ages: &[],
            robot: RobotState {
                position: runs.position,
                velocity: runs.velocity,
            },
            heading: self.scenes.of_first().rules.heading,
            interval,
            stop,
        });
        runs.check_force(command.force, time)?;
        runs.acceleration = self.scenes.of_first().robot.acceleration(command.force);
        runs.push = runs.acceleration * R::splat(step);
        runs.count_sample();
        runs.look_ahead(&self.bodies);
        Ok(())
    }

    /// A motion step under the held force.
    #[inline(always)]
    fn step(&mut self, options: &Options) -> Result<()> {
        let before: Vector2<R> = self.runs.position;
        match options.integrator {
            Integrator::SemiImplicitEuler => semi_implicit_euler(&mut self.runs),
            Integrator::Rk4 => rk4_held(&mut self.runs),
        }
        self.steps += R::splat(1.0);
        self.place(|watched| watched);
        let later = self.time();
        self.runs.account(&self.bodies, before, later, false);
        if options.stop_on_contact {
            self.runs.stop_at_contact(later);
        }
        self.left -= 1;
        if self.left == 0 {
            self.run_out(later)?;
        }
        Ok(())
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
