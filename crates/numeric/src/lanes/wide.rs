//! Numbers that robots side by side share, or that each of them has for itself.

use super::{Lanes, Mask, Real};

/// A number as robots in lanes of kind `R` see it: the same one for all, or one a lane.
pub trait Wide<R: Real>: Real {
    /// The number of every lane.
    fn wide(self) -> R;
    /// The truth of every lane.
    fn wide_mask(mask: Self::Mask) -> R::Mask;
}

impl<R: Real> Wide<R> for f64 {
    #[inline(always)]
    fn wide(self) -> R {
        R::splat(self)
    }
    #[inline(always)]
    fn wide_mask(mask: bool) -> R::Mask {
        R::Mask::splat(mask)
    }
}

impl<const N: usize> Wide<Self> for Lanes<N> {
    #[inline(always)]
    fn wide(self) -> Self {
        self
    }
    #[inline(always)]
    fn wide_mask(mask: Self::Mask) -> Self::Mask {
        mask
    }
}
