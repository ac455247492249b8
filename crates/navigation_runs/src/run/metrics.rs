//! The performance criterion of Zeng (2011), section 5.6.

use crate::run::{Outcome, RunSummary, RunTotals};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};

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

impl Weights {
    /// A third each.
    pub const EQUAL: Self = Self {
        arrival_time: 1.0 / 3.0,
        avoidance: 1.0 / 3.0,
        energy_saving: 1.0 / 3.0,
    };
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

impl Performance {
    /// Costs with `T*/T` and `L*/L` of at most 1, as a search counts them: a law that dawdles
    /// without obstacles would otherwise be paid for it.
    pub(crate) fn with_capped_ratios(self, weights: Weights) -> Self {
        // Nearly every run is slower among obstacles; its bits stay as they are.
        if self.arrival_time <= 1.0 && self.energy_saving <= 1.0 {
            return self;
        }
        let arrival_time = self.arrival_time.min(1.0);
        let energy_saving = self.energy_saving.min(1.0);
        let total = weights.arrival_time * arrival_time
            + weights.avoidance * self.avoidance
            + weights.energy_saving * energy_saving;
        Self {
            // A contact has set it to zero.
            total: if self.total == 0.0 { 0.0 } else { total },
            arrival_time,
            energy_saving,
            ..self
        }
    }
}

/// Least distance between the surfaces of robot and obstacle, in m.
#[must_use]
pub fn clearances(scenario: &Scenario, run: &RunSummary) -> Vec<f64> {
    let pairs = run.min_distance.iter().zip(&scenario.obstacles);
    pairs
        .map(|(distance, placed)| distance - placed.contact_distance)
        .collect()
}

/// Numbers of a run without obstacles for the criterion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nominal {
    /// `T*` in s; NaN without arrival.
    pub arrival_time: f64,
    /// `L*` in J.
    pub energy: f64,
}

impl Nominal {
    /// Of a run that is still to be made.
    pub(crate) const UNSET: Self = Self {
        arrival_time: f64::NAN,
        energy: f64::NAN,
    };

    /// Of a run.
    pub(crate) fn of(run: &RunTotals) -> Self {
        Self {
            arrival_time: run.arrival_time,
            energy: run.energy,
        }
    }
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
    let run_measures = Measures {
        contact: run.outcome == Outcome::Collided,
        arrival_time: run.arrival_time.unwrap_or(f64::NAN),
        energy: run.energy,
    };
    let nominal = Nominal {
        arrival_time: nominal.arrival_time.unwrap_or(f64::NAN),
        energy: nominal.energy,
    };
    let distances = run.min_distance.iter().copied();
    score(scenario, run_measures, distances, nominal, weights)
}

/// Numbers of a run for the criterion, besides its distances.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measures {
    pub contact: bool,
    /// NaN without arrival.
    pub arrival_time: f64,
    pub energy: f64,
}

impl From<&RunTotals> for Measures {
    #[inline(always)]
    fn from(run: &RunTotals) -> Self {
        Self {
            contact: run.outcome == Outcome::Collided,
            arrival_time: run.arrival_time,
            energy: run.energy,
        }
    }
}

/// Score of a run from its least distances to the obstacles in their order.
#[inline(always)]
pub(crate) fn score(
    scenario: &Scenario,
    run: Measures,
    distances: impl Iterator<Item = f64>,
    nominal: Nominal,
    weights: Weights,
) -> Performance {
    let avoidance = if run.contact {
        0.0
    } else {
        avoidance(scenario, distances)
    };
    if run.arrival_time.is_nan() || nominal.arrival_time.is_nan() {
        return Performance {
            total: 0.0,
            arrival_time: 0.0,
            avoidance,
            energy_saving: 0.0,
        };
    }
    let arrival_time = nominal.arrival_time / run.arrival_time;
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
        total: if run.contact { 0.0 } else { total },
        arrival_time,
        avoidance,
        energy_saving,
    }
}

/// Mean over the obstacles of `min(d_s/d_s*, 1)`; 1 without obstacles.
#[inline(always)]
fn avoidance(scenario: &Scenario, distances: impl Iterator<Item = f64>) -> f64 {
    if scenario.obstacles.is_empty() {
        return 1.0;
    }
    let share = |(distance, placed): (f64, &PlacedObstacle)| {
        let clearance = distance - placed.contact_distance;
        (clearance / (placed.regions.active_radius - placed.contact_distance)).min(1.0)
    };
    let sum: f64 = distances.zip(&scenario.obstacles).map(share).sum();
    sum / scenario.obstacles.len() as f64
}

#[cfg(test)]
mod tests {
    use super::{Performance, Weights};

    const WEIGHTS: Weights = Weights {
        arrival_time: 0.5,
        avoidance: 0.25,
        energy_saving: 0.25,
    };

    fn scored(arrival_time: f64, energy_saving: f64, contact: bool) -> Performance {
        let (avoidance, parts) = if contact {
            (0.0, 0.0)
        } else {
            (0.4, 0.5 * arrival_time + 0.25 * 0.4 + 0.25 * energy_saving)
        };
        Performance {
            total: parts,
            arrival_time,
            avoidance,
            energy_saving,
        }
    }

    #[test]
    fn ratios_up_to_one_keep_their_bits() {
        for ratios in [[0.3, 0.7], [1.0, 1.0], [0.0, 0.0]] {
            let own = scored(ratios[0], ratios[1], false);
            assert_eq!(own.with_capped_ratios(WEIGHTS), own);
        }
    }

    #[test]
    fn ratios_above_one_count_one() {
        let capped = scored(3.0, 1.7, false).with_capped_ratios(WEIGHTS);
        assert_eq!(capped, scored(1.0, 1.0, false));
        let capped = scored(0.25, 8.0, false).with_capped_ratios(WEIGHTS);
        assert_eq!(capped, scored(0.25, 1.0, false));
    }

    #[test]
    fn a_contact_stays_at_zero() {
        let capped = scored(2.0, 2.0, true).with_capped_ratios(WEIGHTS);
        assert_eq!((capped.total, capped.arrival_time), (0.0, 1.0));
    }
}
