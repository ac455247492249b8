//! Attraction to a point before the source.

use nalgebra::Vector2;

use numeric::error::{Result, not_negative};

/// Spring and damper to the target: `F_m = K_r (X_r - X_s) - D_r V`, (18).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attraction {
    /// Spring coefficient `K_r`, in N/m.
    pub stiffness: f64,
    /// Damping coefficient `D_r`, in N s/m.
    pub damping: f64,
    /// Distance of the target from the source, in m.
    pub standoff: f64,
}

impl Default for Attraction {
    fn default() -> Self {
        Self {
            stiffness: 2.0,
            damping: 1.0,
            standoff: 0.9,
        }
    }
}

impl Attraction {
    /// Returns the numbers if they are valid.
    ///
    /// # Errors
    /// A number is not finite, or negative.
    pub fn checked(self) -> Result<Self> {
        not_negative("attraction_stiffness", self.stiffness)?;
        not_negative("attraction_damping", self.damping)?;
        not_negative("standoff", self.standoff)?;
        Ok(self)
    }

    /// How far ahead the target of a source at a range is, in m.
    #[inline]
    #[must_use]
    pub fn advance(&self, range: f64) -> f64 {
        (range - self.standoff).max(0.0)
    }

    /// Force in N toward a target at an offset in m, for a velocity in m/s.
    #[inline]
    #[must_use]
    pub fn force(&self, offset: Vector2<f64>, velocity: Vector2<f64>) -> Vector2<f64> {
        offset * self.stiffness - velocity * self.damping
    }
}
