//! Vectors of the plane whose components are numbers of any width.

use std::ops::{Add, Neg, Sub};

pub use ::lanes::{LaneMask, Lanes, Mask, Real};

/// A vector of the plane.
#[derive(Clone, Copy, Debug)]
pub struct Vec2<R> {
    /// Component along x.
    pub x: R,
    /// Component along y.
    pub y: R,
}

impl<R: Real> Vec2<R> {
    /// The same vector in every lane.
    #[inline(always)]
    #[must_use]
    pub fn splat(vector: [f64; 2]) -> Self {
        Self {
            x: R::splat(vector[0]),
            y: R::splat(vector[1]),
        }
    }
    /// The zero vector.
    #[inline(always)]
    #[must_use]
    pub fn zero() -> Self {
        Self::splat([0.0, 0.0])
    }
    /// Dot product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y
    }
    /// Out-of-plane component of the cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> R {
        self.x * other.y - self.y * other.x
    }
    /// The vector turned counter-clockwise by a right angle.
    #[inline(always)]
    #[must_use]
    pub fn perp(self) -> Self {
        Self {
            x: -self.y,
            y: self.x,
        }
    }
    /// Product with a number.
    #[inline(always)]
    #[must_use]
    pub fn scale(self, factor: R) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
        }
    }
    /// `then` where the mask is true, `otherwise` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, then: Self, otherwise: Self) -> Self {
        Self {
            x: R::select(mask, then.x, otherwise.x),
            y: R::select(mask, then.y, otherwise.y),
        }
    }
    /// The vector of one lane.
    #[inline(always)]
    pub fn lane(self, index: usize) -> [f64; 2] {
        [self.x.lane(index), self.y.lane(index)]
    }
}

impl<R: Real> Add for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
        }
    }
}

impl<R: Real> Sub for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
        }
    }
}

impl<R: Real> Neg for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
        }
    }
}
