//! One run of a robot as built.

use crate::error::{Failure, Result};
use crate::lanes::Planar;
use crate::laws::{Situation, Stop};
use crate::run::Interrupted;
use crate::run::built::Built;
use crate::run::built::history::{BuiltTrajectory, Everything, Listener};
use crate::run::built::motion::{IdealHolonomic, Moving, Order, Reading};
use crate::run::built::omni::OmniRobot;
use crate::run::built::sight::Sight;
use crate::run::built::two_wheels::TwoWheels;
use crate::run::group::{AnyLaw, Driven};
use crate::run::metrics::{Performance, Weights, performance};
use crate::run::options::{Clock, Options};
use crate::run::outcome::RunSummary;
use crate::run::runs::Runs;
use crate::run::scene::{Scene, body_at};
use crate::world::geometry::Body;
use crate::world::scenario::Scenario;

/// One run with everything recorded.
///
/// # Errors
/// An option is out of range, the law cannot work in the scenario, the state became non-finite,
/// or the caller asked to stop.
pub fn simulate_built(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &Built,
    interrupted: Interrupted<'_>,
) -> Result<(RunSummary, BuiltTrajectory)> {
    let mut robot = robot_of(scenario, built)?;
    let mut listener = Everything::new(scenario, robot.wheels());
    let summary = run(
        scenario,
        law.driven(),
        built,
        (&mut *robot, &mut listener),
        interrupted,
    )?;
    Ok((summary, listener.finish()))
}

/// A run of a law, its run without obstacles and without noise, and the score.
pub type Scored = (
    Performance,
    (RunSummary, BuiltTrajectory),
    (RunSummary, BuiltTrajectory),
);

/// One run and its score against the run without obstacles.
///
/// # Errors
/// As [`simulate_built`].
pub fn evaluate_built(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &Built,
    weights: Weights,
    interrupted: Interrupted<'_>,
) -> Result<Scored> {
    let run = simulate_built(scenario, law, built, interrupted)?;
    let nominal = simulate_built(&scenario.nominal(), law, &built.seeing_all(), interrupted)?;
    let score = performance(scenario, &run.0, &nominal.0, weights);
    Ok((score, run, nominal))
}

/// The robot of a scenario, at its start.
pub(super) fn robot_of(scenario: &Scenario, built: &Built) -> Result<Box<dyn Moving>> {
    built.suiting(scenario)?;
    Ok(match (&scenario.differential, &built.wheels) {
        (Some(robot), _) => Box::new(TwoWheels::new(scenario, robot, built)?),
        (None, Some(drives)) => Box::new(OmniRobot::new(scenario, drives, built)?),
        (None, None) => Box::new(IdealHolonomic::new(scenario, built.step)),
    })
}

/// Runs a robot under a law; a listener hears of everything.
pub(super) fn run(
    scenario: &Scenario,
    law: &dyn Driven,
    built: &Built,
    (robot, listener): (&mut dyn Moving, &mut impl Listener),
    interrupted: Interrupted<'_>,
) -> Result<RunSummary> {
    let clock = clock_of(scenario, built)?;
    let mut law = law.steering(scenario)?;
    let mut scene = Scene::new(scenario, 1, false);
    let mut sight = Sight::new(scenario, built, &scene.frames[0])?;
    let mut runs = Runs::<f64>::new(scenario, clock, &scene.frames[0]);
    let mut reading = Reading::at_start(scenario);
    let mut energy = 0.0;
    let mut step = 0;
    while step < clock.steps && runs.running {
        scene.advance(&clock, step);
        let time = clock.time(step);
        sight.show(time, &reading, &scene.frames[0]);
        if step % clock.steps_per_sample == 0 {
            runs.check_finite(time)?;
            runs.rest(time);
            if !runs.running {
                break;
            }
            if interrupted() {
                return Err(Failure::Interrupted);
            }
            let seen = sight.look(time, &reading, &scene.frames[0]);
            let command = law.command(&Situation {
                bodies: seen.bodies,
                robot: seen.robot,
                interval: clock.interval,
                stop: Stop(interrupted),
            });
            runs.check_force(command.force, time)?;
            runs.count_sample();
            robot.hold(&Order {
                force: command.force,
                fix: seen.fix,
                clear: seen.clear(),
            });
            listener.sample(&command, seen.robot.position.lane(0));
        }
        listener.row(time, &reading, energy, &scene.frames[0]);
        reading = robot.step();
        let later = clock.time(step + 1);
        energy += reading.loss * account(&mut runs, &reading, &scene.frames[1], later);
        if built.stop_on_contact {
            runs.stop_at_contact(later);
        }
        step += 1;
    }
    let time = clock.time(step);
    runs.check_finite(time)?;
    runs.end(runs.running, time);
    let end = runs.first_end();
    reading.robot.position = runs.position;
    let bodies: Vec<Body> = scenario
        .obstacles
        .iter()
        .map(|placed| body_at(placed, end, &mut 0))
        .collect();
    listener.row(end, &reading, energy, &bodies);
    let mut summary = runs.summary(0, &());
    if !robot.is_ideal() {
        summary.energy = energy;
    }
    Ok(summary)
}

/// Steps of a run.
pub(super) fn clock_of(scenario: &Scenario, built: &Built) -> Result<Clock> {
    Options {
        step: built.step,
        ..Options::default()
    }
    .clock(scenario)
}

/// Accounts for a motion step; returns the share of it that belongs to the run.
fn account(runs: &mut Runs<'_, f64>, reading: &Reading, bodies: &[Body], later: f64) -> f64 {
    let before = runs.position;
    runs.position = reading.robot.position;
    runs.velocity = reading.robot.velocity;
    runs.speed = reading.speed;
    runs.account(bodies, before, later, true);
    if runs.running {
        return 1.0;
    }
    let step = runs.clock.step;
    (runs.first_end() - (later - step)) / step
}
