//! Places of the sensors on the chassis, and what follows from their gaps.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use numeric::error::{Failure, Given, Result, finite, not_negative, positive};

/// Most sensors of a ring: a pattern has one bit for each.
pub const MOST_SENSORS: usize = 64;

/// Number of sensors of the published ring.
pub const PUBLISHED_SENSORS: usize = 9;

/// Angle `theta_1` between a wheel and the sensors beside it in the published ring, in rad.
pub const PUBLISHED_WHEEL_GAP: f64 = PI / 8.0;

/// Farthest that sensors stand outside the chassis, in radii: a sign or a unit is wrong beyond.
const FARTHEST_OUTSIDE: f64 = 1.0;

/// Largest ratio of the two radii of sensors of which a number is told.
const MOST_RATIO: f64 = 1e6;

/// Sensors on a circle, clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    chassis_radius: f64,
    inset: f64,
    bearings: Vec<f64>,
}

impl Ring {
    /// Sensors at given bearings in rad, on a chassis of a radius R in m; their faces lie an inset
    /// w in m inside its edge, or outside if it is negative.
    ///
    /// # Errors
    /// There is no sensor or too many, or a number cannot be.
    pub fn new(chassis_radius: f64, inset: f64, bearings: Vec<f64>) -> Result<Self> {
        positive("chassis_radius", chassis_radius)?;
        finite("sensor_inset", inset)?;
        if inset >= chassis_radius || inset < -FARTHEST_OUTSIDE * chassis_radius {
            let rule = "be below chassis_radius, and not below its negative: sensors outside";
            return Err(Failure::invalid("sensor_inset", rule, Given::Number(inset)));
        }
        check_count(bearings.len())?;
        for (index, bearing) in bearings.iter().enumerate() {
            finite(&format!("bearings[{index}]"), *bearing)?;
        }
        Ok(Self {
            chassis_radius,
            inset,
            bearings,
        })
    }

    /// Bearings of a ring with two sensors beside each of the wheels at 90, 210 and 330 deg, at an
    /// angle `theta_1` in rad from it, and the others evenly between them. Clockwise; the last one is
    /// the one beside the wheel at 210 deg that is nearer to the wheel at 90 deg.
    ///
    /// # Errors
    /// The number is no multiple of three from 6 on, or the angle is not between 0 and 60 deg.
    pub fn beside_wheels(count: usize, wheel_gap: f64) -> Result<Vec<f64>> {
        check_count(count)?;
        if count < 6 || !count.is_multiple_of(3) {
            let rule = "be a multiple of 3 of at least 6 beside three wheels";
            return Err(Failure::invalid(
                "sensors",
                rule,
                Given::Count(count as u64),
            ));
        }
        let gap = closing_gap(count, wheel_gap)?;
        let each = count / 3;
        let section =
            |wheel: f64| (0..each).map(move |place| wheel - wheel_gap - place as f64 * gap);
        let wheels = [7.0 * PI / 6.0, FRAC_PI_2, -PI / 6.0];
        let mut bearings: Vec<f64> = wheels.into_iter().flat_map(section).collect();
        bearings.rotate_left(1);
        Ok(bearings)
    }

    /// Bearings of a ring with equal gaps; the first sensor looks north.
    ///
    /// # Errors
    /// There is no sensor, or there are too many.
    pub fn even(count: usize) -> Result<Vec<f64>> {
        check_count(count)?;
        let gap = TAU / count as f64;
        Ok((0..count)
            .map(|place| FRAC_PI_2 - place as f64 * gap)
            .collect())
    }

    /// Radius R of the chassis, in m.
    #[must_use]
    pub fn chassis_radius(&self) -> f64 {
        self.chassis_radius
    }

    /// Distance R - w of the sensor faces from the center, in m.
    #[must_use]
    pub fn face_radius(&self) -> f64 {
        self.chassis_radius - self.inset
    }

    /// Bearings, in rad.
    #[must_use]
    pub fn bearings(&self) -> &[f64] {
        &self.bearings
    }

    /// Angles from each sensor to the next one in counterclockwise order, in rad; their sum is a
    /// full turn.
    #[must_use]
    pub fn gaps(&self) -> Vec<f64> {
        let mut turned: Vec<f64> = self
            .bearings
            .iter()
            .map(|bearing| bearing.rem_euclid(TAU))
            .collect();
        numeric::order::sort_ascending(&mut turned);
        let first = turned.first().copied().unwrap_or_default();
        let next = turned.iter().skip(1).copied().chain([first + TAU]);
        turned
            .iter()
            .zip(next)
            .map(|(one, other)| other - one)
            .collect()
    }

    /// Largest gap, in rad.
    #[must_use]
    pub fn largest_gap(&self) -> f64 {
        self.gaps().into_iter().fold(0.0, f64::max)
    }

    /// Distance `R_S` from the center at which the beams beside the largest gap meet, in m.
    #[must_use]
    pub fn safe_distance(&self) -> f64 {
        safe_distance(self.face_radius(), self.largest_gap())
    }
}

fn check_count(count: usize) -> Result<()> {
    if (1..=MOST_SENSORS).contains(&count) {
        return Ok(());
    }
    let rule = "be from 1 to 64";
    Err(Failure::invalid(
        "sensors",
        rule,
        Given::Count(count as u64),
    ))
}

fn check_wheel_gap(wheel_gap: f64) -> Result<f64> {
    if positive("wheel_gap", wheel_gap)? < FRAC_PI_3 {
        return Ok(wheel_gap);
    }
    let rule = "be below 60 deg";
    Err(Failure::invalid(
        "wheel_gap",
        rule,
        Given::Number(wheel_gap),
    ))
}

/// Gap theta in rad between sensors that are not beside a wheel, in a ring that closes:
/// 6 `theta_1` + (N - 3) theta = 2 pi. It is (4), theta + `theta_1` = 60 deg, for N = 9.
///
/// # Errors
/// There are fewer than four sensors, or the angle is not between 0 and 60 deg.
pub fn closing_gap(count: usize, wheel_gap: f64) -> Result<f64> {
    let between = sensors_between(count)?;
    Ok((TAU - 6.0 * check_wheel_gap(wheel_gap)?) / between)
}

/// N - 3, for N above 3.
fn sensors_between(count: usize) -> Result<f64> {
    if count > 3 {
        return Ok((count - 3) as f64);
    }
    let rule = "be at least 4";
    Err(Failure::invalid(
        "sensors",
        rule,
        Given::Count(count as u64),
    ))
}

/// Lengths that the printed equations (3) and (5) of the gap need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circumference {
    /// Radius R of the chassis, in m.
    pub chassis_radius: f64,
    /// Distance r of the sensors from the center, in m.
    pub sensor_radius: f64,
    /// Distance `r_1` of the sensors beside the wheels from the center, in m.
    pub wheel_sensor_radius: f64,
    /// Length L of a sensor along the edge, in m.
    pub sensor_length: f64,
    /// Correction factor a of the length.
    pub correction: f64,
}

impl Circumference {
    /// Returns the lengths if they are valid.
    ///
    /// # Errors
    /// A number is not finite or not positive.
    pub fn checked(self) -> Result<Self> {
        positive("chassis_radius", self.chassis_radius)?;
        positive("sensor_radius", self.sensor_radius)?;
        positive("wheel_sensor_radius", self.wheel_sensor_radius)?;
        positive("sensor_length", self.sensor_length)?;
        not_negative("correction", self.correction)?;
        Ok(self)
    }

    /// 2 pi R - a N L, in m.
    fn free(&self, count: usize) -> f64 {
        TAU * self.chassis_radius - self.correction * count as f64 * self.sensor_length
    }

    /// Length of the arcs of (2) between the sensors, `3 S_1 + (N - 3) S_2` in m, for angles in rad.
    fn arcs(&self, count: usize, wheel_gap: f64, gap: f64) -> Result<f64> {
        Ok(3.0 * self.wheel_sensor_radius * wheel_gap
            + sensors_between(count)? * self.sensor_radius * gap)
    }

    /// Radius of the chassis that (1) closes for angles in rad, in m:
    /// `(a N L + 3 S_1 + (N - 3) S_2) / (2 pi)`.
    ///
    /// # Errors
    /// There are fewer than four sensors, or an angle is out of range.
    pub fn closing_radius(&self, count: usize, wheel_gap: f64, gap: f64) -> Result<f64> {
        check_wheel_gap(wheel_gap)?;
        positive("gap", gap)?;
        let sensors = self.correction * count as f64 * self.sensor_length;
        Ok((sensors + self.arcs(count, wheel_gap, gap)?) / TAU)
    }

    /// Gap theta by (3), in rad.
    ///
    /// # Errors
    /// There are fewer than four sensors, or the angle is not between 0 and 60 deg.
    pub fn printed_gap(&self, count: usize, wheel_gap: f64) -> Result<f64> {
        let beside = 3.0 * self.wheel_sensor_radius * check_wheel_gap(wheel_gap)?;
        Ok((self.free(count) - beside) / (sensors_between(count)? * self.sensor_radius))
    }

    /// Gap theta by (5), in rad: (3) with `theta_1` = 60 deg - theta.
    ///
    /// # Errors
    /// There are fewer than four sensors, or (6) does not hold.
    pub fn printed_gap_closed(&self, count: usize) -> Result<f64> {
        let scale = sensors_between(count)? * self.sensor_radius - 3.0 * self.wheel_sensor_radius;
        if scale <= 0.0 {
            let rule = "exceed 3 (1 + r_1/r) by (6)";
            return Err(Failure::invalid(
                "sensors",
                rule,
                Given::Count(count as u64),
            ));
        }
        Ok((self.free(count) - PI * self.wheel_sensor_radius) / scale)
    }

    /// Factor a for which (3) gives the gap of the ring that closes.
    ///
    /// # Errors
    /// There are fewer than four sensors, or the angle is not between 0 and 60 deg.
    pub fn closing_correction(&self, count: usize, wheel_gap: f64) -> Result<f64> {
        let covered = self.arcs(count, wheel_gap, closing_gap(count, wheel_gap)?)?;
        Ok((TAU * self.chassis_radius - covered) / (count as f64 * self.sensor_length))
    }
}

/// Least number of sensors by (6), N > 3 (1 + `r_1`/r), and the next multiple of three from it on.
///
/// # Errors
/// A radius is not finite and positive, or they are of different orders of magnitude.
pub fn least_sensors(wheel_sensor_radius: f64, sensor_radius: f64) -> Result<[f64; 2]> {
    let ratio = positive("wheel_sensor_radius", wheel_sensor_radius)?
        / positive("sensor_radius", sensor_radius)?;
    let least = (3.0 * (1.0 + ratio)).floor() + 1.0;
    if ratio > MOST_RATIO {
        let rule = format!("be at most {MOST_RATIO:e} times sensor_radius");
        let given = Given::Number(wheel_sensor_radius);
        return Err(Failure::invalid("wheel_sensor_radius", rule, given)
            .mended_by("both radii are in m, from the same center"));
    }
    Ok([least, 3.0 * (least / 3.0).ceil()])
}

/// Distance `R_S` from the center, in m, at which lines at 135 deg from the inward axes of two
/// sensors at a radius r meet: r / (cos(gap/2) - sin(gap/2)). Infinite from a gap of 90 deg on.
#[must_use]
pub fn safe_distance(sensor_radius: f64, gap: f64) -> f64 {
    if gap >= FRAC_PI_2 {
        return f64::INFINITY;
    }
    let (sin, cos) = (0.5 * gap).sin_cos();
    sensor_radius / (cos - sin)
}

#[cfg(test)]
mod tests {
    use super::{
        Circumference, PUBLISHED_WHEEL_GAP, Ring, closing_gap, least_sensors, safe_distance,
    };

    const DEGREE: f64 = std::f64::consts::PI / 180.0;

    fn published() -> Circumference {
        Circumference {
            chassis_radius: 0.33,
            sensor_radius: 0.33,
            wheel_sensor_radius: 0.33,
            sensor_length: 0.046,
            correction: 0.68,
        }
    }

    #[test]
    fn nine_sensors_stand_where_the_text_needs_them() {
        let expected = [150.0, 112.5, 67.5, 30.0, -7.5, -52.5, -90.0, -127.5, 187.5];
        let bearings = Ring::beside_wheels(9, PUBLISHED_WHEEL_GAP).unwrap();
        for (bearing, degrees) in bearings.iter().zip(expected) {
            assert!((bearing - degrees * DEGREE).abs() < 1e-15 * 8.0);
        }
    }

    #[test]
    fn every_ring_closes() {
        for count in [6, 9, 12, 15, 24] {
            let bearings = Ring::beside_wheels(count, 0.3).unwrap();
            let ring = Ring::new(0.33, 0.0, bearings).unwrap();
            let gap = closing_gap(count, 0.3).unwrap();
            assert!((ring.gaps().iter().sum::<f64>() - std::f64::consts::TAU).abs() < 1e-13);
            let beside = ring
                .gaps()
                .iter()
                .filter(|own| (**own - 0.6).abs() < 1e-12)
                .count();
            let between = ring
                .gaps()
                .iter()
                .filter(|own| (**own - gap).abs() < 1e-12)
                .count();
            assert_eq!((beside, between), (3, count - 3));
        }
    }

    #[test]
    fn the_printed_gap_does_not_close_the_ring() {
        let lengths = published();
        let by_3 = lengths.printed_gap(9, PUBLISHED_WHEEL_GAP).unwrap() / DEGREE;
        let by_5 = lengths.printed_gap_closed(9).unwrap() / DEGREE;
        assert!(
            (by_3 - 40.6).abs() < 0.05 && (by_5 - 43.7).abs() < 0.05,
            "{by_3} {by_5}"
        );
        let factor = lengths.closing_correction(9, PUBLISHED_WHEEL_GAP).unwrap();
        assert!((factor - 0.939).abs() < 5e-4);
    }

    #[test]
    fn safe_distance_is_where_the_two_lines_meet() {
        // Two lines from the sensor faces, each turned by 45 deg towards the other.
        let (radius, gap) = (0.33_f64, 45.0 * DEGREE);
        let half = 0.5 * gap;
        let (face, turned) = (
            [radius * half.cos(), radius * half.sin()],
            half - 45.0 * DEGREE,
        );
        let meeting = face[0] - face[1] * turned.cos() / turned.sin();
        assert!((safe_distance(radius, gap) - meeting).abs() < 1e-15 * 4.0);
        assert!((safe_distance(radius, gap) - 0.6098).abs() < 5e-5);
        assert!((safe_distance(radius, 37.5 * DEGREE) - 0.5276).abs() < 5e-5);
        assert!(safe_distance(radius, 90.0 * DEGREE).is_infinite());
    }

    #[test]
    fn seven_sensors_are_the_least_and_nine_the_next_multiple() {
        assert_eq!(least_sensors(0.33, 0.33), Ok([7.0, 9.0]));
        assert_eq!(least_sensors(0.30, 0.33), Ok([6.0, 6.0]));
    }
}
