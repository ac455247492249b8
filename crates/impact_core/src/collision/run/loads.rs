//! Peaks of the loads, and what is left of a collision.

use super::super::events::{Start, located};
use super::super::mechanics::{CollisionState, Local, SPEED, TOTAL};
use super::super::outcome::{CollisionStatus, Outcome};
use super::super::step::Step;
use super::{Region, Run};
use crate::covering::Shape;

/// Peaks: force, `eps`, `delta`, `d`, apex pressure, acceleration of the body.
pub const PEAKS: usize = 6;

impl<const N: usize> Run<'_, N> {
    /// Values that may peak, with their rates.
    fn rising(&self, state: &CollisionState<N>, local: &Local) -> [[f64; 2]; PEAKS] {
        [
            [local.force, local.force_rate],
            [state[TOTAL], state[SPEED]],
            [local.deflection, local.deflection_rate],
            [local.compression, local.compression_rate],
            self.mechanics.apex(state, local, &self.past),
            [
                local.body_acceleration,
                self.mechanics.body_jerk(state, local),
            ],
        ]
    }

    /// Offers the ends of a step, and what peaks between them.
    pub fn peaks_within(&mut self, taken: &Step<N>, used: f64, end: f64) {
        let before = self.rising(&self.state, &self.local);
        let after = self.rising(&taken.state, &taken.local);
        for index in 0..PEAKS {
            let [value, rate] = after[index];
            self.peaks[index].offer(before[index][0], self.time);
            self.peaks[index].offer(value, end);
            let [first, first_rate] = before[index];
            // `eps` peaks at an event.
            let alike = index == 1 || (self.mechanics.is_in_step() && (N < 5 || index != 5));
            if alike || !(first_rate > 0.0 && rate < 0.0) {
                continue;
            }
            let size = 1e-6 * self.sizes.sharpness.max(1e-13) * (first.abs() + value.abs()) / used;
            let start = Start {
                time: self.time,
                state: &self.state,
                rates: &self.rates,
                local: &self.local,
            };
            let (found, at) = located(
                &self.mechanics,
                &self.past,
                &start,
                (*taken, used),
                [first_rate, (rate - first_rate) / used],
                size.max(1e-9 * first_rate.abs().max(rate.abs()) * self.sizes.sharpness.sqrt()),
                |tried| {
                    let rate = self.rising(&tried.state, &tried.local)[index][1];
                    // No second derivative is at hand: an infinite one asks for the straight line.
                    [rate, f64::INFINITY]
                },
            );
            let value = self.rising(&found.state, &found.local)[index][0];
            self.peaks[index].offer(value, self.time + at);
        }
    }

    /// Loads at the end.
    pub fn outcome(&self, status: CollisionStatus) -> Outcome {
        let collision = self.mechanics.collision;
        if matches!(
            status,
            CollisionStatus::BeyondData | CollisionStatus::Unfinished
        ) {
            return Outcome {
                evaluations: self.evaluations,
                ..Outcome::nothing(status)
            };
        }
        let [force, total, deflection, compression, apex, acceleration] =
            self.peaks.map(|best| best.value);
        let free = |value: f64| {
            if collision.body.mass.is_finite() {
                value
            } else {
                f64::NAN
            }
        };
        let mut outcome = Outcome {
            status,
            release_time: self.time,
            peak_force: force,
            peak_force_time: self.peaks[0].time,
            peak_total_compression: total,
            peak_body_deflection: if collision.region == Region::Rigid {
                0.0
            } else {
                deflection
            },
            rebound_speed: if status == CollisionStatus::Released {
                -self.state[SPEED]
            } else {
                f64::NAN
            },
            peak_body_acceleration: free(acceleration),
            body_speed_end: free(self.mechanics.body_speed(&self.state)),
            end_force: self.local.force,
            // The acceleration of the body is a force over its mass, or less.
            rising: status == CollisionStatus::Horizon
                && !self.done
                && self.peaks[..PEAKS - 1]
                    .iter()
                    .any(|best| best.time >= self.time),
            evaluations: self.evaluations,
            ..Outcome::nothing(status)
        };
        if let Some(pad) = collision.pad {
            outcome.peak_covering_compression = compression;
            outcome.peak_strain = compression / pad.covering.thickness;
            outcome.bottomed = compression > pad.bottom();
            outcome.peak_pressure = match pad.covering.shape {
                Shape::Flat { area } => force / area,
                Shape::Curved { .. } | Shape::Cylinder { .. } => apex,
            };
            let level = matches!(pad.covering.shape, Shape::Flat { .. })
                && self.mechanics.is_in_step()
                && pad.force(compression)[1] == 0.0;
            if level {
                outcome.peak_force_time = f64::NAN;
            }
        }
        outcome
    }
}
