//! Straight lines and the quantiles of Student's distribution.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{check_confidence, check_samples};
use crate::error::{Failure, Given, Result};

/// Confidence of the intervals that have no setting of their own.
pub(super) const CONFIDENCE: f64 = 0.95;
/// Degrees of freedom up to which the quantile is found by its sums, each half as long.
const SUMMED: usize = 1 << 15;

/// A straight line through measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Slope.
    pub slope: f64,
    /// Value at zero; 0 where the line was forced through the origin.
    pub intercept: f64,
    /// Covariance of slope and intercept.
    pub covariance: [[f64; 2]; 2],
    /// 95 % interval of the slope.
    pub slope_interval: [f64; 2],
    /// 95 % interval of the intercept.
    pub intercept_interval: [f64; 2],
    /// Standard deviation of the residuals.
    pub residual_deviation: f64,
    /// Measurements less fitted numbers.
    pub degrees_of_freedom: usize,
}

/// Stiffness of a foam from static forces and compressions, `f = K_c eps_c` (zeng2011, A.1.2).
///
/// The compression counts from the rest under the slide's own weight, so the line passes through the
/// origin; with `intercept` an unknown zero of the transducer is fitted too.
///
/// # Errors
/// Fewer than three measurements, unequal lengths, numbers that are not finite, compressions that
/// are all alike.
pub fn fit_static(force: &[f64], compression: &[f64], intercept: bool) -> Result<Line> {
    check_samples(
        "static_force",
        force,
        force.len(),
        3,
        "have at least 3 values",
    )?;
    let like_force = "have as many values as static_force";
    check_samples(
        "static_compression",
        compression,
        force.len(),
        3,
        like_force,
    )?;
    fit_line("static_compression", compression, force, intercept)
}

/// Least-squares line `y = slope x + intercept`.
pub(super) fn fit_line(name: &str, x: &[f64], y: &[f64], intercept: bool) -> Result<Line> {
    let count = x.len() as f64;
    let mean = |values: &[f64]| {
        if intercept {
            values.iter().sum::<f64>() / count
        } else {
            0.0
        }
    };
    let (center, level) = (mean(x), mean(y));
    let spread: f64 = x.iter().map(|x| (x - center).powi(2)).sum();
    let largest = x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if spread.is_finite() && spread <= count * (f64::EPSILON * largest).powi(2) {
        return Err(Failure::invalid(
            name,
            "hold different values",
            Given::Number(x[0]),
        ));
    }
    let moment: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (x - center) * (y - level))
        .sum();
    let slope = moment / spread;
    let offset = level - slope * center;
    let squares: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (y - offset - slope * x).powi(2))
        .sum();
    let degrees_of_freedom = x.len() - 1 - usize::from(intercept);
    let variance = squares / degrees_of_freedom as f64;
    let level_variance = if intercept { variance / count } else { 0.0 };
    let slope_variance = variance / spread;
    let mixed = -center * slope_variance;
    let offset_variance = level_variance + center * center * slope_variance;
    if [slope, offset, slope_variance, offset_variance]
        .iter()
        .any(|number| !number.is_finite())
    {
        let largest = y.iter().fold(largest, |largest, y| largest.max(y.abs()));
        let rule = "hold numbers whose squares and their sums can be represented";
        let failure = Failure::invalid(name, rule, Given::Number(largest));
        return Err(
            failure.mended_by("this is the largest of both; give forces in N, compressions in m")
        );
    }
    let quantile = student_quantile(CONFIDENCE, degrees_of_freedom)?;
    let interval = |value: f64, variance: f64| {
        let half = quantile * variance.sqrt();
        [value - half, value + half]
    };
    Ok(Line {
        slope,
        intercept: offset,
        covariance: [[slope_variance, mixed], [mixed, offset_variance]],
        slope_interval: interval(slope, slope_variance),
        intercept_interval: interval(offset, offset_variance),
        residual_deviation: variance.sqrt(),
        degrees_of_freedom,
    })
}

/// The number t for which Student's distribution holds `confidence` between -t and t.
///
/// # Errors
/// A confidence outside (0, 1), no degree of freedom.
pub fn student_quantile(confidence: f64, degrees_of_freedom: usize) -> Result<f64> {
    check_confidence(confidence)?;
    if degrees_of_freedom == 0 {
        return Err(Failure::invalid(
            "degrees_of_freedom",
            "be at least 1",
            Given::Count(0),
        ));
    }
    if degrees_of_freedom > SUMMED {
        return Ok(distant_quantile(confidence, degrees_of_freedom));
    }
    Ok(summed_quantile(confidence, degrees_of_freedom))
}

/// The quantile by inversion of the distribution.
fn summed_quantile(confidence: f64, degrees_of_freedom: usize) -> f64 {
    // The share is a trigonometric sum in the angle atan(t / sqrt(n)) and rises with it.
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if share_within(middle, degrees_of_freedom) < confidence {
            low = middle;
        } else {
            high = middle;
        }
    }
    (0.5 * (low + high)).tan() * (degrees_of_freedom as f64).sqrt()
}

/// The quantile for so many degrees of freedom that their sums would take seconds.
///
/// It is a smooth function of 1/n (Abramowitz and Stegun, 26.7.5): a cubic through four smaller
/// numbers has it to the rounding of their sums.
fn distant_quantile(confidence: f64, degrees_of_freedom: usize) -> f64 {
    let nodes = [SUMMED / 8, SUMMED / 4, SUMMED / 2, SUMMED];
    let at = 1.0 / degrees_of_freedom as f64;
    let mut sum = 0.0;
    for node in nodes {
        let own = 1.0 / node as f64;
        let others = nodes.iter().filter(|other| **other != node);
        let weight: f64 = others
            .map(|&other| (at - 1.0 / other as f64) / (own - 1.0 / other as f64))
            .product();
        sum += weight * summed_quantile(confidence, node);
    }
    sum
}

/// Share between -t and t for t = sqrt(n) tan(angle): the closed sums for whole n.
fn share_within(angle: f64, degrees_of_freedom: usize) -> f64 {
    let (sine, cosine) = angle.sin_cos();
    let odd = degrees_of_freedom % 2 == 1;
    let mut term = if odd { cosine } else { 1.0 };
    let mut sum = 0.0;
    let mut order = usize::from(odd);
    while order + 2 <= degrees_of_freedom {
        sum += term;
        order += 2;
        term *= cosine * cosine * (order - 1) as f64 / order as f64;
    }
    if odd {
        (angle + sine * sum) * 2.0 / PI
    } else {
        sine * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (confidence, degrees, expected) in [
            (0.95, 1, 12.706_204_736),
            (0.95, 2, 4.302_652_730),
            (0.95, 3, 3.182_446_305),
            (0.95, 4, 2.776_445_105),
            (0.99, 5, 4.032_142_984),
            (0.95, 10, 2.228_138_852),
            (0.90, 30, 1.697_260_887),
            (0.95, 1001, 1.962_336_705),
        ] {
            let found = student_quantile(confidence, degrees).unwrap();
            assert!((found - expected).abs() < 1e-8, "{degrees} {found}");
        }
    }

    #[test]
    fn quantiles_of_many_degrees_are_those_of_other_programs() {
        for (confidence, degrees, expected) in [
            (0.5, 40_000, 0.674_495_883_618_917),
            (0.95, SUMMED, 1.960_036_383_141_388),
            (0.95, SUMMED + 1, 1.960_036_380_931_945),
            (0.95, 100_001, 1.959_987_707_297_379),
            (0.95, usize::MAX, 1.959_963_984_540_054), // the normal one
            (0.9999, 100_001, 3.890_748_843_816_152),
        ] {
            let found = student_quantile(confidence, degrees).unwrap();
            // The sums have lost so much, and the interpolation through them hardly more.
            assert!((found / expected - 1.0).abs() < 1e-10, "{degrees} {found}");
        }
    }

    #[test]
    fn exact_lines_are_found_exactly() {
        let x = [0.001, 0.002, 0.004, 0.005];
        let through: Vec<f64> = x.iter().map(|x| 24_250.0 * x).collect();
        let line = fit_static(&through, &x, false).unwrap();
        assert!((line.slope / 24_250.0 - 1.0).abs() < 1e-14);
        assert!(line.residual_deviation < 1e-12 && line.degrees_of_freedom == 3);
        let shifted: Vec<f64> = through.iter().map(|y| y + 3.0).collect();
        let line = fit_static(&shifted, &x, true).unwrap();
        assert!(
            (line.slope / 24_250.0 - 1.0).abs() < 1e-12 && (line.intercept - 3.0).abs() < 1e-10
        );
    }

    #[test]
    fn covariance_is_that_of_the_normal_equations() {
        let (x, y) = ([1.0, 2.0, 3.0, 4.0], [1.1, 1.9, 3.2, 3.8]);
        let line = fit_line("x", &x, &y, true).unwrap();
        // (X'X)^-1 of this design: slope 0.2, intercept 1.5, mixed -0.5.
        let variance = line.residual_deviation.powi(2);
        for (found, expected) in line.covariance.concat().iter().zip([0.2, -0.5, -0.5, 1.5]) {
            assert!((found - expected * variance).abs() < 1e-14);
        }
    }

    #[test]
    fn intervals_of_few_readings_cover_the_truth_in_90_to_99_percent() {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut uniform = || (generator.next_u64() as f64 + 0.5) / 2.0_f64.powi(64);
        let depth: Vec<f64> = (1..=6).map(|k| 0.8e-3 * f64::from(k)).collect();
        let mut covered = 0;
        for _ in 0..500 {
            let force: Vec<f64> = depth
                .iter()
                .map(|depth| {
                    let radius = (-2.0 * uniform().ln()).sqrt();
                    24_250.0 * depth + radius * (2.0 * PI * uniform()).cos()
                })
                .collect();
            let [low, high] = fit_static(&force, &depth, false).unwrap().slope_interval;
            covered += u32::from(low <= 24_250.0 && 24_250.0 <= high);
        }
        assert!((450..=495).contains(&covered), "{covered}");
    }

    #[test]
    fn useless_measurements_are_refused() {
        assert!(fit_static(&[1.0, 2.0], &[1.0, 2.0], false).is_err());
        assert!(fit_static(&[1.0, 2.0, 3.0], &[1.0, 2.0], false).is_err());
        assert!(fit_static(&[1.0, 2.0, 3.0], &[0.0, 0.0, 0.0], false).is_err());
        assert!(fit_static(&[1.0, 2.0, 3.0], &[0.1, 0.1, 0.1], true).is_err());
        assert!(fit_static(&[1.0, f64::NAN, 3.0], &[1.0, 2.0, 3.0], false).is_err());
        assert!(student_quantile(1.0, 3).is_err() && student_quantile(0.9, 0).is_err());
    }
}
