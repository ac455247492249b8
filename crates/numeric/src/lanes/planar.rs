//! Vectors of the plane whose components are numbers of any width.

use nalgebra::Vector2;

use super::Real;

/// Operations of kernels on a vector beyond its arithmetic, lane by lane.
pub trait Planar<R: Real> {
    /// One vector in every lane.
    fn splat(vector: [f64; 2]) -> Self;
    /// The vector turned counter-clockwise by a right angle.
    #[must_use]
    fn left_normal(self) -> Self;
    /// The length.
    #[must_use]
    fn length(self) -> R;
    /// The vector over a number.
    #[must_use]
    fn over(self, divisor: R) -> Self;
    /// `then` where the mask is true, `otherwise` elsewhere.
    #[must_use]
    fn select(mask: R::Mask, then: Self, otherwise: Self) -> Self;
    /// The vector of one lane.
    fn lane(self, index: usize) -> [f64; 2];
    /// Replaces the vector of one lane.
    fn set_lane(&mut self, index: usize, vector: [f64; 2]);
}

impl<R: Real> Planar<R> for Vector2<R> {
    #[inline(always)]
    fn splat([x, y]: [f64; 2]) -> Self {
        Self::new(R::splat(x), R::splat(y))
    }
    #[inline(always)]
    fn left_normal(self) -> Self {
        Self::new(-self.y, self.x)
    }
    #[inline(always)]
    fn length(self) -> R {
        self.dot(&self).sqrt()
    }
    #[inline(always)]
    fn over(self, divisor: R) -> Self {
        Self::new(self.x / divisor, self.y / divisor)
    }
    #[inline(always)]
    fn select(mask: R::Mask, then: Self, otherwise: Self) -> Self {
        Self::new(
            R::select(mask, then.x, otherwise.x),
            R::select(mask, then.y, otherwise.y),
        )
    }
    #[inline(always)]
    fn lane(self, index: usize) -> [f64; 2] {
        [self.x.lane(index), self.y.lane(index)]
    }
    #[inline(always)]
    fn set_lane(&mut self, index: usize, [x, y]: [f64; 2]) {
        self.x.set(index, x);
        self.y.set(index, y);
    }
}
