//! Detour force of one obstacle.

use crate::field::gains::GainLanes;
use crate::field::side::DetourSide;
use navigation_world::world::geometry::Approach;
use numeric::lanes::{Planar, Real, Vector2};

/// `psi` and its damping part (5.4.5), both along the left of `u`, so signed by the side.
#[derive(Clone, Copy, Debug)]
pub struct Turning<R> {
    /// `s psi = s (r2-d)^2 |Phi|` in m^2 rad.
    pub signed_potential: R,
    /// `s psid* = (r2-d)^2 Phidot` in m^2 rad/s; does not depend on the side.
    pub signed_rate: R,
}

impl<R: Real> Turning<R> {
    /// Turning at an approach on a decided side.
    #[inline(always)]
    pub fn new(approach: &Approach<R>, detour: &DetourSide<R>) -> Self {
        let square = approach.depth * approach.depth;
        Self {
            signed_potential: square * detour.turn * detour.side,
            signed_rate: square * approach.angle_rate(),
        }
    }

    /// `F_psi = K_5 (psi + b psid*) u_psi` in N, `u_psi = s t`.
    #[inline(always)]
    pub fn force(&self, gains: &GainLanes<R>, approach: &Approach<R>) -> Vector2<R> {
        let strength = gains.detour * (self.signed_potential + gains.ratio * self.signed_rate);
        approach.outward.left_normal() * strength
    }
}
