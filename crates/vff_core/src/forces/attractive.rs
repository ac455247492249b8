//! Attractive force.

use crate::gains::GainLanes;
use crate::lanes::{Real, Vec2};

/// `F_a = K_1 (E - b V)` in N, (5.4.2) with a goal at rest.
#[inline(always)]
pub fn attractive_force<R: Real>(
    gains: &GainLanes<R>,
    to_goal: Vec2<R>,
    velocity: Vec2<R>,
) -> Vec2<R> {
    (to_goal - velocity.scale(gains.ratio)).scale(gains.attractive)
}
