//! Laws of compressive stress over strain, with their integrals.
//!
//! Named after the literature; `e` is compression over thickness. The work `w(e)` is the integral
//! of the stress, `w2(e)` that of the work: a flat covering needs the first, a curved one both.

use std::sync::Arc;

use super::Kinks;
use super::gibson_ashby::GibsonAshby;
use super::powers::{MOST_EXPONENT, Powers, power, powers, raised, within};
use super::quadrature::integral_before_pole;
use super::table::Table;
use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use numeric::lanes::{Real, Truth, each};

/// Strains at which a law is asked whether it falls.
const LOOKS: usize = 2000;

/// Stress over strain.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// `E e`.
    Linear {
        /// `E`, in Pa.
        modulus: f64,
    },
    /// Elastic, plateau, densification.
    GibsonAshby(GibsonAshby),
    /// `a e^p + b e^q`, `0 < p <= 1 < q`.
    Rusch {
        /// `a`, in Pa.
        a: f64,
        /// `p`.
        p: f64,
        /// `b`, in Pa.
        b: f64,
        /// `q`.
        q: f64,
    },
    /// `A (1 - exp(-(E/A) e (1-e)^m)) + B (e/(1-e))^n`.
    Avalle {
        /// `A`, in Pa.
        plateau: f64,
        /// `E`, in Pa.
        modulus: f64,
        /// `m`.
        m: f64,
        /// `B`, in Pa.
        b: f64,
        /// `n`.
        n: f64,
    },
    /// Measured points.
    Table(Arc<Table>),
}

impl Material {
    /// The law if its numbers are possible and it does not fall before a strain.
    ///
    /// # Errors
    /// A number is out of its range, or the stress falls.
    pub fn checked(self, until: f64) -> Result<Self> {
        match &self {
            Self::Linear { modulus } => drop(positive("modulus", *modulus)?),
            Self::GibsonAshby(law) => law.check()?,
            Self::Rusch { a, p, b, q } => check_rusch([*a, *p, *b, *q])?,
            Self::Avalle {
                plateau,
                modulus,
                m,
                b,
                n,
            } => {
                positive("plateau", *plateau)?;
                positive("modulus", *modulus)?;
                within("m", not_negative("m", *m)?, MOST_EXPONENT)?;
                not_negative("B", *b)?;
                within("n", positive("n", *n)?, MOST_EXPONENT)?;
                self.check_rising(until)?;
            }
            Self::Table(_) => (),
        }
        Ok(self)
    }

    fn check_rising(&self, until: f64) -> Result<()> {
        let most = until.min(0.999);
        for index in 1..=LOOKS {
            let strain = most * index as f64 / LOOKS as f64;
            let [stress, slope] = self.stress(strain);
            if slope < -1e-12 * stress {
                let rule = format!(
                    "give a stress that falls nowhere up to a strain of {most}; this law falls at"
                );
                return Err(Failure::invalid("law", rule, Given::Number(strain)));
            }
        }
        Ok(())
    }

    /// Strain that is never reached; infinite if there is none.
    #[must_use]
    pub fn bound(&self) -> f64 {
        match self {
            Self::Linear { .. } | Self::Rusch { .. } => f64::INFINITY,
            Self::GibsonAshby(law) => law.lock,
            Self::Avalle { .. } => 1.0,
            Self::Table(table) => table.end(),
        }
    }

    /// Power of the strain with which the stress starts.
    #[must_use]
    pub fn first_exponent(&self) -> f64 {
        match self {
            Self::Rusch { a, p, q, .. } => {
                if *a > 0.0 {
                    *p
                } else {
                    *q
                }
            }
            Self::Avalle { b, n, .. } if *b > 0.0 => n.min(1.0),
            _ => 1.0,
        }
    }

    /// Whether the law ends at its bound, rather than to rise without limit before it.
    #[must_use]
    pub fn is_measured(&self) -> bool {
        matches!(self, Self::Table(_))
    }

    /// The stress as a sum of powers of the strain, if it is one.
    #[must_use]
    pub fn powers(&self) -> Option<Powers> {
        let (factors, exponents) = match *self {
            Self::Linear { modulus } => ([modulus, 0.0], [1.0; 2]),
            Self::Rusch { a, p, b, q } => ([a, b], [p, q]),
            _ => return None,
        };
        Some(Powers { factors, exponents })
    }

    /// Stress and its slope.
    #[must_use]
    pub fn stress(&self, strain: f64) -> [f64; 2] {
        if strain < 0.0 {
            return [0.0, self.stress(0.0)[1]];
        }
        match self {
            Self::Linear { modulus } => [modulus * strain, *modulus],
            Self::GibsonAshby(law) => {
                if strain * law.modulus < law.plateau {
                    [law.modulus * strain, law.modulus]
                } else if strain <= law.plateau_end() {
                    [law.plateau, 0.0]
                } else {
                    law.dense(strain)
                }
            }
            Self::Rusch { a, p, b, q } => {
                let [_, stress, slope] = rusch([*a, *b], [*p, *q], strain);
                [stress, slope]
            }
            Self::Avalle {
                plateau,
                modulus,
                m,
                b,
                n,
            } => {
                let left = 1.0 - strain;
                let falling = if *m == 0.0 { 1.0 } else { left.powf(*m) };
                // 1 - exp loses every digit at small strains.
                let risen = -(-modulus / plateau * strain * falling).exp_m1();
                let inner = modulus * falling * (1.0 - m * strain / left);
                let [dense, slope] = power(*b, *n, strain / left);
                [
                    plateau * risen + dense,
                    inner * (1.0 - risen) + slope / (left * left),
                ]
            }
            Self::Table(table) => table.stress(strain),
        }
    }

    /// Work `w`, the integral of the stress.
    #[must_use]
    pub fn work(&self, strain: f64) -> f64 {
        if strain <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Linear { modulus } => 0.5 * modulus * strain * strain,
            Self::GibsonAshby(law) => law.work(strain),
            Self::Rusch { a, p, b, q } => rusch([*a, *b], [*p, *q], strain)[0],
            Self::Avalle { .. } => {
                strain * integral_before_pole(1.0 / strain - 1.0, |y| self.stress(strain * y)[0])
            }
            Self::Table(table) => table.works(strain)[0],
        }
    }

    /// Work of strains side by side.
    #[inline(always)]
    #[must_use]
    pub fn works<R: Real>(&self, strain: R) -> R {
        if let Self::Rusch { a, p, b, q } = self
            && !strain.le(R::zero()).any()
        {
            return rusch([*a, *b], [*p, *q], strain)[0];
        }
        R::from_fn(|lane| self.work(strain.lane(lane)))
    }

    /// Work, stress and slope of the stress of strains side by side, for less than each for itself.
    #[inline(always)]
    #[must_use]
    pub fn work_and_stress<R: Real>(&self, strain: R) -> [R; 3] {
        if let Self::Rusch { a, p, b, q } = self
            && !strain.le(R::zero()).any()
        {
            return rusch([*a, *b], [*p, *q], strain);
        }
        each(strain, |strain| {
            let [stress, slope] = self.stress(strain);
            [self.work(strain), stress, slope]
        })
    }

    /// Integral `w2` of the work.
    #[must_use]
    pub fn work_integral(&self, strain: f64) -> f64 {
        if strain <= 0.0 {
            return 0.0;
        }
        let square = strain * strain;
        match self {
            Self::Linear { modulus } => modulus * square * strain / 6.0,
            Self::GibsonAshby(law) => law.work_integral(strain),
            Self::Rusch { a, p, b, q } => {
                let part = |[value, _]: [f64; 2], exponent: f64| {
                    value / ((exponent + 1.0) * (exponent + 2.0))
                };
                let [first, second] = powers([*a, *b], [*p, *q], strain);
                square * (part(first, *p) + part(second, *q))
            }
            Self::Avalle { .. } => {
                let column = |y: f64| (1.0 - y) * self.stress(strain * y)[0];
                square * integral_before_pole(1.0 / strain - 1.0, column)
            }
            Self::Table(table) => table.works(strain)[1],
        }
    }

    /// Largest strain whose stress is at most a value, `None` beyond the end of a table.
    #[must_use]
    pub fn strain_at(&self, stress: f64) -> Option<f64> {
        match self {
            Self::Linear { modulus } => Some(stress / modulus),
            Self::GibsonAshby(law) => Some(if stress < law.plateau {
                stress / law.modulus
            } else {
                // Rounding must not fall short of the plateau's end.
                let ratio = law.plateau / (law.d * stress);
                let strain = law.lock * (1.0 - raised(ratio, 1.0 / law.m));
                strain.max(law.plateau_end())
            }),
            Self::Rusch { a, p, b, .. } if *b == 0.0 => Some((stress / a).powf(1.0 / p)),
            Self::Rusch { .. } | Self::Avalle { .. } => {
                let found =
                    super::inverse::largest(stress, self.bound(), |strain| self.stress(strain));
                Some(found)
            }
            Self::Table(table) => table.strain_at(stress),
        }
    }

    /// Strains at which the law has a kink, in order.
    #[must_use]
    pub fn kinks(&self) -> Kinks {
        match self {
            Self::Linear { .. } | Self::Rusch { .. } | Self::Avalle { .. } => Kinks::new(),
            Self::GibsonAshby(law) => Kinks::from_slice(&[law.yield_strain(), law.plateau_end()]),
            Self::Table(table) => table.kinks(),
        }
    }

    /// Strain beyond which the law has no kink.
    #[must_use]
    pub fn last_kink(&self) -> f64 {
        match self {
            Self::Linear { .. } | Self::Rusch { .. } | Self::Avalle { .. } => 0.0,
            Self::GibsonAshby(law) => law.plateau_end(),
            Self::Table(table) => table.end(),
        }
    }
}

/// Work, stress and slope of a sum of two powers.
#[inline(always)]
fn rusch<R: Real>(factors: [f64; 2], exponents: [f64; 2], strain: R) -> [R; 3] {
    Powers { factors, exponents }.works(strain)
}

fn check_rusch([a, p, b, q]: [f64; 4]) -> Result<()> {
    not_negative("a", a)?;
    not_negative("b", b)?;
    if a == 0.0 && b == 0.0 {
        let rule = "not be 0 where a is 0 as well";
        return Err(Failure::invalid("b", rule, Given::Number(b)));
    }
    if !(p > 0.0 && p <= 1.0) {
        let rule = "be above 0 and at most 1";
        return Err(Failure::invalid("p", rule, Given::Number(p)));
    }
    if finite("q", q)? <= 1.0 {
        return Err(Failure::invalid("q", "be above 1", Given::Number(q)));
    }
    within("q", q, MOST_EXPONENT)?;
    Ok(())
}
