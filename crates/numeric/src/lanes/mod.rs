//! Numbers of one kernel, two widths: `f64` for a single run and [`Lanes`] for runs side by side.
//!
//! Every operation acts on each lane by the same IEEE operation as `f64`, without contraction,
//! so a run gives the same bits at any width. Plain arrays: the compiler turns the loops into
//! vector instructions.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

mod planar;
mod scalar;
mod vector;
mod vectors;
mod wide;

pub use nalgebra::Vector2;
pub use num_traits::{One, Zero};
pub use planar::{Planar, widened};
pub use vector::{Vector, VectorMask};
pub use vectors::{OnEight, Vectors, on_eight, vectors};
pub use wide::Wide;

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
    /// The same truth in every lane.
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
/// it has already. Vectors of the processor are such numbers, which exist only where it has them.
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
    /// What a comparison gives.
    type Mask: Truth;
    /// Number of lanes.
    const WIDTH: usize;

    /// A number with the same value in every lane.
    #[must_use]
    fn like(self, value: f64) -> Self;
    /// A number with a value for each lane.
    #[must_use]
    fn like_each(self, value: impl FnMut(usize) -> f64) -> Self;
    /// The same truth in every lane.
    fn truth(self, value: bool) -> Self::Mask;
    /// Value of one lane.
    fn lane(self, index: usize) -> f64;
    /// Writes the first lanes.
    fn write(self, to: &mut [f64]);
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
    /// The same value in every lane.
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

/// `N` numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const N: usize>([f64; N]);

/// `N` truths side by side, each all ones or all zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneMask<const N: usize>([u64; N]);

macro_rules! lane_operator {
    ($operator:ident, $method:ident) => {
        impl<const N: usize> $operator for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for (a, b) in self.0.iter_mut().zip(other.0) {
                    *a = a.$method(b);
                }
                self
            }
        }
    };
}
lane_operator!(Add, add);
lane_operator!(Sub, sub);
lane_operator!(Mul, mul);
lane_operator!(Div, div);

macro_rules! constant_operator {
    ($operator:ident, $method:ident) => {
        impl<const N: usize> $operator<f64> for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(Self::splat(other))
            }
        }
    };
}
constant_operator!(Add, add);
constant_operator!(Sub, sub);
constant_operator!(Mul, mul);

macro_rules! lane_assignment {
    ($operator:ident, $method:ident, $plain:ident) => {
        impl<const N: usize> $operator for Lanes<N> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = self.$plain(other);
            }
        }
    };
}
lane_assignment!(AddAssign, add_assign, add);
lane_assignment!(SubAssign, sub_assign, sub);
lane_assignment!(MulAssign, mul_assign, mul);

impl<const N: usize> Zero for Lanes<N> {
    #[inline(always)]
    fn zero() -> Self {
        Self([0.0; N])
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0 == [0.0; N]
    }
}

impl<const N: usize> One for Lanes<N> {
    #[inline(always)]
    fn one() -> Self {
        Self([1.0; N])
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

macro_rules! mask_operator {
    ($operator:ident, $method:ident) => {
        impl<const N: usize> $operator for LaneMask<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for (a, b) in self.0.iter_mut().zip(other.0) {
                    *a = a.$method(b);
                }
                self
            }
        }
    };
}
mask_operator!(BitAnd, bitand);
mask_operator!(BitOr, bitor);

impl<const N: usize> Not for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(mut self) -> Self {
        for a in &mut self.0 {
            *a = !*a;
        }
        self
    }
}

impl<const N: usize> Truth for LaneMask<N> {
    #[inline(always)]
    fn any(self) -> bool {
        let mut joined = 0;
        for a in self.0 {
            joined |= a;
        }
        joined != 0
    }
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        self.0[index] != 0
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        let mut bits = 0;
        for (lane, a) in self.0.into_iter().enumerate() {
            bits |= u32::from(a != 0) << lane;
        }
        bits
    }
}

impl<const N: usize> Mask for LaneMask<N> {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self([if value { u64::MAX } else { 0 }; N])
    }
    #[inline(always)]
    fn without(mut self, index: usize) -> Self {
        self.0[index] = 0;
        self
    }
    #[inline(always)]
    fn set(&mut self, index: usize) {
        self.0[index] = u64::MAX;
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for a in &mut self.0 {
            *a = f(*a);
        }
        self
    }
    #[inline(always)]
    fn compare(self, other: Self, holds: impl Fn(f64, f64) -> bool) -> LaneMask<N> {
        let mut mask = [0; N];
        for ((m, a), b) in mask.iter_mut().zip(self.0).zip(other.0) {
            *m = if holds(a, b) { u64::MAX } else { 0 };
        }
        LaneMask(mask)
    }
}

impl<const N: usize> Number for Lanes<N> {
    type Mask = LaneMask<N>;
    const WIDTH: usize = N;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(value)
    }
    #[inline(always)]
    fn like_each(self, value: impl FnMut(usize) -> f64) -> Self {
        Self::from_fn(value)
    }
    #[inline(always)]
    fn write(self, to: &mut [f64]) {
        to.copy_from_slice(&self.0[..to.len()]);
    }
    #[inline(always)]
    fn truth(self, value: bool) -> LaneMask<N> {
        LaneMask::splat(value)
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0[index]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        self.map(Number::power_of_two)
    }
    #[inline(always)]
    fn min(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = if *a < b { *a } else { b };
        }
        self
    }
    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = if b < *a { *a } else { b };
        }
        self
    }
    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask<N> {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: Self) -> LaneMask<N> {
        self.compare(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn select(mask: LaneMask<N>, mut then: Self, otherwise: Self) -> Self {
        for ((a, b), m) in then.0.iter_mut().zip(otherwise.0).zip(mask.0) {
            *a = f64::from_bits((a.to_bits() & m) | (b.to_bits() & !m));
        }
        then
    }
}

impl<const N: usize> Real for Lanes<N> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(value))
    }
    #[inline(always)]
    fn at(&self, index: usize) -> f64 {
        self.0[index]
    }
    #[inline(always)]
    fn replace(mut self, index: usize, value: f64) -> Self {
        self.0[index] = value;
        self
    }
    #[inline(always)]
    fn set(&mut self, index: usize, value: f64) {
        self.0[index] = value;
    }
    #[inline(always)]
    fn copysign(mut self, sign: Self) -> Self {
        for (a, s) in self.0.iter_mut().zip(sign.0) {
            *a = a.copysign(s);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_lane_is_changed_in_its_place() {
        let mut numbers = Lanes::<8>::from_fn(|lane| lane as f64);
        numbers.set(3, -1.0);
        assert_eq!(numbers, numbers.replace(3, -1.0));
        assert_eq!((numbers.at(2), numbers.lane(3)), (2.0, -1.0));
        let (mut mask, mut truth) = (LaneMask::<8>::none(), false);
        mask.set(5);
        truth.set(0);
        assert!(truth && (0..8).all(|lane| mask.lane(lane) == (lane == 5)));
    }

    #[test]
    fn bits_tell_which_lanes_are_true() {
        let odd = Lanes::<8>::from_fn(|lane| (lane % 2) as f64);
        assert_eq!(odd.gt(Lanes::zero()).bits(), 0b1010_1010);
        assert_eq!(LaneMask::<8>::splat(true).bits(), 0xff);
        assert_eq!((true.bits(), false.bits()), (1, 0));
    }
}
