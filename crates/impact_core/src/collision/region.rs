//! A region of the body: a spring without mass.

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

    /// Force at a deflection, and its slope.
    #[must_use]
    pub fn force(&self, deflection: f64) -> [f64; 2] {
        match *self {
            Self::Rigid => [0.0, f64::INFINITY],
            Self::Spring { stiffness, cubic } => {
                let more = cubic * deflection * deflection;
                [(stiffness + more) * deflection, stiffness + 3.0 * more]
            }
            Self::Power {
                stiffness,
                exponent,
            } => {
                if deflection <= 0.0 {
                    let slope = stiffness * exponent * 0.0_f64.powf(exponent - 1.0);
                    return [0.0, slope];
                }
                let force = stiffness * deflection.powf(exponent);
                [force, exponent * force / deflection]
            }
        }
    }

    /// Deflection under a force.
    #[must_use]
    pub fn deflection(&self, force: f64) -> f64 {
        match *self {
            Self::Rigid => 0.0,
            Self::Spring {
                stiffness,
                cubic: 0.0,
            } => force / stiffness,
            Self::Spring { .. } => covering::inverse_of(force, |x| self.force(x)),
            Self::Power {
                stiffness,
                exponent,
            } => (force / stiffness).powf(1.0 / exponent),
        }
    }

    /// Work that is stored at a deflection.
    #[must_use]
    pub fn stored(&self, deflection: f64) -> f64 {
        match *self {
            Self::Rigid => 0.0,
            Self::Spring { stiffness, cubic } => {
                let square = deflection * deflection;
                square * (0.5 * stiffness + 0.25 * cubic * square)
            }
            Self::Power { exponent, .. } => {
                self.force(deflection)[0] * deflection / (exponent + 1.0)
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
