//! Laws of compressive stress over strain, with their integrals.
//!
//! Named after the literature; `e` is compression over thickness. The work `w(e)` is the integral
//! of the stress, `w2(e)` that of the work: a flat covering needs the first, a curved one both.

use std::sync::Arc;

use super::quadrature::unit_integral;
use super::table::Table;
use crate::error::{Failure, Given, Result, finite, not_negative, positive};

/// Largest exponent of a law: beyond it stresses are no numbers any more.
const MOST_EXPONENT: f64 = 100.0;
/// Largest whole exponent that is a product.
const MOST_PRODUCTS: u32 = 8;
/// Strains at which a law is asked whether it falls.
const LOOKS: usize = 2000;
/// Exponents as near to 1 as this, but not 1, lose digits in the closed form.
const NEAR_ONE: f64 = 1e-3;

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

/// `E e` up to `e_y = s_p/E`, the plateau `s_p` up to `e_p = e_D (1 - D^(-1/m))`, then
/// `s_p/D (e_D/(e_D - e))^m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GibsonAshby {
    /// `E`, in Pa.
    pub modulus: f64,
    /// `s_p`, in Pa.
    pub plateau: f64,
    /// `e_D`.
    pub lock: f64,
    /// `D`.
    pub d: f64,
    /// `m`.
    pub m: f64,
    plateau_end: f64,
    /// `s_p/D e_D^m (e_D - e_p)^(1-m)`, in Pa.
    dense_scale: f64,
}

impl GibsonAshby {
    /// Strain `e_y` at which the plateau starts.
    #[must_use]
    pub fn yield_strain(&self) -> f64 {
        self.plateau / self.modulus
    }

    /// A law from its numbers: `E` and `s_p` in Pa, `e_D`, `D`, `m`.
    #[must_use]
    pub fn new([modulus, plateau, lock, d, m]: [f64; 5]) -> Self {
        let share = if m == 1.0 { 1.0 / d } else { d.powf(-1.0 / m) };
        let plateau_end = lock * (1.0 - share);
        let first = lock - plateau_end;
        let rest = if m == 1.0 { 1.0 } else { first.powf(1.0 - m) };
        Self {
            modulus,
            plateau,
            lock,
            d,
            m,
            plateau_end,
            dense_scale: plateau / d * raised(lock, m) * rest,
        }
    }

    /// Strain `e_p` at which the plateau ends.
    #[must_use]
    pub fn plateau_end(&self) -> f64 {
        self.plateau_end
    }

    /// Stress of densification, and its slope.
    #[must_use]
    pub fn dense(&self, strain: f64) -> [f64; 2] {
        let left = self.lock - strain;
        let stress = self.plateau / self.d * raised(self.lock / left, self.m);
        [stress, self.m * stress / left]
    }

    /// Logarithm of the share that the strain has left of what was left at `e_p`.
    fn length(&self, strain: f64) -> f64 {
        ((self.lock - self.plateau_end) / (self.lock - strain)).ln()
    }

    /// Work above `e_p`, without what the strain before it adds.
    fn dense_work(&self, strain: f64) -> f64 {
        // With r = e_D - e = first exp(-l): int r^-m = first^(1-m) expm1((m-1) l)/(m-1).
        self.dense_scale * growth(self.m - 1.0, self.length(strain))
    }

    /// Integral of the work above `e_p`, without what the strain before it adds.
    fn dense_work_integral(&self, strain: f64) -> f64 {
        let (m, length) = (self.m, self.length(strain));
        let twice = if (m - 1.0).abs() < NEAR_ONE && m != 1.0 {
            length * unit_integral(|y| growth(m - 1.0, y * length) * (-y * length).exp())
        } else if m == 1.0 {
            // int l exp(-l) = 1 - exp(-l) (1 + l).
            -(-length).exp_m1() - length * (-length).exp()
        } else {
            (growth(m - 2.0, length) + (-length).exp_m1()) / (m - 1.0)
        };
        self.dense_scale * (self.lock - self.plateau_end) * twice
    }
}

/// `expm1(a x)/a`, its limit `x` at `a = 0`.
fn growth(a: f64, x: f64) -> f64 {
    if a == 0.0 { x } else { (a * x).exp_m1() / a }
}

impl Material {
    /// The law if its numbers are possible and it does not fall before a strain.
    ///
    /// # Errors
    /// A number is out of its range, or the stress falls.
    pub fn checked(self, until: f64) -> Result<Self> {
        match &self {
            Self::Linear { modulus } => drop(positive("modulus", *modulus)?),
            Self::GibsonAshby(law) => check_gibson(law)?,
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
                let [first, first_slope] = power(*a, *p, strain);
                let [second, second_slope] = power(*b, *q, strain);
                [first + second, first_slope + second_slope]
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
            Self::GibsonAshby(law) => gibson_work(law, strain),
            Self::Rusch { a, p, b, q } => {
                strain
                    * (power(*a, *p, strain)[0] / (p + 1.0) + power(*b, *q, strain)[0] / (q + 1.0))
            }
            Self::Avalle { .. } => strain * unit_integral(|y| self.stress(strain * y)[0]),
            Self::Table(table) => table.works(strain)[0],
        }
    }

    /// Work, stress and slope of the stress, for less than each for itself.
    #[must_use]
    pub fn work_and_stress(&self, strain: f64) -> [f64; 3] {
        if let Self::Rusch { a, p, b, q } = self
            && strain > 0.0
        {
            let [first, first_slope] = power(*a, *p, strain);
            let [second, second_slope] = power(*b, *q, strain);
            return [
                strain * (first / (p + 1.0) + second / (q + 1.0)),
                first + second,
                first_slope + second_slope,
            ];
        }
        let [stress, slope] = self.stress(strain);
        [self.work(strain), stress, slope]
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
            Self::GibsonAshby(law) => gibson_work_integral(law, strain),
            Self::Rusch { a, p, b, q } => {
                let part = |factor, exponent: f64| {
                    power(factor, exponent, strain)[0] / ((exponent + 1.0) * (exponent + 2.0))
                };
                square * (part(*a, *p) + part(*b, *q))
            }
            Self::Avalle { .. } => {
                square * unit_integral(|y| (1.0 - y) * self.stress(strain * y)[0])
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
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Linear { .. } | Self::Rusch { .. } | Self::Avalle { .. } => Vec::new(),
            Self::GibsonAshby(law) => vec![law.yield_strain(), law.plateau_end()],
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

/// `x^exponent`, without logarithms where the exponent is a whole number or a half more than one, up to 8.
fn raised(x: f64, exponent: f64) -> f64 {
    if exponent == 1.0 {
        return x;
    }
    // Saturates; what is too large is no product.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = exponent as u32;
    let rest = exponent - f64::from(whole);
    if whole > MOST_PRODUCTS || !(rest == 0.0 || rest == 0.5) {
        return x.powf(exponent);
    }
    let product = product(x, whole);
    if rest == 0.0 {
        product
    } else {
        product * x.sqrt()
    }
}

/// `x^count` by squares.
fn product(x: f64, count: u32) -> f64 {
    let (mut result, mut square, mut left) = (1.0, x, count);
    while left > 0 {
        if left % 2 == 1 {
            result *= square;
        }
        square *= square;
        left /= 2;
    }
    result
}

/// `factor x^exponent` and its slope.
pub(super) fn power(factor: f64, exponent: f64, x: f64) -> [f64; 2] {
    if factor == 0.0 {
        return [0.0; 2];
    }
    if exponent == 1.0 {
        return [factor * x, factor];
    }
    let value = factor * raised(x, exponent);
    if x == 0.0 {
        let slope = if exponent < 1.0 { f64::INFINITY } else { 0.0 };
        return [value, slope];
    }
    [value, exponent * value / x]
}

/// Work and its integral up to the end of the plateau.
fn gibson_works_before(law: &GibsonAshby, strain: f64) -> [f64; 2] {
    let start = law.yield_strain();
    let elastic = strain.min(start);
    let mut once = 0.5 * law.modulus * elastic * elastic;
    let mut twice = once * elastic / 3.0;
    if strain > start {
        let length = strain.min(law.plateau_end) - start;
        twice += length * (once + 0.5 * law.plateau * length);
        once += law.plateau * length;
    }
    [once, twice]
}

fn gibson_work(law: &GibsonAshby, strain: f64) -> f64 {
    let [once, _] = gibson_works_before(law, strain);
    if strain > law.plateau_end {
        once + law.dense_work(strain)
    } else {
        once
    }
}

fn gibson_work_integral(law: &GibsonAshby, strain: f64) -> f64 {
    let [once, twice] = gibson_works_before(law, strain);
    if strain > law.plateau_end {
        twice + (once * (strain - law.plateau_end) + law.dense_work_integral(strain))
    } else {
        twice
    }
}

fn within(name: &str, value: f64, most: f64) -> Result<f64> {
    if value <= most {
        Ok(value)
    } else {
        let rule = format!("be at most {most}");
        Err(Failure::invalid(name, rule, Given::Number(value)))
    }
}

fn check_gibson(law: &GibsonAshby) -> Result<()> {
    positive("modulus", law.modulus)?;
    positive("plateau", law.plateau)?;
    positive("lock", law.lock)?;
    within("lock", law.lock, 1.0)?;
    within("m", positive("m", law.m)?, MOST_EXPONENT)?;
    if finite("D", law.d)? <= 1.0 {
        return Err(Failure::invalid("D", "be above 1", Given::Number(law.d)));
    }
    let (start, end) = (law.yield_strain(), law.plateau_end());
    if start >= end {
        let rule = format!("give a strain of yield plateau/modulus below the plateau's end {end}");
        return Err(Failure::invalid("plateau", rule, Given::Number(start))
            .mended_by("a lower plateau or a higher modulus"));
    }
    Ok(())
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
