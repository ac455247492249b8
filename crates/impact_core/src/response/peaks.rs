//! Peaks of a trajectory on the continuous solution.

use super::{PIECES, ResponsePeaks};
use crate::contact::{Bodies, Phase, Stretch};
use crate::roots::{Peak, maximum};
use crate::windows::first_fall;

/// Collects peaks until the head's acceleration comes back to zero.
pub(super) struct Watch {
    pub(super) peaks: ResponsePeaks,
    over: bool,
}

impl Watch {
    pub(super) fn new(constrained: bool) -> Self {
        let head = if constrained { f64::NAN } else { 0.0 };
        Self {
            peaks: ResponsePeaks {
                head_acceleration: head,
                contact_force: 0.0,
                compression: 0.0,
                impact_duration: if constrained { f64::NAN } else { f64::INFINITY },
            },
            over: false,
        }
    }

    pub(super) fn look(&mut self, stretch: &Stretch, bodies: &Bodies, duration: f64) {
        if self.over || stretch.start >= duration {
            return;
        }
        let free = !self.peaks.impact_duration.is_nan();
        let mut end = stretch.used.min(duration - stretch.start);
        if free {
            let piece = end / PIECES as f64;
            let noise = |time: f64| {
                let state = stretch.state(time);
                let [inverse_mass, damping, stiffness] = bodies.plant.head;
                let [compression, rate] = state.compression.map(f64::abs);
                let force = bodies.law().force([compression, rate]);
                let [position, velocity] = state.head.map(f64::abs);
                16.0 * f64::EPSILON
                    * (inverse_mass * force + damping * velocity + stiffness * position)
            };
            let fall = (0..PIECES).find_map(|index| {
                let from = piece * index as f64;
                first_fall(|time| stretch.head(time), from, from + piece, noise)
            });
            if let Some(time) = fall {
                end = time;
                self.over = true;
                self.peaks.impact_duration = stretch.start + time;
            }
        }
        let peak =
            |function: &dyn Fn(f64) -> [f64; 3]| -> Peak { maximum(function, 0.0, end, PIECES) };
        let law = bodies.law();
        if free {
            let acceleration = peak(&|time| {
                let [_, value, first, second] = stretch.head(time);
                [value, first, second]
            });
            self.peaks.head_acceleration = self.peaks.head_acceleration.max(acceleration.value);
        }
        if stretch.phase == Phase::Touching {
            let force = peak(&|time| {
                let [value, first, second, third] = stretch.compression_jet(time);
                [
                    law.force([value, first]),
                    law.force([first, second]),
                    law.force([second, third]),
                ]
            });
            let compression = peak(&|time| {
                let [value, first, second, _] = stretch.compression_jet(time);
                [value, first, second]
            });
            self.peaks.contact_force = self.peaks.contact_force.max(force.value);
            self.peaks.compression = self.peaks.compression.max(compression.value);
        }
    }
}
