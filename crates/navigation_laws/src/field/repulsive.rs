//! Repulsive force of one obstacle.

use crate::field::gains::GainLanes;
use navigation_world::world::geometry::Approach;
use numeric::lanes::{Real, Vector2};

/// `L` and its damping part `Ld` (5.4.3).
#[derive(Clone, Copy, Debug)]
pub struct Repulsion<R> {
    /// `L = (r2-d)^2/(d-r3)` in m.
    pub potential: R,
    /// `Ld = -ddot (r2-d)^2/(d-r3)^2` in m/s.
    pub rate: R,
}

impl<R: Real> Repulsion<R> {
    /// Repulsion at an approach.
    #[inline(always)]
    pub fn new(approach: &Approach<R>) -> Self {
        let inverse = R::splat(1.0) / approach.margin;
        let potential = approach.depth * approach.depth * inverse;
        Self {
            potential,
            rate: -(approach.range_rate * potential * inverse),
        }
    }

    /// `F_Lambda = K_3 (L + b Ld) u` in N.
    #[inline(always)]
    pub fn force(&self, gains: &GainLanes<R>, approach: &Approach<R>) -> Vector2<R> {
        approach.outward * (gains.repulsive * (self.potential + gains.ratio * self.rate))
    }
}
