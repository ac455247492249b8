//! Force of a covering over its compression: columns of the law side by side (Winkler foundation).
//!
//! A flat covering compresses every column alike, `F = A s(e)`. Under a paraboloid or a cylinder the
//! compression falls off as `d - s^2`, and the sum over the columns is a fractional integral of the law,
//!
//! ```text
//! F = c I^a s(e),  I^a s(e) = int_0^e (e - t)^(a-1) s(t) dt / Gamma(a)
//! flat       a = 0     c = A
//! cylinder   a = 1/2   c = l sqrt(2 pi R T)
//! paraboloid a = 1     c = 2 pi sqrt(R1 R2) T
//! ```
//!
//! so that `F' = c/T I^(a-1) s` and the stored energy is `c T I^(a+1) s`.

use std::f64::consts::PI;

use super::material::Material;
use super::powers::{Powers, power};
use super::quadrature::integral_between_poles;
use crate::error::{Result, positive};

/// `1/Gamma(5/2)`.
const RAMP: f64 = 0.752_252_778_063_675;

/// Shape of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Flat.
    Flat {
        /// `A`, in m^2.
        area: f64,
    },
    /// A paraboloid gap.
    Curved {
        /// `R1` and `R2`, in m.
        radii: [f64; 2],
    },
    /// A cylinder that lies on the surface.
    Cylinder {
        /// `R`, in m.
        radius: f64,
        /// `l`, in m.
        length: f64,
    },
}

impl Shape {
    /// The shape if its numbers are possible.
    ///
    /// # Errors
    /// A number is not positive.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Flat { area } => drop(positive("area", area)?),
            Self::Curved { radii } => {
                positive("radius", radii[0])?;
                positive("second_radius", radii[1])?;
            }
            Self::Cylinder { radius, length } => {
                positive("radius", radius)?;
                positive("length", length)?;
            }
        }
        Ok(self)
    }

    /// Factor `c` of the force.
    #[must_use]
    pub fn scale(&self, thickness: f64) -> f64 {
        match *self {
            Self::Flat { area } => area,
            Self::Curved { radii } => 2.0 * PI * (radii[0] * radii[1]).sqrt() * thickness,
            Self::Cylinder { radius, length } => length * (2.0 * PI * radius * thickness).sqrt(),
        }
    }

    /// Half-widths `sqrt(2 R d)` of the contact at a compression; `None` for a flat one.
    #[must_use]
    pub fn half_widths(&self, compression: f64) -> Option<[f64; 2]> {
        let width = |radius: f64| (2.0 * radius * compression).sqrt();
        match *self {
            Self::Flat { .. } => None,
            Self::Curved { radii } => Some(radii.map(width)),
            Self::Cylinder { radius, .. } => Some([width(radius); 2]),
        }
    }
}

/// A part of the law that is a power from an origin on, half an order further.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Power {
    factor: f64,
    origin: f64,
    exponent: f64,
}

/// Fractional integrals of a law, of half orders.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfOrders {
    powers: Vec<Power>,
    /// The rest of the law, as far as it is no sum of powers, and where it begins.
    rest: Option<f64>,
}

impl HalfOrders {
    /// Fractional integrals of a law, as far as they do not depend on the strain.
    #[must_use]
    pub fn new(material: &Material) -> Self {
        let ramp = |slope: f64, origin: f64| Power {
            factor: slope * RAMP,
            origin,
            exponent: 1.5,
        };
        let (powers, rest) = match material {
            Material::Linear { modulus } => (vec![ramp(*modulus, 0.0)], None),
            Material::GibsonAshby(law) => (
                vec![
                    ramp(law.modulus, 0.0),
                    ramp(-law.modulus, law.yield_strain()),
                ],
                Some(law.plateau_end()),
            ),
            Material::Rusch { a, p, b, q } => {
                let of = |factor: f64, exponent: f64| Power {
                    factor: factor * libm::tgamma(exponent + 1.0) / libm::tgamma(exponent + 1.5),
                    origin: 0.0,
                    exponent: exponent + 0.5,
                };
                (vec![of(*a, *p), of(*b, *q)], None)
            }
            Material::Avalle { .. } => (Vec::new(), Some(0.0)),
            Material::Table(table) => {
                let mut before = 0.0;
                let bends = table.slopes().map(|(origin, slope)| {
                    let bend = ramp(slope - before, origin);
                    before = slope;
                    bend
                });
                (bends.collect(), None)
            }
        };
        Self { powers, rest }
    }

    /// Order 1/2 as a sum of powers of the strain, if it is one.
    #[must_use]
    pub fn sum(&self) -> Option<Powers> {
        let from_zero = self.rest.is_none() && self.powers.iter().all(|part| part.origin == 0.0);
        let (first, more) = self.powers.split_first().filter(|_| from_zero)?;
        let none = Power {
            factor: 0.0,
            ..*first
        };
        let second = match more {
            [] => &none,
            [second] => second,
            _ => return None,
        };
        Some(Powers {
            factors: [first.factor, second.factor],
            exponents: [first.exponent, second.exponent],
        })
    }

    /// Orders 1/2 and -1/2 at a strain.
    #[must_use]
    pub fn force(&self, material: &Material, strain: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for part in &self.powers {
            if strain >= part.origin {
                let [value, slope] = power(part.factor, part.exponent, strain - part.origin);
                sum[0] += value;
                sum[1] += slope;
            }
        }
        if let Some(origin) = self.rest
            && strain > origin
        {
            // int_0^sqrt(x) h(x - u^2) du with u = sqrt(x) (1 - y).
            let length = strain - origin;
            let scale = 2.0 * (length / PI).sqrt();
            let gap = pole(material, strain, length);
            for (index, entry) in sum.iter_mut().enumerate() {
                let column = |y: f64| rest(material, origin + length * y * (2.0 - y))[index];
                *entry += scale * integral_between_poles(gap, column);
            }
        }
        sum
    }

    /// Order 3/2 at a strain.
    #[must_use]
    pub fn work(&self, material: &Material, strain: f64) -> f64 {
        let mut sum = 0.0;
        for part in &self.powers {
            if strain > part.origin {
                let x = strain - part.origin;
                sum += power(part.factor, part.exponent, x)[0] * x / (part.exponent + 1.0);
            }
        }
        if let Some(origin) = self.rest
            && strain > origin
        {
            let length = strain - origin;
            let column = |y: f64| {
                let left = 1.0 - y;
                left * left * rest(material, origin + length * y * (2.0 - y))[0]
            };
            let gap = pole(material, strain, length);
            let scale = 4.0 * length * (length / PI).sqrt();
            sum += scale * integral_between_poles(gap, column);
        }
        sum
    }
}

/// How far beside 1 the law is infinite at a complex `y`: `strain - length (1 - y)^2` is its bound.
fn pole(material: &Material, strain: f64, length: f64) -> f64 {
    ((material.bound() - strain) / length).sqrt()
}

/// Stress of a law beyond that of its powers, and its slope.
fn rest(material: &Material, strain: f64) -> [f64; 2] {
    match material {
        Material::GibsonAshby(law) => {
            let [stress, slope] = law.dense(strain);
            [stress - law.plateau, slope]
        }
        other => other.stress(strain),
    }
}
