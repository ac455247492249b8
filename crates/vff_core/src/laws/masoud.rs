//! Circulating repulsion of Masoud (2007).

use crate::lanes::{Planar, Real, Vector2, Wide};
use crate::laws::pairwise::{Neighbor, PairwiseField, Push};
use crate::world::geometry::RobotState;

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
    fn attraction(
        &self,
        to_goal: Vector2<R>,
        _velocity: Vector2<R>,
        _inside: R::Mask,
    ) -> Vector2<R> {
        to_goal * self.attractive
    }

    #[inline(always)]
    fn push<B: Wide<R>>(&self, neighbor: &Neighbor<'_, R, B>, _robot: &RobotState<R>) -> Push<R> {
        let offset = neighbor.offset.vector;
        // d t = the offset turned left.
        Push {
            repulsive: offset * self.repulsive,
            detour: offset.left_normal() * self.detour,
        }
    }
}
