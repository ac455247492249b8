//! Stiffness, damping and friction of a foam rig from static and drop tests together.

mod bootstrap;
mod measured;
#[cfg(test)]
mod tests;

use super::drop_test::DropContact;
use super::line::{CONFIDENCE, fit_static};
use super::{check_confidence, check_samples};
use crate::error::{Failure, Given, Result, positive};
use crate::parameters::GRAVITY;
use crate::signal::check_time;
use measured::Tests;
use numeric::parallel::Work;

/// Deviation of the positions before it is known, in m.
const FIRST_DEVIATION: f64 = 1e-4;
/// Rounds in which the deviation of the positions is estimated anew.
const ROUNDS: usize = 3;

/// One drop: the slide is released at rest at the first time.
#[derive(Clone, Copy, Debug)]
pub struct Drop<'a> {
    /// Times, in s.
    pub time: &'a [f64],
    /// Positions, in m, up from the undeformed surface of the foam.
    pub position: &'a [f64],
}

/// Constants of the rig and settings of the intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoamFitSettings {
    /// Moving mass, in kg.
    pub moving_mass: f64,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// When the foam lets go of the slide.
    pub contact: DropContact,
    /// Repeats of the bootstrap; 0 for none.
    pub bootstrap: usize,
    /// Seed of the bootstrap.
    pub seed: u64,
}

impl FoamFitSettings {
    /// Usual settings: standard gravity, 95 %, a foam that cannot pull, no bootstrap.
    #[must_use]
    pub fn new(moving_mass: f64) -> Self {
        Self {
            moving_mass,
            gravity: GRAVITY,
            confidence: CONFIDENCE,
            contact: DropContact::Unilateral,
            bootstrap: 0,
            seed: 0,
        }
    }
}

/// Fitted foam; triples are in the order stiffness, damping ratio, friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FoamFit {
    /// Stiffness `K_c`, in N/m.
    pub stiffness: f64,
    /// Damping ratio on the rig.
    pub damping_ratio: f64,
    /// Friction of the rail, in N.
    pub friction: f64,
    /// Height of release of every drop, in m.
    pub drop_heights: Vec<f64>,
    /// Covariance.
    pub covariance: [[f64; 3]; 3],
    /// Intervals from the covariance and Student's distribution.
    pub interval: [[f64; 2]; 3],
    /// Percentile intervals of the bootstrap.
    pub bootstrap_interval: Option<[[f64; 2]; 3]>,
    /// Standard deviation of the static forces about their line, in N.
    pub force_deviation: f64,
    /// Standard deviation of the positions about the trajectory, in m.
    pub position_deviation: f64,
    /// Measurements less fitted numbers.
    pub degrees_of_freedom: usize,
    /// Steps of the last search.
    pub iterations: usize,
    /// Moving mass of the rig, in kg.
    pub moving_mass: f64,
}

impl FoamFit {
    /// Damping `2 xi sqrt(M K_c)` of the foam under another mass, in N s/m: the ratio is what stays.
    ///
    /// # Errors
    /// A mass that is not positive.
    pub fn damping(&self, mass: f64) -> Result<f64> {
        positive("mass", mass)?;
        Ok(2.0 * self.damping_ratio * (mass * self.stiffness).sqrt())
    }
}

/// Fits stiffness, damping ratio and friction to static forces and to whole drop trajectories.
///
/// Both tests are weighted by their own scatter, which is estimated too. Positions are compared with
/// the solution of the equation of motion, never differentiated. Where a record ends with equal
/// readings the slide rests; those readings say nothing new and are left out.
///
/// It is asked whether to stop between the repeats of the bootstrap; each of them is progress.
///
/// # Errors
/// Bad samples; a drop that starts in the foam or never reaches it; measurements that do not
/// determine the three numbers, or the caller asked to stop.
pub fn identify_foam(
    static_force: &[f64],
    static_compression: &[f64],
    drops: &[Drop<'_>],
    settings: &FoamFitSettings,
    work: Work<'_>,
) -> Result<FoamFit> {
    positive("moving_mass", settings.moving_mass)?;
    positive("gravity", settings.gravity)?;
    check_confidence(settings.confidence)?;
    let line = fit_static(static_force, static_compression, false)?;
    positive("slope of static_force", line.slope)?;
    if drops.is_empty() {
        return Err(Failure::invalid(
            "drops",
            "hold at least one drop",
            Given::Count(0),
        ));
    }
    let moving = drops.iter().map(moving_part).collect::<Result<Vec<_>>>()?;
    let mut tests = Tests {
        force: static_force.to_vec(),
        compression: static_compression,
        time: moving.iter().map(|drop| drop.time).collect(),
        position: moving.iter().map(|drop| drop.position.to_vec()).collect(),
        settings: *settings,
        force_deviation: line.residual_deviation.max(f64::EPSILON * line.slope),
        position_deviation: FIRST_DEVIATION,
        interrupted: work.interrupted,
    };
    let first = tests.first_bounce();
    let start = first.minimize(first.start(line.slope))?.parameters;
    let mut found = tests.minimize(start)?;
    for _ in 0..ROUNDS {
        tests.position_deviation = tests.scatter(&found);
        found = tests.minimize(found.parameters)?;
    }
    let covariance = tests.covariance(&found);
    let interval = tests.interval(&found.parameters, &covariance)?;
    let bootstrap_interval = (settings.bootstrap > 0)
        .then(|| tests.bootstrap(&found, work))
        .transpose()?;
    Ok(FoamFit {
        stiffness: found.parameters[0],
        damping_ratio: found.parameters[1],
        friction: found.parameters[2],
        drop_heights: found.parameters[3..].to_vec(),
        covariance,
        interval,
        bootstrap_interval,
        force_deviation: tests.force_deviation,
        position_deviation: tests.position_deviation,
        degrees_of_freedom: tests.degrees_of_freedom(),
        iterations: found.steps,
        moving_mass: settings.moving_mass,
    })
}

/// A drop without the readings at rest at its end.
fn moving_part<'a>(drop: &Drop<'a>) -> Result<Drop<'a>> {
    check_time("drop_time", drop.time)?;
    let like_time = "have as many values as drop_time, at least 8";
    check_samples(
        "drop_position",
        drop.position,
        drop.time.len(),
        8,
        like_time,
    )?;
    let lowest = drop.position.iter().copied().fold(f64::INFINITY, f64::min);
    if drop.position[0] <= 0.0 || lowest >= 0.0 {
        let value = if drop.position[0] <= 0.0 {
            drop.position[0]
        } else {
            lowest
        };
        return Err(Failure::invalid(
            "drop_position",
            "start above the foam and reach into it",
            Given::Number(value),
        ));
    }
    let last = drop.position[drop.position.len() - 1];
    let resting = drop
        .position
        .iter()
        .rev()
        .take_while(|&&y| y == last)
        .count();
    let kept = (drop.position.len() + 1 - resting).max(2);
    Ok(Drop {
        time: &drop.time[..kept],
        position: &drop.position[..kept],
    })
}
