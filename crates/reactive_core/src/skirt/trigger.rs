//! Readings at which a sensor counts as triggered.

use crate::error::{Failure, Given, Result, positive};
use crate::skirt::ring::{PUBLISHED_SENSORS, PUBLISHED_WHEEL_GAP, Ring};

/// Which triggering distances are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// An echo from within the safe distance `R_S` of the center, for every sensor.
    #[default]
    Consistent,
    /// d1..d8 and y of (7) to (9) and Table 3 as printed, each with the sensor that it belongs to.
    Printed,
}

/// Largest readings cm at which the sensors are triggered, in m, for a safe distance `R_S` in m.
///
/// Consistent: R - w + cm <= `R_S`. Printed: d1..d4 say (R - w + cm - `R_S`) sin <= `R_S` sin, that is
/// cm <= 2 `R_S` - R + w; d5 has sin(theta + 2 `theta_1`) on its left and sin(2 theta) on its right;
/// the others agree with the consistent rule.
///
/// # Errors
/// `R_S` does not exceed the distance of the sensor faces, or the printed rule is asked for another
/// ring than that of nine sensors.
pub fn trigger_distances(ring: &Ring, safe_distance: f64, rule: Rule) -> Result<Vec<f64>> {
    let face = ring.face_radius();
    if positive("safe_distance", safe_distance)? <= face {
        let rule = "exceed the distance of the sensors from the center";
        return Err(Failure::invalid(
            "safe_distance",
            rule,
            Given::Number(safe_distance),
        ));
    }
    let count = ring.bearings().len();
    let mut distances = vec![safe_distance - face; count];
    if rule == Rule::Printed {
        if count != PUBLISHED_SENSORS {
            let given = Given::Count(count as u64);
            let needed = "be 9 for the printed triggering distances";
            return Err(Failure::invalid("sensors", needed, given));
        }
        distances[..4].fill(2.0 * safe_distance - face);
        let gap = std::f64::consts::FRAC_PI_3 - PUBLISHED_WHEEL_GAP;
        let sines = (2.0 * gap).sin() / (gap + 2.0 * PUBLISHED_WHEEL_GAP).sin();
        distances[4] = safe_distance * sines - face;
    }
    Ok(distances)
}

#[cfg(test)]
mod tests {
    use super::{Rule, trigger_distances};
    use crate::skirt::ring::{PUBLISHED_WHEEL_GAP, Ring};

    fn ring(count: usize) -> Ring {
        let bearings = Ring::beside_wheels(count, PUBLISHED_WHEEL_GAP).unwrap();
        Ring::new(0.33, 0.0, bearings).unwrap()
    }

    #[test]
    fn consistent_rule_is_the_same_for_all() {
        let found = trigger_distances(&ring(9), 0.666, Rule::Consistent).unwrap();
        assert!(
            found
                .iter()
                .all(|distance| (distance - 0.336).abs() < 1e-15)
        );
    }

    #[test]
    fn printed_rule_triggers_the_front_three_times_as_far() {
        let found = trigger_distances(&ring(9), 0.666, Rule::Printed).unwrap();
        let expected = [
            1.002, 1.002, 1.002, 1.002, 0.319, 0.336, 0.336, 0.336, 0.336,
        ];
        for (distance, printed) in found.iter().zip(expected) {
            assert!((distance - printed).abs() < 5e-4, "{distance} {printed}");
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        assert!(trigger_distances(&ring(9), 0.33, Rule::Consistent).is_err());
        assert!(trigger_distances(&ring(12), 0.666, Rule::Printed).is_err());
    }
}
