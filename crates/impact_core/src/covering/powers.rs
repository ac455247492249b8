//! Powers of strains.

use crate::error::{Failure, Given, Result};
use numeric::elementary::{exp, logarithm};
use numeric::lanes::Real;

/// Largest exponent of a law: beyond it stresses are no numbers any more.
pub(super) const MOST_EXPONENT: f64 = 100.0;
/// Largest whole exponent that is a product.
const MOST_PRODUCTS: u32 = 8;

/// Whole number of an exponent that needs no logarithm, up to 8, and whether it is a half more.
#[inline(always)]
fn products_of(exponent: f64) -> Option<(u32, bool)> {
    // Saturates; what is too large is no product.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = exponent as u32;
    let rest = exponent - f64::from(whole);
    (whole <= MOST_PRODUCTS && (rest == 0.0 || rest == 0.5)).then_some((whole, rest == 0.5))
}

/// `x^whole`, or `x^(whole + 1/2)`.
#[inline(always)]
fn by_products<R: Real>(x: R, (whole, half): (u32, bool)) -> R {
    if whole == 1 && !half {
        return x;
    }
    let product = product(x, whole);
    if half { product * x.sqrt() } else { product }
}

/// `x^exponent`.
pub(super) fn raised(x: f64, exponent: f64) -> f64 {
    match products_of(exponent) {
        Some(products) => by_products(x, products),
        None => x.powf(exponent),
    }
}

/// `x^count` by squares.
#[inline(always)]
pub fn product<R: Real>(x: R, count: u32) -> R {
    let (mut result, mut square, mut left) = (R::splat(1.0), x, count);
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
    sloped([factor, exponent], x, raised(x, exponent))
}

/// `factor x^exponent` and its slope from `power = x^exponent`.
#[inline(always)]
fn sloped<R: Real>([factor, exponent]: [f64; 2], x: R, power: R) -> [R; 2] {
    if exponent == 1.0 {
        return [x * R::splat(factor), R::splat(factor)];
    }
    let value = power * R::splat(factor);
    let at_zero = if exponent < 1.0 { f64::INFINITY } else { 0.0 };
    let slope = value * R::splat(exponent) / x;
    [value, R::select(x.le(R::zero()), R::splat(at_zero), slope)]
}

/// Two powers with factors and their slopes; those that are no products share the logarithm of `x`, which is not
/// negative.
#[inline(always)]
pub(super) fn powers<R: Real>(factors: [f64; 2], exponents: [f64; 2], x: R) -> [[R; 2]; 2] {
    let products = exponents.map(products_of);
    let logarithm = shared_logarithm(products, x);
    // Written out: what a closure does is not compiled for the instructions of the caller.
    let first = [factors[0], exponents[0]];
    let second = [factors[1], exponents[1]];
    [
        one_of(first, products[0], x, logarithm),
        one_of(second, products[1], x, logarithm),
    ]
}

/// The logarithm of `x` if a power of it is no product.
#[inline(always)]
fn shared_logarithm<R: Real>(products: [Option<(u32, bool)>; 2], x: R) -> R {
    if products[0].is_none() || products[1].is_none() {
        logarithm_of(x)
    } else {
        x
    }
}

/// Two powers of the strain whose sum is the force of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Powers {
    /// Their factors.
    pub factors: [f64; 2],
    /// Their exponents.
    pub exponents: [f64; 2],
}

impl Powers {
    /// Its integral.
    #[must_use]
    pub fn integral(self) -> Self {
        let exponents = self.exponents.map(|exponent| exponent + 1.0);
        let over = |place: usize| self.factors[place] / exponents[place];
        Self {
            factors: [over(0), over(1)],
            exponents,
        }
    }

    /// Its product with a number.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let [first, second] = self.factors;
        Self {
            factors: [factor * first, factor * second],
            ..self
        }
    }

    /// Integral of the sum, the sum and its slope.
    #[inline(always)]
    pub fn works<R: Real>(&self, x: R) -> [R; 3] {
        let [more, most] = self.exponents;
        let (more, most) = (R::splat(more + 1.0), R::splat(most + 1.0));
        let [[first, first_slope], [second, second_slope]] =
            powers(self.factors, self.exponents, x);
        [
            x * (first / more + second / most),
            first + second,
            first_slope + second_slope,
        ]
    }

    /// Sums of powers with these exponents and their slopes, side by side.
    #[inline(always)]
    pub fn sums<R: Real>(exponents: [f64; 2], factors: [R; 2], x: R) -> [R; 2] {
        let products = exponents.map(products_of);
        let logarithm = shared_logarithm(products, x);
        let power = raised_by(products[0], exponents[0], x, logarithm);
        let first = sloped([1.0, exponents[0]], x, power);
        let power = raised_by(products[1], exponents[1], x, logarithm);
        let second = sloped([1.0, exponents[1]], x, power);
        [
            factors[0] * first[0] + factors[1] * second[0],
            factors[0] * first[1] + factors[1] * second[1],
        ]
    }
}

/// A power with a factor and its slope, from the logarithm where it is no product.
#[inline(always)]
fn one_of<R: Real>(
    [factor, exponent]: [f64; 2],
    products: Option<(u32, bool)>,
    x: R,
    logarithm: R,
) -> [R; 2] {
    if factor == 0.0 {
        return [R::zero(); 2];
    }
    let power = raised_by(products, exponent, x, logarithm);
    sloped([factor, exponent], x, power)
}

#[inline(always)]
fn raised_by<R: Real>(products: Option<(u32, bool)>, exponent: f64, x: R, logarithm: R) -> R {
    match products {
        Some(products) => by_products(x, products),
        None => exponential_of(logarithm * R::splat(exponent)),
    }
}

/// One number waits less for the functions of the library, several side by side for series.
#[inline(always)]
pub(crate) fn logarithm_of<R: Real>(x: R) -> R {
    if R::WIDTH == 1 {
        R::splat(x.lane(0).ln())
    } else {
        logarithm(x)
    }
}

/// Exponential by the library for one number, by series for several side by side.
#[inline(always)]
pub(crate) fn exponential_of<R: Real>(x: R) -> R {
    if R::WIDTH == 1 {
        R::splat(x.lane(0).exp())
    } else {
        exp(x)
    }
}

/// An exponent if it is not too large.
pub(super) fn within(name: &str, value: f64, most: f64) -> Result<f64> {
    if value <= most {
        Ok(value)
    } else {
        let rule = format!("be at most {most}");
        Err(Failure::invalid(name, rule, Given::Number(value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::lanes::{Lanes, Number};

    #[test]
    fn shared_logarithms_keep_powers() {
        let exponents = [0.01, 0.43, 1.0, 2.5, 4.3, 17.9, 100.0];
        for (index, p) in exponents.into_iter().enumerate() {
            let both = [p, exponents[exponents.len() - 1 - index]];
            for count in 1..4000 {
                let x = 1e-12_f64.powf(f64::from(count) / 4000.0);
                let alone = powers([2.0, 3.0], both, x);
                let beside = powers([2.0, 3.0], both, Lanes::<8>::splat(x));
                for place in 0..2 {
                    let exact = [2.0, 3.0][place] * x.powf(both[place]);
                    if exact < 1e-190 {
                        continue;
                    }
                    for found in [alone[place], beside[place].map(|lanes| lanes.lane(5))] {
                        let slope = both[place] * exact / x;
                        assert!((found[0] / exact - 1.0).abs() < 1e-13, "{x} {both:?}");
                        assert!((found[1] / slope - 1.0).abs() < 1e-13, "{x} {both:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn powers_of_nothing_are_nothing() {
        let [first, second] = powers([2.0, 3.0], [0.43, 4.3], 0.0);
        assert_eq!((first, second), ([0.0, f64::INFINITY], [0.0, 0.0]));
    }
}
