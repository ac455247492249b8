//! Collision vectors from the echoes of one or two sensors.

use crate::error::{Result, not_negative};
use crate::sensing::sonar::Pose;

/// Point of an echo, `P_i = S_i + r_i (cos th_i, sin th_i)`, (11) and (13): where a sensor stands,
/// and its reading in m along its axis.
#[inline]
#[must_use]
pub fn collision_point(sensor: &Pose, reading: f64) -> [f64; 2] {
    [
        sensor.position[0] + reading * sensor.direction[0],
        sensor.position[1] + reading * sensor.direction[1],
    ]
}

/// Foot by the components of (14) as printed, `V` the slope of the line: the sign of `x_i` in the
/// second one is wrong, so that the vector is not perpendicular; NaN for lines along an axis. Kept to
/// be shown beside [`foot`].
#[must_use]
pub fn printed_foot(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let slope = (other[1] - one[1]) / (other[0] - one[0]);
    let scale = slope + 1.0 / slope;
    [
        (slope * one[0] - one[1]) / scale,
        (one[0] + one[1] / slope) / scale,
    ]
}

/// Foot of the perpendicular from the origin on the line through two points, (14) as a vector:
/// `P - (P.d) d` with the unit vector `d` of the line; the first point if both are one.
#[inline]
#[must_use]
pub fn foot(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let along = [other[0] - one[0], other[1] - one[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    if square == 0.0 {
        return one;
    }
    let share = -(one[0] * along[0] + one[1] * along[1]) / square;
    [one[0] + share * along[0], one[1] + share * along[1]]
}

/// Foot on the line moved to the segment between the points if it lies outside.
#[inline]
#[must_use]
pub fn clamped_foot(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let along = [other[0] - one[0], other[1] - one[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    if square == 0.0 {
        return one;
    }
    let share = (-(one[0] * along[0] + one[1] * along[1]) / square).clamp(0.0, 1.0);
    [one[0] + share * along[0], one[1] + share * along[1]]
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
    /// Passes a rule that can be.
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
    pub fn joins(&self, points: [[f64; 2]; 2], readings: [f64; 2]) -> bool {
        let apart = [points[1][0] - points[0][0], points[1][1] - points[0][1]];
        let limit = self.gap + self.share * readings[0].min(readings[1]);
        apart[0] * apart[0] + apart[1] * apart[1] < limit * limit
    }
}

/// A collision vector and the sensors it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// Vector from the origin of the sensors to the obstacle, in m.
    pub vector: [f64; 2],
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
    points: &[[f64; 2]; 3],
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
