//! Exponential, sine and cosine of numbers side by side, from basic operations only, so that their
//! bits do not depend on the width. Fused operations are basic, too, but slow on a processor without vectors.

use crate::lanes::{Number, Real};

/// `1.5 * 2^52`: a number of moderate size added to it is rounded to an integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// `ln 2` in two parts; products of the first one with small integers are exact.
const LN_2: [f64; 2] = [0.693_147_175_014_019, 5.545_926_296_966_060_5e-9];
/// `2 pi` in two parts, likewise.
const TURN: [f64; 2] = [6.283_185_303_211_212, 3.968_374_318_722_162e-9];
/// Exponents below this give numbers of no weight.
const LOWEST: f64 = -700.0;
/// Exponents above this give numbers too large for a power of two.
const HIGHEST: f64 = 709.0;

/// `1 / (start + step * 0)!`, `1 / (start + step * 1)!` and so on, signs by turns for two steps.
const fn reciprocal_factorials<const N: usize>(start: usize, step: usize) -> [f64; N] {
    let mut found = [0.0; N];
    let mut index = 0;
    while index < N {
        let (mut factorial, mut factor) = (1.0, 1);
        while factor <= start + step * index {
            factorial *= factor as f64;
            factor += 1;
        }
        let sign = if step == 2 && index % 2 == 1 {
            -1.0
        } else {
            1.0
        };
        found[index] = sign / factorial;
        index += 1;
    }
    found
}

/// To `0.3466^13 / 13!`, below 2e-16.
const EXPONENTIAL: [f64; 13] = reciprocal_factorials(0, 1);
/// To `0.7854^17 / 17!`, below 5e-17.
const SINE: [f64; 8] = reciprocal_factorials(1, 2);
/// To `0.7854^18 / 18!`, below 3e-18.
const COSINE: [f64; 9] = reciprocal_factorials(0, 2);

/// `2/3`, `2/5` and so on, to `0.1716^22/23`, below 1e-18.
const LOGARITHM: [f64; 10] = {
    let mut found = [0.0; 10];
    let mut index = 0;
    while index < found.len() {
        found[index] = 2.0 / (2 * index + 3) as f64;
        index += 1;
    }
    found
};

/// `x * y + z`, rounded once if fused.
#[inline(always)]
fn sum<const FUSED: bool, R: Number>(x: R, y: R, z: R) -> R {
    if FUSED { x.mul_add(y, z) } else { x * y + z }
}

/// Even and odd powers apart: half as many steps wait for each other.
#[inline(always)]
fn polynomial<const FUSED: bool, R: Number, const N: usize>(coefficients: &[f64; N], x: R) -> R {
    let square = x * x;
    let mut parts = [x; 2];
    for (power, &coefficient) in coefficients.iter().enumerate().rev() {
        let coefficient = x.like(coefficient);
        let part = &mut parts[power % 2];
        *part = if power + 2 < N {
            sum::<FUSED, R>(*part, square, coefficient)
        } else {
            coefficient
        };
    }
    let [even, odd] = parts;
    sum::<FUSED, R>(odd, x, even)
}

/// `exp(x)` of a number that is not far above zero, fused or not.
#[inline(always)]
pub fn exponential<const FUSED: bool, R: Number>(x: R) -> R {
    within_range::<FUSED, R>(x.max(x.like(LOWEST)))
}

/// `exp(x)` of a number whose rounded power of two is from -1023 to 1023; NaN of NaN.
#[inline(always)]
fn within_range<const FUSED: bool, R: Number>(x: R) -> R {
    let shifted = sum::<FUSED, R>(x, x.like(std::f64::consts::LOG2_E), x.like(ROUNDER));
    let rest = reduced::<FUSED, R>(x, shifted - ROUNDER, LN_2);
    polynomial::<FUSED, R, _>(&EXPONENTIAL, rest) * shifted.power_of_two()
}

/// Rest of a number beside a whole multiple of one in two parts.
#[inline(always)]
fn reduced<const FUSED: bool, R: Number>(x: R, whole: R, [most, least]: [f64; 2]) -> R {
    let rest = sum::<FUSED, R>(whole, x.like(-most), x);
    sum::<FUSED, R>(whole, x.like(-least), rest)
}

/// `exp(x)` of any number: infinite beyond 709, zero below -700, NaN of NaN.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    let highest = R::splat(HIGHEST);
    let found = exponential::<false, R>(x.min(highest));
    let found = R::select(x.lt(R::splat(LOWEST)), R::zero(), found);
    // Neither at most the highest one nor above it: not a number.
    let beyond = R::select(x.gt(highest), R::splat(f64::INFINITY), x);
    R::select(x.le(highest), found, beyond)
}

/// `exp(x)` of a number that is not above zero, as [`exp`] but faster: zero below -700, NaN of NaN.
#[inline(always)]
pub fn decay<R: Real>(x: R) -> R {
    let found = R::select(
        x.lt(R::splat(LOWEST)),
        R::zero(),
        exponential::<false, R>(x),
    );
    R::select(x.le(R::zero()), found, x)
}

/// `exp(x)` of a number that is not above zero, without a comparison: zero where it is below the smallest number of
/// full precision, NaN of NaN.
#[inline(always)]
pub fn fading<R: Real>(x: R) -> R {
    // `2^-1023` comes out as zero. In this order a number that is none stays.
    within_range::<false, R>(R::splat(-HIGHEST).max(x))
}

/// `ln(x)` of a positive number of full precision.
#[inline(always)]
pub fn logarithm<R: Real>(x: R) -> R {
    let [mantissa, exponent] = x.mantissa_and_exponent();
    let one = R::splat(1.0);
    // ln m = 2 artanh s, s = (m - 1)/(m + 1).
    let share = (mantissa - one) / (mantissa + one);
    let square = share * share;
    let series = share * square * polynomial::<false, R, _>(&LOGARITHM, square);
    let small = series + exponent * R::splat(LN_2[1]);
    exponent * R::splat(LN_2[0]) + (share + share + small)
}

/// Cosine and sine of a number of moderate size: those of a quarter of what is left of it beside
/// full turns, doubled twice. Products and sums are rounded together.
#[inline(always)]
pub fn cosine_and_sine<R: Number>(x: R) -> [R; 2] {
    let one = x.like(1.0);
    let per_turn = x.like(0.5 * std::f64::consts::FRAC_1_PI);
    let whole = x.mul_add(per_turn, x.like(ROUNDER)) - ROUNDER;
    let quarter = reduced::<true, R>(x, whole, TURN) * 0.25;
    let square = quarter * quarter;
    let mut cosine = polynomial::<true, R, _>(&COSINE, square);
    let mut sine = polynomial::<true, R, _>(&SINE, square) * quarter;
    for _ in 0..2 {
        let double = sine + sine;
        (cosine, sine) = ((-double).mul_add(sine, one), double * cosine);
    }
    [cosine, sine]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Lanes;

    #[test]
    fn the_exponential_of_any_number_keeps_what_is_not_finite() {
        let given = [
            -1e300,
            f64::NEG_INFINITY,
            709.5,
            f64::INFINITY,
            f64::NAN,
            0.0,
        ];
        let expected = [0.0, 0.0, f64::INFINITY, f64::INFINITY, f64::NAN, 1.0];
        let lanes: Lanes<6> = exp(Lanes::from_fn(|lane| given[lane]));
        for (lane, (x, result)) in given.into_iter().zip(expected).enumerate() {
            assert!(exp(x).to_bits() == result.to_bits() || exp(x).is_nan() && result.is_nan());
            assert!(lanes.lane(lane).to_bits() == exp(x).to_bits() || result.is_nan());
        }
        assert!(Number::lane(lanes, 4).is_nan());
    }

    #[test]
    fn decay_has_the_bits_of_the_exponential() {
        for index in 0..=8000 {
            let x = -0.1 * f64::from(index);
            assert_eq!(decay(x).to_bits(), exp(x).to_bits(), "{x}");
        }
        assert_eq!(decay(f64::NEG_INFINITY), 0.0);
        assert_eq!(decay(-0.0), 1.0);
        assert!(decay(f64::NAN).is_nan());
    }

    #[test]
    fn fading_agrees_with_the_library_down_to_zero() {
        for index in 0..=7080 {
            let x = -0.1 * f64::from(index);
            assert!((fading(x) / x.exp() - 1.0).abs() < 1e-15, "{x}");
        }
        for x in [-708.9, -709.0, -710.0, -1e9, -1e300, f64::NEG_INFINITY] {
            assert_eq!(fading(x), 0.0, "{x}");
            assert_eq!(fading(Lanes::<4>::splat(x)).lane(3), 0.0);
        }
        assert_eq!((fading(0.0), fading(-0.0)), (1.0, 1.0));
        assert!(fading(f64::NAN).is_nan());
    }

    #[test]
    fn logarithms_agree_with_the_library() {
        let near_one = (1..4000).map(|index| 1.0 + 0.0003 * f64::from(index - 2000));
        let far = (-1021..1023).map(|power| 1.37 * 2.0_f64.powi(power));
        for x in near_one.chain(far) {
            let [mantissa, exponent] = x.mantissa_and_exponent();
            assert_eq!(mantissa * exponent.exp2(), x);
            assert!(mantissa * mantissa > 0.499 && mantissa * mantissa < 2.001);
            let error = (logarithm(x) - x.ln()).abs();
            assert!(error <= 5e-16 * x.ln().abs(), "{x}: {error:e}");
            let lanes = logarithm(Lanes::<4>::splat(x));
            assert_eq!(lanes.lane(2).to_bits(), logarithm(x).to_bits());
        }
        assert_eq!(logarithm(1.0), 0.0);
    }

    #[test]
    fn they_agree_with_the_library() {
        for index in -4000..=200 {
            let x = f64::from(index) * 0.01;
            for found in [exponential::<false, _>(x), exponential::<true, _>(x)] {
                let error = found / x.exp() - 1.0;
                assert!(error.abs() < 1e-15, "{x}: {error:e}");
            }
        }
        for index in -7000..=7090 {
            let x = f64::from(index) * 0.1;
            assert!((exp(x) / x.exp() - 1.0).abs() < 1e-15, "{x}");
        }
        for index in 0..100_000 {
            let x = f64::from(index) * 0.003;
            let [cosine, sine] = cosine_and_sine(x);
            let error = (cosine - x.cos()).abs().max((sine - x.sin()).abs());
            assert!(error < 3e-15, "{x}: {error:e}");
        }
    }
}
