//! The Lyapunov function of the field.

use crate::field::detour::Turning;
use crate::field::gains::GainLanes;
use crate::field::repulsive::Repulsion;
use navigation_world::world::geometry::Approach;
use numeric::lanes::{Real, Vector2};

/// `V_1 = K_1^2 |E|^2/2 + m K_1 |Edot|^2/2` in N^2 (5.5.2).
#[inline(always)]
pub fn free_part<R: Real>(
    gains: &GainLanes<R>,
    mass: f64,
    to_goal: Vector2<R>,
    velocity: Vector2<R>,
) -> R {
    let k1 = gains.attractive;
    R::splat(0.5) * k1 * (k1 * to_goal.dot(&to_goal) + R::splat(mass) * velocity.dot(&velocity))
}

/// Part of an active obstacle in N^2, with the `h_Lambda` and `h_psi` of `Q_2` (5.5.2):
/// `K_3^2 L^2/2 + m K_3 (r2-d)^2/(d-r3)^2 ddot^2/2 + K_5^2 psi^2/2 + m K_5 (r2-d)^2 d Phidot^2/2`.
#[inline(always)]
pub fn obstacle_part<R: Real>(
    gains: &GainLanes<R>,
    mass: f64,
    approach: &Approach<R>,
    repulsion: &Repulsion<R>,
    turning: &Turning<R>,
) -> R {
    let (k3, k5, m) = (gains.repulsive, gains.detour, R::splat(mass));
    let repelled = k3 * repulsion.potential;
    let turned = k5 * turning.signed_potential;
    // (r2-d)^2/(d-r3)^2 ddot^2 = -Ld ddot.
    let approaching = -(m * k3 * repulsion.rate * approach.range_rate);
    let spinning = m * k5 * turning.signed_rate * approach.distance * approach.angle_rate();
    R::splat(0.5) * (repelled * repelled + approaching + turned * turned + spinning)
}
