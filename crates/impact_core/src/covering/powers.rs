//! Powers of strains.

use crate::error::{Failure, Given, Result};

/// Largest exponent of a law: beyond it stresses are no numbers any more.
pub(super) const MOST_EXPONENT: f64 = 100.0;
/// Largest whole exponent that is a product.
const MOST_PRODUCTS: u32 = 8;

/// `x^exponent`, without logarithms where the exponent is a whole number or a half more than one, up to 8.
pub(super) fn raised(x: f64, exponent: f64) -> f64 {
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

/// An exponent if it is not too large.
pub(super) fn within(name: &str, value: f64, most: f64) -> Result<f64> {
    if value <= most {
        Ok(value)
    } else {
        let rule = format!("be at most {most}");
        Err(Failure::invalid(name, rule, Given::Number(value)))
    }
}
