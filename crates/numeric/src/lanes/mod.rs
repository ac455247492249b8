//! Numbers of one kernel: `f64` for a single run, [`Lanes`] and [`Packed`] for runs side by side.
//!
//! Every operation acts on each lane by the same IEEE operation as `f64`, fused only where
//! [`Number::mul_add`] says so, so a run gives the same bits at any width. [`Lanes`] are plain arrays, and the compiler turns their
//! loops into vector instructions; [`Packed`] is one of the processor.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

mod arrays;
mod packed;
mod planar;
mod scalar;
mod vectors;

pub use arrays::{LaneMask, Lanes};
pub use nalgebra::Vector2;
pub use num_traits::{One, Zero};
pub use packed::{Packed, PackedMask};
pub use planar::Planar;
pub use vectors::{OnEight, Vectors, on_eight, vectors};

/// Truths side by side, made from others.
pub trait Truth:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + Not<Output = Self>
{
    /// Whether any lane is true.
    fn any(self) -> bool;
    /// Truth of one lane.
    fn lane(self, index: usize) -> bool;
    /// Truths as bits, that of the first lane lowest.
    fn bits(self) -> u32;
}

/// Outcome of a comparison, lane by lane.
pub trait Mask: Truth + PartialEq {
    /// A mask with one truth in every lane.
    fn splat(value: bool) -> Self;
    /// The mask with one lane made false.
    #[must_use]
    fn without(self, index: usize) -> Self;
    /// Makes one lane true, where the mask is in memory.
    fn set(&mut self, index: usize);

    /// No lane is true.
    #[inline(always)]
    #[must_use]
    fn none() -> Self {
        Self::splat(false)
    }
}

/// A real number, or several side by side, made from others: what needs no constant but beside a number
/// it has already. Packed numbers are made so, which exist only where the processor has their vectors.
pub trait Number:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + MulAssign
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Result of a comparison.
    type Mask: Truth;
    /// Number of lanes.
    const WIDTH: usize;

    /// A number with the same value in every lane.
    #[must_use]
    fn like(self, value: f64) -> Self;
    /// A number with a value for each lane.
    #[must_use]
    fn like_each(self, value: impl FnMut(usize) -> f64) -> Self;
    /// A mask with one truth in every lane.
    fn truth(self, value: bool) -> Self::Mask;
    /// Value of one lane.
    fn lane(self, index: usize) -> f64;
    /// Writes the first lanes.
    fn write(self, to: &mut [f64]);
    /// `self * factor + addend`, rounded once. Every processor with vectors has it; where one has not, it is
    /// a call of a library with the same bits, so kernels that also run without vectors do without it.
    #[must_use]
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// `2^k` of an integer `k` between -1022 and 1023 that is given as `1.5 * 2^52 + k`.
    #[must_use]
    fn power_of_two(self) -> Self;
    /// Whether `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `then` where the mask is true, `otherwise` elsewhere; the value not taken may be NaN.
    #[must_use]
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;

    /// The smaller of two numbers; `other` where either is NaN.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// The larger of two numbers; `other` where either is NaN.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
    /// Whether `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// Whether `self >= other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
}

/// A real number, or several side by side, that need no processor of a kind.
pub trait Real: Number<Mask: Mask> + PartialEq + Zero + One {
    /// A number with one value in every lane.
    fn splat(value: f64) -> Self;
    /// A value for each lane.
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self;
    /// Value of one lane, where the number is in memory: no copy of the other lanes is made.
    #[inline(always)]
    fn at(&self, index: usize) -> f64 {
        self.lane(index)
    }
    /// The number with one lane replaced.
    #[must_use]
    fn replace(self, index: usize, value: f64) -> Self;
    /// Changes one lane, where the number is in memory.
    #[inline(always)]
    fn set(&mut self, index: usize, value: f64) {
        *self = self.replace(index, value);
    }
    /// Magnitude of `self` with the sign of `sign`.
    #[must_use]
    fn copysign(self, sign: Self) -> Self;
    /// `m` from `sqrt(1/2)` to `sqrt(2)` and an integer `k` with `self = m 2^k`, of a positive number of full precision.
    #[inline(always)]
    #[must_use]
    fn mantissa_and_exponent(self) -> [Self; 2] {
        // Exponents are counted from the bits of `sqrt(1/2)`; 1024 more of them keep the difference above zero.
        const SQRT_HALF: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
        const MORE: u64 = 1024 << 52;
        const WHOLE: f64 = 4_503_599_627_370_496.0;
        let above = |lane: usize| {
            self.lane(lane)
                .to_bits()
                .wrapping_sub(SQRT_HALF)
                .wrapping_add(MORE)
        };
        let mantissa = Self::from_fn(|lane| {
            let power = above(lane) >> 52 << 52;
            f64::from_bits(
                self.lane(lane)
                    .to_bits()
                    .wrapping_add(MORE)
                    .wrapping_sub(power),
            )
        });
        // The last bits of a number from 2^52 on hold an integer.
        let whole = Self::from_fn(|lane| f64::from_bits(above(lane) >> 52 | WHOLE.to_bits()));
        [mantissa, whole - Self::splat(WHOLE + 1024.0)]
    }
    /// +1 where `self >= 0`, -1 elsewhere.
    #[inline(always)]
    #[must_use]
    fn sign(self) -> Self {
        Self::select(self.ge(Self::zero()), Self::splat(1.0), Self::splat(-1.0))
    }
}

/// Numbers of each lane from its number alone, for what has no lanes.
#[inline(always)]
pub fn each<R: Real, const N: usize>(x: R, of: impl Fn(f64) -> [f64; N]) -> [R; N] {
    let mut found = [R::zero(); N];
    for lane in 0..R::WIDTH {
        for (number, of_lane) in found.iter_mut().zip(of(x.lane(lane))) {
            number.set(lane, of_lane);
        }
    }
    found
}
