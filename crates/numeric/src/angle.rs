//! The unsigned angle between two vectors as one branch-free polynomial of any width.
//!
//! `atan2(|cross|, dot)` from the C library would leave the vector registers; the polynomial
//! below has a relative error of 5.4e-18 in exact arithmetic and below 4.5e-16 rad as coded.

use crate::lanes::Real;

/// tan(pi/8): beyond it the argument is turned back by pi/4.
const TAN_PI_8: f64 = 0.414_213_562_373_095_03;

/// Chebyshev fit of `(atan(t)/t - 1)/t^2` in powers of `t^2` on `|t| <= tan(pi/8)`.
const ATAN: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_42,
    0.111_111_110_152_562_92,
    -0.090_909_045_781_210_85,
    0.076_921_831_907_606_51,
    -0.066_645_114_464_602_2,
    0.058_581_489_047_951_24,
    -0.050_854_496_960_392_584,
    0.039_231_657_085_083_686,
    -0.019_176_885_636_589_053,
];

/// Angle in `[0, pi]` between two vectors from their cross and dot product; 0 if both are 0.
#[inline(always)]
pub fn unsigned_angle<R: Real>(cross: R, dot: R) -> R {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let (y, x) = (cross.abs(), dot.abs());
    let steep = y.gt(x);
    let small = R::select(steep, x, y);
    let large = R::select(steep, y, x);
    let turned = small.gt(large * R::splat(TAN_PI_8));
    let numerator = R::select(turned, small - large, small);
    let denominator = R::select(turned, small + large, large);
    let denominator = R::select(denominator.gt(R::zero()), denominator, R::splat(1.0));
    let t = numerator / denominator;
    let z = t * t;
    let mut series = R::splat(ATAN[10]);
    for coefficient in ATAN[..10].iter().rev() {
        series = series * z + R::splat(*coefficient);
    }
    let angle = t + t * (z * series);
    let angle = R::select(turned, R::splat(FRAC_PI_4) + angle, angle);
    let angle = R::select(steep, R::splat(FRAC_PI_2) - angle, angle);
    R::select(dot.lt(R::zero()), R::splat(PI) - angle, angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_library_arc_tangent() {
        // Two roundings of a value up to pi: 4.4e-16 each.
        const TOLERANCE: f64 = 9e-16;
        for k in 0..200_000 {
            let angle = std::f64::consts::PI * f64::from(k) / 200_000.0;
            let scale = 10f64.powi(k % 13 - 6);
            let (cross, dot) = (scale * angle.sin(), scale * angle.cos());
            let error = unsigned_angle(cross, dot) - cross.abs().atan2(dot);
            assert!(error.abs() < TOLERANCE, "{angle}: {error}");
            assert_eq!(unsigned_angle(-cross, dot), unsigned_angle(cross, dot));
        }
    }

    #[test]
    fn small_angles_keep_their_relative_accuracy() {
        for exponent in 1..300 {
            let cross = 10f64.powi(-exponent);
            let angle = unsigned_angle(cross, 1.0);
            assert!((angle / cross.atan2(1.0) - 1.0).abs() < 4e-16);
        }
    }

    #[test]
    fn no_direction_gives_no_angle() {
        assert_eq!(unsigned_angle(0.0, 0.0), 0.0);
        assert_eq!(unsigned_angle(0.0, -1.0), std::f64::consts::PI);
    }
}
