//! Head injury criterion of pulses that have a formula.

use crate::error::{Result, positive};

/// Half angle of the best window of a half sine, the root of tan(x) = x / 0.6.
const HALF_SINE_ANGLE: f64 = 1.052_794_293_769_870_2;

/// Head injury criterion of the half sine `peak_g sin(pi t / duration)`, in g^2.5 s.
///
/// The best window lies symmetrically about the peak; its ends are at 0.6 of the mean inside it
/// (derivative of the criterion), unless it is longer than `window`.
///
/// # Errors
/// Any argument that is not finite and positive.
pub fn hic_half_sine(peak_g: f64, duration: f64, window: f64) -> Result<f64> {
    check(peak_g, duration, window)?;
    let half_angle = HALF_SINE_ANGLE.min(0.5 * std::f64::consts::PI * window / duration);
    let length = duration * half_angle / (0.5 * std::f64::consts::PI);
    Ok(length * (peak_g * half_angle.sin() / half_angle).powf(2.5))
}

/// Head injury criterion of a constant acceleration that lasts `duration`, in g^2.5 s.
///
/// # Errors
/// Any argument that is not finite and positive.
pub fn hic_square(peak_g: f64, duration: f64, window: f64) -> Result<f64> {
    check(peak_g, duration, window)?;
    Ok(duration.min(window) * peak_g.powf(2.5))
}

/// Head injury criterion of a triangle that is `duration` wide at its base, in g^2.5 s.
///
/// Where the peak lies does not matter: the best window of any length holds everything above one
/// level. It is 4/7 of the base unless that is longer than `window`.
///
/// # Errors
/// Any argument that is not finite and positive.
pub fn hic_triangle(peak_g: f64, duration: f64, window: f64) -> Result<f64> {
    check(peak_g, duration, window)?;
    let share = (4.0_f64 / 7.0).min(window / duration);
    Ok(duration * share * (peak_g * (1.0 - 0.5 * share)).powf(2.5))
}

fn check(peak_g: f64, duration: f64, window: f64) -> Result<()> {
    positive("peak_g", peak_g)?;
    positive("duration", duration)?;
    positive("window", window)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_angle_solves_its_equation() {
        assert!((HALF_SINE_ANGLE.tan() - HALF_SINE_ANGLE / 0.6).abs() < 1e-14);
    }

    #[test]
    fn five_milliseconds_at_100_g_give_207_3() {
        let value = hic_half_sine(100.0, 0.005, 0.015).unwrap();
        assert!((value - 207.3).abs() < 0.05, "{value}");
    }

    #[test]
    fn long_pulses_are_limited_by_the_window() {
        assert_eq!(hic_square(50.0, 1.0, 0.015), Ok(0.015 * 50.0_f64.powf(2.5)));
        let narrow = hic_triangle(50.0, 100.0, 0.015).unwrap();
        assert!((narrow / (0.015 * 50.0_f64.powf(2.5)) - 1.0).abs() < 2e-4);
    }

    #[test]
    fn bad_arguments_are_named() {
        for (peak, duration, window) in [(-1.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, f64::NAN)] {
            assert!(hic_half_sine(peak, duration, window).is_err());
            assert!(hic_square(peak, duration, window).is_err());
            assert!(hic_triangle(peak, duration, window).is_err());
        }
    }
}
