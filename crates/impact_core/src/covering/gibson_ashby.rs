//! The law of elastic foams with a plateau after Gibson and Ashby.

use super::powers::{MOST_EXPONENT, raised, within};
use super::quadrature::unit_integral;
use crate::error::{Failure, Given, Result, finite, positive};

/// Exponents as near to 1 as this, but not 1, lose digits in the closed form.
const NEAR_ONE: f64 = 1e-3;

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

    /// Work and its integral up to the end of the plateau.
    fn works_before(&self, strain: f64) -> [f64; 2] {
        let start = self.yield_strain();
        let elastic = strain.min(start);
        let mut once = 0.5 * self.modulus * elastic * elastic;
        let mut twice = once * elastic / 3.0;
        if strain > start {
            let length = strain.min(self.plateau_end) - start;
            twice += length * (once + 0.5 * self.plateau * length);
            once += self.plateau * length;
        }
        [once, twice]
    }

    /// Work up to a strain.
    pub(super) fn work(&self, strain: f64) -> f64 {
        let [once, _] = self.works_before(strain);
        if strain > self.plateau_end {
            once + self.dense_work(strain)
        } else {
            once
        }
    }

    /// Integral of the work up to a strain.
    pub(super) fn work_integral(&self, strain: f64) -> f64 {
        let [once, twice] = self.works_before(strain);
        if strain > self.plateau_end {
            twice + (once * (strain - self.plateau_end) + self.dense_work_integral(strain))
        } else {
            twice
        }
    }

    /// Checks the ranges of its numbers.
    pub(super) fn check(&self) -> Result<()> {
        positive("modulus", self.modulus)?;
        positive("plateau", self.plateau)?;
        positive("lock", self.lock)?;
        within("lock", self.lock, 1.0)?;
        within("m", positive("m", self.m)?, MOST_EXPONENT)?;
        if finite("D", self.d)? <= 1.0 {
            return Err(Failure::invalid("D", "be above 1", Given::Number(self.d)));
        }
        let (start, end) = (self.yield_strain(), self.plateau_end());
        if start >= end {
            let rule =
                format!("give a strain of yield plateau/modulus below the plateau's end {end}");
            return Err(Failure::invalid("plateau", rule, Given::Number(start))
                .mended_by("a lower plateau or a higher modulus"));
        }
        Ok(())
    }
}

/// `expm1(a x)/a`, its limit `x` at `a = 0`.
fn growth(a: f64, x: f64) -> f64 {
    if a == 0.0 { x } else { (a * x).exp_m1() / a }
}
