//! Virtual force of Borenstein and Koren (1989).

use crate::pairwise::{Neighbor, PairwiseFamily, PairwiseField, Push};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;
use numeric::lanes::{Planar, Real, Vector2};

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
    fn attraction(
        &self,
        to_goal: Vector2<R>,
        _velocity: Vector2<R>,
        inside: R::Mask,
    ) -> Vector2<R> {
        let distance = to_goal.dot(&to_goal).sqrt();
        let pull = to_goal * (self.attractive / distance);
        let pull = Vector2::select(distance.gt(R::zero()), pull, Vector2::zeros());
        if self.attracted_inside {
            pull
        } else {
            Vector2::select(inside, Vector2::zeros(), pull)
        }
    }

    #[inline(always)]
    fn push(&self, neighbor: &Neighbor<'_, R>, _robot: &RobotState<R>) -> Push<R> {
        Push::straight(neighbor.outward * (self.repulsive / neighbor.gap))
    }
}

impl Named for BorensteinKoren {
    const NAME: &'static str = "borenstein_koren";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            attracted_inside: given.flag("attracted_inside")?,
        })
    }
}

impl PairwiseFamily for BorensteinKoren {
    type Field<R: Real> = BorensteinKoren<R>;
    const GAIN_NAMES: &'static [&'static str] = &["attractive_gain", "repulsive_gain"];
    const FREE_GAINS: &'static [usize] = &[0];

    fn gains(&self) -> Vec<f64> {
        vec![self.attractive, self.repulsive]
    }

    #[inline(always)]
    fn with_gains<R: Real>(&self, gains: &[R], _scenario: &Scenario) -> BorensteinKoren<R> {
        BorensteinKoren {
            attractive: gains[0],
            repulsive: gains[1],
            attracted_inside: self.attracted_inside,
        }
    }
}
