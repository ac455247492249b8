//! The compared laws up to their gains.

use crate::pairwise::{Neighbor, PairwiseField, PairwiseLaw, Push};
use crate::{FieldTerms, LaneFamily, Law, LawFamily, Situation};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Result, not_negative};
use numeric::lanes::{Planar, Real, Vector2};

/// A field with its gains, by which it is known to a search.
pub trait PairwiseFamily: Copy + Send + Sync {
    /// The field for gain sets side by side.
    type Field<R: Real>: PairwiseField<R> + Into<AnyField<R>>;
    /// Words for the gains, in their order.
    const GAIN_NAMES: &'static [&'static str];
    /// Gains that act on a robot without obstacles, ascending.
    const FREE_GAINS: &'static [usize];
    /// Its own gains, in that order.
    fn gains(&self) -> Vec<f64>;
    /// The field with gains in one scenario.
    fn with_gains<R: Real>(&self, gains: &[R], scenario: &Scenario) -> Self::Field<R>;
}

/// A field as a family of laws.
#[derive(Clone, Copy, Debug)]
pub struct Pairwise<F>(pub F);

impl<F: Named> Named for Pairwise<F> {
    const NAME: &'static str = F::NAME;

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        F::made_of(given).map(Self)
    }
}

/// The fields, and one that is any of them: the time loop is compiled for it, once for all fields.
macro_rules! any_field {
    ($($module:ident::$field:ident),+ $(,)?) => {
        /// Any of the fields.
        #[derive(Clone, Copy, Debug)]
        pub enum AnyField<R> {
            $(#[doc = concat!("[`", stringify!($field), "`]")] $field(crate::$module::$field<R>)),+
        }

        $(impl<R> From<crate::$module::$field<R>> for AnyField<R> {
            #[inline(always)]
            fn from(field: crate::$module::$field<R>) -> Self {
                Self::$field(field)
            }
        })+

        impl<R: Real> PairwiseField<R> for AnyField<R> {
            #[inline(always)]
            fn attraction(
                &self,
                to_goal: Vector2<R>,
                velocity: Vector2<R>,
                inside: R::Mask,
            ) -> Vector2<R> {
                match self {
                    $(Self::$field(field) => field.attraction(to_goal, velocity, inside)),+
                }
            }

            #[inline(always)]
            fn push(
                &self,
                neighbor: &Neighbor<'_, R>,
                robot: &RobotState<R>,
            ) -> Push<R> {
                match self {
                    $(Self::$field(field) => field.push(neighbor, robot)),+
                }
            }
        }
    };
}
pairwise_laws!(any_field);

impl<F: PairwiseFamily> LawFamily for Pairwise<F> {
    fn gain_names(&self) -> &'static [&'static str] {
        F::GAIN_NAMES
    }

    fn gains(&self) -> Vec<f64> {
        self.0.gains()
    }

    fn free_gains(&self) -> &'static [usize] {
        F::FREE_GAINS
    }

    fn terms(&self, scenario: &Scenario, situation: &Situation<'_, f64>) -> Option<FieldTerms> {
        let field = self.0.with_gains::<f64>(&self.0.gains(), scenario);
        Some(PairwiseLaw::new(field, scenario).terms(situation))
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        for (name, gain) in F::GAIN_NAMES.iter().zip(gains) {
            not_negative(name, *gain)?;
        }
        Ok(())
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        Ok(Box::new(self.with_gains::<f64, false>(gains, scenario)?))
    }
}

impl<F: PairwiseFamily> LaneFamily for Pairwise<F> {
    type Law<R: Real, const RECORD: bool> = PairwiseLaw<R, AnyField<R>>;

    fn with_gains<R: Real, const RECORD: bool>(
        &self,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<Self::Law<R, RECORD>> {
        let field = self.0.with_gains(gains, scenario);
        Ok(PairwiseLaw::new(field.into(), scenario))
    }

    fn enter<R: Real, const RECORD: bool>(
        &self,
        law: &mut Self::Law<R, RECORD>,
        lane: usize,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<()> {
        law.field = self.0.with_gains(gains, scenario).into();
        law.goal.set_lane(lane, scenario.goal);
        Ok(())
    }
}
