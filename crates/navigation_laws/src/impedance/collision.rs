//! Collision vectors from the echoes of one or two sensors.

use nalgebra::Vector2;

use navigation_world::world::frame::Frame;
use numeric::error::{Result, not_negative};

/// Point of an echo, `P_i = S_i + r_i (cos th_i, sin th_i)`, (11) and (13): where a sensor stands,
/// and its reading in m along its axis.
#[inline]
#[must_use]
pub fn collision_point(sensor: &Frame, reading: f64) -> Vector2<f64> {
    sensor.position + sensor.direction * reading
}

/// Foot by the components of (14) as printed, `V` the slope of the line: the sign of `x_i` in the
/// second one is wrong, so that the vector is not perpendicular; NaN for lines along an axis. Kept to
/// be shown beside [`foot`].
#[must_use]
pub fn printed_foot(one: Vector2<f64>, other: Vector2<f64>) -> Vector2<f64> {
    let slope = (other.y - one.y) / (other.x - one.x);
    let scale = slope + 1.0 / slope;
    Vector2::new(
        (slope * one.x - one.y) / scale,
        (one.x + one.y / slope) / scale,
    )
}

/// Foot of the perpendicular from the origin on the line through two points, (14) as a vector:
/// `P - (P.d) d` with the unit vector `d` of the line; the first point if both are one.
#[inline]
#[must_use]
pub fn foot(one: Vector2<f64>, other: Vector2<f64>) -> Vector2<f64> {
    let along = other - one;
    let square = along.dot(&along);
    if square == 0.0 {
        return one;
    }
    one + along * (-one.dot(&along) / square)
}

/// Foot on the line moved to the segment between the points if it lies outside.
#[inline]
#[must_use]
pub fn clamped_foot(one: Vector2<f64>, other: Vector2<f64>) -> Vector2<f64> {
    let along = other - one;
    let square = along.dot(&along);
    if square == 0.0 {
        return one;
    }
    one + along * (-one.dot(&along) / square).clamp(0.0, 1.0)
}

/// When the echoes of two neighboring sensors belong to one obstacle: their points are less than
/// `gap + share * r` apart, `r` the smaller reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pairing {
    /// Distance at zero range, in m.
    pub gap: f64,
    /// Growth with the smaller reading.
    pub share: f64,
}

impl Default for Pairing {
    fn default() -> Self {
        Self {
            gap: 0.5,
            share: 0.6,
        }
    }
}

impl Pairing {
    /// Returns the rule if its values are valid.
    ///
    /// # Errors
    /// A number is not finite, or negative.
    pub fn checked(self) -> Result<Self> {
        not_negative("pairing_gap", self.gap)?;
        not_negative("pairing_share", self.share)?;
        Ok(self)
    }

    /// Whether two echoes belong to one obstacle.
    #[inline]
    #[must_use]
    pub fn joins(&self, points: [Vector2<f64>; 2], readings: [f64; 2]) -> bool {
        let apart = points[1] - points[0];
        let limit = self.gap + self.share * readings[0].min(readings[1]);
        apart.dot(&apart) < limit * limit
    }
}

/// A collision vector and the sensors it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// Vector from the origin of the sensors to the obstacle, in m.
    pub vector: Vector2<f64>,
    /// Which of [`CASES`] it is.
    pub case: usize,
}

/// Sensors (right, center, left) of a collision vector: three of case I, two of case II.
pub const CASES: [&[usize]; 5] = [&[0], &[1], &[2], &[0, 1], &[1, 2]];

/// Collision vectors of three sensors, right to left: at most three, one of two sensors first.
/// Neighbors are paired first right with center, then center with left if both are still free;
/// every other echo stands alone. A reading that is not finite is no echo.
#[inline]
#[must_use]
pub fn pair_echoes(
    points: &[Vector2<f64>; 3],
    readings: &[f64; 3],
    pairing: &Pairing,
) -> [Option<Collision>; 3] {
    let joins = |first: usize| {
        let second = first + 1;
        readings[first].is_finite()
            && readings[second].is_finite()
            && pairing.joins(
                [points[first], points[second]],
                [readings[first], readings[second]],
            )
    };
    let alone = |sensor: usize| {
        readings[sensor].is_finite().then(|| Collision {
            vector: points[sensor],
            case: sensor,
        })
    };
    let joined = |first: usize| {
        Some(Collision {
            vector: clamped_foot(points[first], points[first + 1]),
            case: 3 + first,
        })
    };
    if joins(0) {
        [joined(0), alone(2), None]
    } else if joins(1) {
        [joined(1), alone(0), None]
    } else {
        [alone(0), alone(1), alone(2)]
    }
}
