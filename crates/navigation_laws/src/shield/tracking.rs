//! How nearly a robot does what is planned for it.

use numeric::error::{Result, not_negative};

/// Largest difference between the velocity of a robot and that of its plan: `s_abs + s_rel |v|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingError {
    /// `s_abs` in m/s.
    pub absolute: f64,
    /// `s_rel`, a share of the planned speed.
    pub relative: f64,
}

impl Default for TrackingError {
    /// A base that stands when it is to stand, and follows to 2 %.
    fn default() -> Self {
        Self {
            absolute: 0.0,
            relative: 0.02,
        }
    }
}

impl TrackingError {
    /// A robot that does exactly what is planned.
    pub const EXACT: Self = Self {
        absolute: 0.0,
        relative: 0.0,
    };

    /// Returns it if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        not_negative("velocity_tracking[0]", self.absolute)?;
        not_negative("velocity_tracking[1]", self.relative)?;
        Ok(self)
    }

    /// Largest difference at a planned speed, in m/s.
    #[inline]
    #[must_use]
    pub fn velocity(&self, speed: f64) -> f64 {
        self.absolute + self.relative * speed
    }

    /// Sine of the largest angle between the directions at a planned speed; 1 or more: any direction.
    #[inline]
    pub(super) fn sine(&self, speed: f64) -> f64 {
        if self.absolute == 0.0 {
            return self.relative;
        }
        self.relative + self.absolute / speed.max(f64::MIN_POSITIVE)
    }

    /// Tracking errors of twice the size.
    #[must_use]
    pub fn doubled(&self) -> Self {
        Self {
            absolute: 2.0 * self.absolute,
            relative: 2.0 * self.relative,
        }
    }
}
