//! The time loop: one kernel for one robot and for robots side by side.

use crate::error::{Failure, Result};
use crate::lanes::{Real, Truth, Vector2};
use crate::laws::{Law, Situation, Stop};
use crate::run::Interrupted;
use crate::run::options::{Clock, Integrator, Options};
use crate::run::plan::Plan;
use crate::run::record::Recorder;
use crate::run::runs::{Dormant, Runs};
use crate::run::scene::{Scene, World, bodies_at};
use crate::run::walls::Maps;
use crate::sensing::sampled::{Measured, SampledScene};
use crate::world::geometry::{Body, RobotState};
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Blocks of steps, times obstacles, between two questions whether to stop; about a millisecond.
const BLOCKS_PER_QUESTION: usize = 512;

/// Most steps for which the motion of the obstacles is worked out ahead.
const STEPS_PER_BLOCK: usize = 64;

/// A lane group with its law and its recorder.
pub(crate) struct Member<L, C> {
    /// Drives the robots of the group.
    pub law: L,
    /// Listens to their runs.
    pub recorder: C,
}

/// Runs lane groups through a scenario, in step, so that they share the motion of the obstacles.
///
/// A group's state stays in registers for all steps of a control period. At the end every run is
/// handed over with its index: its group's state, its lane there and its recorder. A team that is
/// `led` behaves alike until an obstacle acts: its first group goes ahead for all.
///
/// # Errors
/// An option is out of range, the state of a run became non-finite, or the caller asked to stop.
#[inline(always)]
pub(crate) fn run_team<R: Real, L: Law<R>, C: Recorder<R>>(
    scenario: &Scenario,
    (team, mut led): (&mut [Member<L, C>], bool),
    (plan, maps): (&Plan, &Maps),
    interrupted: Interrupted<'_>,
    mut keep: impl FnMut(usize, &Runs<&Scenario, R>, usize, &C),
) -> Result<()> {
    let options = &plan.run;
    let clock = options.clock(scenario)?;
    let staged = options.is_staged();
    debug_assert!(R::WIDTH == 1 || !staged, "stages have no lanes");
    let mut sensor = SampledScene::new(scenario);
    let mut groups: Vec<Runs<&Scenario, R>> = Vec::with_capacity(team.len());
    // A group by itself that keeps no rows needs the obstacles between two samples only where they
    // are near; several groups share them.
    let alone = team.len() == 1 && !C::EVERY_STEP && !staged;
    // One run by itself that knows everything exactly need not look at what is far away.
    let single = R::WIDTH == 1 && alone && sensor.is_none() && !led && !plan.shortcuts;
    let steps = clock.steps_per_sample.min(STEPS_PER_BLOCK);
    let mut seen = Vec::new();
    let (mut scene, mut dormant) = if single && Dormant::pays(scenario) {
        let count = scenario.obstacle_count();
        groups.push(Runs::at_start(scenario, clock, count, maps.clone()));
        let felt_within = |placed: &PlacedObstacle| team[0].law.felt_within(placed);
        let (dormant, scene) = Dormant::begin(&mut groups[0], steps, felt_within);
        (scene, Some(dormant))
    } else {
        seen = bodies_at(scenario, 0.0);
        let first = Runs::new(scenario, clock, seen.iter().copied(), maps.clone());
        // Those that are led come when they part.
        groups.resize(if led { 1 } else { team.len() }, first);
        (Scene::of(scenario, seen.clone(), (steps, staged)), None)
    };
    let longest = longest_block(&groups);
    let blocks_per_question = (BLOCKS_PER_QUESTION / scene.told.len().max(1)).max(1);
    let mut until_question = blocks_per_question;
    let thinks = team.first().is_some_and(|member| member.law.thinks());
    let mut first = 0;
    while first < clock.steps && groups.iter().any(|runs| runs.running.any()) {
        let until_sample = clock.steps_per_sample - first % clock.steps_per_sample;
        let steps = until_sample.min(clock.steps - first).min(longest);
        let samples = until_sample == clock.steps_per_sample;
        let span = (first, steps);
        scene.begin(&clock, first);
        if let Some(dormant) = dormant.as_mut().filter(|_| samples) {
            dormant.sample(&mut scene, &mut groups[0], first);
        }
        if !alone {
            scene.complete(&clock, first, |_| true);
        }
        let measured = sensor
            .as_mut()
            .filter(|_| samples)
            .map(|sensor| sensor.measure(clock.time(first), &scene.frames[0], &mut seen));
        if led && samples {
            let known = sensor.as_ref().map(|_| &*seen);
            if groups[0].feels_any(known.unwrap_or(&scene.frames[0])) {
                led = false;
                follow(&mut groups, team.len());
            }
        }
        let members = groups.iter_mut().zip(team.iter_mut());
        for (index, (runs, member)) in members.enumerate() {
            if samples && runs.running.any() {
                let time = clock.time(first);
                if plan.shortcuts {
                    runs.end_hopeless(&scene.frames[0], time);
                }
                let known = sensor.as_ref().map(|_| &*seen);
                let known = known.unwrap_or(&scene.frames[0]);
                let everything = dormant
                    .as_mut()
                    .and_then(|dormant| dormant.everything(first));
                sample(
                    runs,
                    member,
                    everything.unwrap_or(known),
                    measured,
                    &Block::of(&scene, Stop(interrupted), span),
                )
                .map_err(|error| error.of_run(|run| index * R::WIDTH + run))?;
            }
            if alone {
                scene.complete(&clock, first, |slot| runs.watched[slot]);
            }
            if runs.running.any() {
                run_block(
                    runs,
                    member,
                    &Block::of(&scene, Stop(interrupted), span),
                    options,
                    dormant.as_mut(),
                );
                runs.remember();
            }
        }
        first += steps;
        until_question -= 1;
        if thinks || until_question == 0 {
            until_question = blocks_per_question;
            if interrupted() {
                return Err(Failure::Interrupted);
            }
        }
    }
    if led {
        follow(&mut groups, team.len());
    }
    let ended = clock.time(first);
    hand_over(scenario, &mut groups, team, (ended, dormant), &mut keep)
}

/// Most steps of a block: positions between two samples are wanted only for robots that are measured
/// late.
fn longest_block<R: Real>(groups: &[Runs<&Scenario, R>]) -> usize {
    let late = groups.first().is_some_and(|runs| runs.past.is_some());
    if late { 1 } else { STEPS_PER_BLOCK }
}

/// Ends what still runs, and hands over every run.
fn hand_over<R: Real, L, C: Recorder<R>>(
    scenario: &Scenario,
    groups: &mut [Runs<&Scenario, R>],
    team: &mut [Member<L, C>],
    (time, dormant): (f64, Option<Dormant<'_>>),
    keep: &mut impl FnMut(usize, &Runs<&Scenario, R>, usize, &C),
) -> Result<()> {
    if let Some(mut dormant) = dormant {
        dormant.count_all(&mut groups[0]);
    }
    for (index, (runs, member)) in groups.iter_mut().zip(team).enumerate() {
        runs.check_finite(time)
            .map_err(|error| error.of_run(|run| index * R::WIDTH + run))?;
        runs.end(runs.running, time);
        member.recorder.end(
            runs.first_end(),
            runs.position,
            runs.velocity,
            &runs.currents,
            || bodies_at(scenario, runs.first_end()),
        );
        for lane in 0..R::WIDTH {
            keep(index * R::WIDTH + lane, runs, lane, &member.recorder);
        }
    }
    Ok(())
}

/// All groups continue from where the first one is.
#[cold]
fn follow<R: Real>(groups: &mut Vec<Runs<&Scenario, R>>, count: usize) {
    if let Some(first) = groups.first().cloned() {
        groups.resize(count, first);
    }
}

/// Steps that all groups take with the same obstacles.
struct Block<'a> {
    scene: &'a Scene<&'a Scenario>,
    /// Whether to stop, for a law that thinks long.
    stop: Stop<'a>,
    /// Step at which it begins.
    first: usize,
    /// Number of its steps.
    steps: usize,
}

impl<'a> Block<'a> {
    #[inline(always)]
    fn of(scene: &'a Scene<&'a Scenario>, stop: Stop<'a>, (first, steps): (usize, usize)) -> Self {
        Self {
            scene,
            stop,
            first,
            steps,
        }
    }
}

/// A sample of the force for the runs of a group, whose law is told of the known obstacles.
#[inline(always)]
fn sample<R: Real, L: Law<R>, C: Recorder<R>>(
    runs: &mut Runs<&Scenario, R>,
    member: &mut Member<L, C>,
    known: &[Body],
    measured: Option<Measured>,
    block: &Block<'_>,
) -> Result<()> {
    let clock = runs.clock;
    let time = clock.time(block.first);
    runs.check_finite(time)?;
    runs.rest(time);
    if !runs.running.any() {
        return Ok(());
    }
    let situation = Situation {
        time,
        bodies: known,
        ages: &[],
        robot: observe(runs, measured),
        heading: runs.scenario.rules.heading,
        interval: clock.interval,
        stop: block.stop,
    };
    let command = member.law.command(&situation);
    runs.check_force(command.force, time)?;
    if C::EVERY_STEP {
        runs.command = command;
    }
    runs.acceleration = runs.scenario.robot.acceleration(command.force);
    runs.push = runs.acceleration * R::splat(clock.step);
    runs.count_sample();
    runs.look_ahead(&block.scene.frames[0]);
    member.recorder.sample(&command, runs.running);
    Ok(())
}

/// Steps of a group under the held force.
#[inline(always)]
fn run_block<R: Real, L: Law<R>, C: Recorder<R>>(
    runs: &mut Runs<&Scenario, R>,
    member: &mut Member<L, C>,
    block: &Block<'_>,
    options: &Options,
    mut dormant: Option<&mut Dormant<'_>>,
) {
    let clock = runs.clock;
    for step in 0..block.steps {
        let time = clock.time(block.first + step);
        record(runs, member, time, &block.scene.frames[step]);
        let before = runs.position;
        match options.integrator {
            Integrator::SemiImplicitEuler => semi_implicit_euler(runs),
            // Lanes are for held forces; without lanes this law is not compiled a second time.
            Integrator::Rk4 if options.hold || R::WIDTH > 1 => rk4_held(runs),
            Integrator::Rk4 => rk4(runs, &mut member.law, block, time),
        }
        let later = clock.time(block.first + step + 1);
        runs.account(&block.scene.frames[step + 1], before, later, C::EVERY_STEP);
        if R::WIDTH == 1
            && let Some(dormant) = &mut dormant
        {
            dormant.pass(runs);
        }
        if options.stop_on_contact {
            runs.stop_at_contact(later);
        }
        if !runs.running.any() {
            break;
        }
    }
}

#[inline(always)]
fn record<R: Real, L, C: Recorder<R>>(
    runs: &Runs<&Scenario, R>,
    member: &mut Member<L, C>,
    time: f64,
    bodies: &[Body],
) {
    member.recorder.row(
        time,
        runs.position,
        runs.velocity,
        &runs.currents,
        &runs.command,
        bodies,
    );
}

/// State of the robots as the controller knows it.
#[inline(always)]
fn observe<R: Real>(runs: &mut Runs<&Scenario, R>, measured: Option<Measured>) -> RobotState<R> {
    // No closures: they become calls, which pass whole lane groups through memory.
    let (mut position, velocity) = (runs.position, runs.velocity);
    if let Some(past) = &runs.past {
        position = past.delayed(position);
    }
    let robot = RobotState { position, velocity };
    match measured {
        Some(measured) => measured.of_robot(robot, &mut runs.last_measured),
        None => robot,
    }
}

#[inline(always)]
pub(crate) fn semi_implicit_euler<W: World<R>, R: Real>(runs: &mut Runs<W, R>) {
    let robot = &runs.scenario.common().robot;
    let (position, velocity) = (runs.position, runs.velocity);
    let mut state = RobotState { position, velocity };
    runs.speed = robot.advance(&mut state, runs.push, runs.clock.step);
    (runs.position, runs.velocity) = (state.position, state.velocity);
}

/// Runge-Kutta of order 4 with a held acceleration; the second and third stage coincide.
pub(crate) fn rk4_held<W: World<R>, R: Real>(runs: &mut Runs<W, R>) {
    let robot = &runs.scenario.common().robot;
    let Clock { step, .. } = runs.clock;
    let change = robot.change(runs.velocity, runs.acceleration * R::splat(step), step);
    let at = |share: f64| match robot.max_deceleration {
        None => runs.velocity + runs.acceleration * R::splat(share * step),
        Some(_) => runs.velocity + change * R::splat(share),
    };
    let middle = robot.limited_velocity(at(0.5)).0;
    let (last, speed) = robot.limited_velocity(at(1.0));
    let weighted = runs.velocity + middle * R::splat(4.0) + last;
    runs.position += weighted * R::splat(step / 6.0);
    (runs.velocity, runs.speed) = (last, speed);
}

/// Force of a later stage; out of line, or the kernel would hold four copies of the law.
#[inline(never)]
fn stage_force<R: Real, L: Law<R>>(law: &mut L, situation: &Situation<'_, R>) -> Vector2<R> {
    law.command(situation).force
}

/// Runge-Kutta of order 4 with the force evaluated in every stage.
fn rk4<R: Real, L: Law<R>>(
    runs: &mut Runs<&Scenario, R>,
    law: &mut L,
    block: &Block<'_>,
    time: f64,
) {
    let robot = &runs.scenario.robot;
    let Clock { step, interval, .. } = runs.clock;
    let begun = runs.velocity;
    // Every stage keeps the limits of the velocity at the start of the step.
    let kept = |acceleration: Vector2<R>| match robot.max_deceleration {
        None => acceleration,
        Some(_) => robot.change(begun, acceleration * R::splat(step), step) * R::splat(1.0 / step),
    };
    let first = kept(runs.acceleration);
    let (scene, stop) = (block.scene, block.stop);
    let heading = runs.scenario.rules.heading;
    let (start, velocity) = (runs.position, runs.velocity);
    let mut push = |time: f64, bodies: &[Body], position, velocity| {
        let state = RobotState { position, velocity };
        kept(robot.acceleration(stage_force(
            law,
            &Situation {
                time,
                bodies,
                ages: &[],
                robot: state,
                heading,
                interval,
                stop,
            },
        )))
    };
    let middle = time + 0.5 * step;
    let limited = |velocity| robot.limited_velocity(velocity).0;
    let (half, whole) = (R::splat(0.5 * step), R::splat(step));
    let v2 = limited(velocity + first * half);
    let second = push(middle, &scene.middle, start + velocity * half, v2);
    let v3 = limited(velocity + second * half);
    let third = push(middle, &scene.middle, start + v2 * half, v3);
    let v4 = limited(velocity + third * whole);
    let fourth = push(time + step, &scene.frames[1], start + v3 * whole, v4);
    let (sixth, two) = (R::splat(step / 6.0), R::splat(2.0));
    runs.position = start + (velocity + (v2 + v3) * two + v4) * sixth;
    let gain = (first + (second + third) * two + fourth) * sixth;
    let gain = robot.change(velocity, gain, step);
    (runs.velocity, runs.speed) = robot.limited_velocity(velocity + gain);
}
