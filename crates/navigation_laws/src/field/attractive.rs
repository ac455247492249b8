//! Attractive force.

use crate::field::gains::GainLanes;
use numeric::lanes::{Real, Vector2};

/// `F_a = K_1 (E - b V)` in N, (5.4.2) with a goal at rest.
#[inline(always)]
pub fn attractive_force<R: Real>(
    gains: &GainLanes<R>,
    to_goal: Vector2<R>,
    velocity: Vector2<R>,
) -> Vector2<R> {
    (to_goal - velocity * gains.ratio) * gains.attractive
}
