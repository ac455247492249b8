//! Motions that a robot can make next: twists within reach, arcs, poses.

use std::f64::consts::{PI, TAU};

use super::Vector;
use numeric::error::{Failure, Given, Result, not_negative};

/// Ends of a range nearer than this are one.
const SAME: f64 = 1e-5;

/// Turns below this are straight, in rad: the arc differs by less than its rounding.
const STRAIGHT: f64 = 1e-9;

/// Position in m and heading in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position in m.
    pub position: Vector,
    /// Heading in rad.
    pub heading: f64,
}

impl Pose {
    /// Ahead of it.
    #[must_use]
    pub fn front(&self) -> Vector {
        let (sine, cosine) = self.heading.sin_cos();
        Vector::new(cosine, sine)
    }

    /// A way in the axes of the robot.
    #[must_use]
    pub fn inward(&self, way: Vector) -> Vector {
        let front = self.front();
        Vector::new(front.dot(&way), front.perp(&way))
    }

    /// Bearing of a place in rad, 0 ahead.
    #[must_use]
    pub fn bearing(&self, place: Vector) -> f64 {
        let way = self.inward(place - self.position);
        way.y.atan2(way.x)
    }
}

/// An angle in (-pi, pi].
#[must_use]
pub fn wrap(angle: f64) -> f64 {
    let rest = angle - TAU * (angle / TAU).round();
    if rest <= -PI { rest + TAU } else { rest }
}

/// Way along the exact arc of a length in m, from a heading in rad whose cosine and sine are given, that turns by an
/// angle in rad.
#[must_use]
pub fn arc(front: Vector, length: f64, turn: f64) -> Vector {
    // Chord `length sin(turn/2)/(turn/2)` half way through the turn.
    let (sine, cosine) = (0.5 * turn).sin_cos();
    let chord = if turn.abs() < STRAIGHT {
        length
    } else {
        length * sine / (0.5 * turn)
    };
    Vector::new(
        front.x * cosine - front.y * sine,
        front.x * sine + front.y * cosine,
    ) * chord
}

/// So many values from one to another, ends included.
pub fn evenly(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    let step = (high - low) / count.saturating_sub(1).max(1) as f64;
    (0..count).map(move |index| {
        if index > 0 && index + 1 == count {
            high
        } else {
            low + step * index as f64
        }
    })
}

/// Limits of a velocity along an axis, or of the turn rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// Least value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// Largest rise in a second.
    pub acceleration: f64,
    /// Largest fall in a second, not positive.
    pub deceleration: f64,
}

impl AxisLimits {
    /// Whether least and largest value are in order.
    ///
    /// # Errors
    /// They are not, or a rate has the wrong sign.
    pub fn checked(self, names: [&str; 4]) -> Result<Self> {
        if self.most < self.least {
            let rule = format!("be at least {}, {}", names[0], self.least);
            return Err(Failure::invalid(names[1], rule, Given::Number(self.most)));
        }
        not_negative(names[2], self.acceleration)?;
        if self.deceleration > 0.0 {
            let rule = "be negative or 0: the rate at which the velocity falls";
            return Err(Failure::invalid(
                names[3],
                rule,
                Given::Number(self.deceleration),
            ));
        }
        Ok(self)
    }

    /// A velocity moved towards another one for a time in s.
    #[inline]
    #[must_use]
    pub fn toward(&self, now: f64, target: f64, time: f64) -> f64 {
        if now < target {
            (now + self.acceleration * time).min(target)
        } else {
            (now + self.deceleration * time).max(target)
        }
    }

    /// Values within reach in a time in s: so many, and 0 between neighbors of opposite sign.
    pub fn samples(&self, now: f64, time: f64, count: usize, values: &mut Vec<f64>) {
        values.clear();
        let now = now.clamp(self.least, self.most);
        let high = self.toward(now, self.most, time);
        let low = self.toward(now, self.least, time);
        if (high - low).abs() < SAME {
            values.push(low);
            return;
        }
        let mut before = 0.0;
        for value in evenly(low, high, count.max(2)) {
            if before < 0.0 && value > 0.0 {
                values.push(0.0);
            }
            values.push(value);
            before = value;
        }
    }
}
