//! Artificial potential field of Khatib (1986).

use crate::pairwise::{Neighbor, PairwiseFamily, PairwiseField, Push};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;
use numeric::lanes::{Real, Vector2};

/// Which repulsion is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KhatibForm {
    /// Along the gradient of the distance, as its author has it.
    #[default]
    Gradient,
    /// Along the rate of change of the offset, as the thesis prints it (2.2.3).
    Printed,
}

/// `F_a = K_1 (E - b V)` (2.2.2) and `F_Lambda = K (1/d_s - 1/d_k2)/d_s^2 u`, `d_s` the distance
/// of the surfaces, `d_k2` the one at which the active region begins; the printed form (2.2.3)
/// has `-K (d_k2 - d_s)/d_s^3 Ddot` instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Khatib<R = f64> {
    /// `K_1` in N/m.
    pub attractive: R,
    /// `K_K3` in N m^2; in N s with the printed form.
    pub repulsive: R,
    /// `b = K_2/K_1` in s.
    pub ratio: R,
    /// Form of the repulsion.
    pub form: KhatibForm,
}

impl<R: Real> PairwiseField<R> for Khatib<R> {
    #[inline(always)]
    fn attraction(
        &self,
        to_goal: Vector2<R>,
        velocity: Vector2<R>,
        _inside: R::Mask,
    ) -> Vector2<R> {
        (to_goal - velocity * self.ratio) * self.attractive
    }

    #[inline(always)]
    fn push(&self, neighbor: &Neighbor<'_, R>, robot: &RobotState<R>) -> Push<R> {
        let gap = neighbor.gap;
        let reach = neighbor.reach;
        let square = gap * gap;
        let force = match self.form {
            KhatibForm::Gradient => {
                let one = R::splat(1.0);
                let steepness = (one / gap - one / reach) / square;
                neighbor.outward * (self.repulsive * steepness)
            }
            KhatibForm::Printed => {
                let velocity = Vector2::from(neighbor.body.state.velocity);
                let strength = self.repulsive * (reach - gap) / (square * gap);
                (velocity - robot.velocity) * strength
            }
        };
        Push::straight(force)
    }
}

impl Named for Khatib {
    const NAME: &'static str = "khatib";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            ratio: given.number("gain_ratio")?,
            form: if given.flag("printed")? {
                KhatibForm::Printed
            } else {
                KhatibForm::Gradient
            },
        })
    }
}

impl PairwiseFamily for Khatib {
    type Field<R: Real> = Khatib<R>;
    const GAIN_NAMES: &'static [&'static str] =
        &["attractive_gain", "repulsive_gain", "gain_ratio"];
    const FREE_GAINS: &'static [usize] = &[0, 2];

    fn gains(&self) -> Vec<f64> {
        vec![self.attractive, self.repulsive, self.ratio]
    }

    #[inline(always)]
    fn with_gains<R: Real>(&self, gains: &[R], _scenario: &Scenario) -> Khatib<R> {
        Khatib {
            attractive: gains[0],
            repulsive: gains[1],
            ratio: gains[2],
            form: self.form,
        }
    }
}
