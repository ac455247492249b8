//! A region of the body: a spring without mass.

use numeric::lanes::{Real, each};

use crate::covering;
use crate::error::{Failure, Given, Result, not_negative, positive};

/// Force over the deflection of a region of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// It does not yield.
    Rigid,
    /// `k x + k3 x^3`.
    Spring {
        /// `k`, in N/m.
        stiffness: f64,
        /// `k3`, in N/m^3.
        cubic: f64,
    },
    /// `k x^n`.
    Power {
        /// `k`, in N/m^n.
        stiffness: f64,
        /// `n`.
        exponent: f64,
    },
}

impl Region {
    /// The region if its numbers are possible.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Rigid => (),
            Self::Spring { stiffness, cubic } => {
                positive("region.k", stiffness)?;
                not_negative("region.k3", cubic)?;
            }
            Self::Power {
                stiffness,
                exponent,
            } => {
                positive("region.k", stiffness)?;
                if !(exponent > 0.0 && exponent <= 10.0) {
                    let rule = "be above 0 and at most 10";
                    return Err(Failure::invalid("region.n", rule, Given::Number(exponent)));
                }
            }
        }
        Ok(self)
    }

    /// Force at deflections side by side, and its slope.
    #[inline(always)]
    #[must_use]
    pub fn force<R: Real>(&self, deflection: R) -> [R; 2] {
        match *self {
            Self::Rigid => [R::zero(), R::splat(f64::INFINITY)],
            Self::Spring { stiffness, cubic } => {
                let stiffness = R::splat(stiffness);
                let more = R::splat(cubic) * deflection * deflection;
                let slope = stiffness + R::splat(3.0) * more;
                [(stiffness + more) * deflection, slope]
            }
            Self::Power {
                stiffness,
                exponent,
            } => each(deflection, |deflection| {
                if deflection <= 0.0 {
                    let slope = stiffness * exponent * 0.0_f64.powf(exponent - 1.0);
                    return [0.0, slope];
                }
                let force = stiffness * deflection.powf(exponent);
                [force, exponent * force / deflection]
            }),
        }
    }

    /// Deflection under forces side by side.
    #[inline(always)]
    #[must_use]
    pub fn deflection<R: Real>(&self, force: R) -> R {
        match *self {
            Self::Rigid => R::zero(),
            Self::Spring {
                stiffness,
                cubic: 0.0,
            } => force / R::splat(stiffness),
            Self::Spring { .. } => {
                let of = |lane| covering::inverse_of(force.lane(lane), |x| self.force(x));
                R::from_fn(of)
            }
            Self::Power {
                stiffness,
                exponent,
            } => R::from_fn(|lane| (force.lane(lane) / stiffness).powf(1.0 / exponent)),
        }
    }

    /// Work that is stored at deflections side by side.
    #[inline(always)]
    #[must_use]
    pub fn stored<R: Real>(&self, deflection: R) -> R {
        match *self {
            Self::Rigid => R::zero(),
            Self::Spring { stiffness, cubic } => {
                let square = deflection * deflection;
                square * (R::splat(0.5 * stiffness) + R::splat(0.25 * cubic) * square)
            }
            Self::Power { exponent, .. } => {
                self.force(deflection)[0] * deflection / R::splat(exponent + 1.0)
            }
        }
    }

    /// Work that is stored under a force.
    #[must_use]
    pub fn work(&self, force: f64) -> f64 {
        match *self {
            Self::Rigid => 0.0,
            Self::Spring {
                stiffness,
                cubic: 0.0,
            } => 0.5 * force * force / stiffness,
            Self::Spring { .. } => self.stored(self.deflection(force)),
            Self::Power { exponent, .. } => force * self.deflection(force) / (exponent + 1.0),
        }
    }
}
