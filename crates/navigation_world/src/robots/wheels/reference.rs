//! Wanted motion of a wheel.

/// Reference of a wheel at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelWish {
    /// Angle in rad.
    pub angle: f64,
    /// Speed in rad/s.
    pub speed: f64,
    /// Acceleration in rad/s^2.
    pub acceleration: f64,
}

/// Wanted motion from wanted speeds, one for each wheel period: the acceleration by numerical
/// differentiation, the angle by integration (trapezoid rule), as in section 7.4 of Zeng (2011).
#[derive(Clone, Copy, Debug)]
pub struct WheelReference {
    period: f64,
    last: WheelWish,
}

impl WheelReference {
    /// A wheel at rest at angle 0; `period` in s.
    #[must_use]
    pub fn new(period: f64) -> Self {
        Self {
            period,
            last: WheelWish::default(),
        }
    }

    /// The wish for the next wanted speed in rad/s. A speed that jumps once in several periods
    /// gives a spike of acceleration; interpolate it first.
    pub fn next(&mut self, speed: f64) -> WheelWish {
        let before = self.last.speed;
        self.last = WheelWish {
            angle: self.last.angle + 0.5 * self.period * (before + speed),
            speed,
            acceleration: (speed - before) / self.period,
        };
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_of_speed_is_exact() {
        let mut reference = WheelReference::new(0.01);
        let mut wish = WheelWish::default();
        for step in 1..=100 {
            wish = reference.next(3.0 * 0.01 * f64::from(step));
        }
        assert!((wish.angle - 1.5).abs() < 1e-12 && (wish.speed - 3.0).abs() < 1e-15);
        assert!((wish.acceleration - 3.0).abs() < 1e-9);
    }
}
