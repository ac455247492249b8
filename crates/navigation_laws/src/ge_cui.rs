//! Dynamic potential field of Ge and Cui (2002).

use crate::pairwise::{Neighbor, PairwiseFamily, PairwiseField, Push};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::{Approach, RobotState};
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;
use numeric::lanes::{Mask, Planar, Real, Vector2};

/// Least `(d - r)^2` in m^2: where the stopping distance `r` equals `d` the law is singular.
const LEAST_SQUARE: f64 = 1e-12;

/// `F_a = K_1 (E - b V)` (2.2.11), `F_Lambda = K (1 - ddot/a_max)/(d - r)^2 u` and
/// `F_psi = -K ddot betadot d/(d - r)^2 t` (2.2.12)-(2.2.13), `r = ddot^2/(2 a_max)` (2.2.15),
/// `d` from the centre: the detour goes along the tangential relative velocity while the two
/// approach and against it while they recede.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeCui<R = f64> {
    /// `K_1` in N/m.
    pub attractive: R,
    /// `K_G3` in N m^2, of repulsion and detour.
    pub repulsive: R,
    /// `b = K_2/K_1` in s.
    pub ratio: R,
    /// `a_max`, with which the robot brakes, in m/s^2.
    pub max_deceleration: f64,
}

impl<R: Real> PairwiseField<R> for GeCui<R> {
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
        // The goal enters the angles of an approach only, which are not used here.
        let everywhere = R::Mask::splat(true);
        let goal = Vector2::zeros();
        let approach = Approach::new(neighbor.body, neighbor.offset, everywhere, robot, goal);
        let (rate, limit) = (approach.range_rate, R::splat(self.max_deceleration));
        let stopping = rate * rate / (limit + limit);
        let margin = neighbor.distance - stopping;
        let square = (margin * margin).max(R::splat(LEAST_SQUARE));
        let strength = self.repulsive / square;
        let away = strength * (R::splat(1.0) - rate / limit);
        let around = -(strength * rate * approach.bearing_rate * neighbor.distance);
        // On the centre of an obstacle nothing has a direction.
        let apart = neighbor.distance.gt(R::zero());
        let (outward, zero) = (neighbor.outward, Vector2::zeros());
        Push {
            repulsive: Vector2::select(apart, outward * away, zero),
            detour: Vector2::select(apart, outward.left_normal() * around, zero),
        }
    }
}

impl Named for GeCui {
    const NAME: &'static str = "ge_cui";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            attractive: given.number("attractive_gain")?,
            repulsive: given.number("repulsive_gain")?,
            ratio: given.number("gain_ratio")?,
            // Every scenario brings the one of its robot.
            max_deceleration: f64::NAN,
        })
    }
}

impl PairwiseFamily for GeCui {
    type Field<R: Real> = GeCui<R>;
    const GAIN_NAMES: &'static [&'static str] =
        &["attractive_gain", "repulsive_gain", "gain_ratio"];
    const FREE_GAINS: &'static [usize] = &[0, 2];

    fn gains(&self) -> Vec<f64> {
        vec![self.attractive, self.repulsive, self.ratio]
    }

    #[inline(always)]
    fn with_gains<R: Real>(&self, gains: &[R], scenario: &Scenario) -> GeCui<R> {
        GeCui {
            attractive: gains[0],
            repulsive: gains[1],
            ratio: gains[2],
            max_deceleration: scenario.robot.deceleration(),
        }
    }
}
