//! The performance criterion of Zeng (2011), section 5.6.

use crate::scenario::Scenario;
use crate::simulate::{Outcome, RunSummary};

/// Weights of time, distance and energy; they sum to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Weight of `H_T`.
    pub arrival_time: f64,
    /// Weight of `H_D`.
    pub avoidance: f64,
    /// Weight of `H_E`.
    pub energy_saving: f64,
}

/// Score of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Performance {
    /// `H`.
    pub total: f64,
    /// `H_T = T*/T`; 0 without arrival.
    pub arrival_time: f64,
    /// `H_D`; 0 after a contact.
    pub avoidance: f64,
    /// `H_E = L*/L`; 0 without arrival.
    pub energy_saving: f64,
}

/// Least distance between the surfaces of robot and obstacle, in m.
#[must_use]
pub fn clearances(scenario: &Scenario, run: &RunSummary) -> Vec<f64> {
    let pairs = run.min_distance.iter().zip(&scenario.obstacles);
    pairs
        .map(|(distance, placed)| distance - placed.contact_distance)
        .collect()
}

/// Score of a run against the run of the same law without obstacles, (5.6.1)-(5.6.6):
/// `H = k (w_T T*/T + w_D mean min(d_s/d_s*, 1) + w_E L*/L)`, `d_s = d - rho_r - rho_obs`,
/// `d_s* = r2 - rho_r - rho_obs`, `k = 0` after a contact or without arrival.
#[must_use]
pub fn performance(
    scenario: &Scenario,
    run: &RunSummary,
    nominal: &RunSummary,
    weights: Weights,
) -> Performance {
    let contact = run.outcome == Outcome::Collided;
    let avoidance = if contact {
        0.0
    } else {
        avoidance(scenario, run)
    };
    let (Some(time), Some(nominal_time)) = (run.arrival_time, nominal.arrival_time) else {
        return Performance {
            total: 0.0,
            arrival_time: 0.0,
            avoidance,
            energy_saving: 0.0,
        };
    };
    let arrival_time = nominal_time / time;
    // A robot without motor losses saves all there is to save.
    let energy_saving = if run.energy == 0.0 {
        1.0
    } else {
        nominal.energy / run.energy
    };
    let total = weights.arrival_time * arrival_time
        + weights.avoidance * avoidance
        + weights.energy_saving * energy_saving;
    Performance {
        total: if contact { 0.0 } else { total },
        arrival_time,
        avoidance,
        energy_saving,
    }
}

/// Mean over the obstacles of `min(d_s/d_s*, 1)`; 1 without obstacles.
fn avoidance(scenario: &Scenario, run: &RunSummary) -> f64 {
    if scenario.obstacles.is_empty() {
        return 1.0;
    }
    let share = |(clearance, placed): (f64, &crate::scenario::PlacedObstacle)| {
        (clearance / (placed.regions.active_radius - placed.contact_distance)).min(1.0)
    };
    let sum: f64 = clearances(scenario, run)
        .into_iter()
        .zip(&scenario.obstacles)
        .map(share)
        .sum();
    sum / scenario.obstacles.len() as f64
}
