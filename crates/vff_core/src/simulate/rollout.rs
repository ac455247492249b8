//! The time loop: one kernel for one robot and for robots side by side.

use crate::error::{NavigationError, Result};
use crate::forces::geometry::{Body, RobotState};
use crate::lanes::{Mask, Real, Vec2};
use crate::laws::{Command, Law, Situation};
use crate::measurement::{Measured, Sensor};
use crate::scenario::Scenario;
use crate::simulate::Interrupted;
use crate::simulate::options::{Clock, Integrator, Options};
use crate::simulate::outcome::RunSummary;
use crate::simulate::record::Recorder;
use crate::simulate::runs::Runs;
use crate::simulate::scene::{Scene, body_at};

/// Samples between two questions whether to stop; about a millisecond.
const SAMPLES_PER_QUESTION: usize = 512;

/// A lane group with its law and its recorder.
pub struct Member<L, C> {
    /// Drives the robots of the group.
    pub law: L,
    /// Listens to their runs.
    pub recorder: C,
}

/// Runs lane groups through a scenario, in step, so that they share the motion of the obstacles.
///
/// A group's state stays in registers for all steps of a control period.
///
/// # Errors
/// An option is out of range, the state of a run became non-finite, or the caller asked to stop.
#[inline(always)]
pub fn run_team<R: Real, L: Law<R>, C: Recorder<R>>(
    scenario: &Scenario,
    team: &mut [Member<L, C>],
    options: &Options,
    interrupted: Interrupted<'_>,
) -> Result<Vec<RunSummary>> {
    let clock = options.clock(scenario)?;
    let mut scene = Scene::new(scenario, &clock, options.integrator == Integrator::Rk4);
    let mut sensor = Sensor::new(scenario);
    let mut seen = scene.frames[0].clone();
    let mut groups: Vec<Runs<'_, R>> = team
        .iter()
        .map(|_| Runs::new(scenario, clock, &seen))
        .collect();
    let mut until_question = SAMPLES_PER_QUESTION;
    let mut first = 0;
    while first < clock.steps && groups.iter().any(|runs| runs.running.any()) {
        let steps = clock.steps_per_sample.min(clock.steps - first);
        scene.advance(&clock, first);
        let measured = sensor
            .as_mut()
            .map(|sensor| sensor.measure(&scene.frames[0], &mut seen));
        let period = Period {
            scene: &scene,
            seen: if measured.is_some() {
                &seen
            } else {
                &scene.frames[0]
            },
            measured,
            first,
            steps,
        };
        for (index, (runs, member)) in groups.iter_mut().zip(team.iter_mut()).enumerate() {
            if runs.running.any() {
                run_period(runs, member, &period, options)
                    .map_err(|error| of_group(error, index * R::WIDTH))?;
            }
        }
        first += steps;
        until_question -= 1;
        if until_question == 0 {
            until_question = SAMPLES_PER_QUESTION;
            if interrupted() {
                return Err(NavigationError::Interrupted);
            }
        }
    }
    let mut summaries = Vec::with_capacity(team.len() * R::WIDTH);
    for (index, (runs, member)) in groups.iter_mut().zip(team).enumerate() {
        let time = clock.time(first);
        runs.check_finite(time)
            .map_err(|error| of_group(error, index * R::WIDTH))?;
        runs.end(runs.running, time);
        member.recorder.end(
            runs.first_end(),
            runs.position,
            runs.velocity,
            &runs.currents,
            || {
                let end = runs.first_end();
                scenario
                    .obstacles
                    .iter()
                    .map(|placed| body_at(placed, end, &mut 0))
                    .collect()
            },
        );
        summaries.extend((0..R::WIDTH).map(|lane| runs.summary(lane, &member.recorder)));
    }
    Ok(summaries)
}

/// The error of a lane as the error of a run of the team.
fn of_group(error: NavigationError, first: usize) -> NavigationError {
    match error {
        NavigationError::NonFinite { run, time } => NavigationError::NonFinite {
            run: first + run,
            time,
        },
        other => other,
    }
}

/// What all groups share in a control period.
struct Period<'a> {
    scene: &'a Scene<'a>,
    seen: &'a [Body],
    measured: Option<Measured>,
    /// Step at which it begins.
    first: usize,
    /// Number of its steps.
    steps: usize,
}

/// One control period of a group: a sample of the force, then its steps.
#[inline(always)]
fn run_period<R: Real, L: Law<R>, C: Recorder<R>>(
    runs: &mut Runs<'_, R>,
    member: &mut Member<L, C>,
    period: &Period<'_>,
    options: &Options,
) -> Result<()> {
    let clock = runs.clock;
    let begin = clock.time(period.first);
    runs.check_finite(begin)?;
    runs.rest(begin);
    if !runs.running.any() {
        return Ok(());
    }
    let robot = observe(runs, period.measured);
    let situation = Situation {
        bodies: period.seen,
        robot,
        interval: clock.interval,
    };
    let command = member.law.command(&situation);
    let acceleration = runs.scenario.robot.acceleration(command.force);
    runs.push = acceleration.scale(R::splat(clock.step));
    runs.count_sample();
    runs.look_ahead(&period.scene.frames[0]);
    member.recorder.sample(&command, runs.running);
    for step in 0..period.steps {
        let bodies = &period.scene.frames[step];
        let time = clock.time(period.first + step);
        record(runs, member, time, &command, bodies);
        let before = runs.position;
        match options.integrator {
            Integrator::SemiImplicitEuler => semi_implicit_euler(runs),
            Integrator::Rk4 if options.hold => rk4_held(runs, acceleration),
            Integrator::Rk4 => rk4(runs, acceleration, &mut member.law, period.scene),
        }
        let later = clock.time(period.first + step + 1);
        runs.account(&period.scene.frames[step + 1], before, later);
        if options.stop_on_contact {
            runs.stop_at_contact(later);
        }
        if !runs.running.any() {
            break;
        }
    }
    Ok(())
}

#[inline(always)]
fn record<R: Real, L, C: Recorder<R>>(
    runs: &Runs<'_, R>,
    member: &mut Member<L, C>,
    time: f64,
    command: &Command<R>,
    bodies: &[Body],
) {
    member.recorder.row(
        time,
        runs.position,
        runs.velocity,
        &runs.currents,
        command,
        bodies,
    );
}

/// State of the robots as the controller knows it.
#[inline(always)]
fn observe<R: Real>(runs: &mut Runs<'_, R>, measured: Option<Measured>) -> RobotState<R> {
    let (position, velocity) = (runs.position, runs.velocity);
    let Some(Measured {
        robot_error: Some(error),
        period,
    }) = measured
    else {
        return RobotState { position, velocity };
    };
    let position = position + Vec2::splat(error);
    let rate = R::splat(period);
    // The first velocity is the true one.
    let velocity = runs.last_measured.map_or(velocity, |last| {
        let way = position - last;
        Vec2 {
            x: way.x / rate,
            y: way.y / rate,
        }
    });
    runs.last_measured = Some(position);
    RobotState { position, velocity }
}

#[inline(always)]
fn semi_implicit_euler<R: Real>(runs: &mut Runs<'_, R>) {
    let robot = &runs.scenario.robot;
    (runs.velocity, runs.speed) = robot.limited_velocity(runs.velocity + runs.push);
    runs.position = runs.position + runs.velocity.scale(R::splat(runs.clock.step));
}

/// Runge-Kutta of order 4 with a held acceleration; the second and third stage coincide.
fn rk4_held<R: Real>(runs: &mut Runs<'_, R>, acceleration: Vec2<R>) {
    let robot = &runs.scenario.robot;
    let Clock { step, .. } = runs.clock;
    let at = |share: f64| runs.velocity + acceleration.scale(R::splat(share * step));
    let middle = robot.limited_velocity(at(0.5)).0;
    let (last, speed) = robot.limited_velocity(at(1.0));
    let weighted = runs.velocity + middle.scale(R::splat(4.0)) + last;
    runs.position = runs.position + weighted.scale(R::splat(step / 6.0));
    (runs.velocity, runs.speed) = (last, speed);
}

/// Force of a later stage; out of line, or the kernel would hold four copies of the law.
#[inline(never)]
fn stage_force<R: Real, L: Law<R>>(law: &mut L, situation: &Situation<'_, R>) -> Vec2<R> {
    law.command(situation).force
}

/// Runge-Kutta of order 4 with the force evaluated in every stage.
fn rk4<R: Real, L: Law<R>>(runs: &mut Runs<'_, R>, first: Vec2<R>, law: &mut L, scene: &Scene<'_>) {
    let robot = &runs.scenario.robot;
    let Clock { step, interval, .. } = runs.clock;
    let (start, velocity) = (runs.position, runs.velocity);
    let mut push = |bodies: &[Body], position, velocity| {
        let state = RobotState { position, velocity };
        robot.acceleration(stage_force(
            law,
            &Situation {
                bodies,
                robot: state,
                interval,
            },
        ))
    };
    let limited = |velocity| robot.limited_velocity(velocity).0;
    let (half, whole) = (R::splat(0.5 * step), R::splat(step));
    let v2 = limited(velocity + first.scale(half));
    let second = push(&scene.middle, start + velocity.scale(half), v2);
    let v3 = limited(velocity + second.scale(half));
    let third = push(&scene.middle, start + v2.scale(half), v3);
    let v4 = limited(velocity + third.scale(whole));
    let fourth = push(&scene.frames[1], start + v3.scale(whole), v4);
    let (sixth, two) = (R::splat(step / 6.0), R::splat(2.0));
    runs.position = start + (velocity + (v2 + v3).scale(two) + v4).scale(sixth);
    let gain = (first + (second + third).scale(two) + fourth).scale(sixth);
    (runs.velocity, runs.speed) = robot.limited_velocity(velocity + gain);
}
