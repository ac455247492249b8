//! Coverings that bottom out: laws of foam, shapes of contact, rate, unloading, backing.
//!
//! Force at compression `d` is `F(d) R U`: the columns of the law over the contact with the backing that
//! acts from `e_b T` on, a factor of the rate, and one of unloading.

mod gibson_ashby;
mod inverse;
mod material;
mod powers;
mod quadrature;
mod shape;
mod table;
#[cfg(test)]
mod tests;
mod work;

pub use gibson_ashby::GibsonAshby;
pub use material::Material;
pub use powers::{Powers, product};
pub(crate) use powers::{exponential_of, logarithm_of};
pub use shape::Shape;
pub use table::Table;

use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use shape::HalfOrders;
use smallvec::SmallVec;

/// Kinks of a law: mostly so few that a collision asks for no memory, which threads would wait for.
pub type Kinks = SmallVec<[f64; 8]>;

/// Argument in [0, infinity) at which a rising function from (0, 0) reaches a value.
#[must_use]
pub fn inverse_of(target: f64, function: impl Fn(f64) -> [f64; 2]) -> f64 {
    inverse::largest(target, f64::INFINITY, function)
}

/// Argument in [0, `bound`) at which a rising function from (0, 0) reaches a value.
#[must_use]
pub fn inverse_within(target: f64, bound: f64, function: impl Fn(f64) -> [f64; 2]) -> f64 {
    inverse::largest(target, bound, function)
}

/// Strain `e_b` at which a covering bottoms out by default.
pub const BOTTOMING_STRAIN: f64 = 0.8;
/// Stiffness `K_b` of the backing by default, in N/m.
pub const BACKING_STIFFNESS: f64 = 1e7;
/// Radii below this share of the thickness are edges, which columns side by side do not describe.
pub const EDGE: f64 = 0.2;

/// Factor `R(v) = (1 + v/(T e0))^n`, `n = a + b e`, for `v > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// `a`.
    pub base: f64,
    /// `b`.
    pub slope: f64,
    /// `e0`, in 1/s.
    pub reference: f64,
}

/// Factor `U = 1 - (1-H) (1 - (w(e)/w(e_max))^s)` below the largest strain so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unloading {
    /// `H`.
    pub retained: f64,
    /// `s`.
    pub exponent: f64,
}

/// Backing that acts from a strain on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bottoming {
    /// `e_b`.
    pub strain: f64,
    /// `K_b`, in N/m; 0: there is none.
    pub stiffness: f64,
}

/// Description of a covering.
#[derive(Clone, Debug, PartialEq)]
pub struct Covering {
    /// Law of the stress.
    pub material: Material,
    /// `T`, in m.
    pub thickness: f64,
    /// Shape of the contact.
    pub shape: Shape,
    /// `C_c`, in N s/m.
    pub damping: f64,
    /// Factor of the rate.
    pub rate: Rate,
    /// Factor of unloading.
    pub unloading: Unloading,
    /// Backing.
    pub bottoming: Bottoming,
}

impl Default for Rate {
    fn default() -> Self {
        Self {
            base: 0.0,
            slope: 0.0,
            reference: 1.0,
        }
    }
}

impl Default for Unloading {
    fn default() -> Self {
        Self {
            retained: 1.0,
            exponent: 1.0,
        }
    }
}

impl Default for Bottoming {
    fn default() -> Self {
        Self {
            strain: BOTTOMING_STRAIN,
            stiffness: BACKING_STIFFNESS,
        }
    }
}

impl Rate {
    /// Whether the force does not depend on the rate.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.base == 0.0 && self.slope == 0.0
    }

    fn check(&self) -> Result<()> {
        positive("rate.reference", self.reference)?;
        let at_ends = [self.base, self.base + self.slope];
        for (name, value) in ["rate.base", "rate.slope"].into_iter().zip(at_ends) {
            finite(name, value)?;
            if !(0.0..=1.0).contains(&value) {
                let rule =
                    "give an exponent n = base + slope e within [0, 1] for strains of 0 to 1; n";
                return Err(Failure::invalid(name, rule, Given::Number(value)));
            }
        }
        Ok(())
    }
}

impl Covering {
    /// The covering ready for use, if its numbers are possible.
    ///
    /// # Errors
    /// A number is out of its range, or the law falls.
    pub fn prepared(self) -> Result<Pad> {
        self.check_numbers()?;
        let until = self.bottoming.strain;
        let named = |failure: Failure| failure.within("material");
        let checked = self.material.clone().checked(until).map_err(named)?;
        Ok(Pad::new(Self {
            material: checked,
            ..self
        }))
    }

    /// Checks all but the law.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn check_numbers(&self) -> Result<()> {
        positive("thickness", self.thickness)?;
        self.shape.checked()?;
        not_negative("damping", self.damping)?;
        self.rate.check()?;
        let Unloading { retained, exponent } = self.unloading;
        if !(retained > 0.0 && retained <= 1.0) {
            let rule = "be above 0 and at most 1";
            return Err(Failure::invalid(
                "unloading.retained",
                rule,
                Given::Number(retained),
            ));
        }
        positive("unloading.exponent", exponent)?;
        let Bottoming { strain, stiffness } = self.bottoming;
        not_negative("bottoming.stiffness", stiffness)?;
        positive("bottoming.strain", strain)?;
        if stiffness > 0.0 && strain >= 1.0 {
            let rule = "be below 1 where there is a backing";
            return Err(Failure::invalid(
                "bottoming.strain",
                rule,
                Given::Number(strain),
            ));
        }
        Ok(())
    }
}

/// A covering with numbers that do not depend on its compression.
#[derive(Clone, Debug, PartialEq)]
pub struct Pad {
    /// Description of the covering.
    pub covering: Covering,
    scale: f64,
    halves: Option<HalfOrders>,
    powers: Option<Powers>,
    /// Compression at which the backing begins, infinite if there is none.
    bottom: f64,
}

impl Pad {
    /// The pad of a covering that has been checked.
    #[must_use]
    pub fn new(covering: Covering) -> Self {
        let halves = matches!(covering.shape, Shape::Cylinder { .. })
            .then(|| HalfOrders::new(&covering.material));
        let bottom = if covering.bottoming.stiffness > 0.0 {
            covering.bottoming.strain * covering.thickness
        } else {
            f64::INFINITY
        };
        let scale = covering.shape.scale(covering.thickness);
        let powers = match (&covering.shape, &halves) {
            (Shape::Cylinder { .. }, halves) => halves.as_ref().and_then(HalfOrders::sum),
            (Shape::Flat { .. }, _) => covering.material.powers(),
            (Shape::Curved { .. }, _) => covering.material.powers().map(Powers::integral),
        };
        Self {
            scale,
            powers: powers.map(|powers| powers.times(scale)),
            halves,
            bottom,
            covering,
        }
    }

    /// The pad in another thickness, in m.
    #[must_use]
    pub fn of_thickness(&self, thickness: f64) -> Self {
        Self::new(Covering {
            thickness,
            ..self.covering.clone()
        })
    }

    /// Compression that is never reached.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.covering.material.bound() * self.covering.thickness
    }

    /// Power of the compression with which the force starts.
    #[must_use]
    pub fn first_exponent(&self) -> f64 {
        let of_law = self.covering.material.first_exponent();
        match self.covering.shape {
            Shape::Flat { .. } => of_law,
            Shape::Cylinder { .. } => of_law + 0.5,
            Shape::Curved { .. } => of_law + 1.0,
        }
    }

    /// Compression at which the backing begins, infinite if there is none.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.bottom
    }

    /// Force `F(d)` and its slope.
    #[must_use]
    pub fn force(&self, compression: f64) -> [f64; 2] {
        let thickness = self.covering.thickness;
        self.columns(compression, compression / thickness, |slope| {
            slope / thickness
        })
    }

    /// Force `F(d)` and its slope from `1/T`.
    #[inline]
    #[must_use]
    pub fn force_by(&self, compression: f64, reciprocal: f64) -> [f64; 2] {
        self.columns(compression, compression * reciprocal, |slope| {
            slope * reciprocal
        })
    }

    /// Force and its slope at a compression that is some strain, from the slope over the strain.
    #[inline]
    fn columns(&self, compression: f64, strain: f64, slope_of: impl Fn(f64) -> f64) -> [f64; 2] {
        let Covering {
            material,
            shape,
            bottoming,
            ..
        } = &self.covering;
        let [value, slope] = match (shape, &self.halves) {
            (Shape::Cylinder { .. }, Some(halves)) if strain >= 0.0 => {
                halves.force(material, strain)
            }
            (Shape::Flat { .. }, _) => material.stress(strain),
            _ if strain >= 0.0 => [material.work(strain), material.stress(strain)[0]],
            _ => [0.0; 2],
        };
        let (mut value, mut slope) = (self.scale * value, slope_of(self.scale * slope));
        if compression > self.bottom {
            value += bottoming.stiffness * (compression - self.bottom);
            slope += bottoming.stiffness;
        }
        [value, slope]
    }

    /// The force as a sum of powers of the strain, as far as the onset of the backing, if it is one.
    #[must_use]
    pub fn powers(&self) -> Option<Powers> {
        self.powers
    }

    /// Largest compression at which the force is at most a value; `None` beyond the end of a table.
    #[must_use]
    pub fn compression_at(&self, force: f64) -> Option<f64> {
        let Covering {
            material,
            thickness,
            shape,
            ..
        } = &self.covering;
        if let Shape::Flat { .. } = shape {
            let strain = material.strain_at(force / self.scale);
            let free = strain.map(|strain| strain * thickness);
            match free {
                Some(compression) if compression <= self.bottom => return free,
                None if self.bottom.is_infinite() => return None,
                _ => (),
            }
        }
        let bound = self.bound();
        if material.is_measured() {
            let most = self.force(bound)[0];
            if force >= most {
                return (force == most).then_some(bound);
            }
        }
        let start = if matches!(shape, Shape::Flat { .. }) && self.bottom.is_finite() {
            self.bottom
        } else {
            0.0
        };
        if start > 0.0 {
            let [at_start, slope] = self.force(start);
            let steep = slope + self.covering.bottoming.stiffness;
            let from = (start, at_start, steep);
            let until = (material.last_kink() * thickness, bound);
            return Some(inverse::beyond(force, from, until, |d| self.force(d)));
        }
        Some(inverse::largest(force, bound, |d| self.force(d)))
    }

    /// Kinks of the force as compressions in order, the onset of the backing among them.
    #[must_use]
    pub fn kinks(&self) -> Kinks {
        let mut all = self.covering.material.kinks();
        for strain in &mut all {
            *strain *= self.covering.thickness;
        }
        if self.bottom.is_finite() {
            all.push(self.bottom);
        }
        numeric::order::sort_ascending(&mut all);
        all
    }

    /// Factor of the rate with its derivatives over rate and over strain; `speed` is not negative.
    #[must_use]
    pub fn rate_factor(&self, speed: f64, strain: f64) -> [f64; 3] {
        let Rate {
            base,
            slope,
            reference,
        } = self.covering.rate;
        let unit = self.covering.thickness * reference;
        let inner = 1.0 + speed / unit;
        let exponent = base + slope * strain;
        let logarithm = inner.ln();
        let factor = (exponent * logarithm).exp();
        [
            factor,
            exponent * factor / (unit * inner),
            slope * logarithm * factor,
        ]
    }

    /// Factor of unloading and its derivative over strain, below the largest strain, whose work is given.
    #[must_use]
    pub fn unloading_factor(&self, strain: f64, largest_work: f64) -> [f64; 2] {
        let Unloading { retained, exponent } = self.covering.unloading;
        let lost = 1.0 - retained;
        if strain <= 0.0 {
            return [retained, 0.0];
        }
        let ratio = self.covering.material.work(strain) / largest_work;
        let share = if exponent == 1.0 {
            ratio
        } else {
            ratio.powf(exponent)
        };
        let stress = self.covering.material.stress(strain)[0];
        let slope = lost * exponent * share / ratio * stress / largest_work;
        [1.0 - lost * (1.0 - share), slope]
    }
}
