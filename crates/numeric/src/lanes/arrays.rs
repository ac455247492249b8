//! Numbers side by side in arrays, of which the compiler makes vectors.

use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

use super::{Mask, Number, One, Real, Truth, Zero};

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
    fn mul_add(mut self, factor: Self, addend: Self) -> Self {
        for ((a, b), c) in self.0.iter_mut().zip(factor.0).zip(addend.0) {
            *a = a.mul_add(b, c);
        }
        self
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
