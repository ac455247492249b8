//! Readings at which a sensor counts as triggered.

use navigation_world::sensing::sonar::ring::{PUBLISHED_SENSORS, PUBLISHED_WHEEL_GAP, Ring};
use numeric::error::{Failure, Given, Result, positive};

/// Which triggering distances are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// An echo from within the safe distance `R_S` of the center, for every sensor.
    #[default]
    Consistent,
    /// d1..d8 and y of (7) to (9) and Table 3 as printed, each with the sensor that it belongs to.
    Printed,
}

/// One normal distance of (7) to (9), `d = (R - w + cm [- R_S]) sin`, and its limit `d' = R_S sin`.
struct Normal {
    /// Sensor that it belongs to, from 0.
    sensor: usize,
    /// Reading that is printed, from 0.
    printed: usize,
    /// Multiples of theta and `theta_1` in the sine of `d`.
    angle: [f64; 2],
    /// Multiples in the sine of `d'`.
    limit: [f64; 2],
    /// Whether `R_S` is subtracted as printed.
    from_safe: bool,
}

const fn normal(sensor: usize, angle: [f64; 2], from_safe: bool) -> Normal {
    Normal {
        sensor,
        printed: sensor,
        angle,
        limit: angle,
        from_safe,
    }
}

/// d1 to d8 as printed.
const NORMALS: [Normal; 8] = [
    normal(0, [1.0, 1.0], true),
    normal(1, [0.0, 1.0], true),
    normal(2, [0.0, 1.0], true),
    normal(3, [1.0, 1.0], true),
    Normal {
        limit: [2.0, 0.0],
        ..normal(4, [1.0, 2.0], false)
    },
    normal(5, [1.0, 0.0], false),
    normal(7, [1.0, 0.0], false),
    Normal {
        printed: 7,
        ..normal(8, [2.0, 0.0], false)
    },
];

/// Sine of multiples of the angles theta and `theta_1` of the published ring.
fn sine([gaps, wheel_gaps]: [f64; 2]) -> f64 {
    let gap = std::f64::consts::FRAC_PI_3 - PUBLISHED_WHEEL_GAP;
    (gaps * gap + wheel_gaps * PUBLISHED_WHEEL_GAP).sin()
}

/// Normal distances d1 to d8 of the published ring and their limits d1' to d8', in m, for the nine
/// readings cm in m, (7) to (9).
///
/// Printed: as they stand. Consistent: `R_S` is subtracted nowhere, d8 takes the reading of sensor 9,
/// and d5 and d8, mirror images, have sin(theta + 2 `theta_1`) on both sides.
///
/// # Errors
/// `R_S` is not positive, or the ring or the readings are not of nine sensors.
pub fn normal_distances(
    ring: &Ring,
    safe_distance: f64,
    readings: &[f64],
    rule: Rule,
) -> Result<[[f64; 2]; 8]> {
    positive("safe_distance", safe_distance)?;
    nine(ring.bearings().len(), "sensors")?;
    nine(readings.len(), "readings")?;
    let face = ring.face_radius();
    Ok(std::array::from_fn(|index| {
        let normal = &NORMALS[index];
        match rule {
            Rule::Printed => {
                let subtracted = if normal.from_safe { safe_distance } else { 0.0 };
                let along = face + readings[normal.printed] - subtracted;
                [
                    along * sine(normal.angle),
                    safe_distance * sine(normal.limit),
                ]
            }
            Rule::Consistent => {
                let angle = if index == 7 {
                    NORMALS[4].angle
                } else {
                    normal.angle
                };
                let along = face + readings[normal.sensor];
                [along * sine(angle), safe_distance * sine(angle)]
            }
        }
    }))
}

fn nine(count: usize, name: &str) -> Result<()> {
    if count == PUBLISHED_SENSORS {
        return Ok(());
    }
    let needed = "be 9 for the printed triggering distances";
    Err(Failure::invalid(name, needed, Given::Count(count as u64)))
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
        nine(count, "sensors")?;
        // Where d = d'.
        for normal in &NORMALS {
            let reach = safe_distance * (sine(normal.limit) / sine(normal.angle));
            let subtracted = if normal.from_safe { safe_distance } else { 0.0 };
            distances[normal.sensor] = reach + subtracted - face;
        }
    }
    Ok(distances)
}

#[cfg(test)]
mod tests {
    use super::{Rule, trigger_distances};
    use navigation_world::sensing::sonar::ring::{PUBLISHED_WHEEL_GAP, Ring};

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
