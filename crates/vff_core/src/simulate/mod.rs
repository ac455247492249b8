//! Runs: control period, integrators, outcomes; one run, or many at once.

mod batch;
mod group;
mod nominal;
mod options;
mod outcome;
mod record;
mod rollout;
mod runs;
mod scene;
mod table;

pub use batch::{BatchOptions, Instructions, Width, run_batch};
pub use group::AnyLaw;
pub use options::{Integrator, Options};
pub use outcome::{CONTACT_SPEED, Contact, Outcome, RunSummary, RunTotals};
pub use record::{DescentCounter, Recorder, Trajectory, TrajectoryRecorder};
pub use table::BatchTable;

pub(crate) use batch::on_threads;
pub(crate) use group::{Group, Plan};
pub(crate) use nominal::{Key, Ways, key_of, nominal_runs};
pub(crate) use table::min_clearance;

use crate::error::{NavigationError, Result};
use crate::forces::geometry::{Body, RobotState};
use crate::gains::GainLanes;
use crate::lanes::Vec2;
use crate::laws::{FieldTerms, ForceFieldLaw, Situation, VirtualForceField};
use crate::scenario::Scenario;
use crate::simulate::rollout::{Member, run_team};

/// Asked now and then whether to stop.
pub type Interrupted<'a> = &'a (dyn Fn() -> bool + Sync);

/// One run with everything recorded.
///
/// # Errors
/// An option is out of range, the state became non-finite, or the caller asked to stop.
pub fn simulate(
    scenario: &Scenario,
    law: &VirtualForceField,
    options: &Options,
    interrupted: Interrupted<'_>,
) -> Result<(RunSummary, Trajectory)> {
    let gains = GainLanes::<f64>::gather(law.gains, &[]);
    let law = ForceFieldLaw::<f64, true>::new(law, gains, scenario);
    let mut team = [Member {
        law,
        recorder: TrajectoryRecorder::new(scenario),
    }];
    let mut summary = None;
    run_team(
        scenario,
        (&mut team, false),
        &Plan::single(*options),
        interrupted,
        |_, runs, lane, recorder| summary = Some(runs.summary(lane, recorder)),
    )?;
    let [member] = team;
    let summary = summary.ok_or(NavigationError::Interrupted)?;
    Ok((summary, member.recorder.finish()))
}

/// Every force term at one state.
///
/// # Errors
/// A value is not finite or the time is negative.
pub fn terms_at(
    scenario: &Scenario,
    law: &VirtualForceField,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> Result<FieldTerms> {
    crate::error::finite_pair("position", position)?;
    crate::error::finite_pair("velocity", velocity)?;
    crate::error::not_negative("time", time)?;
    let bodies: Vec<Body> = scenario
        .obstacles
        .iter()
        .map(|placed| scene::body_at(placed, time, &mut 0))
        .collect();
    let gains = GainLanes::<f64>::gather(law.gains, &[]);
    let mut field = ForceFieldLaw::<f64, true>::new(law, gains, scenario);
    let robot = RobotState {
        position: Vec2::splat(position),
        velocity: Vec2::splat(velocity),
    };
    let interval = scenario.rules.control_period;
    Ok(field.terms(&Situation {
        bodies: &bodies,
        robot,
        interval,
    }))
}
