//! Runs: control period, integrators, outcomes; one run, or many at once.

pub(crate) mod any_law;
pub mod as_built;
mod batch;
pub mod controller;
mod episode;
pub mod follower;
pub(crate) mod lanes;
pub mod metrics;
pub(crate) mod navigation;
mod nominal;
mod options;
mod outcome;
mod plan;
pub mod pursuit;
mod record;
mod registry;
mod runs;
mod scene;
pub mod skirt;
mod table;
mod tasks;
mod walls;
mod way;

pub use any_law::AnyLaw;
pub use batch::{BatchOptions, run_batch};
pub use episode::Episode;
pub(crate) use episode::Parts;
pub use navigation::{Navigation, Request};
pub(crate) use options::Clock;
pub use options::{Integrator, Kept, Options};
pub use outcome::{
    CONTACT_SPEED, Contact, ContactCounts, DECIDED_OVERLAP, Outcome, RunSummary, RunTotals,
};
pub use plan::{Instructions, Width};
pub use record::{DescentCounter, Recorder, Trajectory, TrajectoryRecorder};
pub use registry::law_named;
pub use table::BatchTable;

pub(crate) use lanes::group::{Group, RunJob};
pub(crate) use nominal::Ways;
pub(crate) use plan::{Key, RunPlan, key_of};
pub(crate) use table::min_clearance;

use navigation_laws::{FieldTerms, Scan, Situation, Stop};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
pub use numeric::error::Interrupted;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::{Planar, Vector2};

/// One run with everything recorded.
///
/// # Errors
/// An option is out of range, the law cannot work in the scenario, the state became non-finite,
/// or the caller asked to stop.
pub fn simulate(
    scenario: &Scenario,
    law: impl Into<AnyLaw>,
    options: &Options,
    interrupted: Interrupted<'_>,
) -> Result<(RunSummary, Trajectory)> {
    let law: AnyLaw = law.into();
    scenario.of_point_mass()?;
    law.suits(scenario)?;
    law.record(scenario, options, interrupted)
}

/// Everything at one instant, for a law that is asked for the first time.
fn at_state<T>(
    scenario: &Scenario,
    [position, velocity]: [[f64; 2]; 2],
    time: f64,
    answer: impl FnOnce(&Situation<'_, f64>) -> T,
) -> Result<T> {
    numeric::error::finite_pair("position", position)?;
    numeric::error::finite_pair("velocity", velocity)?;
    numeric::error::not_negative("time", time)?;
    let bodies = scene::bodies_at(scenario, time);
    let robot = RobotState {
        position: Vector2::splat(position),
        velocity: Vector2::splat(velocity),
    };
    Ok(answer(&Situation {
        time,
        bodies: &bodies,
        ages: &[],
        robot,
        heading: scenario.rules.heading,
        interval: scenario.rules.control_period,
        scan: Scan::default(),
        stop: Stop::never(),
    }))
}

/// Force that a law asks for at one state, as at its first control step, in N.
///
/// # Errors
/// A value is not finite, the time is negative, or the law cannot work in the scenario.
pub fn command_at(
    scenario: &Scenario,
    law: impl Into<AnyLaw>,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> Result<[f64; 2]> {
    let law: AnyLaw = law.into();
    let command = at_state(
        scenario,
        [position, velocity],
        time,
        |situation| -> Result<_> {
            let mut law = law.at_work(&law.gains(), scenario, false)?;
            Ok(law.command(situation))
        },
    )??;
    Ok(command.force.lane(0))
}

/// Every force term at one state, of a law that is a sum of terms.
///
/// # Errors
/// A value is not finite, the time is negative, or the law is a planner.
pub fn terms_at(
    scenario: &Scenario,
    law: impl Into<AnyLaw>,
    position: [f64; 2],
    velocity: [f64; 2],
    time: f64,
) -> Result<FieldTerms> {
    let law: AnyLaw = law.into();
    let terms = at_state(scenario, [position, velocity], time, |situation| {
        law.terms(scenario, situation)
    })?;
    terms.ok_or_else(|| {
        let rule = "be a sum of attraction and repulsion, such as VirtualForceField or Masoud";
        Failure::invalid(
            "law",
            rule,
            Given::Found(format!("one with the gains {}", law.gain_names().join(", ")).into()),
        )
    })
}
