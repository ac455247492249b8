//! Circulating repulsion of Masoud (2007).

use super::{Neighbor, PairwiseField, Push};
use crate::forces::geometry::RobotState;
use crate::lanes::{Real, Vec2};

/// `F = K_1 E + sum (K_3 D + K_5 d t)`, (2.2.8)-(2.2.10): no damping anywhere, the circulation
/// always counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Masoud<R = f64> {
    /// `K_MM1` in N/m.
    pub attractive: R,
    /// `K_MM3` in N/m.
    pub repulsive: R,
    /// `K_MM5` in N/m.
    pub detour: R,
}

impl<R: Real> PairwiseField<R> for Masoud<R> {
    #[inline(always)]
    fn attraction(&self, to_goal: Vec2<R>, _velocity: Vec2<R>, _inside: R::Mask) -> Vec2<R> {
        to_goal.scale(self.attractive)
    }

    #[inline(always)]
    fn push(&self, neighbor: &Neighbor<'_, R>, _robot: &RobotState<R>) -> Push<R> {
        let offset = neighbor.offset.vector;
        // d t = the offset turned left.
        Push {
            repulsive: offset.scale(self.repulsive),
            detour: offset.perp().scale(self.detour),
        }
    }
}
