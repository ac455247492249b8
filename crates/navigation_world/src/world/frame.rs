//! Frames in the plane: where a robot or a sensor is, and where it looks.

use nalgebra::Vector2;

use numeric::error::{Result, finite_pair, positive};

/// Which way a robot faces: as an angle, or as the unit vector of a robot that needs no angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Heading {
    /// In rad, counterclockwise from x.
    Angle(f64),
    /// Unit vector.
    Direction(Vector2<f64>),
}

impl Heading {
    /// Unit vector.
    #[inline]
    #[must_use]
    pub fn direction(self) -> Vector2<f64> {
        match self {
            Self::Angle(angle) => {
                let (sin, cos) = angle.sin_cos();
                Vector2::new(cos, sin)
            }
            Self::Direction(direction) => direction,
        }
    }
}

/// Origin and unit vector of the x axis; y is to its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Origin, in m.
    pub position: Vector2<f64>,
    /// Unit vector of the x axis: forward.
    pub direction: Vector2<f64>,
}

impl Frame {
    /// At a position in m, with its x axis at an angle in rad.
    #[must_use]
    pub fn at(position: [f64; 2], angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            position: position.into(),
            direction: Vector2::new(cos, sin),
        }
    }

    /// Returns the frame if its numbers are finite and its axis has a direction.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        finite_pair("position", self.position.into())?;
        let [x, y] = finite_pair("direction", self.direction.into())?;
        positive("length of direction", x.hypot(y))?;
        Ok(self)
    }

    /// Angle of the x axis in rad, from -pi to pi.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.direction.y.atan2(self.direction.x)
    }

    /// The vector with components along and to the left of the x axis.
    #[inline]
    #[must_use]
    pub fn outward(&self, own: Vector2<f64>) -> Vector2<f64> {
        let axis = self.direction;
        Vector2::new(
            axis.x * own.x - axis.y * own.y,
            axis.y * own.x + axis.x * own.y,
        )
    }

    /// Components of a vector along and to the left of the x axis.
    #[inline]
    #[must_use]
    pub fn inward(&self, vector: Vector2<f64>) -> Vector2<f64> {
        let axis = self.direction;
        Vector2::new(axis.dot(&vector), axis.perp(&vector))
    }

    /// Frame of something that is mounted in this one.
    #[inline]
    #[must_use]
    pub fn carrying(&self, mounted: &Self) -> Self {
        Self {
            position: self.position + self.outward(mounted.position),
            direction: self.outward(mounted.direction),
        }
    }
}
