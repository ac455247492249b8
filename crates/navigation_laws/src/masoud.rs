//! Circulating repulsion of Masoud (2007).

use crate::pairwise::{Neighbor, PairwiseFamily, PairwiseField, Push};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;
use numeric::lanes::{Planar, Real, Vector2};

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
    fn push(&self, neighbor: &Neighbor<'_, R>, _robot: &RobotState<R>) -> Push<R> {
        let offset = neighbor.offset.vector;
        // d t = the offset turned left.
        Push {
            repulsive: offset * self.repulsive,
            detour: offset.left_normal() * self.detour,
        }
    }
}

impl Named for Masoud {
    const NAME: &'static str = "masoud";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            detour: given.number("detour_gain")?,
        })
    }
}

impl PairwiseFamily for Masoud {
    type Field<R: Real> = Masoud<R>;
    const GAIN_NAMES: &'static [&'static str] =
        &["attractive_gain", "repulsive_gain", "detour_gain"];
    const FREE_GAINS: &'static [usize] = &[0];

    fn gains(&self) -> Vec<f64> {
        vec![self.attractive, self.repulsive, self.detour]
    }

    #[inline(always)]
    fn with_gains<R: Real>(&self, gains: &[R], _scenario: &Scenario) -> Masoud<R> {
        Masoud {
            attractive: gains[0],
            repulsive: gains[1],
            detour: gains[2],
        }
    }
}
