//! Virtual force of Borenstein and Koren (1989).

use super::{Neighbor, PairwiseField, Push};
use crate::forces::geometry::RobotState;
use crate::lanes::{Real, Vec2};

/// `F_Lambda = K_B3/d_s u` (2.2.5), `F_a = K_B1 u_E` (2.2.6), `d_s` the distance of the surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorensteinKoren<R = f64> {
    /// `K_B1` in N.
    pub attractive: R,
    /// `K_B3` in N m.
    pub repulsive: R,
    /// Whether the goal attracts inside an active region too; (2.2.6) prints that it does not.
    pub attracted_inside: bool,
}

impl<R: Real> PairwiseField<R> for BorensteinKoren<R> {
    #[inline(always)]
    fn attraction(&self, to_goal: Vec2<R>, _velocity: Vec2<R>, inside: R::Mask) -> Vec2<R> {
        let distance = to_goal.dot(to_goal).sqrt();
        let pull = to_goal.scale(self.attractive / distance);
        let pull = Vec2::select(distance.gt(R::zero()), pull, Vec2::zero());
        if self.attracted_inside {
            pull
        } else {
            Vec2::select(inside, Vec2::zero(), pull)
        }
    }

    #[inline(always)]
    fn push(&self, neighbor: &Neighbor<'_, R>, _robot: &RobotState<R>) -> Push<R> {
        Push::straight(neighbor.outward.scale(self.repulsive / neighbor.gap))
    }
}
