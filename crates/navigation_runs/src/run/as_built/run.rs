//! Runs of robots as built.

use std::sync::Arc;

use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::as_built::history::AsBuiltTrajectory;
use crate::run::as_built::{AsBuilt, SteeringLaw};
use crate::run::episode::Episode;
use crate::run::metrics::{Performance, Weights, performance};
use crate::run::options::{Clock, Options};
use crate::run::outcome::RunSummary;
use navigation_world::robots::drives::{IdealHolonomic, MotorDrive, OmniRobot, TwoWheels};
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;

/// One run with everything recorded.
///
/// # Errors
/// An option is out of range, the law cannot work in the scenario, the state became non-finite,
/// or the caller asked to stop.
pub fn simulate_as_built(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &AsBuilt,
    interrupted: Interrupted<'_>,
) -> Result<(RunSummary, AsBuiltTrajectory)> {
    let episode = Episode::new(Arc::new(scenario.clone()), Some(law), built)?;
    let (summary, listener) = episode.completed(interrupted)?;
    Ok((summary, listener.finish()))
}

/// A run of a law, its run without obstacles and without noise, and the score.
pub type Scored = (
    Performance,
    (RunSummary, AsBuiltTrajectory),
    (RunSummary, AsBuiltTrajectory),
);

/// One run and its score against the run without obstacles.
///
/// # Errors
/// Fails like [`simulate_as_built`].
pub fn evaluate_as_built(
    scenario: &Scenario,
    law: &AnyLaw,
    built: &AsBuilt,
    weights: Weights,
    interrupted: Interrupted<'_>,
) -> Result<Scored> {
    let run = simulate_as_built(scenario, law, built, interrupted)?;
    let nominal = simulate_as_built(
        &scenario.nominal(),
        law,
        &built.seeing_all(law),
        interrupted,
    )?;
    let score = performance(scenario, &run.0, &nominal.0, weights);
    Ok((score, run, nominal))
}

/// The robot of a scenario under a law, at its start: one with two wheels follows what the law steers
/// it by.
pub(crate) fn robot_under(
    scenario: &Scenario,
    built: &AsBuilt,
    law: Option<&AnyLaw>,
) -> Result<Box<dyn MotorDrive>> {
    if scenario.differential.is_some() && law.is_some_and(|law| law.steers_by_velocity()) {
        let steering_law = SteeringLaw::Velocity;
        return robot_of(
            scenario,
            &AsBuilt {
                steering_law,
                ..built.clone()
            },
        );
    }
    robot_of(scenario, built)
}

/// The robot of a scenario, at its start.
fn robot_of(scenario: &Scenario, built: &AsBuilt) -> Result<Box<dyn MotorDrive>> {
    built.suiting(scenario)?;
    let start = built.start_in(scenario);
    let wheels = built.wheels.as_deref();
    Ok(match (&scenario.differential, wheels) {
        (Some(robot), _) => Box::new(TwoWheels::new(
            &start,
            robot,
            (wheels, built.slip),
            (&built.steering_law, built.fusion),
        )?),
        (None, Some(drives)) => Box::new(OmniRobot::new(&start, drives, (built.omni, built.slip))?),
        (None, None) => Box::new(IdealHolonomic::new(&start)),
    })
}

/// Steps of a run.
pub(crate) fn clock_of(scenario: &Scenario, built: &AsBuilt) -> Result<Clock> {
    Options {
        step: built.step,
        ..Options::default()
    }
    .clock(scenario)
}
